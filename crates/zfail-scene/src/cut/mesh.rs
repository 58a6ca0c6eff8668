//! Whole meshes: which of their triangles are cut, along what, and what the mesh becomes.
//!
//! In: a scene, a tolerance, limits. Out: the scene with its masked primitives cut, and where new vertices come from.

use super::field::{AlphaField, FAR};
use super::outline::Outline;
use super::triangle::{Corner, Cut, cut};
use super::vertices::{Source, Vertices, extend, extend_alike, extend_attribute};
use glam::DVec2;
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use std::sync::atomic::{AtomicU64, Ordering};
use zfail_plan::scene::{AlphaMode, Image, Material, Mesh, Primitive, Scene, Texture, TextureRef};

/// What cutting a scene may cost.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Triangles that all cut primitives of the scene may have together.
    pub triangles: u64,
    /// Bytes that the new vertices and triangles may take, and the contour of a texture while it is made.
    pub bytes: u64,
}

impl Default for Limits {
    /// 4 million triangles and 2 GiB.
    fn default() -> Self {
        Self { triangles: 4_000_000, bytes: 2 << 30 }
    }
}

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

/// A mesh whose cut is too large is tried again with tolerances so many times as large.
const COARSER: [f64; 4] = [1.0, 4.0, 16.0, 64.0];

/// Cuts all masked triangles of `scene` along the contour of their alpha, at most `tolerance` texels from it, and gives them
/// opaque copies of their materials. Meshes that exceed the limits are cut more coarsely, or left as they are, with a
/// notice.
///
/// Returns what the meshes that have changed were made from, by ascending index.
pub fn cut_masked(scene: &mut Scene, tolerance: f64, mut limits: Limits) -> Vec<CutMesh> {
    let tolerance = if tolerance >= TOLERANCES[0] { tolerance.min(TOLERANCES[1]) } else { TOLERANCES[0] };
    let Scene { meshes, materials, textures, images, notices, .. } = scene;
    let masks = Masks { textures, images };
    let mut outlines = FxHashMap::default();
    let mut opaque = FxHashMap::default();
    let mut done = Vec::new();
    for (index, mesh) in meshes.iter_mut().enumerate() {
        let patterns = masks.of(mesh, materials, notices);
        if patterns.iter().all(Option::is_none) {
            continue;
        }
        let Some((cutting, tolerance)) = COARSER.iter().find_map(|coarser| {
            let tolerance = tolerance * coarser;
            let points = (limits.bytes / BYTES_PER_POINT) as usize;
            let outlines = masks.outlines(&patterns, tolerance, points, &mut outlines)?;
            let cutting = Cutting::new(mesh, &patterns, &outlines, limits)?;
            if *coarser > 1.0 {
                notices.push(format!(
                    "mesh \"{}\": its masked triangles are cut to within {tolerance} texels only, since it would get \
                         too many triangles",
                    mesh.name
                ));
            }
            Some((cutting, tolerance))
        }) else {
            notices.push(format!(
                "mesh \"{}\": its masked triangles would be cut into too many; they cast shadows as whole triangles",
                mesh.name
            ));
            continue;
        };
        limits.triangles -= cutting.added.triangles.min(limits.triangles);
        limits.bytes -= cutting.added.bytes.min(limits.bytes);
        let sources = cutting.apply(mesh, |material| {
            *opaque.entry(material).or_insert_with(|| {
                materials.push(Material { alpha: AlphaMode::Opaque, ..materials[material].clone() });
                materials.len() - 1
            })
        });
        done.push(CutMesh { mesh: index, sources, tolerance });
    }
    done
}

/// Working memory per point of a contour.
const BYTES_PER_POINT: u64 = 192;

/// How a primitive is masked.
#[derive(Clone, Copy, Debug)]
enum Pattern {
    /// Its alpha is the same everywhere: it is there, or it is not.
    Even(bool),
    /// Along the contour of a texture at a level of 0 to 255.
    Texture(TextureRef, f64),
}

