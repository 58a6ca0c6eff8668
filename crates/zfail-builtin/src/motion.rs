//! Movements of the generated scenes: things that turn about a vertical axis, one revolution without a seam.
//!
//! In: a generated scene. Out: the scene with its animation. It is at rest as the animation begins.

use glam::{DAffine3, DQuat, DVec3};
use std::f64::consts::TAU;
use std::sync::Arc;
use zfail_scene::animate::{Interpolation, Move, Node, Parent, Rig, Track, Trs};
use zfail_scene::placement::light_placement;
use zfail_scene::{Animated, Animation, Scene};

/// Seconds of one revolution.
const PERIOD: f32 = 4.0;

/// What turns: all instances and lights of this name, about the vertical axis through a point.
struct Turn {
    name: &'static str,
    /// Where the axis is; `None` is the thing's own origin.
    axis: Option<[f64; 3]>,
}

const fn orbit(name: &'static str, axis: [f64; 3]) -> Turn {
    Turn { name, axis: Some(axis) }
}

const fn spin(name: &'static str) -> Turn {
    Turn { name, axis: None }
}

fn turns(scene: &str) -> &'static [Turn] {
    const CONTAINER: &[Turn] = &[orbit("light", [0.09, 0.0, -0.06]), spin("knot")];
    const CATHEDRAL: &[Turn] = &[orbit("light", [0.4, 0.0, -1.2]), spin("dancer")];
    const NESTED: &[Turn] = &[spin("inner shell"), spin("middle shell"), spin("gimbal")];
    const ROOM: &[Turn] = &[spin("statue"), spin("guard")];
    const STAGE: &[Turn] = &[spin("left dancer"), spin("middle dancer"), spin("right dancer")];
    match scene {
        "container" => CONTAINER,
        "cathedral" => CATHEDRAL,
        "nested" => NESTED,
        "room" => ROOM,
        "stage" => STAGE,
        _ => &[],
    }
}

/// `scene` with its movement, if it has one.
pub(super) fn animated(scene: Scene) -> Animated {
    let (mut rig, mut moves) = (Rig::default(), Vec::new());
    for turn in turns(&scene.name) {
        // A node on the axis, and the thing relative to it.
        let mut hang = |rig: &mut Rig, place: DAffine3| {
            let axis = turn.axis.map_or(place.translation, DVec3::from);
            let parent_from_node = DAffine3::from_translation(axis);
            rig.nodes.push(Node { parent: Parent::Fixed(DAffine3::IDENTITY), parent_from_node });
            moves.extend(revolution(rig.nodes.len() - 1, axis));
            (rig.nodes.len() - 1, DAffine3::from_translation(-axis) * place)
        };
        for (i, instance) in scene.instances.iter().enumerate().filter(|(_, it)| it.name == turn.name) {
            let (node, place) = hang(&mut rig, instance.world_from_object);
            let bounds = scene.meshes[instance.mesh].bounds();
            rig.carry_instance(i, node, place, &bounds, instance.world_from_object);
        }
        for (i, light) in scene.lights.iter().enumerate().filter(|(_, it)| it.name == turn.name) {
            let (node, place) = hang(&mut rig, light_placement(light));
            rig.carry_light(i, node, place, light.kind);
        }
    }
    if moves.is_empty() {
        return scene.into();
    }
    let animation = Animation { name: "turn".into(), duration: PERIOD.into(), moves, ..Animation::default() };
    Animated { scene, animations: vec![animation], rig, ..Animated::default() }
}

/// One revolution of a node about the vertical axis through its origin, in four arcs.
fn revolution(node: usize, translation: DVec3) -> Option<Move> {
    const ARCS: u8 = 4;
    let share = |k: u8| f32::from(k) / f32::from(ARCS);
    let times: Arc<[f32]> = (0..=ARCS).map(|k| PERIOD * share(k)).collect();
    let turned = |k: u8| DQuat::from_rotation_y(TAU * f64::from(share(k))).as_quat().to_array();
    let rotation = Track::new(Interpolation::Linear, times, (0..=ARCS).map(turned).collect());
    let rest = Trs { translation, rotation: DQuat::IDENTITY, scale: DVec3::ONE };
    rotation.map(|rotation| Move { node, rest, translation: None, rotation: Some(rotation), scale: None })
}

#[cfg(test)]
mod tests {
    use super::*;
    use zfail_scene::Pose;

    #[test]
    fn everything_that_is_named_turns_and_comes_back() {
        for name in ["container", "cathedral", "nested", "room", "stage"] {
            let animated = crate::animated(name).unwrap();
            let rest = Pose::of(&animated.scene);
            let near = |pose: &Pose| {
                pose.instances.iter().zip(&rest.instances).all(|(a, b)| a.abs_diff_eq(*b, 1e-6))
                    && pose
                        .lights
                        .iter()
                        .zip(&rest.lights)
                        .all(|(a, b)| a.homogeneous().abs_diff_eq(b.homogeneous(), 1e-6))
            };
            assert!(near(&animated.pose(0, 0.0)) && near(&animated.pose(0, PERIOD.into())), "{name}");
            let half = animated.pose(0, 0.5 * f64::from(PERIOD));
            assert!(!near(&half), "{name}");
            let named = |name: &str| turns(&animated.scene.name).iter().any(|turn| turn.name == name);
            for (i, instance) in animated.scene.instances.iter().enumerate() {
                let moved = half.instances[i] != rest.instances[i];
                assert_eq!(moved, named(&instance.name), "{name}: {}", instance.name);
            }
            for turn in turns(name) {
                let known = animated.scene.instances.iter().any(|instance| instance.name == turn.name);
                assert!(known, "{name}: nothing is called {}", turn.name);
            }
        }
    }

    #[test]
    fn an_orbit_is_a_circle() {
        let animated = crate::animated("container").unwrap();
        let light = animated.scene.lights.iter().position(|light| light.name == "light").unwrap();
        let axis = DVec3::new(0.09, 0.45, -0.06);
        for k in 0..16 {
            let pose = animated.pose(0, f64::from(k) * f64::from(PERIOD) / 16.0);
            let from_axis = pose.lights[light].homogeneous().truncate() - axis;
            let angle = TAU * f64::from(k) / 16.0;
            let expected = DQuat::from_rotation_y(angle) * DVec3::new(-0.06, 0.0, 0.04);
            assert!(from_axis.distance(expected) < 1e-6, "{k}: {from_axis} is not {expected}");
        }
    }
}
