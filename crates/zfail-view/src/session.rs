//! What is shown: a scene and everything about it that a user can change. It knows no window and no device.
//!
//! In: a loaded scene, edits and [`Action`]s. Out: the scene as it is now, the view, the settings, and what has changed
//! since somebody last looked ([`Changes`]).

mod lights;
mod surroundings;
#[cfg(test)]
mod tests;

use crate::action::Action;
use crate::camera::{Mode, Rig};
use crate::playback::Playback;
use lights::Origin;
use std::mem;
use surroundings::Spare;
use zfail_figures::Overlay;
use zfail_plan::bounds::Bounds;
use zfail_plan::view::View;
use zfail_render::{Exposure, RenderError, Renderer, Settings, Technique};
use zfail_scene::{Animated, Pose, Scene};

/// How scenes are shown; it stays when another one is opened.
#[derive(Clone, Debug, Default)]
pub struct Look {
    /// Technique, samples, exposure and the like. Which lights shine is the scene's business.
    pub settings: Settings,
    /// What is drawn over the picture, in the order of [`Overlay::ALL`].
    pub overlays: Vec<Overlay>,
}

impl Look {
    /// Draws an overlay, or no longer.
    pub fn toggle(&mut self, overlay: Overlay) {
        match self.overlays.binary_search(&overlay) {
            Ok(at) => drop(self.overlays.remove(at)),
            Err(at) => self.overlays.insert(at, overlay),
        }
    }
}

/// What of a scene is not yet on the device, or not yet in the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    /// Number, place, colour or excluded casters of lights.
    pub lights: bool,
    /// Which instances cast.
    pub casting: bool,
    /// Where things are.
    pub pose: bool,
    /// Light from all sides, background and ground.
    pub surroundings: bool,
    /// The picture, by these or by camera and settings.
    pub picture: bool,
}

/// A scene that is being looked at.
#[derive(Debug)]
pub struct Session {
    /// As on a command line: a file or `builtin:NAME`.
    pub source: String,
    /// The scene at rest, without its images.
    rest: Animated,
    /// As it is now.
    pub scene: Scene,
    /// By light of [`Self::scene`].
    origins: Vec<Origin>,
    /// The eye.
    pub rig: Rig,
    /// How it is shown.
    pub look: Look,
    /// The moment.
    pub playback: Playback,
    /// The light that is being edited.
    pub selected: Option<usize>,
    /// Since the last [`Self::upload`] and the last picture.
    pub changes: Changes,
    /// The picture's aspect ratio.
    aspect: f64,
    /// What the panel switches between.
    spare: Spare,
    bounds: Bounds,
    pose: Pose,
}

impl Session {
    /// Shows `animated`, which has a camera, as its first camera sees it.
    #[must_use]
    pub fn new(source: String, mut animated: Animated, look: Look) -> Self {
        // Poses are made of everything but images; those would be much to keep twice.
        let images = mem::take(&mut animated.scene.images);
        let scene = Scene { images, ..animated.scene.clone() };
        let bounds = scene.bounds();
        let camera = scene.cameras.first().cloned().unwrap_or_else(|| {
            let mut lacking =
                Scene { meshes: scene.meshes.clone(), instances: scene.instances.clone(), ..Scene::default() };
            zfail_scene::complete(&mut lacking);
            lacking.cameras.swap_remove(0)
        });
        Self {
            source,
            origins: scene.lights.iter().enumerate().map(Origin::of_file).collect(),
            rig: Rig::new(&camera, 0, &bounds),
            look,
            playback: Playback::default(),
            selected: None,
            changes: Changes { picture: true, ..Changes::default() },
            aspect: 1.0,
            spare: Spare::of(&scene),
            bounds,
            pose: Pose::of(&scene),
            rest: animated,
            scene,
        }
    }

    /// What an image of `size` pixels shows.
    #[must_use]
    pub fn view(&self, size: [u32; 2]) -> View {
        self.rig.camera.view(size, &self.bounds)
    }

    /// Takes the aspect ratio of the picture; a camera that was made for the scene is made for it again.
    pub fn fit(&mut self, aspect: f64) {
        if aspect == self.aspect {
            return;
        }
        self.aspect = aspect;
        let (Some(framing), Some(made)) = (&self.rest.framing, self.scene.cameras.len().checked_sub(1)) else { return };
        let camera = framing.camera(aspect);
        for scene in [&mut self.scene, &mut self.rest.scene] {
            scene.cameras[made] = camera.clone();
        }
        if self.rig.preset == Some(made) {
            self.rig.take(&camera, made, &self.bounds);
            self.touch();
        }
    }

    /// World bounds of the scene as it is now.
    #[must_use]
    pub fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// Names of the animations, and their durations in seconds.
    pub fn animations(&self) -> impl Iterator<Item = (&str, f64)> {
        self.rest.animations.iter().map(|animation| (animation.name.as_str(), animation.duration))
    }

