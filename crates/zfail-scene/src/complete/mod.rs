//! What a scene needs to be looked at, where the file leaves it out.
//!
//! Data flow: `viewpoint` (from which side, or from where within) -> `light` (a sun for that view, or a lamp) -> the motion of
//! all points -> `ground` (at the lowest of them) -> `framing` (a camera that holds them and their shadows). `posed` and
//! `sight` are what these see the scene with.

mod framing;
mod ground;
mod light;
mod posed;
mod sight;
mod viewpoint;

pub use framing::Framing;
pub use ground::{GroundChoice, fitting_ground};
pub use light::{Sun, fitting_ambient, fitting_sky};

use crate::{Animated, Mesh, Pose, Scene};
use framing::Reach;
use glam::{DMat3, DVec3};
use posed::Posed;
use sight::{Lens, upright};
use std::mem;
use viewpoint::Viewpoint;
use zfail_plan::bounds::Bounds;
use zfail_plan::light::LightKind;

/// Adds the camera and the lights that a scene lacks, as for a picture of 16 by 9, and no surroundings.
pub fn complete(scene: &mut Scene) {
    let mut animated = Animated::from(mem::take(scene));
    Setting { surroundings: false, ..Setting::default() }.complete(&mut animated);
    *scene = animated.scene;
}

/// What a scene that lacks something gets.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// Width over height of the picture that a camera is made for.
    pub aspect: f64,
    /// The animation of which all moments are to be in the picture; `None` for the pose at rest and the first animation.
    pub animation: Option<usize>,
    /// Where the sun of a scene without lights stands; `None` for where its shadows are seen best.
    pub sun: Option<Sun>,
    /// Whether a scene without lights stands under a sky; otherwise it has light that is the same from all sides.
    pub sky: bool,
    /// Whether there is a ground.
    pub ground: GroundChoice,
    /// Without them there is no sky and no ground but a surface, and the camera is the same: for pictures that are judged.
    pub surroundings: bool,
}

impl Default for Setting {
    fn default() -> Self {
        let (sky, ground) = (true, GroundChoice::Auto);
        Self { aspect: 16.0 / 9.0, animation: None, sun: None, sky, ground, surroundings: true }
    }
}

impl Setting {
    /// Adds what is missing to a scene.
    ///
    /// - **A camera** where there is none: see [`Framing`]. It looks from the front, the right and above, and holds the
    ///   projected points of all poses in which the scene may be shown, with their shadows on the ground; from another side
    ///   or from within where that shows far more (`viewpoint.rs` says when). A level floor many times as wide as all that
    ///   stands on it may leave the picture.
    /// - **A light** where there is none, and a notice: a sun to the left of the eye, or where too little of what is seen
    ///   would be lit, a lamp within. With it come a sky, an exposure that suits both, and a ground at the lowest point of
    ///   all poses, unless the lowest is a floor.
    /// - **Ambient light and background** where there is neither: relative to what the lights give a typical surface, so that
    ///   shadows are dark but not black. Intensities in files differ by orders of magnitude and pictures are exposed to match.
    pub fn complete(&self, animated: &mut Animated) {
        let (no_camera, no_light) = (animated.scene.cameras.is_empty(), animated.scene.lights.is_empty());
        if no_camera || no_light || matches!(self.ground, GroundChoice::Height(_)) {
            self.stage(animated, no_camera, no_light);
        }
        if !no_light && self.sun.is_some() {
            animated.scene.notices.push("the scene has lights of its own; --sun changes nothing".into());
        }
        let scene = &mut animated.scene;
        if scene.ambient == [0.0; 3] && scene.sky.is_none() {
            scene.ambient = fitting_ambient(scene);
        }
        if scene.background == [0.0; 3] {
            scene.background = [0.10, 0.13, 0.18].map(|x| x * light::typical_white(scene));
        }
    }

