//! Whole meshes: which of their triangles are cut, along what, and what the mesh becomes.
//!
//! In: a scene, a tolerance, limits. Out: the scene with its masked primitives cut, and where new vertices come from.

use super::field::FAR;
use super::limits::{Limits, Room, Spent, Step};
use super::masks::{Masks, Pattern, Shape, alpha, triangles_of};
use super::product;
use super::triangle::{Corner, Cut, cut};
use super::vertices::{Source, Vertices, extend, extend_alike, extend_attribute};
use crate::{AlphaMode, Instance, Material, Mesh, Primitive, Scene};
use glam::DVec2;
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use std::sync::atomic::Ordering;

/// A mesh that was cut. Its first vertices are those that it had, at the same indices; the others come from `sources`.
#[derive(Clone, Debug, PartialEq)]
pub struct CutMesh {
    /// Index into [`Scene::meshes`].
    pub mesh: usize,
    /// Of each vertex behind those that the mesh had: see [`derive`].
    pub sources: Vec<Source>,
    /// How far contours may be off, in texels: what was asked for, or more if that would have exceeded the limits.
    pub tolerance: f64,
}

/// The least and the greatest tolerance, in texels. Others are moved into this range.
const TOLERANCES: [f64; 2] = [1.0 / 64.0, 1024.0];

/// Cuts all masked triangles of `scene` along the contour of their alpha, at most `tolerance` texels from it, and gives them
/// opaque copies of their materials. Meshes that exceed the limits are cut more coarsely, with a notice that says how far
/// the cut is off, or left as they are if nothing else helps.
///
/// Returns what the meshes that have changed were made from, by ascending index.
pub fn cut_masked(scene: &mut Scene, tolerance: f64, mut limits: Limits) -> Vec<CutMesh> {
    let tolerance = if tolerance >= TOLERANCES[0] { tolerance.min(TOLERANCES[1]) } else { TOLERANCES[0] };
    let Scene { meshes, materials, textures, images, instances, notices, .. } = scene;
    let masks = Masks { textures, images };
    let mut shapes = FxHashMap::default();
    let mut opaque = FxHashMap::default();
    let mut done = Vec::new();
    for (index, mesh) in meshes.iter_mut().enumerate() {
        let patterns = masks.of(mesh, materials);
        if patterns.iter().all(Option::is_none) {
            continue;
        }
        let masked = mesh.primitives.iter().zip(&patterns).filter(|(_, pattern)| pattern.is_some());
        let masked = masked.map(|(primitive, _)| triangles_of(mesh, primitive).len() as u64).sum();
        let limit = limits.of_mesh(masked);
        let found = Step::all(tolerance).find_map(|step| {
            let shapes = masks.shapes(&patterns, step, &mut limits, &mut shapes)?;
            let cutting = Cutting::new(mesh, &patterns, &shapes, step.tolerance, limit)?;
            Some((cutting, step, step.error(stretch(&masks, &patterns, &shapes))))
        });
        let Some((cutting, step, error)) = found else {
            notices.push(format!(
                "mesh \"{}\": its masked triangles would be cut into too many; they cast shadows as whole triangles",
                mesh.name
            ));
            continue;
        };
        if error > tolerance {
            let size = pixel_size(&masks, mesh, &patterns) * scale(instances, index);
            notices.push(coarser(mesh, materials, &patterns, step, [tolerance, error], size));
        }
        limits.take(masked, cutting.added);
        let sources = cutting.apply(mesh, |material| {
            *opaque.entry(material).or_insert_with(|| {
                materials.push(Material { alpha: AlphaMode::Opaque, ..materials[material].clone() });
                materials.len() - 1
            })
        });
        done.push(CutMesh { mesh: index, sources, tolerance: error });
    }
    done
}

/// A mesh with its masked primitives cut.
struct Cutting {
    triangles: Vec<[u32; 3]>,
    primitives: Vec<Primitive>,
    /// Of each primitive, whether it was cut.
    cut: Vec<bool>,
    sources: Vec<Source>,
    added: Spent,
}

