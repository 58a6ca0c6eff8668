//! Animations of nodes and of morph weights.
//!
//! In: a validated document and its node hierarchy. Out: keyframe tracks, and a rig of the nodes that they move, on
//! which instances, lights, cameras and skins are hung as they are read.
//!
//! Left out, with a notice: whatever an extension targets, moves of nodes that have a matrix, and weights of nodes without
//! morph targets.

use super::document::Document;
use super::error::{Result, invalid};
use super::graph::{Graph, properties};
use super::schema::{self, Channel, Component};
use crate::animate::{Animated, Animation, Morph, Move, Node, Parent, Rig, Track};
use crate::deform::Body;
use crate::placement::unit_quaternion;
use glam::DQuat;
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;
use std::sync::Arc;
use zfail_plan::scene::Scene;

/// The animations of a document.
pub(super) struct Motion {
    pub animations: Vec<Animation>,
    pub rig: Rig,
    /// By node of the document, its place in the rig.
    pub rig_node: Vec<Option<usize>>,
    /// By animation, the morph weights of nodes of the document.
    morphs: Vec<BTreeMap<usize, Vec<Track<1>>>>,
    /// Meshes that bend, and the node of the document that has one for itself, because its weights are animated.
    pub bodies: Vec<(Body, Option<usize>)>,
}

impl Motion {
    /// Whether any animation changes the morph weights of a node of the document.
    pub fn morphs(&self, node: usize) -> bool {
        self.morphs.iter().any(|morphs| morphs.contains_key(&node))
    }

    /// The finished scene, without moves of nodes that carry nothing.
    pub fn animate(mut self, scene: Scene) -> Animated {
        let loaded = self.rig.loaded(self.bodies.iter().flat_map(|(body, _)| body.nodes()));
        for (animation, mut morphs) in self.animations.iter_mut().zip(self.morphs) {
            animation.moves.retain(|moved| loaded[moved.node]);
            let weights = |(b, (_, node)): (usize, &(Body, Option<usize>))| Some((b, morphs.remove(node.as_ref()?)?));
            let bodies = self.bodies.iter().enumerate().filter_map(weights);
            animation.morphs = bodies.map(|(body, weights)| Morph { body, weights }).collect();
        }
        let bodies = self.bodies.into_iter().map(|(body, _)| body).collect();
        Animated { scene, animations: self.animations, framing: None, rig: self.rig, bodies }
    }
}

/// Reads all animations.
pub(super) fn read(document: &Document<'_>, graph: &Graph, notices: &mut Vec<String>) -> Result<Motion> {
    let mut reader = Reader { document, notices, times: FxHashMap::default() };
    let animations = document.root.animations.iter().enumerate();
    let clips: Vec<Clip> = animations.map(|(i, animation)| reader.animation(i, animation)).collect::<Result<_>>()?;

    let mut moved = vec![false; document.root.nodes.len()];
    clips.iter().flat_map(|clip| clip.moves.keys()).for_each(|&node| moved[node] = true);
    let (rig, rig_node) = rig(document, graph, &moved);
    let (animations, morphs) = clips.into_iter().map(|clip| clip.on_rig(&rig_node)).unzip();
    Ok(Motion { animations, rig, rig_node, morphs, bodies: Vec::new() })
}

/// An animation whose moves are by node of the document.
struct Clip {
    name: String,
    duration: f64,
    moves: BTreeMap<usize, Move>,
    morphs: BTreeMap<usize, Vec<Track<1>>>,
}

impl Clip {
    /// Without what it moves outside of the default scene; and the morph weights, still by node of the document.
    fn on_rig(self, rig_node: &[Option<usize>]) -> (Animation, BTreeMap<usize, Vec<Track<1>>>) {
        let place = |(node, moved): (usize, Move)| Some(Move { node: rig_node[node]?, ..moved });
        let mut moves: Vec<Move> = self.moves.into_iter().filter_map(place).collect();
        moves.sort_by_key(|moved| moved.node);
        (Animation { name: self.name, duration: self.duration, moves, morphs: Vec::new() }, self.morphs)
    }
}

