//! One scene mesh from one glTF mesh: its primitives completed, posed and put one after the other.
//!
//! In: a mesh of a validated document, its morph weights and, if skinned, its joints. Out: a [`Mesh`] at rest, near its own
//! origin, the translation that puts it back, and if it bends what other poses are made from.

use super::document::Document;
use super::schema::{self, Mode};
use super::surface::{Losses, Surface};
use super::{pose, shading};
use crate::shared::error::{Result, refused};
use glam::{DAffine3, DVec2, DVec3};
use zfail_plan::bounds::Bounds;
use zfail_scene::animate::MAX_COORDINATE;
use zfail_scene::deform::{Section, alike};
use zfail_scene::placement::{localize, recenter};
use zfail_scene::{Material, Mesh, Primitive, TextureRef};

/// A mesh as some node uses it; equal poses are built once.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Pose {
    /// Index into the document's meshes.
    pub mesh: usize,
    /// Bits of the morph weights.
    pub weights: Vec<u64>,
    /// Index into the document's skins.
    pub skin: Option<usize>,
    /// The node, if animations change its morph weights: no other has the same then.
    pub node: Option<usize>,
}

/// A mesh ready for the scene.
pub(super) struct Built {
    /// Without triangles if nothing in it can be drawn.
    pub mesh: Mesh,
    /// Translation from the mesh's coordinates to the node's space, or to the world if skinned.
    pub origin: DVec3,
    /// Of the mesh, without the origin.
    pub bounds: Bounds,
    /// Of a mesh that bends.
    pub sections: Vec<Section>,
    pub notices: Vec<String>,
}

/// Bytes that a vertex occupies while its mesh is built: the attributes twice over, in both precisions.
const VERTEX_COST: u64 = 200;

/// Builds the mesh for `pose`. `joints` take the mesh's space to the world; `bends` tells whether anything moves them or the
/// morph weights.
pub(super) fn build(
    document: &Document<'_>,
    pose: &Pose,
    joints: Option<&[DAffine3]>,
    bends: bool,
    materials: &[Material],
) -> Result<Built> {
    let source = &document.root.meshes[pose.mesh];
    let name = source.name.clone().unwrap_or_else(|| format!("mesh {}", pose.mesh));
    let weights: Vec<f64> = pose.weights.iter().map(|&bits| f64::from_bits(bits)).collect();
    let mut assembly = Assembly { joints, bends, ..Assembly::new(document, materials, &weights) };
    for (j, primitive) in source.primitives.iter().enumerate() {
        assembly.append(primitive, &format!("meshes[{}].primitives[{j}]", pose.mesh))?;
    }
    let notices = assembly.counts.notices(&name);
    let (mesh, origin, sections) = assembly.finish(name);
    if mesh.positions.iter().flatten().any(|&x| f64::from(x).abs() > MAX_COORDINATE) || origin.length() > MAX_COORDINATE
    {
        let problem = format!("reaches more than {MAX_COORDINATE:e} m from its origin");
        return Err(refused(format!("meshes[{}]", pose.mesh), problem, "scale it down"));
    }
    let bounds = mesh.bounds();
    Ok(Built { mesh, origin, bounds, sections, notices })
}

struct Assembly<'a> {
    document: &'a Document<'a>,
    materials: &'a [Material],
    weights: &'a [f64],
    joints: Option<&'a [DAffine3]>,
    bends: bool,
    positions: Vec<DVec3>,
    mesh: Mesh,
    sections: Vec<Section>,
    counts: Counts,
}

/// What could not be taken as it is.
#[derive(Default)]
struct Counts {
    no_triangles: usize,
    no_positions: usize,
    remainders: usize,
    unskinned: usize,
    normals: usize,
    attributes: usize,
    contradictions: usize,
    losses: Losses,
}

