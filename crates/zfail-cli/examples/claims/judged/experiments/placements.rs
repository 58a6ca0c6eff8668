//! How likely each case is when light, viewer and caster are placed at random in a sphere (McG section 7).

use super::{caster, look, plan, point, topology};
use serde::{Deserialize, Serialize};
use std::error::Error;
use zfail_builtin::shapes;
use zfail_plan::glam::DVec3;
use zfail_plan::plan::{Planner, Technique};
use zfail_testing::Random;

/// Many placements in one sphere.
#[derive(Debug, Deserialize, Serialize)]
pub struct Placement {
    /// Of the sphere, in radii of the caster.
    pub radius: f64,
    /// How often the caster was drawn in each case.
    pub cases: [u32; 3],
    /// How often nothing of it had to be drawn.
    pub undrawn: u32,
}

impl Placement {
    /// The share of case 1 in what is drawn.
    pub fn case_1(&self) -> f64 {
        f64::from(self.cases[0]) / f64::from(self.cases.iter().sum::<u32>())
    }
}

/// As many placements as asked for in spheres from large to small.
///
/// # Errors
/// If the caster cannot cast.
pub fn measure(trials: u32) -> Result<Vec<Placement>, Box<dyn Error>> {
    let ball = topology(&shapes::uv_sphere(1.0, 16, 8))?;
    let mut lines = Vec::new();
    for radius in [100.0, 30.0, 10.0, 3.0, 1.0, 0.3] {
        let mut random = Random(7);
        let mut line = Placement { radius, cases: [0; 3], undrawn: 0 };
        for _ in 0..trials {
            let [light, eye, at] = std::array::from_fn(|_| radius * within(&mut random));
            let casters = [caster(&ball, 0, at)];
            let view = look(eye, eye + within(&mut random), [160, 90]);
            let mut planner = Planner::new();
            let steps = Technique::Mcguire.steps();
            let stats = plan(&mut planner, &view, &casters, point(light), steps)?.lights[0].stats;
            line.cases.iter_mut().zip(stats.cases).for_each(|(sum, count)| *sum += count);
            line.undrawn += u32::from(stats.cases == [0; 3]);
        }
        lines.push(line);
    }
    Ok(lines)
}

/// Uniform in the ball of radius 1.
fn within(random: &mut Random) -> DVec3 {
    loop {
        let p = random.vector(1.0);
        if p.length_squared() <= 1.0 {
            return p;
        }
    }
}
