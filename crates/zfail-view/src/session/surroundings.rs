//! Switching what a scene stands in.

use super::Session;
use zfail_scene::{Ground, Scene, Sky};

/// What is there when it is switched on, or when it was before.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spare {
    sky: Sky,
    ground: Ground,
    /// Where there is no sky.
    ambient: [f32; 3],
}

impl Spare {
    /// Those of `scene`, and for what it has not what would suit it.
    pub(super) fn of(scene: &Scene) -> Self {
        Self {
            sky: scene.sky.unwrap_or_else(|| zfail_scene::fitting_sky(scene)),
            ground: scene.ground.unwrap_or_else(|| zfail_scene::fitting_ground(scene)),
            ambient: if scene.sky.is_some() { zfail_scene::fitting_ambient(scene) } else { scene.ambient },
        }
    }
}

impl Session {
    /// Stands the scene under a sky, or in light that is the same from all sides.
    pub fn set_sky(&mut self, on: bool) {
        let scene = &mut self.scene;
        (scene.sky, scene.ambient) = if on { (Some(self.spare.sky), [0.0; 3]) } else { (None, self.spare.ambient) };
        self.surrounded();
    }

    /// Puts a ground that catches shadows below the scene, where the last one was, or none.
    pub fn set_ground(&mut self, on: bool) {
        self.scene.ground = on.then_some(self.spare.ground);
        self.surrounded();
    }

    /// Raises or lowers the ground, metres.
    pub fn move_ground(&mut self, height: f64) {
        if height.is_finite() {
            self.spare.ground.height = height;
            self.set_ground(true);
        }
    }

    fn surrounded(&mut self) {
        self.changes.surroundings = true;
        self.touch();
    }
}
