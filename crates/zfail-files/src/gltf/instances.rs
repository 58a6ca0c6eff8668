//! Meshes where the nodes put them.
//!
//! In: the document, its node hierarchy and the scene's materials. Out: meshes and instances in the scene.

use super::animations::{Motion, target_count};
use super::document::Document;
use super::graph::{Graph, Visit};
use super::mesh::{self, Built, Pose};
use super::schema::Instancing;
use super::skins::{self, Skin};
use crate::shared::error::{Result, invalid, refused};
use glam::{DAffine3, DQuat, DVec3};
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};
use std::ops::Range;
use zfail_scene::animate::MAX_COORDINATE;
use zfail_scene::deform::{Body, Frame};
use zfail_scene::placement::{Rank, flatten, invertible, is_moderate, rank, unit_quaternion};
use zfail_scene::{Instance, Scene};

/// Adds the default scene's meshes and instances to `scene`, and hangs those that move on the rig. Returns, per visit,
/// which instances its node and its descendants hold.
pub(super) fn read(
    document: &Document<'_>,
    graph: &Graph,
    motion: &mut Motion,
    scene: &mut Scene,
) -> Result<Vec<Range<usize>>> {
    let (poses, pose_of_visit) = poses(document, graph, motion)?;
    let skins = skins::read(document, graph, motion, &mut scene.notices)?;
    let built: Vec<Built> = poses
        .par_iter()
        .map(|pose| {
            let skin = pose.skin.map(|skin| &skins[skin]);
            let bends = pose.node.is_some() || skin.is_some_and(Skin::moves);
            mesh::build(document, pose, skin.map(|skin| &skin.at_rest[..]), bends, &scene.materials)
        })
        .collect::<Result<_>>()?;
    scene.notices.extend(built.iter().flat_map(|b| b.notices.iter().cloned()));

    let shown = vec![Vec::new(); built.len()];
    let mut placer = Placer { document, motion, scene, scene_mesh: vec![None; built.len()], shown, built };
    let mut skinned = FxHashSet::default();
    let mut first_instance = Vec::with_capacity(graph.visits.len() + 1);
    for (v, (visit, pose)) in graph.visits.iter().zip(pose_of_visit).enumerate() {
        first_instance.push(placer.scene.instances.len());
        let Some(pose) = pose else { continue };
        let is_skinned = poses[pose].skin.is_some();
        // A skin puts its mesh in the same place wherever the node hangs.
        if !is_skinned || skinned.insert(visit.node) {
            placer.place_node(visit, placer.motion.rig_node[v], pose, is_skinned)?;
        }
    }
    first_instance.push(placer.scene.instances.len());
    placer.embody(&poses, &skins);
    let held = |(i, visit): (usize, &Visit)| first_instance[i]..first_instance[visit.end];
    Ok(graph.visits.iter().enumerate().map(held).collect())
}

/// The distinct poses in the order of their meshes in the file, and the index of each visit's.
fn poses(document: &Document<'_>, graph: &Graph, motion: &Motion) -> Result<(Vec<Pose>, Vec<Option<usize>>)> {
    let meshes = &document.root.meshes;
    let target_counts: Vec<usize> = meshes.iter().map(target_count).collect();
    let pose = |visit: &Visit| {
        let node = &document.root.nodes[visit.node];
        let Some(mesh) = node.mesh.filter(|_| visit.is_visible) else { return Ok(None) };
        let weights = node.weights.as_ref().unwrap_or(&meshes[mesh].weights);
        let weights = &weights[..target_counts[mesh].min(weights.len())];
        document.budget.charge(weights.len() as u64, 16, || format!("nodes[{}].weights", visit.node))?;
        let weights = weights.iter().map(|w| w.to_bits()).collect();
        let own = motion.morphs(visit.node).then_some(visit.node);
        Ok(Some(Pose { mesh, weights, skin: node.skin, node: own }))
    };
    let of_visit: Vec<Option<Pose>> = graph.visits.iter().map(pose).collect::<Result<_>>()?;
    let mut poses: Vec<Pose> = of_visit.iter().flatten().cloned().collect();
    poses.sort_by(|a, b| (a.mesh, a.skin, a.node, &a.weights).cmp(&(b.mesh, b.skin, b.node, &b.weights)));
    poses.dedup();
    let index: FxHashMap<&Pose, usize> = poses.iter().enumerate().map(|(i, pose)| (pose, i)).collect();
    let of_visit = of_visit.iter().map(|pose| pose.as_ref().map(|pose| index[pose])).collect();
    Ok((poses, of_visit))
}

