//! Animations of nodes and of morph weights.
//!
//! In: a validated document and its node hierarchy. Out: keyframe tracks, and a rig of the nodes that they move, on
//! which instances, lights, cameras and skins are hung as they are read.
//!
//! Left out, with a notice: whatever an extension targets, moves of nodes that have a matrix, weights of nodes without
//! morph targets, what another channel has moved before, and channels whose data are broken. Key frames are sorted.

use super::document::Document;
use super::graph::{Graph, properties};
use super::schema::{self, Channel, Component};
use crate::shared::error::{Result, invalid};
use crate::shared::limits::Budget;
use glam::DQuat;
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;
use std::sync::Arc;
use zfail_scene::animate::{Interpolation, Morph, Move, Node, Parent, Rig, Track};
use zfail_scene::deform::Body;
use zfail_scene::placement::unit_quaternion;
use zfail_scene::{Animated, Animation, Scene};

/// The animations of a document.
pub(super) struct Motion {
    pub animations: Vec<Animation>,
    pub rig: Rig,
    /// By visit, the node's place in the rig.
    pub rig_node: Vec<Option<usize>>,
    /// By animation, the morph weights of nodes of the document.
    morphs: Vec<Morphs>,
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

/// Reads all animations. A channel that cannot be understood is left out: at rest the scene is sound without it.
pub(super) fn read(document: &Document<'_>, graph: &Graph, notices: &mut Vec<String>) -> Result<Motion> {
    let mut reader = Reader { document, graph, notices, keys: FxHashMap::default() };
    let animations = document.root.animations.iter().enumerate();
    let clips: Vec<Clip> = animations.map(|(i, animation)| reader.animation(i, animation)).collect::<Result<_>>()?;

    let mut moved = vec![false; document.root.nodes.len()];
    clips.iter().flat_map(|clip| clip.moves.keys()).for_each(|&node| moved[node] = true);
    let (rig, rig_node) = rig(graph, &moved);
    let mut rig_nodes: FxHashMap<usize, Vec<usize>> = FxHashMap::default();
    for (visit, rig_node) in graph.visits.iter().zip(&rig_node) {
        rig_nodes.entry(visit.node).or_default().extend(rig_node);
    }
    let clips = clips.into_iter().map(|clip| clip.on_rig(&rig_nodes, &document.budget));
    let (animations, morphs) = clips.collect::<Result<Vec<_>>>()?.into_iter().unzip();
    Ok(Motion { animations, rig, rig_node, morphs, bodies: Vec::new() })
}

/// The animated morph weights of nodes of the document.
type Morphs = BTreeMap<usize, Vec<Track<1>>>;

/// An animation whose moves are by node of the document.
struct Clip {
    name: String,
    duration: f64,
    moves: BTreeMap<usize, Move>,
    morphs: Morphs,
}

impl Clip {
    /// With moves by node of the rig: none outside of the scene, and several of what hangs below several nodes. The morph
    /// weights are still by node of the document.
    fn on_rig(self, rig_nodes: &FxHashMap<usize, Vec<usize>>, budget: &Budget) -> Result<(Animation, Morphs)> {
        let mut moves = Vec::with_capacity(self.moves.len());
        for (node, moved) in self.moves {
            let places = rig_nodes.get(&node).map_or(&[][..], Vec::as_slice);
            let copies = places.len().saturating_sub(1) as u64;
            budget.charge(copies, moved.size(), || format!("nodes[{node}], reached by many ways"))?;
            moves.extend(places.iter().map(|&node| Move { node, ..moved.clone() }));
        }
        moves.sort_by_key(|moved| moved.node);
        Ok((Animation { name: self.name, duration: self.duration, moves, morphs: Vec::new() }, self.morphs))
    }
}

/// The nodes of the scene that are `moved` or have a moved ancestor, and their places by visit.
fn rig(graph: &Graph, moved: &[bool]) -> (Rig, Vec<Option<usize>>) {
    let mut rig = Rig::default();
    let mut rig_node: Vec<Option<usize>> = Vec::with_capacity(graph.visits.len());
    for visit in &graph.visits {
        let moving_parent = visit.parent.and_then(|parent| rig_node[parent]);
        let is_moving = moved[visit.node] || moving_parent.is_some();
        rig_node.push(is_moving.then_some(rig.nodes.len()));
        if is_moving {
            let fixed = visit.parent.map(|parent| graph.visits[parent].world_from_node).unwrap_or_default();
            let parent = moving_parent.map_or(Parent::Fixed(fixed), Parent::Moving);
            rig.nodes.push(Node { parent, parent_from_node: visit.parent_from_node });
        }
    }
    (rig, rig_node)
}

struct Reader<'a> {
    document: &'a Document<'a>,
    graph: &'a Graph,
    notices: &'a mut Vec<String>,
    /// By accessor; most tracks of a file share theirs.
    keys: FxHashMap<usize, Keys>,
}

