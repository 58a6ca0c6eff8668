//! The moment of the animation that is shown.

use zfail_scene::Animated;

/// Where playing is.
#[derive(Clone, Debug, PartialEq)]
pub struct Playback {
    /// Index into [`Animated::animations`].
    pub animation: usize,
    /// Seconds after its start; `None` while the scene is at rest.
    pub seconds: Option<f64>,
    /// Whether time passes.
    pub playing: bool,
    /// Seconds of the animation per second.
    pub speed: f64,
}

impl Default for Playback {
    fn default() -> Self {
        Self { animation: 0, seconds: None, playing: false, speed: 1.0 }
    }
}

impl Playback {
    /// Lets `seconds` pass; returns whether that moved the scene.
    pub fn advance(&mut self, scene: &Animated, seconds: f64) -> bool {
        let Some(animation) = scene.animations.get(self.animation).filter(|_| self.playing) else { return false };
        let now = animation.wrapped(self.seconds.unwrap_or(0.0) + seconds * self.speed);
        let moved = self.seconds != Some(now);
        self.seconds = Some(now);
        moved
    }

    /// Plays on or pauses.
    pub fn toggle(&mut self) {
        self.playing = !self.playing;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_passes_only_while_playing_and_starts_again_at_the_end() {
        let scene = zfail_builtin::SCENES
            .iter()
            .filter_map(|entry| zfail_builtin::animated(entry.name))
            .find(|scene| !scene.animations.is_empty())
            .expect("one of the built-in scenes moves");
        let duration = scene.animations[0].duration;
        let mut playback = Playback::default();
        assert!(!playback.advance(&scene, 0.5) && playback.seconds.is_none());
        playback.toggle();
        playback.speed = 2.0;
        assert!(playback.advance(&scene, 0.25 * duration));
        assert_eq!(playback.seconds, Some(0.5 * duration));
        assert!(playback.advance(&scene, 0.4 * duration));
        assert!(playback.seconds.is_some_and(|now| (now - 0.3 * duration).abs() < 1e-9 * duration));
        playback.toggle();
        assert!(!playback.advance(&scene, 1.0));
        let still = Animated::default();
        assert!(!Playback { playing: true, ..Playback::default() }.advance(&still, 1.0));
    }
}