impl Counts {
    fn notices(&self, name: &str) -> Vec<String> {
        let count = |n: usize, thing: &str| match (n, thing) {
            (1, _) => format!("1 {thing}"),
            (_, "index") => format!("{n} indices"),
            _ => format!("{n} {thing}s"),
        };
        [
            (self.no_triangles, "primitive", "of points or lines: not drawn"),
            (self.no_positions, "primitive", "without POSITION: not drawn"),
            (self.remainders, "primitive", "whose vertex count is no multiple of 3: the rest is not drawn"),
            (self.unskinned, "primitive", "of a skinned mesh without joints: left in the mesh's own space"),
            (self.normals, "vertex normal", "without a direction: replaced"),
            (self.attributes, "texture coordinates or colour", "that are not finite: replaced"),
            (self.losses.nowhere, "triangle", "with a vertex that is not finite or has no joint: left out"),
            (self.losses.beyond, "triangle", "with a vertex that is not there: left out"),
            (self.losses.restarts, "index", "with the forbidden restart value: a new strip or fan begins"),
            (self.contradictions, "primitive", "whose normals disagree with its triangles: it may be shaded wrong"),
        ]
        .into_iter()
        .filter(|(n, ..)| *n > 0)
        .map(|(n, thing, what)| format!("mesh \"{name}\": {} {what}", count(n, thing)))
        .chain(self.losses.attributes.iter().map(|lost| format!("mesh \"{name}\": {lost}")))
        .collect()
    }
}

impl<'a> Assembly<'a> {
    fn new(document: &'a Document<'a>, materials: &'a [Material], weights: &'a [f64]) -> Self {
        let (positions, mesh, sections, counts) = Default::default();
        Self { document, materials, weights, joints: None, bends: false, positions, mesh, sections, counts }
    }

    fn append(&mut self, primitive: &schema::Primitive, path: &str) -> Result<()> {
        let Some(&positions) = primitive.attributes.get("POSITION") else {
            self.counts.no_positions += 1;
            return Ok(());
        };
        if matches!(primitive.mode, Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
            self.counts.no_triangles += 1;
            return Ok(());
        }
        let corners = primitive.indices.unwrap_or(positions);
        if primitive.mode == Mode::Triangles && !self.document.root.accessors[corners].count.is_multiple_of(3) {
            self.counts.remainders += 1;
        }

        let count = self.document.checked_count(positions)?;
        self.document.budget.charge(count, VERTEX_COST, || path.into())?;
        let losses = &mut self.counts.losses;
        let mut surface = Surface::read(self.document, primitive, positions, path, losses)?;
        let mut section = Section { flat: surface.normals.is_none(), ..Section::default() };
        let mut broken: Vec<bool> = surface.positions.iter().map(|p| !p.is_finite()).collect();
        let weight = |t: usize| self.weights.get(t).copied().unwrap_or(0.0);
        let wanted = |t: usize| self.bends || weight(t) != 0.0;
        section.targets = pose::targets(self.document, primitive, path, &mut broken, wanted)?;
        if let Some(joints) = self.joints {
            section.influences = pose::influences(self.document, primitive, joints.len(), path, &mut broken)?;
            self.counts.unskinned += usize::from(section.influences.is_none());
        }
        if broken.contains(&true) {
            section.gather(&surface.remove(&broken, losses));
        }
        let normals = match surface.normals.take() {
            Some(mut normals) => {
                self.counts.contradictions += usize::from(shading::contradicts(&surface, &normals));
                self.counts.normals += shading::mend_normals(&surface, &mut normals);
                normals
            }
            None => {
                self.document.budget.charge(surface.triangles.len() as u64, 3 * VERTEX_COST, || path.into())?;
                section.gather(&surface.unshare());
                // The specification has given tangents ignored along with missing normals.
                surface.tangents = None;
                shading::flat_normals(&surface)
            }
        };
        self.counts.attributes += mend_attributes(&mut surface);
        let normal_map = primitive.material.and_then(|m| self.materials[m].normal_texture);
        section.tangents = tangents(&surface, &normals, normal_map);
        section.positions = surface.positions.iter().map(|p| p.as_vec3().to_array()).collect();
        section.normals = normals.iter().map(|n| n.as_vec3().to_array()).collect();
        self.push(surface, section, primitive.material, path)
    }