    /// Where everything is.
    #[must_use]
    pub fn pose(&self) -> &Pose {
        &self.pose
    }

    /// Says that the picture has to be drawn again.
    pub fn touch(&mut self) {
        self.changes.picture = true;
    }

    /// Lets time pass.
    pub fn advance(&mut self, seconds: f64) {
        if self.playback.advance(&self.rest, seconds) {
            self.posed();
        }
    }

    /// Moves everything to the moment of [`Self::playback`]. Lights that were moved by hand stay where they are.
    pub fn posed(&mut self) {
        match self.playback.seconds {
            Some(seconds) => self.rest.pose_into(self.playback.animation, seconds, &mut self.pose),
            None => self.pose.take(&self.rest.scene),
        }
        for (light, origin) in self.scene.lights.iter_mut().zip(&self.origins) {
            if let Some((kind, axes)) =
                origin.follows.and_then(|i| self.pose.lights.get(i).zip(self.pose.light_axes.get(i)))
            {
                (light.kind, light.shape.axes) = (*kind, *axes);
            }
        }
        self.list_lights();
        self.scene.set_pose(&self.pose);
        self.bounds = self.scene.bounds();
        if let Some(camera) = self.rig.preset.and_then(|preset| self.scene.cameras.get(preset)) {
            self.rig.camera.world_from_view = camera.world_from_view;
        }
        self.changes.pose = true;
        self.touch();
    }

    /// The pose's lights become the scene's.
    fn list_lights(&mut self) {
        self.pose.lights.clear();
        self.pose.lights.extend(self.scene.lights.iter().map(|light| light.kind));
        self.pose.light_axes.clear();
        self.pose.light_axes.extend(self.scene.lights.iter().map(|light| light.shape.axes));
    }

    /// Brings the device's scene up to date.
    ///
    /// # Errors
    /// If the device refuses.
    pub fn upload(&mut self, renderer: &mut Renderer<'_>) -> Result<(), RenderError> {
        let changes = self.changes;
        self.changes = Changes { picture: changes.picture, ..Changes::default() };
        if changes.casting {
            renderer.set_casting(&self.scene)?;
        }
        if changes.lights {
            renderer.set_lights(&self.scene)?;
        }
        if changes.surroundings {
            renderer.set_surroundings(&self.scene)?;
        }
        if changes.pose {
            self.list_lights();
            renderer.set_pose(&self.pose)?;
        }
        Ok(())
    }

    /// Whether an instance casts.
    pub fn set_casting(&mut self, instance: usize, casts: bool) {
        if let Some(instance) = self.scene.instances.get_mut(instance).filter(|i| i.casts_shadow != casts) {
            instance.casts_shadow = casts;
            self.changes.casting = true;
            self.touch();
        }
    }

    /// Does what it can of `action`; returns whether that was all.
    pub fn perform(&mut self, action: &Action) -> bool {
        let settings = &mut self.look.settings;
        match *action {
            Action::Frame => self.rig.frame(&self.bounds, self.aspect),
            Action::Camera(index) => {
                if let Some(camera) = self.scene.cameras.get(index) {
                    self.rig.take(camera, index, &self.bounds);
                }
            }
            Action::SwitchMode => {
                self.rig.mode = if self.rig.mode == Mode::Orbit { Mode::Fly } else { Mode::Orbit };
            }
            Action::Play => self.playback.toggle(),
            Action::Shadows => settings.shadows = !settings.shadows,
            Action::Samples => settings.samples = if settings.samples == 1 { 4 } else { 1 },
            Action::Technique => settings.technique = next_technique(settings.technique),
            Action::Expose(stops) => {
                let now = if let Exposure::Ev(ev) = settings.exposure { ev } else { 0.0 };
                settings.exposure = Exposure::Ev((now + stops).clamp(-24.0, 24.0));
            }
            Action::AutoExposure => settings.exposure = Exposure::Auto,
            Action::AddLight(place) => self.add_light(place),
            Action::RemoveLight => self.remove_light(),
            Action::Overlay(overlay) => self.look.toggle(overlay),
            Action::NextLight => {
                let count = self.scene.lights.len();
                self.selected = (count > 0).then(|| self.selected.map_or(0, |light| (light + 1) % count));
            }
            _ => return false,
        }
        self.touch();
        true
    }

    /// Whether anything moves by itself.
    #[must_use]
    pub fn is_moving(&self) -> bool {
        self.playback.playing && self.rest.animations.get(self.playback.animation).is_some_and(|a| a.moves_anything())
    }
}

fn next_technique(technique: Technique) -> Technique {
    let at = Technique::ALL.iter().position(|&t| t == technique).unwrap_or(0);
    Technique::ALL[(at + 1) % Technique::ALL.len()]
}
