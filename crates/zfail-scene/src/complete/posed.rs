//! A scene in one of its poses, read where it lies.

use crate::{Mesh, Pose, Scene};
use glam::{DAffine3, DVec3};
use zfail_plan::bounds::Bounds;
use zfail_plan::topology::Blocking;

/// A scene, and where everything is.
#[derive(Clone, Copy)]
pub(super) struct Posed<'a> {
    pub scene: &'a Scene,
    pub pose: &'a Pose,
    /// By mesh, the vertices that triangles use.
    pub used: &'a [Vec<u32>],
}

/// A mesh where one of its instances has it.
pub(super) struct Placed<'a> {
    /// Index of the mesh.
    pub index: usize,
    pub mesh: &'a Mesh,
    /// Object space, as the pose has them.
    positions: &'a [[f32; 3]],
    pub world_from_object: DAffine3,
    pub casts: bool,
    /// The vertices that triangles use.
    pub used: &'a [u32],
}

/// A point on a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    /// World space.
    pub point: DVec3,
    /// Unit, of the triangle's front, world space.
    pub normal: DVec3,
    /// Of the triangle that it stands for, in square metres.
    pub area: f64,
    /// Whether its back is drawn too.
    pub both_sides: bool,
}

impl<'a> Posed<'a> {
    /// All instances, in the scene's order.
    pub fn placed(self) -> impl Iterator<Item = Placed<'a>> {
        self.scene.instances.iter().enumerate().map(move |(i, instance)| {
            let mesh = &self.scene.meshes[instance.mesh];
            let bent = self.pose.bent.iter().find(|bent| bent.mesh == instance.mesh);
            Placed {
                index: instance.mesh,
                mesh,
                positions: bent.map_or(&mesh.positions, |bent| &bent.positions),
                world_from_object: self.pose.instances.get(i).copied().unwrap_or(instance.world_from_object),
                casts: instance.casts_shadow,
                used: &self.used[instance.mesh],
            }
        })
    }

    /// The smallest box around all triangles.
    pub fn bounds(self) -> Bounds {
        Bounds::of(self.placed().flat_map(|placed| placed.used.iter().map(move |&v| placed.world(v))))
    }

    /// Triangles of all instances.
    pub fn triangles(self) -> usize {
        self.scene.instances.iter().map(|instance| self.scene.meshes[instance.mesh].triangles.len()).sum()
    }

    /// About `wanted` points spread over the triangles that something is seen of, as many on each.
    pub fn samples(self, wanted: usize) -> Vec<Sample> {
        let total = self.triangles();
        let (step, each) = (total.div_ceil(wanted).max(1), (wanted / total.max(1)).max(1));
        let (mut samples, mut skip) = (Vec::new(), 0);
        for placed in self.placed() {
            let count = placed.mesh.triangles.len();
            // A mirrored instance turns its triangles over.
            let side = placed.world_from_object.matrix3.determinant().signum();
            for t in (skip..count).step_by(step) {
                let surface = self.scene.triangle_blocking(placed.index, t);
                let [a, b, c] = placed.triangle(t);
                let cross = side * (b - a).cross(c - a);
                let area = 0.5 * cross.length() * step as f64 / each as f64;
                let normal = cross.try_normalize();
                let Some(normal) = normal.filter(|_| surface != Blocking::Nothing) else { continue };
                for k in 0..each {
                    let point = spread([a, b, c], k);
                    samples.push(Sample { point, normal, area, both_sides: surface != Blocking::Front });
                }
            }
            skip = (skip + step - count % step) % step;
        }
        samples
    }
}

impl Placed<'_> {
    /// Object space.
    pub fn position(&self, v: u32) -> DVec3 {
        let [x, y, z] = self.positions[v as usize];
        DVec3::new(x.into(), y.into(), z.into())
    }

    /// World space.
    pub fn world(&self, v: u32) -> DVec3 {
        self.world_from_object.transform_point3(self.position(v))
    }

    /// World space.
    pub fn triangle(&self, t: usize) -> [DVec3; 3] {
        self.mesh.triangles[t].map(|v| self.world(v))
    }
}

/// Point number `k` of many that are spread evenly over a triangle; the first is its middle.
pub(super) fn spread([a, b, c]: [DVec3; 3], k: usize) -> DVec3 {
    // A sequence of low discrepancy, folded over the diagonal.
    let [u, v] = [0.754_877_666, 0.569_840_291].map(|step: f64| (1.0 / 3.0 + k as f64 * step).fract());
    let [u, v] = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
    a + u * (b - a) + v * (c - a)
}