struct Placer<'a> {
    document: &'a Document<'a>,
    motion: &'a mut Motion,
    scene: &'a mut Scene,
    built: Vec<Built>,
    /// Where in the scene a built mesh has been moved, once an instance has needed it.
    scene_mesh: Vec<Option<usize>>,
    /// Instances of each built mesh.
    shown: Vec<Vec<usize>>,
}

/// Where a node puts its mesh.
struct Site<'a> {
    visit: &'a Visit,
    world_from_node: DAffine3,
    /// The node's place in the rig, if it moves.
    rig_node: Option<usize>,
    /// Index of the mesh among those built.
    pose: usize,
}

impl Placer<'_> {
    /// `rig_node` is the node's place in the rig, if it moves.
    fn place_node(&mut self, visit: &Visit, rig_node: Option<usize>, pose: usize, skinned: bool) -> Result<()> {
        let node = &self.document.root.nodes[visit.node];
        let name = node.name.clone().unwrap_or_else(|| format!("node {}", visit.node));
        // Skinning has taken the mesh to the world; its own node's transform does not count.
        let (world_from_node, rig_node) =
            if skinned { (DAffine3::IDENTITY, None) } else { (visit.world_from_node, rig_node) };
        let site = Site { visit, world_from_node, rig_node, pose };
        match &node.extensions.instancing {
            None => self.place(name, &site, &DAffine3::IDENTITY),
            Some(instancing) => {
                let path = format!("nodes[{}].extensions.EXT_mesh_gpu_instancing", visit.node);
                for (i, local) in instance_transforms(self.document, instancing, &path)?.into_iter().enumerate() {
                    self.place(format!("{name} #{i}"), &site, &local)?;
                }
                Ok(())
            }
        }
    }

    fn place(&mut self, name: String, site: &Site<'_>, node_from_instance: &DAffine3) -> Result<()> {
        let (origin, bounds) = (self.built[site.pose].origin, self.built[site.pose].bounds);
        if bounds.is_empty() {
            return Ok(());
        }
        let element = || format!("nodes[{}]", site.visit.node);
        let node_from_object = *node_from_instance * DAffine3::from_translation(origin);
        let world_from_object = site.world_from_node * node_from_object;
        let reach = bounds.transformed(&world_from_object);
        if !(reach.min.abs().max_element() <= MAX_COORDINATE && reach.max.abs().max_element() <= MAX_COORDINATE) {
            let problem = format!("places its mesh more than {MAX_COORDINATE:e} m from the origin");
            return Err(refused(element(), problem, "move or scale the scene"));
        }
        let bends = !self.built[site.pose].sections.is_empty();
        let (mesh, world_from_object) = match (rank(&world_from_object.matrix3), site.rig_node) {
            (Rank::Full, None) => (self.scene_mesh(site.pose), world_from_object),
            (_, None) if bends => {
                let matrix3 = invertible(&world_from_object.matrix3);
                (self.scene_mesh(site.pose), DAffine3 { matrix3, translation: world_from_object.translation })
            }
            (_, Some(rig_node)) => {
                // It may be flat at rest and have its shape later.
                let matrix3 = invertible(&world_from_object.matrix3);
                let rest = DAffine3 { matrix3, translation: world_from_object.translation };
                let index = self.scene.instances.len();
                self.motion.rig.carry_instance(index, rig_node, node_from_object, &bounds, rest);
                (self.scene_mesh(site.pose), rest)
            }
            (Rank::Plane, None) => {
                let mesh = self.scene_mesh[site.pose].map_or(&self.built[site.pose].mesh, |m| &self.scene.meshes[m]);
                self.document.budget.charge(mesh.positions.len() as u64, 100, element)?;
                let (flat, origin) = flatten(mesh, &world_from_object);
                self.scene.notices.push(format!("node \"{name}\" flattens its mesh into a plane"));
                self.scene.meshes.push(flat);
                (self.scene.meshes.len() - 1, DAffine3::from_translation(origin))
            }
            (Rank::Line, None) => {
                self.scene.notices.push(format!("node \"{name}\" shrinks its mesh to a line or a point: not drawn"));
                return Ok(());
            }
        };
        let (casts_shadow, receives_shadow) = (site.visit.casts_shadow, site.visit.receives_shadow);
        self.shown[site.pose].push(self.scene.instances.len());
        self.scene.instances.push(Instance { name, mesh, world_from_object, casts_shadow, receives_shadow });
        Ok(())
    }

    /// Hands what bends to the animation, once all instances are placed.
    fn embody(&mut self, poses: &[Pose], skins: &[Skin]) {
        for (p, pose) in poses.iter().enumerate() {
            let Built { sections, origin, .. } = &mut self.built[p];
            let Some(mesh) = self.scene_mesh[p].filter(|_| !sections.is_empty()) else { continue };
            let frame = match pose.skin {
                None => Frame::Object { origin: *origin },
                Some(skin) => {
                    Frame::Skin { joints: skins[skin].joints.clone(), instances: std::mem::take(&mut self.shown[p]) }
                }
            };
            let weights = pose.weights.iter().map(|&bits| f64::from_bits(bits)).collect();
            let (sections, cuts) = (std::mem::take(sections), Vec::new());
            self.motion.bodies.push((Body { mesh, sections, cuts, weights, frame }, pose.node));
        }
    }

    fn scene_mesh(&mut self, pose: usize) -> usize {
        *self.scene_mesh[pose].get_or_insert_with(|| {
            self.scene.meshes.push(std::mem::take(&mut self.built[pose].mesh));
            self.scene.meshes.len() - 1
        })
    }
}

