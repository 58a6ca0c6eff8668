//! The scene as one list of triangles in f64.
//!
//! In: meshes and instances. Out: world triangles relative to the centre of the scene, so that offsets of 10^6 m cost
//! no precision, wound so that fronts are fronts in world space.

use glam::DVec3;
use std::collections::HashMap;
use zfail_plan::scene::{AlphaMode, Scene};

/// A triangle as the oracle sees it.
#[derive(Clone, Debug)]
pub(crate) struct Triangle {
    /// Vertices relative to [`Soup::origin`], counter-clockwise seen from the front.
    pub v: [DVec3; 3],
    /// `(b - a) x (c - a)`: twice the area, towards the front.
    pub normal: DVec3,
    /// Per edge `v[i] -> v[i + 1]`, the triangle of the same instance that alone shares it, traversing it backwards.
    pub neighbours: [Option<u32>; 3],
    /// Largest size of the products in the transformation of its vertices: rounding errors are proportional to it.
    pub extent: f64,
    pub instance: u32,
    /// Index in its mesh.
    pub index: u32,
    /// Drawn where alpha is high enough.
    pub masked: bool,
    pub double_sided: bool,
    /// Blocks light, per-light exclusions aside.
    pub casts: bool,
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

/// All opaque and masked triangles with an area: blended ones are no surfaces and block no light.
#[derive(Clone, Debug)]
pub(crate) struct Soup {
    /// World position of the list's zero.
    pub origin: DVec3,
    pub triangles: Vec<Triangle>,
}

impl Soup {
    pub fn new(scene: &Scene) -> Self {
        let bounds = scene.bounds();
        let origin = if bounds.is_empty() { DVec3::ZERO } else { bounds.center() };
        let mut triangles = Vec::new();
        for (i, instance) in scene.instances.iter().enumerate() {
            let Some(mesh) = scene.meshes.get(instance.mesh) else { continue };
            let linear = instance.world_from_object.matrix3;
            let translation = instance.world_from_object.translation - origin;
            let mirrored = linear.determinant() < 0.0;
            let magnitude = linear
                .x_axis
                .abs()
                .max_element()
                .max(linear.y_axis.abs().max_element().max(linear.z_axis.abs().max_element()));
            for (t, corners) in mesh.triangles.iter().enumerate() {
                let material = mesh.material_of(t).and_then(|m| scene.materials.get(m));
                let alpha = material.map_or(AlphaMode::Opaque, |m| m.alpha);
                let blended = alpha == AlphaMode::Blend;
                let object = corners.map(|c| mesh.position(c));
                let mut v = object.map(|p| linear * p + translation);
                if mirrored {
                    v.swap(1, 2);
                }
                let normal = (v[1] - v[0]).cross(v[2] - v[0]);
                if normal == DVec3::ZERO || blended {
                    continue;
                }
                triangles.push(Triangle {
                    v,
                    normal,
                    neighbours: [None; 3],
                    extent: magnitude * object.iter().map(|p| p.abs().element_sum()).fold(0.0, f64::max),
                    instance: i as u32,
                    index: t as u32,
                    masked: matches!(alpha, AlphaMode::Mask(_)),
                    double_sided: material.is_some_and(|m| m.double_sided),
                    casts: instance.casts_shadow && material.is_none_or(|_| scene.triangle_casts(instance.mesh, t)),
                });
            }
        }
        link(&mut triangles);
        Self { origin, triangles }
    }
}

/// Fills in [`Triangle::neighbours`].
fn link(triangles: &mut [Triangle]) {
    let bits = |p: DVec3| p.to_array().map(|x| (x + 0.0).to_bits());
    let key = |t: &Triangle, i: usize| {
        let (a, b) = (bits(t.v[i]), bits(t.v[(i + 1) % 3]));
        (t.instance, a.min(b), a.max(b))
    };
    let mut users: HashMap<_, Vec<(u32, usize)>> = HashMap::new();
    for (index, t) in triangles.iter().enumerate() {
        for i in 0..3 {
            users.entry(key(t, i)).or_default().push((index as u32, i));
        }
    }
    for edge in users.values() {
        let &[(s, i), (t, j)] = &edge[..] else { continue };
        if triangles[s as usize].v[i] == triangles[t as usize].v[(j + 1) % 3] {
            triangles[s as usize].neighbours[i] = Some(t);
            triangles[t as usize].neighbours[j] = Some(s);
        }
    }
}
