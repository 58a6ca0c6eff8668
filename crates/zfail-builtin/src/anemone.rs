//! A sea anemone: tentacles on chains of joints sway around a pearl that breathes by morph targets. Silhouettes, caps and
//! culls follow bodies that bend and come to meet themselves.

use glam::{DAffine3, DQuat, DVec2, DVec3, Vec3};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;
use zfail_scene::{Mesh, Pose, Scene};

use super::builder::{SceneBuilder, at};
use super::pattern;
use super::shapes::{ico_sphere, lathe};
use zfail_scene::animate::{Interpolation, Morph, Move, Node, Parent, Rig, Track, Trs};
use zfail_scene::deform::{Body, Frame, Influences, Joint, Section, Target, alike};
use zfail_scene::{Animated, Animation};

/// Seconds after which everything is as it was.
const PERIOD: f32 = 4.0;
const KEYS: u16 = 16;
const TENTACLES: u16 = 7;
const JOINTS: u16 = 6;
/// Metres between two joints.
const LINK: f64 = 0.28;
const RINGS: u16 = 30;

pub(super) fn scene() -> Scene {
    animated().scene
}

pub(super) fn animated() -> Animated {
    let mut b = SceneBuilder::new("anemone", [0.02, 0.026, 0.032], [0.003, 0.006, 0.01]);
    let sand = b.textured(pattern::stone("sand", 0xc9b58a, 0.1), 1.2, 0.95);
    let rock = b.textured(pattern::stone("rock", 0x8f8a80, 0.12), 2.0, 0.95);
    b.block("floor", [-2.6, -0.2, -2.2], [2.6, 0.0, 2.6], sand);
    b.block("rock", [-2.6, 0.0, -2.2], [2.6, 2.6, -1.9], rock);
    let flesh = [0xd9668f, 0xe0855a].map(|color| b.matte("tentacle", color, 0.5));
    let nacre = b.matte("pearl", 0xe9e4da, 0.3);

    let (mut rig, mut moves) = (Rig::default(), Vec::new());
    let (mut bodies, mut shown) = (Vec::new(), Vec::new());
    for k in 0..TENTACLES {
        let around = TAU * f64::from(k) / f64::from(TENTACLES);
        let stand = DVec3::new(0.85 * around.cos(), 0.0, 0.85 * around.sin());
        let joints = chain(&mut rig, &mut moves, stand, around);
        let mesh = tentacle();
        let section = Section { influences: Some(influences(&mesh)), ..section(&mesh) };
        let name = format!("tentacle {k}");
        let instance = b.add(&name, mesh, flesh[usize::from(k % 2)], DAffine3::IDENTITY);
        let frame = Frame::Skin { joints, instances: vec![instance] };
        shown.push(instance);
        bodies.push(Body { mesh: 0, sections: vec![section], cuts: vec![], weights: vec![], frame });
    }

    let mesh = ico_sphere(0.34, 3, true);
    let targets = vec![displaced(&mesh, |p| p * DVec3::new(0.45, -0.5, 0.45)), displaced(&mesh, dented)];
    let section = Section { targets, ..section(&mesh) };
    let pearl = b.add("pearl", mesh, nacre, at(0.0, 0.42, 0.0, 0.0));
    let frame = Frame::Object { origin: DVec3::ZERO };
    shown.push(pearl);
    bodies.push(Body { mesh: 0, sections: vec![section], cuts: vec![], weights: vec![0.0; 2], frame });
    let breath = |turns: f64| track(|t| [(0.5 - 0.5 * (turns * TAU * t).cos()) as f32]);
    let weights: Vec<Track<1>> = [breath(1.0), breath(2.0)].into_iter().flatten().collect();
    let morphs = vec![Morph { body: bodies.len() - 1, weights }];

    b.bulb("moon", DVec3::new(1.5, 2.3, 1.1), 0.06, 0xbfe3ff, 9.0);
    b.bulb("glow", DVec3::new(-0.35, 1.0, 0.2), 0.04, 0xffb27a, 1.3);
    b.camera("camera", DVec3::new(0.6, 2.2, 4.6), DVec3::new(0.0, 0.75, 0.0), 38.0);
    let mut scene = b.finish();
    for (body, instance) in bodies.iter_mut().zip(shown) {
        body.mesh = scene.instances[instance].mesh;
        scene.meshes[body.mesh].alike = alike(&body.sections);
    }
    let animation = Animation { name: "sway".into(), duration: PERIOD.into(), moves, morphs };
    let mut animated = Animated { scene, animations: vec![animation], framing: None, rig, bodies };
    let mut rest = Pose::default();
    animated.pose_into(0, 0.0, &mut rest);
    animated.scene.set_pose(&rest);
    animated
}

