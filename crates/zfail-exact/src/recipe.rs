//! A test scene as a list of parts, so that a failing one can be shrunk by leaving parts out.
//!
//! In: parts, lights, a view. Out: the scene that renderer and oracle are given.

use crate::{kinds::Kind, shapes::Shape};
use zfail_plan::glam::{DAffine3, DMat3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::{Projection, View};
use zfail_scene::{AlphaMode, Instance, Light, LightShape, Material, Scene};

/// Everything a test scene is made of.
#[derive(Clone, Debug)]
pub struct Recipe {
    /// What it is to exercise.
    pub kind: Kind,
    /// What it was made from.
    pub seed: u64,
    /// Receivers and casters.
    pub parts: Vec<Part>,
    /// Lights, judged one by one.
    pub lights: Vec<LightKind>,
    /// Of a box around the first light, turned somehow, beyond which it lights nothing.
    pub half_extents: Option<DVec3>,
    /// Camera and image.
    pub view: View,
}

/// One instance with a mesh of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Its mesh.
    pub shape: Shape,
    /// Object to world.
    pub pose: DAffine3,
    /// Its material.
    pub surface: Surface,
    /// For whom it casts.
    pub casting: CastsFor,
    /// Whether shadows fall on it.
    pub receives: bool,
}

/// Materials that matter for shadows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// Opaque, back faces are not drawn.
    Single,
    /// Opaque, both sides are drawn.
    Double,
    /// Blended: neither a surface in the mask nor a caster.
    Blended,
}

/// Which lights a part casts shadows for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CastsFor {
    /// Every light.
    All,
    /// Every light but the first.
    AllButFirst,
    /// No light.
    None,
}

impl Part {
    /// A single-sided part that casts.
    #[must_use]
    pub const fn new(shape: Shape, pose: DAffine3) -> Self {
        Self { shape, pose, surface: Surface::Single, casting: CastsFor::All, receives: true }
    }

    /// With both sides drawn.
    #[must_use]
    pub const fn double(self) -> Self {
        Self { surface: Surface::Double, ..self }
    }
}

impl Recipe {
    /// The scene.
    #[must_use]
    pub fn scene(&self) -> Scene {
        let opaque = Material { base_color: [0.8, 0.8, 0.8, 1.0], metallic: 0.0, ..Material::default() };
        let double = Material { double_sided: true, ..opaque.clone() };
        let blended = Material { alpha: AlphaMode::Blend, ..double.clone() };
        let mut scene = Scene { materials: vec![opaque, double, blended], ..Scene::default() };
        for (i, part) in self.parts.iter().enumerate() {
            scene.meshes.push(part.shape.mesh(Some(part.surface as usize)));
            scene.instances.push(Instance {
                name: format!("part {i}"),
                mesh: i,
                world_from_object: part.pose,
                casts_shadow: part.casting != CastsFor::None,
                receives_shadow: part.receives,
            });
        }
        let parts = || self.parts.iter().enumerate();
        let excluded: Vec<_> = parts().filter(|(_, p)| p.casting == CastsFor::AllButFirst).map(|(i, _)| i).collect();
        scene.lights.extend(self.lights.iter().enumerate().map(|(i, &kind)| Light {
            name: format!("light {i}"),
            kind,
            color: [1.0; 3],
            intensity: 1.0,
            excluded: if i == 0 { excluded.clone() } else { Vec::new() },
            shape: LightShape {
                half_extents: self.half_extents.filter(|_| i == 0),
                axes: DMat3::from_rotation_y(0.5) * DMat3::from_rotation_x(0.3),
                ..LightShape::default()
            },
        }));
        scene
    }

    /// Scales everything about the origin, then moves it: the same picture elsewhere in the world.
    pub fn transform(&mut self, scale: f64, offset: DVec3) {
        let place = |p: DVec3| p * scale + offset;
        for part in &mut self.parts {
            let pose = &mut part.pose;
            *pose = DAffine3 { matrix3: pose.matrix3 * scale, translation: place(pose.translation) };
        }
        for light in &mut self.lights {
            match light {
                LightKind::Point { position, range } | LightKind::Spot { position, range, .. } => {
                    *position = place(*position);
                    *range *= scale;
                }
                LightKind::Directional { .. } => {}
            }
        }
        self.half_extents = self.half_extents.map(|half| half * scale);
        let eye = &mut self.view.world_from_view.translation;
        *eye = place(*eye);
        match &mut self.view.projection {
            Projection::Perspective { near, .. } => *near *= scale,
            Projection::Orthographic { ymag, near, far } => {
                for length in [ymag, near, far] {
                    *length *= scale;
                }
            }
        }
    }
}

/// A camera's placement.
#[must_use]
pub fn look(eye: DVec3, target: DVec3) -> DAffine3 {
    let back = (eye - target).normalize();
    let up = if back.y.abs() > 0.99 { DVec3::X } else { DVec3::Y };
    let right = up.cross(back).normalize();
    DAffine3 { matrix3: DMat3::from_cols(right, back.cross(right), back), translation: eye }
}
