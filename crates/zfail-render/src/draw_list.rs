//! What is drawn and in which order: one draw per primitive of each instance.

use std::ops::Range;
use zfail_plan::glam::{DAffine3, DVec3};
use zfail_plan::scene::{AlphaMode, Bounds, Instance, Scene};

/// One primitive of one instance.
#[derive(Clone, Debug)]
pub struct Draw {
    /// Index into the scene's instances.
    pub instance: usize,
    /// Index into the scene's meshes.
    pub mesh: usize,
    /// Index into the uploaded materials, of which the last is the default one.
    pub material: usize,
    /// Range of the mesh's index buffer.
    pub indices: Range<u32>,
    /// The fixed-function state that it needs.
    pub state: DrawState,
    /// Centre of its bounds, object space.
    center: DVec3,
}

/// What a pipeline depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct DrawState {
    /// How alpha is used.
    pub alpha: Alpha,
    /// Both sides are visible.
    pub double_sided: bool,
    /// The instance's transform turns triangles inside out.
    pub mirrored: bool,
    /// No light applies.
    pub unlit: bool,
}

impl DrawState {
    /// This state in every pose that its instance may take.
    pub fn poses(self) -> [Self; 2] {
        [false, true].map(|mirrored| Self { mirrored, ..self })
    }
}

/// [`AlphaMode`] without its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Alpha {
    Opaque,
    Mask,
    Blend,
}

/// Everything the scene shows.
#[derive(Clone, Debug)]
pub struct DrawList {
    /// Opaque and masked, ordered to change state seldom.
    pub solid: Vec<Draw>,
    /// Blended, in scene order.
    pub blended: Vec<Draw>,
}

impl DrawList {
    /// Lists the draws of a scene that has passed [`crate::check::scene`].
    pub fn new(scene: &Scene) -> Self {
        let mut list = Self { solid: Vec::new(), blended: Vec::new() };
        for (i, instance) in scene.instances.iter().enumerate() {
            let mesh = &scene.meshes[instance.mesh];
            for primitive in mesh.primitives.iter().filter(|p| !p.triangles.is_empty()) {
                let material = primitive.material.map(|m| &scene.materials[m]);
                let alpha = match material.map_or(AlphaMode::Opaque, |m| m.alpha) {
                    AlphaMode::Opaque => Alpha::Opaque,
                    AlphaMode::Mask(_) => Alpha::Mask,
                    AlphaMode::Blend => Alpha::Blend,
                };
                let triangles = &mesh.triangles[primitive.triangles.start as usize..primitive.triangles.end as usize];
                let draw = Draw {
                    instance: i,
                    mesh: instance.mesh,
                    material: primitive.material.unwrap_or(scene.materials.len()),
                    indices: primitive.triangles.start * 3..primitive.triangles.end * 3,
                    state: DrawState {
                        alpha,
                        double_sided: material.is_some_and(|m| m.double_sided),
                        mirrored: mirrors(&instance.world_from_object),
                        unlit: material.is_some_and(|m| m.unlit),
                    },
                    center: Bounds::of(triangles.iter().flatten().map(|&v| mesh.position(v))).center(),
                };
                if alpha == Alpha::Blend { &mut list.blended } else { &mut list.solid }.push(draw);
            }
        }
        list.sort();
        list
    }

    fn sort(&mut self) {
        self.solid.sort_by_key(|d| (d.state, d.material, d.mesh));
    }

    /// Follows instances that were moved, since their new transforms may mirror.
    pub fn pose(&mut self, instances: &[Instance]) {
        for draw in self.solid.iter_mut().chain(&mut self.blended) {
            draw.state.mirrored = mirrors(&instances[draw.instance].world_from_object);
        }
        self.sort();
    }
}

fn mirrors(world_from_object: &DAffine3) -> bool {
    world_from_object.matrix3.determinant() < 0.0
}

/// `draws` from the farthest to the nearest, equals in scene order.
pub fn back_to_front<'d>(draws: &'d [Draw], view_from_object: &[DAffine3]) -> Vec<&'d Draw> {
    let mut sorted: Vec<_> =
        draws.iter().map(|d| (view_from_object[d.instance].transform_point3(d.center).z, d)).collect();
    sorted.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    sorted.into_iter().map(|(_, d)| d).collect()
}