/// Key times in ascending order, and the place in the file of each, if they were not in order there.
#[derive(Clone)]
struct Keys {
    times: Arc<[f32]>,
    order: Option<Arc<[usize]>>,
}

impl Keys {
    /// `values`, of which there are `per_key`, in the order of the times.
    fn sorted<T: Copy>(&self, values: Vec<T>, per_key: usize) -> Vec<T> {
        match &self.order {
            Some(order) if values.len() == order.len() * per_key => {
                order.iter().flat_map(|&key| &values[key * per_key..][..per_key]).copied().collect()
            }
            _ => values,
        }
    }
}

/// A channel of an animation, with what it takes to read it.
struct Source<'a> {
    channel: &'a Channel,
    interpolation: Interpolation,
    keys: Keys,
    /// Index of the accessor of values.
    output: usize,
    /// JSON paths of the channel and of its output.
    path: String,
    output_path: String,
}

impl Reader<'_> {
    fn animation(&mut self, index: usize, animation: &schema::Animation) -> Result<Clip> {
        let name = animation.name.clone().unwrap_or_else(|| format!("animation {index}"));
        let mut clip = Clip { name, duration: 0.0, moves: BTreeMap::new(), morphs: BTreeMap::new() };
        for (c, channel) in animation.channels.iter().enumerate() {
            let path = format!("animations[{index}].channels[{c}]");
            let Some(sampler) = channel.sampler else { continue };
            let Some((input, output)) = animation.samplers[sampler].input.zip(animation.samplers[sampler].output)
            else {
                continue;
            };
            let sampler_path = format!("animations[{index}].samplers[{sampler}]");
            let read = self.keys(input, &format!("{sampler_path}.input")).and_then(|keys| {
                clip.duration = keys.times.last().map_or(clip.duration, |&last| clip.duration.max(last.into()));
                let Some(node) = self.target(channel, &path) else { return Ok(()) };
                let (path, output_path) = (path.clone(), format!("{sampler_path}.output"));
                let interpolation = animation.samplers[sampler].interpolation.into();
                let source = Source { channel, interpolation, keys, output, path, output_path };
                if channel.target.path == "weights" {
                    self.weights(&mut clip, node, source)
                } else {
                    self.channel(&mut clip, node, source)
                }
            });
            if let Err(fault) = read {
                let Some(problem) = fault.problem() else { return Err(fault) };
                let problem = problem.strip_prefix(&format!("{path}: ")).unwrap_or(&problem);
                self.notices.push(format!("{path} is left out: {problem}"));
            }
        }
        Ok(clip)
    }

    /// The node that a channel moves, if it is one that can be moved.
    fn target(&mut self, channel: &Channel, path: &str) -> Option<usize> {
        let node = channel.target.node;
        let is_drawn = |node: usize| self.graph.visit_of(node).is_some();
        let is_visible =
            |node: usize| self.graph.visit_of(node).is_some_and(|visit| self.graph.visits[visit].is_visible);
        let pointer = &channel.target.extensions.pointer.pointer;
        let why = match (channel.target.path.as_str(), node) {
            ("translation" | "rotation" | "scale" | "weights", None) => return None,
            // Nothing of it is to be seen.
            ("translation" | "rotation" | "scale" | "weights", Some(node)) if !is_drawn(node) => return None,
            ("translation" | "rotation" | "scale", Some(node)) if self.document.root.nodes[node].matrix.is_none() => {
                return Some(node);
            }
            ("translation" | "rotation" | "scale", Some(node)) => {
                format!("{path} would move nodes[{node}], which has a matrix: left out")
            }
            ("weights", Some(node)) if self.target_count(node) > 0 => return Some(node),
            ("weights", Some(node)) if !is_visible(node) => return None,
            ("weights", Some(node)) => {
                format!("{path} would change the morph weights of nodes[{node}], which has none: left out")
            }
            ("pointer", _) if pointer.contains("/KHR_node_visibility/") => {
                format!("{path} would show and hide by \"{pointer}\": left out, the node stays as it is at rest")
            }
            ("pointer", _) if !pointer.is_empty() => format!("{path} would change \"{pointer}\": left out"),
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

    fn weights(&mut self, clip: &mut Clip, node: usize, source: Source<'_>) -> Result<()> {
        let Source { interpolation, keys, output, path, output_path, .. } = source;
        if clip.morphs.contains_key(&node) {
            return Err(invalid(path, format!("it changes the morph weights of nodes[{node}] a second time")));
        }
        let values = track_values::<1>(self.document, output, &output_path)?;
        let (targets, per_key) = (self.target_count(node), interpolation.values_per_key());
        let needed = keys.times.len() * per_key * targets;
        if values.len() != needed {
            let (found, keys) = (values.len(), keys.times.len());
            let of = format!("accessors[{output}] has {found} elements");
            return Err(invalid(
                output_path,
                format!("{of}, but {keys} keys of {targets} morph targets need {needed}"),
            ));
        }
        let values = keys.sorted(values, per_key * targets);
        // Key by key in the file, and for splines all in-tangents of a key before its values.
        let of_target = |t: usize| values.iter().skip(t).step_by(targets).copied().collect();
        let tracks = (0..targets).filter_map(|t| Track::new(interpolation, keys.times.clone(), of_target(t)));
        clip.morphs.insert(node, tracks.collect());
        Ok(())
    }

    fn channel(&mut self, clip: &mut Clip, node: usize, source: Source<'_>) -> Result<()> {
        let property = source.channel.target.path.as_str();
        let taken = clip.moves.get(&node).is_some_and(|moved| match property {
            "rotation" => moved.rotation.is_some(),
            "scale" => moved.scale.is_some(),
            _ => moved.translation.is_some(),
        });
        if taken {
            return Err(invalid(source.path, format!("it moves the {property} of nodes[{node}] a second time")));
        }
        let rest = properties(&self.document.root.nodes[node]);
        let still = Move { node, rest, translation: None, rotation: None, scale: None };
        match property {
            "rotation" => {
                let track = track(self.document, &source)?;
                if !(0..track.key_count()).all(|k| unit_quaternion(DQuat::from_array(track.key(k))).is_some()) {
                    self.notices.push(format!("{} has rotations without length: replaced", source.output_path));
                }
                clip.moves.entry(node).or_insert(still).rotation = Some(track);
            }
            "scale" => {
                let track = track(self.document, &source)?;
                clip.moves.entry(node).or_insert(still).scale = Some(track);
            }
            _ => {
                let track = track(self.document, &source)?;
                clip.moves.entry(node).or_insert(still).translation = Some(track);
            }
        }
        Ok(())
    }

    /// Key times: finite, and in order.
    fn keys(&mut self, accessor: usize, element: &str) -> Result<Keys> {
        if let Some(keys) = self.keys.get(&accessor) {
            return Ok(keys.clone());
        }
        if self.document.root.accessors[accessor].component_type != Component::F32 {
            return Err(invalid(element, format!("accessors[{accessor}] must hold single-precision floats")));
        }
        let mut times: Vec<f32> = self.document.floats::<1>(accessor)?.into_iter().flatten().collect();
        if times.is_empty() {
            return Err(invalid(element, format!("accessors[{accessor}] has no keys")));
        }
        if let Some(key) = times.iter().position(|time| !time.is_finite()) {
            return Err(invalid(element, format!("the time of key {key} (accessors[{accessor}]) is not finite")));
        }
        let mut order = None;
        if !times.is_sorted() {
            self.document.budget.charge(times.len() as u64, 16, || element.into())?;
            let mut places: Vec<usize> = (0..times.len()).collect();
            places.sort_by(|&a, &b| times[a].total_cmp(&times[b]));
            times = places.iter().map(|&key| times[key]).collect();
            order = Some(places.into());
            self.notices.push(format!("{element} (accessors[{accessor}]) has key times out of order: sorted"));
        }
        let keys = Keys { times: times.into(), order };
        self.keys.insert(accessor, keys.clone());
        Ok(keys)
    }
}

/// Of the primitive that has the most.
pub(super) fn target_count(mesh: &schema::Mesh) -> usize {
    mesh.primitives.iter().map(|primitive| primitive.targets.len()).max().unwrap_or(0)
}

fn track<const N: usize>(document: &Document<'_>, source: &Source<'_>) -> Result<Track<N>> {
    let Source { interpolation, keys, output, output_path, .. } = source;
    let values = track_values(document, *output, output_path)?;
    let (found, per_key) = (values.len(), interpolation.values_per_key());
    Track::new(*interpolation, keys.times.clone(), keys.sorted(values, per_key)).ok_or_else(|| {
        let (keys, needed) = (keys.times.len(), keys.times.len() * per_key);
        invalid(output_path, format!("accessors[{output}] has {found} elements, but {keys} keys need {needed}"))
    })
}

/// Finite values of accessor `output`.
fn track_values<const N: usize>(document: &Document<'_>, output: usize, element: &str) -> Result<Vec<[f32; N]>> {
    let accessor = &document.root.accessors[output];
    let is_fraction = accessor.normalized && accessor.component_type != Component::U32;
    if accessor.component_type != Component::F32 && !is_fraction {
        return Err(invalid(element, format!("accessors[{output}] must hold floats or normalized integers")));
    }
    let values = document.floats::<N>(output)?;
    if let Some(at) = values.iter().flatten().position(|x| !x.is_finite()) {
        return Err(invalid(element, format!("element {} (accessors[{output}]) is not finite", at / N)));
    }
    Ok(values)
}
