//! The table of a comparison, in the shape of compare.json.

use super::measure::{Drawn, Entry, Outcome};
use crate::commands::judged::JudgedLight;
use crate::error::Error;
use crate::groups::Subject;
use crate::input::Shot;
use serde::Serialize;
use std::fmt::Write;
use zfail_methods::{FiniteOptions, Method, Options, ShadowMapOptions};
use zfail_oracle::Truth;
use zfail_render::Gpu;

/// The whole table.
#[derive(Debug, Serialize)]
pub struct Record {
    pub scene: String,
    /// Name of the camera.
    pub camera: String,
    pub size: [u32; 2],
    pub adapter: String,
    pub backend: String,
    pub driver: String,
    pub shadow_map: ShadowMapRecord,
    pub finite: FiniteRecord,
    /// Of the pictures, in stops.
    pub exposure: f32,
    /// Verdicts that the oracle could judge, of all lights together.
    pub verdicts: usize,
    pub lights: Vec<JudgedLight>,
    pub methods: Vec<MethodRecord>,
}

/// How the shadow map was drawn and read.
#[derive(Debug, Serialize)]
pub struct ShadowMapRecord {
    pub resolution: u32,
    /// A fraction of the light's depth range.
    pub bias: f32,
    /// Texels per unit of slope.
    pub slope_bias: f32,
    pub pcf: bool,
}

/// Where things ended that the theory wants at infinity; null where the method had the choice.
#[derive(Debug, Serialize)]
pub struct FiniteRecord {
    /// Distance of the far plane, scene units.
    pub far: Option<f64>,
    /// Length of volumes, scene units.
    pub extrusion: Option<f64>,
}

/// One row.
#[derive(Debug, Serialize)]
pub struct MethodRecord {
    pub method: &'static str,
    pub title: &'static str,
    /// The paper and its section.
    pub source: &'static str,
    /// Whether it promises to have no wrong pixel.
    pub exact: bool,
    /// Why it is right, or where it goes wrong.
    pub why: &'static str,
    /// Why it has not run, if it has not.
    pub unavailable: Option<String>,
    /// What it did, if it has run.
    pub result: Option<MethodResult>,
}

/// What one method did, for all lights together.
#[derive(Debug, Serialize)]
pub struct MethodResult {
    /// Wrong verdicts.
    pub wrong_pixels: usize,
    /// The same light by light.
    pub wrong_by_light: Vec<usize>,
    pub triangles: u64,
    pub vertices: u64,
    /// Rasterised fragments of these triangles; of ray queries, rays.
    pub fragments: u64,
    pub passes: u32,
    /// CPU time, milliseconds.
    pub planning_ms: f64,
    /// Wall time from an idle device to an idle device, milliseconds.
    pub render_ms: f64,
}

impl Record {
    /// Gathers what was measured.
    ///
    /// # Errors
    /// If the truth contradicts itself, which is a bug.
    pub fn new(
        subject: &Subject,
        shot: &Shot,
        gpu: &Gpu,
        options: &Options,
        exposure: f32,
        truths: &[Truth],
        entries: &[Entry],
    ) -> Result<Self, Error> {
        let judged = shot.lights.iter().zip(truths).map(|(&light, truth)| JudgedLight::new(&shot.scene, light, truth));
        let lights: Vec<JudgedLight> = judged.collect::<Result<_, _>>()?;
        let ShadowMapOptions { resolution, bias, slope_bias, pcf } = options.shadow_map;
        let FiniteOptions { far, extrusion } = options.finite;
        Ok(Self {
            scene: subject.scene.scene.clone(),
            camera: shot.camera.clone(),
            size: shot.view.size,
            adapter: gpu.info.name.clone(),
            backend: gpu.info.backend.to_string(),
            driver: [gpu.info.driver.as_str(), gpu.info.driver_info.as_str()].join(" ").trim().to_owned(),
            shadow_map: ShadowMapRecord { resolution, bias, slope_bias, pcf },
            finite: FiniteRecord { far, extrusion },
            exposure,
            verdicts: lights.iter().map(|light| light.checked + light.out_of_reach + light.background).sum(),
            lights,
            methods: entries.iter().map(MethodRecord::new).collect(),
        })
    }