    /// Adds what depends on where the scene is seen from.
    fn stage(&self, animated: &mut Animated, no_camera: bool, no_light: bool) {
        let start = match self.animation {
            Some(animation) => animated.pose(animation, 0.0),
            None => Pose::of(&animated.scene),
        };
        let used: Vec<Vec<u32>> = animated.scene.meshes.iter().map(Mesh::used_vertices).collect();
        let posed = Posed { scene: &animated.scene, pose: &start, used: &used };
        let all = posed.bounds();
        let content = content(posed, &all);
        let samples = posed.samples(SAMPLES);

        let (viewpoint, lens) = match animated.scene.cameras.first().filter(|_| !no_camera) {
            Some(camera) => (None, Lens::of(camera, self.aspect)),
            None => {
                let viewpoint = viewpoint::choose(posed, &content, &samples);
                (Some(viewpoint), viewpoint.lens(&content))
            }
        };
        let key = no_light.then(|| light::key(posed, &content, &samples, lens, self.sun));
        let indoors = matches!(viewpoint, Some(Viewpoint::Inside { .. }));
        let lamp = key.as_ref().is_some_and(|key| matches!(key.kind, LightKind::Point { .. }));
        let grounded = match self.ground {
            GroundChoice::Auto => no_light && !indoors && !ground::has_floor(posed, &content),
            GroundChoice::None => false,
            GroundChoice::Height(_) => true,
        };

        let axes = match viewpoint {
            Some(Viewpoint::Around(back)) => upright(back),
            _ => DMat3::IDENTITY,
        };
        let sunlight = key.as_ref().and_then(|key| match key.kind {
            LightKind::Directional { direction } if direction.y < 0.0 => Some(direction),
            _ => None,
        });
        let origin = if content.is_empty() { DVec3::ZERO } else { content.center() };
        let mut motion = Motion::new(self.aspect, origin, axes, sunlight);
        motion.limit = (content != all).then_some(content);
        self.follow(animated, &used, &mut motion);

        let height = match self.ground {
            GroundChoice::Height(height) => height,
            _ => motion.bounds.min.y,
        };
        let height = if height.is_finite() { height } else { -1.0 };
        let ground = grounded.then(|| {
            let reach =
                sunlight.map_or(0.0, |way| motion.bounds.half().y.max(0.0) * 2.0 * way.with_y(0.0).length() / -way.y);
            let around = if content == all { &motion.bounds } else { &content };
            let wide = if matches!(self.ground, GroundChoice::Height(_)) { 4.0 } else { 1.0 };
            ground::around(around, height, reach, wide)
        });
        if let Some(viewpoint) = viewpoint {
            let framing = match viewpoint {
                Viewpoint::Inside { eye, back } => Framing::inside(eye, back, content.half().length()),
                Viewpoint::Around(_) => motion.framing(ground.map(|ground| ground.height)),
            };
            animated.scene.cameras.push(framing.camera(self.aspect));
            animated.framing = Some(framing);
        }
        let scene = &mut animated.scene;
        if let Some(key) = key {
            scene.notices.push(match lamp {
                true => "the scene has no light, and a sun would light too little of it; a lamp is added".into(),
                false => "the scene has no light; one directional light is added".into(),
            });
            scene.lights.push(key);
            scene.exposure = Some(0.0);
            scene.sky = (self.sky && self.surroundings).then_some(light::SKY);
        }
        match (ground, self.ground) {
            (Some(ground), GroundChoice::Height(_)) => ground::add(scene, &ground),
            (ground, _) => scene.ground = ground.filter(|_| self.surroundings),
        }
    }

    /// Adds the points of all poses that are to be seen.
    fn follow(&self, animated: &Animated, used: &[Vec<u32>], motion: &mut Motion) {
        let mut pose = Pose::of(&animated.scene);
        if self.animation.is_none() {
            motion.add(Posed { scene: &animated.scene, pose: &pose, used });
        }
        let number = self.animation.unwrap_or(0);
        let Some(animation) = animated.animations.get(number).filter(|animation| animation.moves_anything()) else {
            if self.animation.is_some() {
                motion.add(Posed { scene: &animated.scene, pose: &pose, used });
            }
            return;
        };
        for moment in 0..MOMENTS {
            let seconds = animation.duration * moment as f64 / (MOMENTS - 1) as f64;
            animated.pose_into(number, seconds, &mut pose);
            motion.add(Posed { scene: &animated.scene, pose: &pose, used });
        }
    }
}

