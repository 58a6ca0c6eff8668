//! The moving part of a node hierarchy and what hangs on it.
//!
//! In: moves of nodes at a time. Out: the placements of instances, lights and cameras below them.

use super::Track;
use crate::Pose;
use crate::placement::{invertible, is_moderate, rigid};
use glam::{DAffine3, DQuat, DVec3};
use zfail_plan::bounds::Bounds;
use zfail_plan::light::LightKind;

/// Coordinates beyond this, in metres, are refused: their squares must stay finite in single precision.
pub const MAX_COORDINATE: f64 = 1e15;

/// The properties of a node that animations move.
#[derive(Clone, Copy, Debug)]
pub struct Trs {
    /// Metres.
    pub translation: DVec3,
    /// Of unit length.
    pub rotation: DQuat,
    /// Along the node's own axes, before it is turned.
    pub scale: DVec3,
}

impl Trs {
    /// Parent from node.
    pub fn affine(&self) -> DAffine3 {
        DAffine3::from_scale_rotation_translation(self.scale, self.rotation, self.translation)
    }
}

/// What one animation does with one node.
#[derive(Clone, Debug)]
pub struct Move {
    /// Index into the rig's nodes.
    pub node: usize,
    /// Properties without a track keep these values.
    pub rest: Trs,
    /// As [`Trs::translation`].
    pub translation: Option<Track<3>>,
    /// As [`Trs::rotation`].
    pub rotation: Option<Track<4>>,
    /// As [`Trs::scale`].
    pub scale: Option<Track<3>>,
}

impl Move {
    /// Bytes of its tracks.
    pub fn size(&self) -> u64 {
        fn size<const N: usize>(track: &Option<Track<N>>) -> u64 {
            track.as_ref().map_or(0, |track| (track.key_count() * 3 * size_of::<[f32; N]>()) as u64)
        }
        size_of::<Self>() as u64 + size(&self.translation) + size(&self.rotation) + size(&self.scale)
    }

    fn parent_from_node(&self, seconds: f64) -> DAffine3 {
        let vector = |track: &Option<Track<3>>, rest| track.as_ref().map_or(rest, |track| track.vector(seconds));
        let rotation = self.rotation.as_ref().and_then(|track| track.rotation(seconds));
        Trs {
            translation: vector(&self.translation, self.rest.translation),
            rotation: rotation.unwrap_or(self.rest.rotation),
            scale: vector(&self.scale, self.rest.scale),
        }
        .affine()
    }
}

/// A node that some animation moves, itself or by an ancestor.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// What it is relative to.
    pub parent: Parent,
    /// At rest.
    pub parent_from_node: DAffine3,
}

/// What a node of the rig is relative to.
#[derive(Clone, Copy, Debug)]
pub enum Parent {
    /// World from parent, which nothing moves.
    Fixed(DAffine3),
    /// An earlier node of the rig.
    Moving(usize),
}

/// Nodes that move, parents before children, and what they carry.
#[derive(Clone, Debug, Default)]
pub struct Rig {
    /// Those that move.
    pub nodes: Vec<Node>,
    instances: Vec<Carried<DAffine3>>,
    lights: Vec<Carried<LightKind>>,
    cameras: Vec<Carried<DAffine3>>,
}

/// An instance, light or camera.
#[derive(Clone, Debug)]
struct Carried<T> {
    /// Which, of the scene's.
    index: usize,
    /// Of the rig's.
    node: usize,
    node_from_self: DAffine3,
    /// The greatest coordinate of its geometry.
    reach: f64,
    /// Where it stays while its node is beyond all measure.
    rest: T,
}

impl Rig {
    /// Hangs instance `index`, with a mesh of `bounds`, on `node`.
    pub fn carry_instance(
        &mut self,
        index: usize,
        node: usize,
        node_from_self: DAffine3,
        bounds: &Bounds,
        rest: DAffine3,
    ) {
        let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
        self.instances.push(Carried { index, node, node_from_self, reach, rest });
    }