impl Cutting {
    /// Cuts, or gives up where a limit is exceeded.
    fn new(
        mesh: &Mesh,
        patterns: &[Option<Pattern>],
        shapes: &[Option<&Shape<'_>>],
        tolerance: f64,
        limit: Spent,
    ) -> Option<Self> {
        /// Bytes of a vertex with its source, and of a triangle.
        const VERTEX: u64 = (size_of::<[f32; 18]>() + size_of::<Source>()) as u64;
        const TRIANGLE: u64 = size_of::<[u32; 3]>() as u64;
        let room = Room::new(limit);
        let planes: Vec<_> = patterns
            .iter()
            .zip(shapes)
            .map(|(pattern, &shape)| Some(Plane { mesh, pattern: pattern.as_ref()?, shape, tolerance, room: &room }))
            .collect();
        let cut_ones = || mesh.primitives.iter().zip(&planes).filter_map(|(p, plane)| Some((p, plane.as_ref()?)));
        // Before any triangle is cut, since cutting takes much longer.
        let expected = Room::new(limit);
        for (primitive, plane) in cut_ones() {
            let triangles = triangles_of(mesh, primitive);
            triangles
                .par_iter()
                .map(|&t| Room::take(&expected.triangles, plane.expected(t)?))
                .collect::<Option<()>>()?;
        }
        let mut vertices = Vertices::new(mesh);
        let mut all = Vec::with_capacity(mesh.triangles.len());
        let mut primitives = Vec::with_capacity(mesh.primitives.len());
        let mut added = 0;
        for (primitive, plane) in mesh.primitives.iter().zip(&planes) {
            let start = all.len();
            let triangles = triangles_of(mesh, primitive);
            if let Some(plane) = plane {
                let cuts: Vec<Cut> = triangles.par_iter().map(|&t| plane.cut(t)).collect::<Option<_>>()?;
                for (&triangle, cut) in triangles.iter().zip(&cuts) {
                    match cut {
                        Cut::Whole => all.push(triangle),
                        Cut::Nothing => {}
                        Cut::Pieces(pieces) => all.extend(vertices.of_pieces(triangle, pieces)),
                    }
                }
                added += (all.len() - start) as u64;
            } else {
                all.extend_from_slice(triangles);
            }
            primitives.push(Primitive { triangles: start as u32..all.len() as u32, material: primitive.material });
        }
        let bytes = VERTEX * vertices.sources.len() as u64 + TRIANGLE * added;
        let fits = mesh.positions.len() + vertices.sources.len() < 1 << 30 && bytes <= limit.bytes;
        let cut = patterns.iter().map(Option::is_some).collect();
        let spent = Spent { triangles: added, bytes };
        fits.then_some(Self { triangles: all, primitives, cut, sources: vertices.sources, added: spent })
    }

    /// Puts it into `mesh`; `opaque` gives the opaque copy of a material.
    fn apply(self, mesh: &mut Mesh, mut opaque: impl FnMut(usize) -> usize) -> Vec<Source> {
        let sources = self.sources;
        extend(&sources, &mut mesh.positions, &mut mesh.normals, &mut mesh.tangents);
        extend_attribute(&sources, &mut mesh.uv0, |uv| uv);
        extend_attribute(&sources, &mut mesh.uv1, |uv| uv);
        extend_attribute(&sources, &mut mesh.colors, |color| color);
        extend_alike(&sources, &mut mesh.alike);
        mesh.triangles = self.triangles;
        mesh.primitives = self.primitives;
        for (primitive, cut) in mesh.primitives.iter_mut().zip(self.cut) {
            if cut {
                primitive.material = primitive.material.map(&mut opaque);
            }
        }
        sources
    }
}

/// A primitive on the plane of its mask.
struct Plane<'a> {
    mesh: &'a Mesh,
    pattern: &'a Pattern,
    shape: Option<&'a Shape<'a>>,
    tolerance: f64,
    room: &'a Room,
}

