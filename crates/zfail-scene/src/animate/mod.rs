//! Scenes that move: keyframes of nodes and morph weights, and the pose of everything at a moment.
//!
//! In: a scene at rest, the part of its node hierarchy that moves, and key frames. Out: a [`Pose`] for any time.
//! Data flow: `track` (a value over time) -> `rig` (local transforms, world transforms, whatever hangs on the nodes)
//! -> [`crate::deform`] (skins and morph targets).
//!
//! A pose is a function of animation and time alone: frames may be asked for in any order.

mod rig;
mod track;

pub use rig::{MAX_COORDINATE, Move, Node, Parent, Rig, Trs, placed};
pub use track::{Interpolation, Track};

use crate::complete::Framing;
use crate::cut::{self, CutMesh};
use crate::deform::{Body, Frame};
use crate::{Pose, Scene};
use glam::DAffine3;

/// A scene with the animations that move its instances, lights and cameras, and bend its meshes.
#[derive(Clone, Debug, Default)]
pub struct Animated {
    /// The scene at rest. Instances, lights and cameras may be added behind those that are there, as
    /// [`crate::complete`] does; what is there keeps its index.
    pub scene: Scene,
    /// In the order of the file.
    pub animations: Vec<Animation>,
    /// How the last of the scene's cameras frames it, if [`crate::Setting::complete`] has added that.
    pub framing: Option<Framing>,
    /// The nodes that move.
    pub rig: Rig,
    /// The meshes that bend.
    pub bodies: Vec<Body>,
}

/// An animation by name.
#[derive(Clone, Debug, Default)]
pub struct Animation {
    /// As in the file, or an invented one.
    pub name: String,
    /// Time of the last key, seconds. Beyond it, and before the first key, everything stands still.
    pub duration: f64,
    /// What it does with nodes, in the order of the rig's.
    pub moves: Vec<Move>,
    /// What it does with morph weights.
    pub morphs: Vec<Morph>,
}

/// What an animation does with the morph weights of a body.
#[derive(Clone, Debug)]
pub struct Morph {
    /// Index into [`Animated::bodies`].
    pub body: usize,
    /// By morph target.
    pub weights: Vec<Track<1>>,
}

impl Animation {
    /// Whether it moves anything of the scene.
    #[must_use]
    pub fn moves_anything(&self) -> bool {
        !self.moves.is_empty() || !self.morphs.is_empty()
    }

    /// The time within the animation at which it is `seconds` after its start if it is played again and again.
    #[must_use]
    pub fn wrapped(&self, seconds: f64) -> f64 {
        // Key times are single precision; the last key itself must not become the first.
        if seconds as f32 <= self.duration as f32 { seconds } else { seconds % self.duration.max(f64::MIN_POSITIVE) }
    }
}

impl From<Scene> for Animated {
    /// Without animations.
    fn from(scene: Scene) -> Self {
        Self { scene, ..Self::default() }
    }
}

impl Animated {
    /// Where everything is in animation number `animation` after `seconds`; at rest if there is no such animation.
    ///
    /// All arithmetic is in `f64`. Each key is hit exactly at its time, which files store in single precision.
    #[must_use]
    pub fn pose(&self, animation: usize, seconds: f64) -> Pose {
        let mut pose = Pose::default();
        self.pose_into(animation, seconds, &mut pose);
        pose
    }

    /// [`Self::pose`] in the memory of `pose`.
    pub fn pose_into(&self, animation: usize, seconds: f64, pose: &mut Pose) {
        pose.take(&self.scene);
        if let Some(animation) = self.animations.get(animation) {
            let world_from_node = self.rig.pose(&animation.moves, seconds, pose);
            self.bend(&animation.morphs, seconds, &world_from_node, pose);
        }
    }

    /// [`cut::cut_masked`] for a scene that moves: what is cut bends as it would have done uncut.
    pub fn cut_masked(&mut self, tolerance: f64, limits: cut::Limits) -> Vec<CutMesh> {
        let cuts = cut::cut_masked(&mut self.scene, tolerance, limits);
        for cut in &cuts {
            for body in self.bodies.iter_mut().filter(|body| body.mesh == cut.mesh) {
                body.cuts.clone_from(&cut.sources);
            }
        }
        cuts
    }

    /// Overwrites the bent meshes in `pose`, and the places of skins.
    fn bend(&self, morphs: &[Morph], seconds: f64, world_from_node: &[DAffine3], pose: &mut Pose) {
        let Pose { instances, bent, .. } = pose;
        for (b, body) in self.bodies.iter().enumerate() {
            let Some(bent) = bent.iter_mut().find(|bent| bent.mesh == body.mesh) else { continue };
            let morph = morphs.iter().find(|morph| morph.body == b);
            let animated: Option<Vec<f64>> =
                morph.map(|morph| morph.weights.iter().map(|track| track.scalar(seconds)).collect());
            match body.pose(animated.as_ref().unwrap_or(&body.weights), world_from_node, bent) {
                Some(origin) => {
                    if let Frame::Skin { instances: shown, .. } = &body.frame {
                        shown.iter().for_each(|&i| instances[i] = DAffine3::from_translation(origin));
                    }
                }
                // It stays at rest.
                None => bent.take(&self.scene.meshes[body.mesh]),
            }
        }
    }
}
