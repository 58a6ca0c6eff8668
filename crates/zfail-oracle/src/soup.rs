//! The scene's triangles in f64.
//!
//! In: meshes and instances. Out: world triangles relative to the centre of the scene, so that offsets of 10^6 m cost
//! no precision, wound so that fronts are fronts in world space. They are kept once per mesh, in object space, and placed
//! when they are asked for: a thousand instances take no more memory than one.

use glam::{DMat3, DVec3};
use std::collections::HashMap;
use zfail_scene::{AlphaMode, Instance, Material, Scene};

/// Which triangle of which instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Id {
    pub instance: u32,
    /// Number among [`Soup::faces`] of the instance's mesh.
    pub face: u32,
}

/// A triangle as the oracle sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    /// Vertices relative to [`Soup::origin`], counter-clockwise seen from the front.
    pub v: [DVec3; 3],
    /// `(b - a) x (c - a)`: twice the area, towards the front.
    pub normal: DVec3,
    /// Per edge `v[i] -> v[i + 1]`, the triangle of the same instance that alone shares it, traversing it backwards.
    pub neighbours: [Option<Id>; 3],
    /// Largest size of the products in the transformation of its vertices: rounding errors are proportional to it.
    pub extent: f64,
    pub instance: u32,
    /// Index in its mesh.
    pub index: u32,
    /// Seen by the camera: blended triangles are not, also where they cast.
    pub visible: bool,
    /// Drawn where alpha is high enough.
    pub masked: bool,
    pub double_sided: bool,
    /// Blocks light, per-light exclusions aside.
    pub casts: bool,
    /// Whether shadows fall on it.
    pub receives: bool,
}

impl Triangle {
    /// Whether both are of one instance and share a corner.
    pub fn touches(&self, other: &Self) -> bool {
        self.instance == other.instance && self.v.iter().any(|p| other.v.contains(p))
    }

    /// Whether both have the same three corners.
    pub fn coincides(&self, other: &Self) -> bool {
        self.v.iter().all(|p| other.v.contains(p)) && other.v.iter().all(|p| self.v.contains(p))
    }
}

/// A triangle of a mesh.
#[derive(Clone, Debug)]
pub(crate) struct Face {
    /// Object space, as stored.
    pub corners: [DVec3; 3],
    /// As in [`Triangle`], among the faces of the mesh.
    neighbours: [Option<u32>; 3],
    /// Of the coordinates of its corners, the largest sum.
    size: f64,
    index: u32,
    visible: bool,
    masked: bool,
    double_sided: bool,
    casts: bool,
}

/// Where an instance is.
#[derive(Clone, Debug)]
pub(crate) struct Placement {
    pub mesh: usize,
    pub linear: DMat3,
    /// Relative to [`Soup::origin`].
    pub translation: DVec3,
    mirrored: bool,
    /// The largest element of `linear`.
    pub magnitude: f64,
    casts: bool,
    receives: bool,
}

/// All opaque and masked triangles: blended ones are no surfaces, and here only if they block light.
#[derive(Clone, Debug)]
pub(crate) struct Soup {
    /// World position of the list's zero.
    pub origin: DVec3,
    /// By mesh.
    pub faces: Vec<Vec<Face>>,
    /// Of every instance; `None` if it has no mesh.
    pub placements: Vec<Option<Placement>>,
    /// Largest [`Triangle::extent`].
    pub extent: f64,
}

impl Soup {
    pub fn new(scene: &Scene) -> Self {
        let bounds = scene.bounds();
        let origin = if bounds.is_empty() { DVec3::ZERO } else { bounds.center() };
        let faces: Vec<Vec<Face>> = (0..scene.meshes.len()).map(|mesh| faces(scene, mesh)).collect();
        let place = |instance: &Instance| faces.get(instance.mesh).map(|_| Placement::new(instance, origin));
        let placements: Vec<_> = scene.instances.iter().map(place).collect();
        let sizes: Vec<f64> = faces.iter().map(|f| f.iter().map(|face| face.size).fold(0.0, f64::max)).collect();
        let extents = placements.iter().flatten().map(|placement| placement.magnitude * sizes[placement.mesh]);
        let extent = extents.fold(0.0, f64::max);
        Self { origin, faces, placements, extent }
    }

