//! `zfail render --tiles --silhouettes`: steps of a technique that are chosen, not measured.
//!
//! In: the command line. Out: settings. Which way is quicker is a matter of times, which are another on every run; so files,
//! which are the same on every run, take these steps where somebody says so, and only there.

use crate::error::Error;
use clap::{Args, ValueEnum};
use zfail_render::{Settings, Silhouettes, Technique, Tiles};

/// Who does the work of a technique.
#[derive(Args, Clone, Copy, Debug)]
pub struct StepArgs {
    /// Count the sides of volumes by tiles in a compute shader: never, or always, wherever z-pass counts them. Needs
    /// technique auto and one sample per pixel.
    #[arg(long, value_name = "never|always", default_value = "never", hide_possible_values = true)]
    tiles: TilesArg,
    /// Find silhouettes on the cpu, or in compute shaders on the device for all casters for which that can be done. Needs
    /// technique auto.
    #[arg(long, value_name = "cpu|device", default_value = "cpu", hide_possible_values = true)]
    silhouettes: SilhouettesArg,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum TilesArg {
    Never,
    Always,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum SilhouettesArg {
    Cpu,
    Device,
}

impl StepArgs {
    /// Whether `technique` takes the steps, with `samples` per pixel.
    ///
    /// # Errors
    /// If a step is asked for that would not be taken.
    pub fn check(self, technique: Technique, samples: u32) -> Result<(), Error> {
        let steps = technique.steps();
        let tiles = self.tiles == TilesArg::Always;
        if tiles && steps.tiles == Tiles::Never {
            return Err(Error::usage(format!("--tiles always needs --technique auto; '{technique}' rasterises")));
        }
        if tiles && samples > 1 {
            return Err(Error::usage(format!("--tiles always needs --samples 1, not {samples}")));
        }
        if self.silhouettes == SilhouettesArg::Device && steps.silhouettes == Silhouettes::Cpu {
            let message = format!("--silhouettes device needs --technique auto; '{technique}' finds them on the CPU");
            return Err(Error::usage(message));
        }
        Ok(())
    }

    /// `settings` with these steps.
    pub fn apply(self, settings: Settings) -> Settings {
        Settings {
            tiles: match self.tiles {
                TilesArg::Never => Tiles::Never,
                TilesArg::Always => Tiles::Always,
            },
            silhouettes: match self.silhouettes {
                SilhouettesArg::Cpu => Silhouettes::Cpu,
                SilhouettesArg::Device => Silhouettes::Gpu,
            },
            ..settings
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_that_would_not_be_taken_is_refused() {
        let args = |tiles, silhouettes| StepArgs { tiles, silhouettes };
        let [neither, tiles, device] = [
            args(TilesArg::Never, SilhouettesArg::Cpu),
            args(TilesArg::Always, SilhouettesArg::Cpu),
            args(TilesArg::Never, SilhouettesArg::Device),
        ];
        for technique in Technique::ALL {
            let auto = technique == Technique::Auto;
            assert!(neither.check(technique, 4).is_ok());
            assert_eq!(tiles.check(technique, 1).is_ok(), auto, "{technique}");
            assert_eq!(device.check(technique, 4).is_ok(), auto, "{technique}");
        }
        assert!(tiles.check(Technique::Auto, 4).is_err());
        let settings = args(TilesArg::Always, SilhouettesArg::Device).apply(Settings::default().repeatable());
        assert_eq!((settings.tiles, settings.silhouettes), (Tiles::Always, Silhouettes::Gpu));
        assert_eq!(neither.apply(Settings::default()), Settings::default().repeatable());
    }
}