    fn push(&mut self, surface: Surface, section: Section, material: Option<usize>, path: &str) -> Result<()> {
        let count = surface.positions.len();
        let (first_vertex, first_triangle) = (self.positions.len(), self.mesh.triangles.len());
        let (Ok(first_vertex), Ok(_)) = (u32::try_from(first_vertex), u32::try_from(first_vertex + count)) else {
            return Err(self.document.budget.exceeded(path.into()));
        };
        let ends = (u32::try_from(first_triangle), u32::try_from(first_triangle + surface.triangles.len()));
        let (Ok(start), Ok(end)) = ends else {
            return Err(self.document.budget.exceeded(path.into()));
        };
        let mesh = &mut self.mesh;
        mesh.triangles.extend(surface.triangles.iter().map(|t| t.map(|v| first_vertex + v)));
        if start < end {
            mesh.primitives.push(Primitive { triangles: start..end, material });
        }
        let end = self.positions.len() + count;
        self.positions.resize(end, DVec3::ZERO);
        mesh.normals.resize(end, [0.0; 3]);
        mesh.tangents.resize(end, [0.0; 4]);
        let positions = &mut self.positions[end - count..];
        let (normals, tangents) = (&mut mesh.normals[end - count..], &mut mesh.tangents[end - count..]);
        section.pose(self.weights, self.joints.unwrap_or_default(), positions, normals, tangents);
        if let Some(v) = positions.iter().position(|p| !p.is_finite()) {
            let problem = format!("vertex {v}: its morph targets or joints take it to infinity");
            return Err(refused(path, problem, "give it smaller weights, or its joints smaller transforms"));
        }
        let [uv0, uv1] = surface.uv.map(|uv| uv.unwrap_or_else(|| vec![[0.0; 2]; count]));
        mesh.uv0.extend(uv0);
        mesh.uv1.extend(uv1);
        mesh.colors.extend(surface.colors.unwrap_or_else(|| vec![[1.0; 4]; count]));
        if self.bends {
            self.sections.push(section);
        }
        Ok(())
    }

    fn finish(self, name: String) -> (Mesh, DVec3, Vec<Section>) {
        let mut mesh = Mesh { name, ..self.mesh };
        if self.bends {
            mesh.alike = alike(&self.sections);
        }
        if self.joints.is_some() {
            let (origin, positions) = localize(&self.positions);
            mesh.positions = positions;
            return (mesh, origin, self.sections);
        }
        mesh.positions = self.positions.iter().map(|p| p.as_vec3().to_array()).collect();
        let origin = recenter(&mut mesh);
        (mesh, origin, self.sections)
    }
}

/// Replaces texture coordinates and colours that are not finite; returns how many there were.
fn mend_attributes(surface: &mut Surface) -> usize {
    fn mend<const N: usize>(values: &mut [[f32; N]], replacement: f32) -> usize {
        let broken = values.iter_mut().filter(|v| !v.iter().all(|x| x.is_finite()));
        broken.map(|v| *v = [replacement; N]).count()
    }
    let uv: usize = surface.uv.iter_mut().flatten().map(|uv| mend(uv, 0.0)).sum();
    uv + surface.colors.iter_mut().map(|colors| mend(colors, 1.0)).sum::<usize>()
}

/// The file's tangents, or made ones if a normal map needs them, or zeros.
fn tangents(surface: &Surface, normals: &[DVec3], normal_map: Option<TextureRef>) -> Vec<[f32; 4]> {
    if let Some(tangents) = &surface.tangents {
        return shading::mend_tangents(tangents);
    }
    let uv = normal_map.and_then(|map| Some((map.uv_from_mesh, surface.uv[usize::from(map.uv_set)].as_ref()?)));
    match uv {
        None => vec![[0.0; 4]; normals.len()],
        Some((rows, uv)) => {
            let transform = |[u, v]: [f32; 2]| DVec2::from(rows.map(|[a, b, c]| f64::from(a * u + b * v + c)));
            let uv: Vec<DVec2> = uv.iter().map(|&uv| transform(uv)).collect();
            shading::tangents(surface, normals, &uv)
        }
    }
}
