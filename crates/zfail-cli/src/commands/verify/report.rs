//! What was found, in the shape of `--json`.
//!
//! In: what was judged of every light in every view. Out: a verdict, and what is wrong in a sentence.

use super::closure::Closed;
use super::light::{LightReport, TechniqueReport};
use super::proof::Proof;
use serde::Serialize;
use zfail_plan::closure::Closure;
use zfail_plan::view::View;
use zfail_render::Gpu;

/// The whole report.
#[derive(Debug, Serialize)]
pub struct Report {
    pub scene: String,
    pub size: [u32; 2],
    pub adapter: String,
    pub backend: String,
    pub driver: String,
    pub depth_format: String,
    pub closure: ClosureReport,
    /// In the picture that was asked for.
    pub lights: Vec<LightReport>,
    /// Further views, of the lights of which more had to be seen.
    pub closeups: Vec<Closeup>,
    /// How much all of it proves.
    pub proof: Proof,
    /// Whether nothing is wrong.
    pub passed: bool,
    /// Whose fault it seems to be, if it has not passed.
    pub suspect: Option<Opinion>,
}

/// The proof that volumes are closed.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ClosureReport {
    pub volumes: usize,
    pub triangles: u64,
    pub open_edges: u64,
    /// Pairs of caster and light that were not examined, because there are too many.
    pub left_out: usize,
}

/// A view from somewhere else.
#[derive(Debug, Serialize)]
pub struct Closeup {
    /// World space.
    pub eye: [f64; 3],
    /// The way that it looks.
    pub towards: [f64; 3],
    pub lights: Vec<LightReport>,
}

impl Closeup {
    /// What was found in `view`.
    pub fn new(view: &View, lights: Vec<LightReport>) -> Self {
        let axes = view.world_from_view;
        Self { eye: axes.translation.to_array(), towards: (-axes.matrix3.z_axis).to_array(), lights }
    }
}

/// Whose fault a mismatch seems to be.
#[derive(Debug, PartialEq, Serialize)]
pub struct Opinion {
    pub points_to: Suspect,
    /// A sentence.
    pub because: String,
}

/// Who may be at fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Suspect {
    Driver,
    Zfail,
    Unknown,
}

impl Report {
    pub fn new(
        scene: String,
        size: [u32; 2],
        gpu: &Gpu,
        closed: Closed,
        lights: Vec<LightReport>,
        closeups: Vec<Closeup>,
        proof: Proof,
    ) -> Self {
        let driver = [gpu.info.driver.as_str(), gpu.info.driver_info.as_str()].join(" ").trim().to_owned();
        let Closed { closure: Closure { volumes, triangles, open_edges }, left_out } = closed;
        let mut report = Self {
            scene,
            size,
            adapter: gpu.info.name.clone(),
            backend: gpu.info.backend.to_string(),
            driver,
            depth_format: format!("{:?}", gpu.depth_stencil),
            closure: ClosureReport { volumes, triangles, open_edges, left_out },
            lights,
            closeups,
            proof,
            passed: false,
            suspect: None,
        };
        report.passed = open_edges == 0 && report.rows().all(TechniqueReport::passes);
        report
    }

    /// Wrong verdicts of all lights and techniques together.
    pub fn wrong_pixels(&self) -> usize {
        self.rows().map(|row| row.wrong_pixels).sum()
    }

    /// Wrong counts of all lights and techniques together.
    pub fn wrong_counts(&self) -> usize {
        self.rows().map(|row| row.wrong_counts).sum()
    }

    /// Names of the techniques that are wrong anywhere, each once.
    pub fn wrong_techniques(&self) -> Vec<&'static str> {
        let mut names: Vec<_> = self.rows().filter(|row| !row.passes()).map(|row| row.technique).collect();
        names.sort_unstable();
        names.dedup();
        names
    }

    /// What is wrong, in a sentence.
    pub fn complaint(&self) -> Option<String> {
        if self.passed {
            return None;
        }
        let mut faults = Vec::new();
        for (number, what) in [
            (self.wrong_pixels() as u64, "wrong pixels"),
            (self.wrong_counts() as u64, "wrong counts"),
            (self.closure.open_edges, "open edges of volumes"),
        ] {
            if number > 0 {
                faults.push(format!("{number} {what}"));
            }
        }
        Some(faults.join(", "))
    }

    fn rows(&self) -> impl Iterator<Item = &TechniqueReport> {
        let closer = self.closeups.iter().flat_map(|closeup| &closeup.lights);
        self.lights.iter().chain(closer).flat_map(|light| &light.techniques)
    }
}