/// The nodes of the default scene that are `moved` or have a moved ancestor.
fn rig(document: &Document<'_>, graph: &Graph, moved: &[bool]) -> (Rig, Vec<Option<usize>>) {
    let nodes = &document.root.nodes;
    let mut rig = Rig::default();
    let mut rig_node = vec![None; nodes.len()];
    let mut parent_of = vec![None; nodes.len()];
    for node in graph.visits.iter().map(|visit| visit.node) {
        nodes[node].children.iter().for_each(|&child| parent_of[child] = Some(node));
        let parent: Option<usize> = parent_of[node];
        let moving_parent = parent.and_then(|parent| rig_node[parent]);
        if moved[node] || moving_parent.is_some() {
            let fixed = || Parent::Fixed(parent.map(|p| graph.world_from_node[p]).unwrap_or_default());
            let parent = moving_parent.map_or_else(fixed, Parent::Moving);
            rig.nodes.push(Node { parent, parent_from_node: graph.parent_from_node[node] });
            rig_node[node] = Some(rig.nodes.len() - 1);
        }
    }
    (rig, rig_node)
}

struct Reader<'a> {
    document: &'a Document<'a>,
    notices: &'a mut Vec<String>,
    /// By accessor; most tracks of a file share theirs.
    times: FxHashMap<usize, Arc<[f32]>>,
}

impl Reader<'_> {
    fn animation(&mut self, index: usize, animation: &schema::Animation) -> Result<Clip> {
        let name = animation.name.clone().unwrap_or_else(|| format!("animation {index}"));
        let mut clip = Clip { name, duration: 0.0, moves: BTreeMap::new(), morphs: BTreeMap::new() };
        for (c, channel) in animation.channels.iter().enumerate() {
            let path = format!("animations[{index}].channels[{c}]");
            let sampler = &animation.samplers[channel.sampler];
            let sampler_path = format!("animations[{index}].samplers[{}]", channel.sampler);
            let times = self.times(sampler.input, &format!("{sampler_path}.input"))?;
            clip.duration = times.last().map_or(clip.duration, |&last| clip.duration.max(last.into()));
            let Some(node) = self.target(channel, &path) else { continue };
            if channel.target.path == "weights" {
                self.weights(&mut clip, node, sampler, &times, [&path, &sampler_path])?;
            } else {
                self.channel(&mut clip, node, channel, sampler, times, [&path, &sampler_path])?;
            }
        }
        Ok(clip)
    }

    /// The node that a channel moves, if it is one that can be moved.
    fn target(&mut self, channel: &Channel, path: &str) -> Option<usize> {
        let node = channel.target.node;
        let why = match (channel.target.path.as_str(), node) {
            ("translation" | "rotation" | "scale", None) => return None,
            ("translation" | "rotation" | "scale", Some(node)) if self.document.root.nodes[node].matrix.is_none() => {
                return Some(node);
            }
            ("translation" | "rotation" | "scale", Some(node)) => {
                format!("{path} would move nodes[{node}], which has a matrix: left out")
            }
            ("weights", None) => return None,
            ("weights", Some(node)) if self.target_count(node) > 0 => return Some(node),
            ("weights", Some(node)) => {
                format!("{path} would change the morph weights of nodes[{node}], which has none: left out")
            }
            (other, _) => format!("{path}.target.path is \"{other}\": left out"),
        };
        self.notices.push(why);
        None
    }

    /// Morph targets of a node's mesh.
    fn target_count(&self, node: usize) -> usize {
        let root = &self.document.root;
        root.nodes[node].mesh.map_or(0, |mesh| target_count(&root.meshes[mesh]))
    }

    fn weights(
        &mut self,
        clip: &mut Clip,
        node: usize,
        sampler: &schema::AnimationSampler,
        times: &Arc<[f32]>,
        [path, sampler_path]: [&str; 2],
    ) -> Result<()> {
        let output = format!("{sampler_path}.output");
        let values = track_values::<1>(self.document, sampler, &output)?;
        let (keys, targets) = (times.len() * sampler.interpolation.values_per_key(), self.target_count(node));
        if values.len() != keys * targets {
            let problem = format!(
                "accessors[{}] has {} elements, but {} keys of {targets} morph targets need {}",
                sampler.output,
                values.len(),
                times.len(),
                keys * targets
            );
            return Err(invalid(output, problem));
        }
        // Key by key in the file, and for splines all in-tangents of a key before its values.
        let of_target = |t: usize| values.iter().skip(t).step_by(targets).copied().collect();
        let tracks = (0..targets).filter_map(|t| Track::new(sampler.interpolation, times.clone(), of_target(t)));
        if clip.morphs.insert(node, tracks.collect()).is_some() {
            let problem = format!("changes the morph weights of nodes[{node}] a second time");
            return Err(invalid(format!("{path}.target"), problem));
        }
        Ok(())
    }

    fn channel(
        &mut self,
        clip: &mut Clip,
        node: usize,
        channel: &Channel,
        sampler: &schema::AnimationSampler,
        times: Arc<[f32]>,
        [path, sampler_path]: [&str; 2],
    ) -> Result<()> {
        let moved = clip.moves.entry(node).or_insert_with(|| Move {
            node,
            rest: properties(&self.document.root.nodes[node]),
            translation: None,
            rotation: None,
            scale: None,
        });
        let output = &format!("{sampler_path}.output");
        let is_second = match channel.target.path.as_str() {
            "rotation" => {
                let track = track(self.document, sampler, times, output)?;
                if !(0..track.key_count()).all(|k| unit_quaternion(DQuat::from_array(track.key(k))).is_some()) {
                    self.notices.push(format!("{output} has rotations without length: replaced"));
                }
                moved.rotation.replace(track).is_some()
            }
            "scale" => moved.scale.replace(track(self.document, sampler, times, output)?).is_some(),
            _ => moved.translation.replace(track(self.document, sampler, times, output)?).is_some(),
        };
        if is_second {
            let problem = format!("moves the {} of nodes[{node}] a second time", channel.target.path);
            return Err(invalid(format!("{path}.target"), problem));
        }
        Ok(())
    }

    /// Key times: finite, and none before the one before it.
    fn times(&mut self, accessor: usize, element: &str) -> Result<Arc<[f32]>> {
        if let Some(times) = self.times.get(&accessor) {
            return Ok(times.clone());
        }
        if self.document.root.accessors[accessor].component_type != Component::F32 {
            return Err(invalid(element, format!("accessors[{accessor}] must hold single-precision floats")));
        }
        let times: Arc<[f32]> = self.document.floats::<1>(accessor)?.into_iter().flatten().collect();
        if times.is_empty() {
            return Err(invalid(element, format!("accessors[{accessor}] has no keys")));
        }
        if let Some(key) = times.iter().position(|time| !time.is_finite()) {
            return Err(invalid(element, format!("the time of key {key} (accessors[{accessor}]) is not finite")));
        }
        if let Some(key) = times.windows(2).position(|pair| pair[1] < pair[0]) {
            let problem = format!("the time of key {} (accessors[{accessor}]) is before that of key {key}", key + 1);
            return Err(invalid(element, problem));
        }
        self.times.insert(accessor, times.clone());
        Ok(times)
    }
}

