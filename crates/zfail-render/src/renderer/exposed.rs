//! What shines in a frame, in the range that its targets hold best.

use super::parts::Finish;
use crate::passes::frame::Shading;
use crate::scene::SceneOnGpu;
use crate::scene::gpu_data::LightRecord;
use crate::scene::surroundings::Surroundings;
use crate::{Exposure, scene::lights};
use zfail_plan::view::View;
use zfail_scene::Sky;

/// Light of a frame, scaled to the range of half floats.
#[derive(Debug)]
pub struct Exposed {
    pub lights: Vec<LightRecord>,
    pub ambient: [f32; 3],
    pub background: [f32; 3],
    pub sky: Option<Sky>,
    pub pre_exposure: f32,
    /// From pre-exposed radiance to the picture's; meaningless where it is measured.
    pub exposure: f32,
}

impl Exposed {
    pub fn new(scene: &SceneOnGpu, chosen: &[usize], exposure: Exposure, view: &View) -> Self {
        let lit = chosen.iter().map(|&l| &scene.lights[l]);
        let &Surroundings { ambient, background, sky, .. } = &scene.surroundings;
        let Sky { zenith, horizon, nadir } = sky.unwrap_or_default();
        let constant = [ambient, background, scene.emission, zenith, horizon, nadir];
        let pre_exposure = lights::pre_exposure(lit, &scene.bounds, &constant);
        let record = |&l: &usize| lights::record(&scene.lights[l], view, pre_exposure, scene.shapes.of_light[l]);
        Self {
            lights: chosen.iter().map(record).collect(),
            ambient: ambient.map(|c| c * pre_exposure),
            background: background.map(|c| c * pre_exposure),
            sky: sky.map(|sky| sky.scaled(pre_exposure)),
            pre_exposure,
            exposure: match exposure {
                Exposure::Auto => 1.0,
                Exposure::Ev(stops) => (stops.exp2() / pre_exposure).clamp(0.0, f32::MAX),
            },
        }
    }

    /// What a picture finished so shows of the scene's lights; each has its share of the error.
    pub fn precision(&self, scene: &SceneOnGpu, finish: Finish) -> lights::Precision {
        let step = match finish {
            Finish::Forward => lights::DISPLAY_STEP / f64::from(self.exposure),
            Finish::Darkroom => lights::HALF_FLOAT_STEP,
        };
        lights::Precision {
            step: step / self.lights.len().max(1) as f64,
            pre_exposure: self.pre_exposure.into(),
            reflectance: lights::greatest_reflectance(scene.roughness),
        }
    }

    pub fn shading(&self) -> Shading<'_> {
        let Self { ref lights, ambient, background, sky, pre_exposure, exposure } = *self;
        Shading { lights, other_lights: &[], ambient, background, sky, ground: None, pre_exposure, exposure }
    }
}