    /// A triangle in its place; one that has no area there is neither visible nor does it cast.
    ///
    /// # Panics
    /// If there is none.
    pub fn triangle(&self, id: Id) -> Triangle {
        let Some(place) = &self.placements[id.instance as usize] else { unreachable!("an instance without triangles") };
        let face = &self.faces[place.mesh][id.face as usize];
        let mut v = face.corners.map(|p| place.linear * p + place.translation);
        let mut neighbours = face.neighbours.map(|n| n.map(|face| Id { face, ..id }));
        if place.mirrored {
            v.swap(1, 2);
            neighbours.swap(0, 2);
        }
        let normal = (v[1] - v[0]).cross(v[2] - v[0]);
        let solid = normal != DVec3::ZERO;
        Triangle {
            v,
            normal,
            neighbours,
            extent: place.magnitude * face.size,
            instance: id.instance,
            index: face.index,
            visible: face.visible && solid,
            masked: face.masked,
            double_sided: face.double_sided,
            casts: face.casts && place.casts && solid,
            receives: place.receives,
        }
    }
}

impl Placement {
    fn new(instance: &Instance, origin: DVec3) -> Self {
        let linear = instance.world_from_object.matrix3;
        let columns = [linear.x_axis, linear.y_axis, linear.z_axis];
        Self {
            mesh: instance.mesh,
            linear,
            translation: instance.world_from_object.translation - origin,
            mirrored: linear.determinant() < 0.0,
            magnitude: columns.map(|column| column.abs().max_element()).into_iter().fold(0.0, f64::max),
            casts: instance.casts_shadow,
            receives: instance.receives_shadow,
        }
    }
}

/// The triangles of a mesh that are of interest.
fn faces(scene: &Scene, mesh: usize) -> Vec<Face> {
    let of = &scene.meshes[mesh];
    let face = |(t, corners): (usize, &[u32; 3])| {
        let material = of.material_of(t).and_then(|m| scene.materials.get(m));
        let blended = material.is_some_and(Material::is_blended);
        let corners = corners.map(|c| of.position(c));
        let [a, b, c] = corners;
        // Collinear ones may have an area where they are placed, for what rounding does to them.
        let is_nothing = a == b || b == c || c == a || blended && !scene.blended_casts;
        (!is_nothing).then(|| Face {
            corners,
            neighbours: [None; 3],
            size: corners.iter().map(|p| p.abs().element_sum()).fold(0.0, f64::max),
            index: t as u32,
            visible: !blended,
            masked: matches!(material.map_or(AlphaMode::Opaque, |m| m.alpha), AlphaMode::Mask(_)),
            double_sided: material.is_some_and(|m| m.double_sided),
            casts: material.is_none_or(|_| scene.triangle_casts(mesh, t)),
        })
    };
    let mut faces: Vec<Face> = of.triangles.iter().enumerate().filter_map(face).collect();
    link(&mut faces);
    faces
}

/// Fills in [`Face::neighbours`].
fn link(faces: &mut [Face]) {
    let bits = |p: DVec3| p.to_array().map(|x| (x + 0.0).to_bits());
    let key = |face: &Face, i: usize| {
        let (a, b) = (bits(face.corners[i]), bits(face.corners[(i + 1) % 3]));
        (a.min(b), a.max(b))
    };
    let mut users: HashMap<_, Vec<(u32, usize)>> = HashMap::new();
    for (index, face) in faces.iter().enumerate() {
        let [a, b, c] = face.corners;
        if (b - a).cross(c - a) != DVec3::ZERO {
            for i in 0..3 {
                users.entry(key(face, i)).or_default().push((index as u32, i));
            }
        }
    }
    for edge in users.values() {
        let &[(s, i), (t, j)] = &edge[..] else { continue };
        if faces[s as usize].corners[i] == faces[t as usize].corners[(j + 1) % 3] {
            faces[s as usize].neighbours[i] = Some(t);
            faces[t as usize].neighbours[j] = Some(s);
        }
    }
}
