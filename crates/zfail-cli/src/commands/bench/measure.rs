//! The clock around frames.
//!
//! In: a scene's frames and the techniques to compare. Out: a timing per frame and technique, and one without shadows.
//! Each frame is rendered in all ways before the next one is, and each time another way begins, so that what drifts in
//! the machine (clocks, caches, other programs) drifts for all alike.

use super::scenes::Course;
use crate::error::Error;
use cpu_time::ProcessTime;
use indicatif::ProgressBar;
use std::time::{Duration, Instant};
use zfail_render::{Exposure, FrameStats, Gpu, RenderError, Renderer, Settings, Technique};
use zfail_scene::Pose;

/// Frames before the clock counts: pipelines are compiled, buffers have grown, caches are filled.
const WARM_UP: usize = 2;

/// Each of `chosen` once, or all techniques if it is empty.
pub fn techniques(chosen: &[Technique]) -> Vec<Technique> {
    let mut techniques: Vec<Technique> = Vec::new();
    for &technique in if chosen.is_empty() { &Technique::ALL[..] } else { chosen } {
        if !techniques.contains(&technique) {
            techniques.push(technique);
        }
    }
    techniques
}

/// What a frame cost, rendered in one way.
pub struct Timing {
    /// User and system time of all threads of the process. On a software rasteriser this includes the rendering.
    pub cpu: Duration,
    pub wall: Duration,
    pub stats: FrameStats,
}

/// What all scenes are measured with.
pub struct Setup<'a> {
    pub gpu: &'a Gpu,
    pub techniques: &'a [Technique],
    pub samples: u32,
}

/// What the frames of one scene cost.
pub struct Timings {
    /// With shadows, by technique.
    pub on: Vec<Vec<Timing>>,
    /// Without shadows, where techniques do not differ.
    pub off: Vec<Timing>,
}

impl Setup<'_> {
    /// How many frames [`Self::play`] renders.
    pub fn frame_count(&self, course: &Course) -> usize {
        (WARM_UP + course.frames.len()) * (self.techniques.len() + 1)
    }

    /// Renders every frame of `course` by every technique and without shadows.
    ///
    /// # Errors
    /// If the renderer or the device fails.
    pub fn play(&self, course: &Course, progress: &ProgressBar) -> Result<Timings, Error> {
        // Known beforehand, as in a program that draws one frame after the other: no frame waits for its own brightness.
        let exposure = Exposure::Ev(0.0);
        let settings = |technique, shadows| Settings {
            technique,
            shadows,
            samples: self.samples,
            exposure,
            ..Settings::default()
        };
        let on = self.techniques.iter().map(|&technique| settings(technique, true));
        let variants = on.chain([settings(Technique::default(), false)]);
        let mut players: Vec<Player<'_>> =
            variants.map(|settings| Player::new(self.gpu, course, settings)).collect::<Result<_, _>>()?;
        let count = players.len();
        for (turn, k) in order(course.frames.len()).enumerate() {
            for i in 0..count {
                players[(i + turn) % count].play(course, k, turn >= WARM_UP)?;
                progress.inc(1);
            }
        }
        let mut on: Vec<Vec<Timing>> = players.into_iter().map(|player| player.timings).collect();
        let off = on.pop().unwrap_or_default();
        Ok(Timings { on, off })
    }
}

/// Frames in the order of play: the last ones to warm up, as if the animation came round, then all.
fn order(count: usize) -> impl Iterator<Item = usize> {
    let last = count.saturating_sub(1);
    (0..WARM_UP).rev().map(move |before| last.saturating_sub(before)).chain(0..count)
}

/// Plays one scene in one way. Each has a renderer of its own, because planning and uploads reuse what they know of the
/// frame before.
struct Player<'g> {
    settings: Settings,
    renderer: Renderer<'g>,
    pose: Pose,
    timings: Vec<Timing>,
}

impl<'g> Player<'g> {
    fn new(gpu: &'g Gpu, course: &Course, settings: Settings) -> Result<Self, Error> {
        let renderer = Renderer::new(gpu, &course.animated.scene)?;
        Ok(Self { settings, renderer, pose: Pose::default(), timings: Vec::with_capacity(course.frames.len()) })
    }

    fn play(&mut self, course: &Course, k: usize, counts: bool) -> Result<(), Error> {
        let mut timing = self.time(course, k)?;
        if counts {
            // Off the clock.
            self.renderer.count_fragments(&mut timing.stats)?;
            self.timings.push(timing);
        }
        Ok(())
    }

    /// Renders frame `k` with the clock running: pose, plan, upload, encoding and rendering until the device is idle.
    fn time(&mut self, course: &Course, k: usize) -> Result<Timing, RenderError> {
        let (seconds, view) = &course.frames[k];
        let (wall, cpu) = (Instant::now(), ProcessTime::now());
        course.pose_into(*seconds, &mut self.pose);
        self.renderer.set_pose(&self.pose)?;
        let stats = self.renderer.render(view, &self.settings)?;
        Ok(Timing { cpu: cpu.elapsed(), wall: wall.elapsed(), stats })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_warms_up_for_the_beginning() {
        assert_eq!(order(5).collect::<Vec<_>>(), [3, 4, 0, 1, 2, 3, 4]);
        assert_eq!(order(1).collect::<Vec<_>>(), [0, 0, 0]);
    }

    #[test]
    fn techniques_come_once_in_the_order_asked_for() {
        assert_eq!(techniques(&[]), Technique::ALL);
        let [a, b] = [Technique::ALL[1], Technique::ALL[0]];
        assert_eq!(techniques(&[a, b, a]), [a, b]);
    }
}