/// What masks are made of.
struct Masks<'a> {
    textures: &'a [Texture],
    images: &'a [Image],
}

/// The outlines of a scene by texture, level and tolerance; `None` for those with too many points.
type Outlines<'a> = FxHashMap<OutlineKey, Option<Outline<'a>>>;

/// Texture and the bits of level and tolerance.
type OutlineKey = (usize, u64, u64);

impl<'a> Masks<'a> {
    /// The pattern of each primitive of `mesh`, `None` for those that are not cut.
    fn of(&self, mesh: &Mesh, materials: &[Material], notices: &mut Vec<String>) -> Vec<Option<Pattern>> {
        let of_primitive = |primitive: &Primitive| {
            let material = materials.get(primitive.material?)?;
            let AlphaMode::Mask(cutoff) = material.alpha else { return None };
            let Some(alpha) = even_alpha(mesh, primitive) else {
                notices.push(format!(
                    "mesh \"{}\": its vertices differ in alpha; masked triangles cast shadows as whole triangles",
                    mesh.name
                ));
                return None;
            };
            Some(self.pattern(material, material.base_color[3] * alpha, cutoff))
        };
        mesh.primitives.iter().map(of_primitive).collect()
    }

    /// The pattern of a material whose texture's alpha is multiplied by `factor`.
    fn pattern(&self, material: &Material, factor: f32, cutoff: f32) -> Pattern {
        let solid = factor >= cutoff;
        let Some(reference) = material.base_color_texture.filter(|r| self.field(r.texture).is_some()) else {
            return Pattern::Even(solid);
        };
        let level = f64::from(cutoff) / f64::from(factor) * 255.0;
        if cutoff <= 0.0 || !(factor > 0.0 && level <= 255.0) {
            return Pattern::Even(solid);
        }
        Pattern::Texture(reference, level)
    }

    fn field(&self, texture: usize) -> Option<AlphaField<'a>> {
        let texture = self.textures.get(texture)?;
        Some(AlphaField::new(self.images.get(texture.image)?, texture))
    }

    /// Sees to it that `made` has the outlines of all `patterns`; `None` if one has more than `limit` points.
    fn outlines<'m>(
        &self,
        patterns: &[Option<Pattern>],
        tolerance: f64,
        limit: usize,
        made: &'m mut Outlines<'a>,
    ) -> Option<Vec<Option<&'m Outline<'a>>>> {
        let key = |pattern: &Option<Pattern>| match pattern {
            Some(Pattern::Texture(reference, level)) => Some((reference.texture, level.to_bits(), tolerance.to_bits())),
            _ => None,
        };
        for key in patterns.iter().filter_map(key) {
            made.entry(key)
                .or_insert_with(|| Outline::new(self.field(key.0)?, f64::from_bits(key.1), tolerance, limit))
                .as_ref()?;
        }
        let made = &*made;
        Some(patterns.iter().map(|pattern| made.get(&key(pattern)?)?.as_ref()).collect())
    }
}

/// The alpha of a primitive's vertices if it is the same for all.
fn even_alpha(mesh: &Mesh, primitive: &Primitive) -> Option<f32> {
    let mut vertices = triangles_of(mesh, primitive).iter().flatten();
    let alpha = |&v: &u32| mesh.colors.get(v as usize).map_or(1.0, |color| color[3]);
    let first = vertices.next().map_or(1.0, alpha);
    vertices.all(|v| alpha(v) == first).then_some(first)
}

fn triangles_of<'m>(mesh: &'m Mesh, primitive: &Primitive) -> &'m [[u32; 3]] {
    let range = primitive.triangles.start as usize..primitive.triangles.end as usize;
    mesh.triangles.get(range).unwrap_or(&[])
}