/// The transforms of EXT_mesh_gpu_instancing, from an instance to its node.
fn instance_transforms(document: &Document<'_>, instancing: &Instancing, path: &str) -> Result<Vec<DAffine3>> {
    let attribute = |name: &str| instancing.attributes.get(name).copied();
    let counts = instancing.attributes.iter().map(|(name, &a)| (name, document.root.accessors[a].count));
    let count = counts.clone().next().map_or(0, |(_, count)| count);
    if let Some((name, other)) = counts.clone().find(|&(_, other)| other != count) {
        return Err(invalid(format!("{path}.attributes.{name}"), format!("has {other} elements, others have {count}")));
    }
    document.budget.charge(count, 512, || path.into())?;
    let vectors = |name: &str, default: [f32; 3]| match attribute(name) {
        Some(accessor) => document.floats::<3>(accessor),
        None => Ok(vec![default; count as usize]),
    };
    let translations = vectors("TRANSLATION", [0.0; 3])?;
    let scales = vectors("SCALE", [1.0; 3])?;
    let rotations = match attribute("ROTATION") {
        Some(accessor) => document.floats::<4>(accessor)?,
        None => vec![[0.0, 0.0, 0.0, 1.0]; count as usize],
    };
    let transform = |i: usize| {
        let [translation, scale] = [translations[i], scales[i]].map(|v| DVec3::from(v.map(f64::from)));
        let rotation = unit_quaternion(DQuat::from_array(rotations[i].map(f64::from))).unwrap_or(DQuat::IDENTITY);
        let transform = DAffine3::from_scale_rotation_translation(scale, rotation, translation);
        let fault = || invalid(path, format!("instance {i} has a transform beyond all measure"));
        if is_moderate(&transform) { Ok(transform) } else { Err(fault()) }
    };
    (0..count as usize).map(transform).collect()
}