/// A tapering arm of [`JOINTS`] links, upright on the origin.
fn tentacle() -> Mesh {
    let height = f64::from(JOINTS) * LINK;
    let arm = (0..=RINGS).map(|i| {
        let t = f64::from(i) / f64::from(RINGS);
        DVec2::new(0.15 * (1.0 - 0.75 * t) * (1.0 + 0.08 * (9.0 * TAU * t).sin()), height * t)
    });
    let profile: Vec<DVec2> = [DVec2::ZERO].into_iter().chain(arm).chain([DVec2::new(0.0, height + 0.03)]).collect();
    lathe(&profile, 14, 0.9)
}

/// The vertices of `mesh` before they are bent.
fn section(mesh: &Mesh) -> Section {
    Section {
        positions: mesh.positions.clone(),
        normals: mesh.normals.clone(),
        tangents: mesh.tangents.clone(),
        ..Section::default()
    }
}

/// Every vertex follows the joint below it and the one above, by its height.
fn influences(mesh: &Mesh) -> Influences {
    let mut all = Influences { width: 2, ..Influences::default() };
    for [_, y, _] in &mesh.positions {
        let height = (f64::from(*y) / LINK - 0.5).clamp(0.0, f64::from(JOINTS - 1));
        let below = (height.floor() as u32).min(u32::from(JOINTS) - 2);
        let above = (height - f64::from(below)) as f32;
        all.joints.extend([below, below + 1]);
        all.weights.extend([1.0 - above, above]);
    }
    all
}

/// Adds a chain of joints at `stand` and how they sway.
fn chain(rig: &mut Rig, moves: &mut Vec<Move>, stand: DVec3, around: f64) -> Vec<Joint> {
    let axis = DVec3::new(-around.sin(), 0.0, around.cos());
    let mut joints = Vec::new();
    for j in 0..JOINTS {
        let translation = if j == 0 { stand } else { DVec3::Y * LINK };
        let parent = if j == 0 { Parent::Fixed(DAffine3::IDENTITY) } else { Parent::Moving(rig.nodes.len() - 1) };
        rig.nodes.push(Node { parent, parent_from_node: DAffine3::from_translation(translation) });
        let node = rig.nodes.len() - 1;
        let late = 0.9 * f64::from(j) + 2.0 * around;
        let bend = |t: f64| {
            let out = DQuat::from_axis_angle(axis, -0.16 + 0.3 * (TAU * t - late).sin());
            let aside = DQuat::from_rotation_y(0.25 * (TAU * t - 0.5 * late).cos());
            (aside * out).as_quat().to_array()
        };
        let rest = Trs { translation, rotation: DQuat::IDENTITY, scale: DVec3::ONE };
        moves.push(Move { node, rest, translation: None, rotation: track(bend), scale: None });
        let node_from_mesh = DAffine3::from_translation(DVec3::Y * -LINK * f64::from(j));
        joints.push(Joint::Moving { node, node_from_mesh });
    }
    joints
}

/// A track through the values of one period, which ends as it begins.
fn track<const N: usize>(value: impl Fn(f64) -> [f32; N]) -> Option<Track<N>> {
    let share = |k: u16| f64::from(k % KEYS) / f64::from(KEYS);
    let times: Arc<[f32]> = (0..=KEYS).map(|k| PERIOD * f32::from(k) / f32::from(KEYS)).collect();
    Track::new(Interpolation::Linear, times, (0..=KEYS).map(|k| value(share(k))).collect())
}

/// A morph target that moves every point by `by`.
fn displaced(mesh: &Mesh, by: impl Fn(DVec3) -> DVec3) -> Target {
    let displace = |p: &[f32; 3]| by(Vec3::from_array(*p).as_dvec3()).as_vec3().to_array();
    Target { positions: mesh.positions.iter().map(displace).collect(), ..Target::default() }
}

/// Pushes the top of a ball down through its bottom, so that it meets itself.
fn dented(p: DVec3) -> DVec3 {
    let angle = p.angle_between(DVec3::Y);
    let depth = if angle < PI / 3.0 { 0.5 + 0.5 * (3.0 * angle).cos() } else { 0.0 };
    DVec3::Y * -0.62 * depth
}
