//! The plans that figures show.
//!
//! In: model, view, lights, technique. Out: what the technique draws, and whole volumes of everything.

use crate::Error;
use crate::model::Model;
use crate::volumes::{self, Triangle};
use zfail_plan::glam::DVec4;
use zfail_plan::plan::{Counting, FramePlan, Input, Planner, ShadowLight, Silhouettes, Steps, Technique};
use zfail_plan::view::{Projection, View};

/// Two planners, so that each finds its last frame as it left it.
#[derive(Debug, Default)]
pub struct Plans {
    technique: Planner,
    whole: Planner,
}

impl Plans {
    /// What `technique` draws.
    pub fn of(
        &mut self,
        model: &mut Model,
        view: &View,
        lights: &[usize],
        technique: Technique,
    ) -> Result<&FramePlan, Error> {
        // Figures need the lists, so no silhouette is left to a device.
        let steps = Steps { silhouettes: Silhouettes::Cpu, ..technique.steps() };
        plan(&mut self.technique, model, view, lights, steps, Counting::Verdict)
    }

    /// Whole volumes of all casters, nothing culled, closed at infinity by the extruded light cap (E&K 2002).
    pub fn whole(&mut self, model: &mut Model, view: &View, lights: &[usize]) -> Result<Whole, Error> {
        let steps = Technique::EverittKilgard.steps();
        let plan = plan(&mut self.whole, model, view, lights, steps, Counting::Raw)?;
        let finite = matches!(view.projection, Projection::Orthographic { .. });
        Ok(Whole { triangles: volumes::triangles(plan, model), silhouettes: volumes::silhouettes(plan, model, finite) })
    }
}

/// Volumes from which nothing is left out.
#[derive(Debug)]
pub struct Whole {
    pub triangles: Vec<Triangle>,
    pub silhouettes: Vec<(usize, [DVec4; 2])>,
}

fn plan<'p>(
    planner: &'p mut Planner,
    model: &mut Model,
    view: &View,
    lights: &[usize],
    steps: Steps,
    counting: Counting,
) -> Result<&'p FramePlan, Error> {
    model.make_topologies()?;
    let excluded: Vec<Vec<usize>> = lights.iter().map(|&l| model.excluded(l)).collect();
    let lights: Vec<ShadowLight<'_>> = lights
        .iter()
        .zip(&excluded)
        .map(|(&l, excluded)| {
            let light = &model.lights[l];
            ShadowLight::new(light.kind).within(light.bounds()).excluding(excluded)
        })
        .collect();
    let receivers = &model.receivers(view);
    let frame = Input { view, casters: &model.casters(), lights: &lights, receivers, steps, counting };
    Ok(planner.plan(&frame)?)
}
