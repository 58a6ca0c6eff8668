//! The clock around frames.
//!
//! In: a scene's frames and the variants to compare. Out: a sample per frame and variant. Each frame is rendered by
//! every variant before the next one is, and each time another one begins, so that what drifts in the machine (clocks,
//! caches, other programs) drifts for all alike.

use super::scenes::Course;
use crate::error::Error;
use crate::render::failed;
use cpu_time::ProcessTime;
use indicatif::ProgressBar;
use std::time::{Duration, Instant};
use zfail_plan::scene::Pose;
use zfail_render::{FrameStats, Gpu, RenderError, Renderer, Settings, Technique};

/// Frames of every variant before the clock counts: pipelines are compiled, buffers have grown, caches are filled.
const WARM_UP: usize = 2;

/// What is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variant {
    pub technique: Technique,
    pub shadows: bool,
}

impl Variant {
    /// Every technique with shadows and without; all techniques if `chosen` is empty.
    pub fn all(chosen: &[Technique]) -> Vec<Self> {
        let mut techniques: Vec<Technique> = Vec::new();
        for &technique in if chosen.is_empty() { &Technique::ALL[..] } else { chosen } {
            if !techniques.contains(&technique) {
                techniques.push(technique);
            }
        }
        techniques.iter().flat_map(|&technique| [true, false].map(|shadows| Self { technique, shadows })).collect()
    }
}

/// One frame of one variant.
pub struct Frame {
    /// User and system time of all threads of the process. On a software rasteriser this includes the rendering.
    pub cpu: Duration,
    pub wall: Duration,
    pub stats: FrameStats,
}

/// What all scenes are measured with.
pub struct Setup<'a> {
    pub gpu: &'a Gpu,
    pub variants: &'a [Variant],
    pub samples: u32,
}

impl Setup<'_> {
    /// How many frames [`Self::play`] renders.
    pub fn frame_count(&self, course: &Course) -> usize {
        (WARM_UP + course.frames.len()) * self.variants.len()
    }

    /// The frames of `course`, by variant.
    pub fn play(&self, course: &Course, progress: &ProgressBar) -> Result<Vec<Vec<Frame>>, Error> {
        let mut players: Vec<Player<'_>> = Vec::new();
        for variant in self.variants {
            // Planning reuses what it knows of the frame before, which must have been planned by the same technique.
            if players.iter().all(|player| player.technique != variant.technique) {
                players.push(Player::new(self.gpu, course, variant.technique).map_err(|e| failed(&e))?);
            }
        }
        let mut samples: Vec<Vec<Frame>> = self.variants.iter().map(|_| Vec::new()).collect();
        for (turn, k) in order(course.frames.len()).enumerate() {
            for i in 0..self.variants.len() {
                let v = (i + turn) % self.variants.len();
                let variant = self.variants[v];
                let Some(player) = players.iter_mut().find(|player| player.technique == variant.technique) else {
                    continue;
                };
                let settings = Settings {
                    technique: variant.technique,
                    samples: self.samples,
                    shadows: variant.shadows,
                    ..Settings::default()
                };
                let frame = player.time(course, k, &settings).map_err(|e| failed(&e))?;
                if turn >= WARM_UP {
                    samples[v].push(frame);
                }
                progress.inc(1);
            }
        }
        Ok(samples)
    }
}

/// Frames in the order of play: the last ones to warm up, as if the animation came round, then all.
fn order(count: usize) -> impl Iterator<Item = usize> {
    let last = count.saturating_sub(1);
    (0..WARM_UP).rev().map(move |before| last.saturating_sub(before)).chain(0..count)
}

/// A renderer that plays one scene by one technique.
struct Player<'g> {
    technique: Technique,
    renderer: Renderer<'g>,
    pose: Pose,
}

impl<'g> Player<'g> {
    fn new(gpu: &'g Gpu, course: &Course, technique: Technique) -> Result<Self, RenderError> {
        Ok(Self { technique, renderer: Renderer::new(gpu, &course.animated.scene)?, pose: Pose::default() })
    }

    /// Renders frame `k` with the clock running: pose, plan, upload, encoding and rendering until the device is idle.
    fn time(&mut self, course: &Course, k: usize, settings: &Settings) -> Result<Frame, RenderError> {
        let (seconds, view) = &course.frames[k];
        let (wall, cpu) = (Instant::now(), ProcessTime::now());
        course.pose_into(*seconds, &mut self.pose);
        self.renderer.set_pose(&self.pose)?;
        let stats = self.renderer.render(view, settings)?;
        Ok(Frame { cpu: cpu.elapsed(), wall: wall.elapsed(), stats })
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
    fn every_technique_comes_once_with_shadows_and_once_without() {
        let all = Variant::all(&[]);
        assert_eq!(all.len(), 2 * Technique::ALL.len());
        for technique in Technique::ALL {
            assert!([true, false].iter().all(|&shadows| all.contains(&Variant { technique, shadows })));
        }
        let [a, b] = [Technique::ALL[1], Technique::ALL[0]];
        let chosen: Vec<_> = Variant::all(&[a, b, a]).iter().map(|variant| variant.technique).collect();
        assert_eq!(chosen, [a, a, b, b]);
    }
}