/// Of the primitive that has the most.
pub(super) fn target_count(mesh: &schema::Mesh) -> usize {
    mesh.primitives.iter().map(|primitive| primitive.targets.len()).max().unwrap_or(0)
}

fn track<const N: usize>(
    document: &Document<'_>,
    sampler: &schema::AnimationSampler,
    times: Arc<[f32]>,
    element: &str,
) -> Result<Track<N>> {
    let values = track_values(document, sampler, element)?;
    let (keys, found) = (times.len(), values.len());
    Track::new(sampler.interpolation, times, values).ok_or_else(|| {
        let needed = keys * sampler.interpolation.values_per_key();
        let problem = format!("accessors[{}] has {found} elements, but {keys} keys need {needed}", sampler.output);
        invalid(element, problem)
    })
}

/// Finite values.
fn track_values<const N: usize>(
    document: &Document<'_>,
    sampler: &schema::AnimationSampler,
    element: &str,
) -> Result<Vec<[f32; N]>> {
    let accessor = &document.root.accessors[sampler.output];
    let is_fraction = accessor.normalized && accessor.component_type != Component::U32;
    if accessor.component_type != Component::F32 && !is_fraction {
        let problem = format!("accessors[{}] must hold floats or normalized integers", sampler.output);
        return Err(invalid(element, problem));
    }
    let values = document.floats::<N>(sampler.output)?;
    if let Some(at) = values.iter().flatten().position(|x| !x.is_finite()) {
        let problem = format!("element {} (accessors[{}]) is not finite", at / N, sampler.output);
        return Err(invalid(element, problem));
    }
    Ok(values)
}
