//! What is played: a scene, its first animation, and where it is seen from in every frame.
//!
//! In: a SCENE argument. Out: everything about its frames that can be known before the clock runs.

use super::args::Args;
use crate::error::Error;
use crate::groups::Moment;
use crate::input;
use zfail_plan::bounds::Bounds;
use zfail_plan::view::{Projection, View};
use zfail_scene::{Animated, Camera, Pose};

/// The scenes where none is named.
pub const DEFAULT: [&str; 5] =
    ["builtin:container", "builtin:room", "builtin:cathedral", "builtin:nested", "builtin:stage"];

/// A scene and its frames.
pub struct Course {
    /// As on the command line.
    pub name: String,
    /// The scene with its animations; the first is played.
    pub animated: Animated,
    /// Time and view of each frame, the first camera's.
    pub frames: Vec<(f64, View)>,
    /// Width and height, pixels.
    pub size: [u32; 2],
}

impl Course {
    /// Loads a scene; frame k of `--frames` is the time k / fps, wrapped over the animation.
    ///
    /// # Errors
    /// If there is no such scene, or it cannot be used.
    pub fn new(name: &str, args: &Args) -> Result<Self, Error> {
        let moment = Moment { time: None, animation: None };
        let mut animated = input::complete(name, &args.loading, Some(&moment), args.size.0, &args.sunlight.bare())?;
        if !animated.animations.first().is_some_and(|animation| animation.moves_anything()) {
            animated
                .scene
                .notices
                .push(format!("{name} has no animation that moves anything: all its frames are alike"));
        }
        let size = args.size.0;
        let mut scene = animated.scene.clone();
        let frame = |k: u32| {
            let seconds = f64::from(k) / args.fps;
            let seconds = animated.animations.first().map_or(seconds, |animation| animation.wrapped(seconds));
            scene.set_pose(&animated.pose(0, seconds));
            let camera: &Camera =
                scene.cameras.first().ok_or_else(|| Error::failed(format!("{name} has no camera")))?;
            // Bounds are for far planes, which a perspective view of ours does not have.
            let bounds = match camera.projection {
                Projection::Perspective { .. } => Bounds::EMPTY,
                Projection::Orthographic { .. } => scene.bounds(),
            };
            Ok((seconds, camera.view(size, &bounds)))
        };
        let frames = (0..args.frames).map(frame).collect::<Result<_, Error>>()?;
        Ok(Self { name: name.to_owned(), animated, frames, size })
    }

    /// The pose at `seconds`, in the memory of `pose`.
    pub fn pose_into(&self, seconds: f64, pose: &mut Pose) {
        self.animated.pose_into(0, seconds, pose);
    }
}