/// Points by which viewpoints and lights are chosen.
const SAMPLES: usize = 3000;
/// Moments of an animation that are looked at.
const MOMENTS: usize = 24;

/// All points of all poses, as far as a camera and a ground need them.
struct Motion {
    origin: DVec3,
    axes: DMat3,
    /// Of the sun, downwards.
    sunlight: Option<DVec3>,
    /// Points beyond this are not framed.
    limit: Option<Bounds>,
    bounds: Bounds,
    reach: Reach,
    /// Of the shadows of all points on the plane y = 0 of the origin.
    shadows: Reach,
}

impl Motion {
    fn new(aspect: f64, origin: DVec3, axes: DMat3, sunlight: Option<DVec3>) -> Self {
        let [reach, shadows] = [(); 2].map(|()| Reach::new(aspect));
        Self { origin, axes, sunlight, limit: None, bounds: Bounds::EMPTY, reach, shadows }
    }

    fn add(&mut self, posed: Posed<'_>) {
        let view_from_world = self.axes.transpose();
        for placed in posed.placed() {
            for &v in placed.used {
                let world = placed.world(v);
                self.bounds.add(world);
                if self.limit.is_some_and(|limit| limit.distance_squared(world) > 0.0) {
                    continue;
                }
                let p = world - self.origin;
                self.reach.add(view_from_world * p);
                if let Some(way) = self.sunlight.filter(|_| placed.casts) {
                    self.shadows.add(view_from_world * (p - p.y / way.y * way));
                }
            }
        }
    }

    /// Of all points, and of their shadows on a ground at this height.
    fn framing(&self, ground: Option<f64>) -> Framing {
        let mut reach = self.reach.clone();
        if let (Some(height), Some(way)) = (ground, self.sunlight) {
            reach.join(&self.shadows, self.axes.transpose() * ((height - self.origin.y) / way.y * way));
        }
        Framing::around(self.origin, self.axes, reach)
    }
}

/// The bounds of all but level ground that is many times as wide as what stands on it.
fn content(posed: Posed<'_>, all: &Bounds) -> Bounds {
    /// How many times.
    const WIDE: f64 = 5.0;
    let samples: Vec<DVec3> = posed
        .placed()
        .flat_map(|placed| {
            let step = placed.used.len().div_ceil(2000).max(1);
            placed.used.iter().step_by(step).map(move |&v| placed.world(v))
        })
        .collect();
    if samples.len() < 50 {
        return *all;
    }
    let quantile = |axis: usize, share: f64| {
        let mut along: Vec<f64> = samples.iter().map(|p| p[axis]).collect();
        along.sort_by(f64::total_cmp);
        along[(share * (along.len() - 1) as f64) as usize]
    };
    let corner = |share: f64| DVec3::from_array([0, 1, 2].map(|axis| quantile(axis, share)));
    let core = Bounds { min: corner(0.05), max: corner(0.95) };
    let margin = core.half().with_y(0.0);
    let core = Bounds { min: (core.min - margin).max(all.min), max: (core.max + margin).min(all.max) };
    let core = Bounds { min: core.min.with_y(all.min.y), max: core.max.with_y(all.max.y) };
    if all.half().x < WIDE * core.half().x && all.half().z < WIDE * core.half().z {
        return *all;
    }
    // What lies outside must be level and low.
    let level = all.min.y + 0.1 * core.half().x.max(core.half().z);
    let outside = |p: &DVec3| core.distance_squared(*p) > 0.0;
    if samples.iter().filter(|p| outside(p)).all(|p| p.y <= level) { core } else { *all }
}

#[cfg(test)]
mod tests;