impl Plane<'_> {
    /// About how many pieces a triangle will be cut into: there is about one for each segment of the outline. `None` if
    /// there is no room for the work.
    fn expected(&self, triangle: [u32; 3]) -> Option<u64> {
        let texels = self.corners(triangle)?.map(|corner| corner.texel);
        match self.shape {
            None => Some(1),
            Some(Shape::Outline(outline)) => {
                Room::take(&self.room.places, outline.effort(texels) as u64)?;
                Some(1 + outline.near(texels).len() as u64)
            }
            Some(Shape::Field(_)) => {
                Room::take(&self.room.places, product::effort(texels) as u64)?;
                Some(1)
            }
        }
    }

    /// What is left of a triangle; `None` if there is no room for it.
    fn cut(&self, triangle: [u32; 3]) -> Option<Cut> {
        let cut = match (self.pattern, self.shape) {
            (Pattern::Even(true), _) => return Some(Cut::Whole),
            (Pattern::Even(false), _) => return Some(Cut::Nothing),
            (Pattern::Texture(..), Some(Shape::Outline(outline))) => cut(outline, self.corners(triangle)?),
            (&Pattern::Product(_, level), shape) => {
                let field = shape.and_then(|shape| if let Shape::Field(field) = shape { Some(field) } else { None });
                let alphas = triangle.map(|v| f64::from(alpha(self.mesh, v)));
                let most = self.room.triangles.load(Ordering::Relaxed) as usize;
                product::cut(field, level, self.tolerance, self.corners(triangle)?, alphas, most)?
            }
            (Pattern::Texture(..), _) => return None,
        };
        let pieces = match &cut {
            Cut::Pieces(pieces) => pieces.len() as u64,
            Cut::Whole => 1,
            Cut::Nothing => 0,
        };
        Room::take(&self.room.triangles, pieces)?;
        Some(cut)
    }

    /// The corners of a triangle; `None` if one is too far away on the plane to be cut.
    fn corners(&self, triangle: [u32; 3]) -> Option<[Corner; 3]> {
        let size = self.shape.map_or(DVec2::ONE, Shape::size);
        let corner = |v: u32| Corner {
            position: self.mesh.positions[v as usize],
            texel: self.pattern.place(self.mesh, v) * size,
        };
        let corners = triangle.map(corner);
        // Also false where a coordinate is no number.
        corners.iter().all(|corner| corner.texel.abs().max_element() <= FAR / 4.0).then_some(corners)
    }
}

/// How many pixels of a texture are one texel of its halved image, in the direction in which that is more.
fn stretch(masks: &Masks<'_>, patterns: &[Option<Pattern>], shapes: &[Option<&Shape<'_>>]) -> f64 {
    let of_one = |(pattern, shape): (&Option<Pattern>, &Option<&Shape<'_>>)| {
        let whole = masks.size(pattern.as_ref()?.reference()?)?;
        Some((whole / shape.as_ref()?.size()).max_element())
    };
    patterns.iter().zip(shapes).filter_map(of_one).fold(1.0, f64::max)
}

/// The length of a pixel on the masked surfaces of a mesh, in units of the mesh, on the average; 0 if they have no area on
/// the texture.
fn pixel_size(masks: &Masks<'_>, mesh: &Mesh, patterns: &[Option<Pattern>]) -> f64 {
    let (mut surface, mut pixels) = (0.0, 0.0);
    for (primitive, pattern) in mesh.primitives.iter().zip(patterns) {
        let Some(pattern) = pattern else { continue };
        let Some(size) = pattern.reference().and_then(|reference| masks.size(reference)) else { continue };
        for &triangle in triangles_of(mesh, primitive) {
            let [a, b, c] = triangle.map(|v| mesh.position(v));
            surface += (b - a).cross(c - a).length();
            let [a, b, c] = triangle.map(|v| pattern.place(mesh, v) * size);
            pixels += (b - a).perp_dot(c - a).abs();
        }
    }
    if pixels > 0.0 { (surface / pixels).sqrt() } else { 0.0 }
}

/// The largest scale at which a mesh is shown, on the average of all directions.
fn scale(instances: &[Instance], mesh: usize) -> f64 {
    let shown = instances.iter().filter(|instance| instance.mesh == mesh);
    shown.map(|instance| instance.world_from_object.matrix3.determinant().abs().cbrt()).fold(0.0, f64::max)
}

/// Says how far off a cut is, in pixels and where `size` is known in metres, and what does better.
fn coarser(
    mesh: &Mesh,
    materials: &[Material],
    patterns: &[Option<Pattern>],
    step: Step,
    [wanted, error]: [f64; 2],
    size: f64,
) -> String {
    let masked = mesh.primitives.iter().zip(patterns).find(|(_, pattern)| pattern.is_some());
    let material = masked.and_then(|(primitive, _)| materials.get(primitive.material?));
    let mut text = format!("mesh \"{}\", material \"{}\": ", mesh.name, material.map_or("", |m| &m.name));
    text += "its mask has more detail than can be cut";
    if step.halvings > 0 {
        text += &format!("; with one of {0} by {0} pixels", 1_u64 << step.halvings);
    }
    text += &format!(", its edges are off by up to {} pixels of the texture", short(error));
    if size > 0.0 && size.is_finite() {
        text += &format!(" (about {} m)", short(error * size));
    }
    text + &format!(" instead of {}; --alpha-shadows solid draws it as it is and casts whole triangles", short(wanted))
}

/// A number with two digits that count.
fn short(x: f64) -> String {
    let digits = (1.0 - x.log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{x:.digits$}")
}