    /// Hangs light `index` on `node`; it shines along its own -z axis.
    pub fn carry_light(&mut self, index: usize, node: usize, node_from_self: DAffine3, rest: LightKind) {
        self.lights.push(Carried { index, node, node_from_self, reach: 0.0, rest });
    }

    /// Hangs camera `index` on `node`.
    pub fn carry_camera(&mut self, index: usize, node: usize, node_from_self: DAffine3, rest: DAffine3) {
        self.cameras.push(Carried { index, node, node_from_self, reach: 0.0, rest });
    }

    /// Per node, whether it carries anything, itself or by a descendant. `joints` are nodes that carry skins.
    pub fn loaded(&self, joints: impl Iterator<Item = usize>) -> Vec<bool> {
        let mut loaded = vec![false; self.nodes.len()];
        joints.for_each(|node| loaded[node] = true);
        let instances = self.instances.iter().chain(&self.cameras).map(|carried| carried.node);
        instances.chain(self.lights.iter().map(|light| light.node)).for_each(|node| loaded[node] = true);
        for (i, node) in self.nodes.iter().enumerate().rev() {
            if let Parent::Moving(parent) = node.parent {
                loaded[parent] |= loaded[i];
            }
        }
        loaded
    }

    /// Overwrites the placements in `pose` of all that is carried. `moves` are in the order of their nodes. Returns the
    /// world transform of every node.
    pub fn pose(&self, moves: &[Move], seconds: f64, pose: &mut Pose) -> Vec<DAffine3> {
        let mut moves = moves.iter().peekable();
        let mut world_from_node: Vec<DAffine3> = Vec::with_capacity(self.nodes.len());
        for (i, node) in self.nodes.iter().enumerate() {
            let moved = moves.next_if(|m| m.node == i).map(|m| m.parent_from_node(seconds));
            let world_from_parent = match node.parent {
                Parent::Fixed(world_from_parent) => world_from_parent,
                Parent::Moving(parent) => world_from_node[parent],
            };
            world_from_node.push(world_from_parent * moved.unwrap_or(node.parent_from_node));
        }
        for instance in &self.instances {
            let Some(slot) = pose.instances.get_mut(instance.index) else { continue };
            *slot = instance.world_from_self(&world_from_node).map_or(instance.rest, |world| DAffine3 {
                matrix3: invertible(&world.matrix3),
                translation: world.translation,
            });
        }
        for light in &self.lights {
            let Some(slot) = pose.lights.get_mut(light.index) else { continue };
            let world = light.world_from_self(&world_from_node);
            *slot = world.map_or(light.rest, |world| placed(&light.rest, &world));
            if let (Some(axes), Some(world)) = (pose.light_axes.get_mut(light.index), world) {
                *axes = rigid(&world).matrix3;
            }
        }
        for camera in &self.cameras {
            let Some(slot) = pose.cameras.get_mut(camera.index) else { continue };
            *slot = camera.world_from_self(&world_from_node).map_or(camera.rest, |world| rigid(&world));
        }
        world_from_node
    }
}

impl<T> Carried<T> {
    /// `None` if that would take it out of all measure.
    fn world_from_self(&self, world_from_node: &[DAffine3]) -> Option<DAffine3> {
        let world = world_from_node[self.node] * self.node_from_self;
        let matrix = world.matrix3.to_cols_array().iter().fold(0.0_f64, |greatest, x| greatest.max(x.abs()));
        let farthest = world.translation.abs().max_element() + 3.0 * matrix * self.reach;
        (is_moderate(&world) && farthest <= MAX_COORDINATE).then_some(world)
    }
}

/// A light like `kind` where its node stands; it shines along the node's -z axis.
pub fn placed(kind: &LightKind, world_from_node: &DAffine3) -> LightKind {
    let position = world_from_node.translation;
    let direction = (-world_from_node.matrix3.z_axis).try_normalize().unwrap_or(DVec3::NEG_Z);
    match *kind {
        LightKind::Point { range, .. } => LightKind::Point { position, range },
        LightKind::Spot { range, inner, outer, .. } => LightKind::Spot { position, direction, range, inner, outer },
        LightKind::Directional { .. } => LightKind::Directional { direction },
    }
}
