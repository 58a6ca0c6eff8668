//! Who looks at a low sun has every object before it in case 3 (McG section 7).

use super::{caster, look, plan, topology};
use serde::{Deserialize, Serialize};
use std::error::Error;
use zfail_builtin::shapes;
use zfail_plan::glam::DVec3;
use zfail_plan::light::LightKind;
use zfail_plan::plan::{Planner, Technique};
use zfail_testing::Random;

/// Viewers among boxes on a plain, who look towards the sun.
#[derive(Debug, Deserialize, Serialize)]
pub struct Sun {
    /// Degrees above the horizon.
    pub elevation: f64,
    /// Boxes drawn in each case, over all viewers.
    pub cases: [u32; 3],
    /// Boxes between a viewer's eye and the sun.
    pub before: u32,
    /// Of these, how many are in case 3.
    pub before_in_case_3: u32,
}

/// The sun low and high, as many viewers as asked for.
///
/// # Errors
/// If a box cannot cast.
pub fn measure(viewers: u32) -> Result<Vec<Sun>, Box<dyn Error>> {
    let mut lines = Vec::new();
    for elevation in [3.0_f64, 60.0] {
        let (sin, cos) = elevation.to_radians().sin_cos();
        let towards = DVec3::new(0.0, sin, -cos);
        let light = LightKind::Directional { direction: -towards };
        let mut line = Sun { elevation, cases: [0; 3], before: 0, before_in_case_3: 0 };
        let mut random = Random(11);
        for _ in 0..viewers {
            let eye = DVec3::new(0.0, 1.7, 0.0);
            let view = look(eye, eye + DVec3::NEG_Z, [160, 90]);
            for _ in 0..100 {
                let at = DVec3::new(random.real(-20.0, 20.0), 0.0, random.real(-60.0, 20.0));
                let half = DVec3::new(random.real(0.5, 2.0), random.real(1.0, 6.0), random.real(0.5, 2.0));
                let body = topology(&shapes::cuboid(-half, half))?;
                let casters = [caster(&body, 0, at)];
                if inside(eye, at, half + 0.1) {
                    continue;
                }
                let mut planner = Planner::new();
                let steps = Technique::Mcguire.steps();
                let cases = plan(&mut planner, &view, &casters, light, steps)?.lights[0].stats.cases;
                line.cases.iter_mut().zip(cases).for_each(|(sum, count)| *sum += count);
                if meets(eye - at, towards, half) {
                    line.before += 1;
                    line.before_in_case_3 += cases[2];
                }
            }
        }
        lines.push(line);
    }
    Ok(lines)
}

fn inside(eye: DVec3, at: DVec3, half: DVec3) -> bool {
    (eye - at).abs().cmplt(half).all()
}

/// Whether a ray meets a box around the origin.
fn meets(from: DVec3, towards: DVec3, half: DVec3) -> bool {
    let [a, b] = [-half, half].map(|corner| (corner - from) / towards);
    let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
    leave > enter.max(0.0)
}