    /// Methods that promise to be exact and have wrong pixels, each with their number.
    pub fn broken_promises(&self) -> Vec<String> {
        let wrong = |m: &MethodRecord| Some((m.method, m.result.as_ref()?.wrong_pixels)).filter(|_| m.exact);
        let broken = self.methods.iter().filter_map(wrong).filter(|(_, wrong)| *wrong > 0);
        broken.map(|(method, wrong)| format!("{method} has {wrong} wrong pixels")).collect()
    }

    /// The table as a person reads it in a terminal.
    pub fn table(&self) -> String {
        let [width, height] = self.size;
        let mut text = format!(
            "{} from '{}' at {width}x{height} on {} ({}, driver {})\n{} verdicts checked, of lights: {}\n\n",
            self.scene,
            self.camera,
            self.adapter,
            self.backend,
            self.driver,
            self.verdicts,
            self.lights.len()
        );
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{:<26}{:>9}{:>11}{:>11}{:>12}{:>8}{:>10}",
            "method", "wrong", "triangles", "vertices", "fragments", "passes", "ms"
        );
        for row in &self.methods {
            let _ = match (&row.result, &row.unavailable) {
                (Some(r), _) => writeln!(
                    text,
                    "{:<26}{:>9}{:>11}{:>11}{:>12}{:>8}{:>10.1}",
                    row.method,
                    r.wrong_pixels,
                    r.triangles,
                    r.vertices,
                    r.fragments,
                    r.passes,
                    r.milliseconds()
                ),
                (None, why) => writeln!(text, "{:<20}  {}", row.method, why.as_deref().unwrap_or("has not run")),
            };
        }
        text
    }
}

impl MethodRecord {
    fn new(entry: &Entry) -> Self {
        let method: Method = entry.method;
        let (result, unavailable) = match &entry.outcome {
            Outcome::Drawn(drawn) => (Some(MethodResult::new(drawn)), None),
            Outcome::Missing(why) => (None, Some(why.clone())),
        };
        Self {
            method: method.name(),
            title: method.title(),
            source: method.source(),
            exact: method.exact(),
            why: method.why(),
            unavailable,
            result,
        }
    }
}

impl MethodResult {
    fn new(drawn: &Drawn) -> Self {
        let figures = &drawn.figures;
        Self {
            wrong_pixels: drawn.wrong.iter().sum(),
            wrong_by_light: drawn.wrong.clone(),
            triangles: figures.triangles,
            vertices: figures.vertices,
            fragments: figures.fragments,
            passes: figures.passes,
            planning_ms: figures.planning_ms,
            render_ms: figures.render_ms,
        }
    }

    /// Planning and rendering.
    pub fn milliseconds(&self) -> f64 {
        self.planning_ms + self.render_ms
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// A record of three methods: an old one with wrong pixels, an exact one, and one that has not run.
    pub fn record(wrong_of_exact: usize) -> Record {
        let drawn = |wrong| Outcome::Drawn(Drawn { masks: Vec::new(), wrong, figures: Default::default() });
        let entries = [
            Entry { method: Method::HeidmannTwoPass, outcome: drawn(vec![3, 4]) },
            Entry { method: Method::Mcguire, outcome: drawn(vec![wrong_of_exact, 0]) },
            Entry { method: Method::RayQuery, outcome: Outcome::Missing("no <rays> here".to_owned()) },
        ];
        Record {
            scene: "a & b.glb".to_owned(),
            camera: "eye".to_owned(),
            size: [2, 1],
            adapter: "A".to_owned(),
            backend: "vulkan".to_owned(),
            driver: "1".to_owned(),
            shadow_map: ShadowMapRecord { resolution: 1, bias: 0.0, slope_bias: 0.0, pcf: false },
            finite: FiniteRecord { far: None, extrusion: None },
            exposure: 0.0,
            verdicts: 8,
            lights: Vec::new(),
            methods: entries.iter().map(MethodRecord::new).collect(),
        }
    }

    #[test]
    fn only_exact_methods_can_break_a_promise() {
        assert!(record(0).broken_promises().is_empty());
        assert_eq!(record(2).broken_promises(), ["mcguire has 2 wrong pixels"]);
    }

    #[test]
    fn the_table_has_a_row_for_every_method() {
        let table = record(0).table();
        let row = |name: &str| table.lines().find(|line| line.starts_with(name)).unwrap_or_default().to_owned();
        assert!(row("heidmann-two-pass").split_whitespace().nth(1) == Some("7"), "{table}");
        assert!(row("mcguire").split_whitespace().nth(1) == Some("0"), "{table}");
        assert!(row("ray-query").ends_with("no <rays> here"), "{table}");
    }
}