/// What is spent while a mesh is cut.
#[derive(Clone, Copy, Debug, Default)]
struct Spent {
    triangles: u64,
    bytes: u64,
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
        outlines: &[Option<&Outline<'_>>],
        limits: Limits,
    ) -> Option<Self> {
        /// Bytes of a vertex with its source, and of a triangle.
        const VERTEX: u64 = (size_of::<[f32; 18]>() + size_of::<Source>()) as u64;
        const TRIANGLE: u64 = size_of::<[u32; 3]>() as u64;
        let room = Room::new(limits);
        let mut vertices = Vertices::new(mesh);
        let mut all = Vec::with_capacity(mesh.triangles.len());
        let mut primitives = Vec::with_capacity(mesh.primitives.len());
        let mut added = 0;
        for ((primitive, pattern), &outline) in mesh.primitives.iter().zip(patterns).zip(outlines) {
            let start = all.len();
            let triangles = triangles_of(mesh, primitive);
            match (pattern, outline) {
                (None, _) | (Some(Pattern::Even(true)), _) => all.extend_from_slice(triangles),
                (Some(Pattern::Even(false)), _) => {}
                (Some(Pattern::Texture(reference, _)), outline) => {
                    let plane = Plane { mesh, reference, outline: outline?, room: &room };
                    let cuts: Vec<Cut> = triangles.par_iter().map(|&t| plane.cut(t)).collect::<Option<_>>()?;
                    for (&triangle, cut) in triangles.iter().zip(&cuts) {
                        match cut {
                            Cut::Whole => all.push(triangle),
                            Cut::Nothing => {}
                            Cut::Pieces(pieces) => all.extend(vertices.of_pieces(triangle, pieces)),
                        }
                    }
                }
            }
            if pattern.is_some() {
                added += (all.len() - start) as u64;
            }
            primitives.push(Primitive { triangles: start as u32..all.len() as u32, material: primitive.material });
        }
        let bytes = VERTEX * vertices.sources.len() as u64 + TRIANGLE * added;
        let fits = mesh.positions.len() + vertices.sources.len() < 1 << 30 && bytes <= limits.bytes;
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

/// What is left to spend on a mesh.
struct Room {
    triangles: AtomicU64,
    /// Buckets of an outline to be looked into.
    buckets: AtomicU64,
}

impl Room {
    fn new(limits: Limits) -> Self {
        /// Looking into a bucket takes some 10 ns.
        const BUCKETS: u64 = 1 << 28;
        Self { triangles: limits.triangles.into(), buckets: BUCKETS.into() }
    }

    fn take(of: &AtomicU64, amount: u64) -> Option<()> {
        of.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(amount)).ok().map(|_| ())
    }
}

/// A primitive on the plane of its mask.
struct Plane<'a> {
    mesh: &'a Mesh,
    reference: &'a TextureRef,
    outline: &'a Outline<'a>,
    room: &'a Room,
}

impl Plane<'_> {
    /// What the outline leaves of a triangle; `None` if there is no room for it.
    fn cut(&self, triangle: [u32; 3]) -> Option<Cut> {
        let corners = triangle.map(|v| Corner { position: self.mesh.positions[v as usize], texel: self.texel(v) });
        let texels = corners.map(|corner| corner.texel);
        // Also false where a coordinate is no number.
        if !texels.iter().all(|texel| texel.abs().max_element() <= FAR / 4.0) {
            return None;
        }
        Room::take(&self.room.buckets, self.outline.effort(texels) as u64)?;
        let cut = cut(self.outline, corners);
        let pieces = match &cut {
            Cut::Pieces(pieces) => pieces.len() as u64,
            Cut::Whole => 1,
            Cut::Nothing => 0,
        };
        Room::take(&self.room.triangles, pieces)?;
        Some(cut)
    }

    /// Where a vertex lies on the plane.
    fn texel(&self, vertex: u32) -> DVec2 {
        let uv = if self.reference.uv_set == 0 { &self.mesh.uv0 } else { &self.mesh.uv1 };
        let [u, v] = uv.get(vertex as usize).copied().unwrap_or_default().map(f64::from);
        let [x, y] = self.reference.uv_from_mesh.map(|[a, b, c]| f64::from(a) * u + f64::from(b) * v + f64::from(c));
        DVec2::new(x, y) * self.outline.size()
    }
}
