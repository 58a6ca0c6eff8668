//! The ways to draw shadows that can be verified: every technique, and `auto` with all that the device can do.

use clap::builder::PossibleValuesParser;
use zfail_render::{Settings, Silhouettes, Technique, Tiles};

/// Every variant.
const ALL: &str = "all";
/// [`Technique::Auto`] that leaves nothing to the cost model.
const ON_DEVICE: &str = "auto-on-device";

/// A way to draw shadows.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    /// On the command line and in reports.
    pub name: &'static str,
    settings: Settings,
}

impl Variant {
    fn of(technique: Technique) -> Self {
        Self { name: technique.name(), settings: Settings { technique, ..Settings::default() } }
    }

    fn on_device() -> Self {
        let settings = Settings { tiles: Tiles::Always, silhouettes: Silhouettes::Gpu, ..Settings::default() };
        Self { name: ON_DEVICE, settings }
    }

    /// The whole volume of every caster by z-fail: no compute shader, no cull, nothing but what every device can do.
    pub fn plainest() -> Self {
        Self::of(Technique::EverittKilgard)
    }

    /// The settings with these lights alone.
    pub fn settings(&self, lights: &[usize]) -> Settings {
        Settings { lights: Some(lights.to_vec()), ..self.settings.clone() }
    }
}

/// Accepts what [`chosen`] knows.
pub fn parser() -> PossibleValuesParser {
    PossibleValuesParser::new(every().map(|variant| variant.name).chain([ALL]))
}

/// The variants of these names, each once, in the order of history.
pub fn chosen(names: &[String]) -> Vec<Variant> {
    every().filter(|variant| names.iter().any(|name| name == variant.name || name == ALL)).collect()
}

fn every() -> impl Iterator<Item = Variant> {
    let published = [Technique::EverittKilgard, Technique::Lengyel, Technique::Mcguire, Technique::Auto];
    published.map(Variant::of).into_iter().chain([Variant::on_device()])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_are_all_techniques() {
        let names = |wanted: &[&str]| -> Vec<_> {
            let wanted: Vec<String> = wanted.iter().map(|name| (*name).to_owned()).collect();
            chosen(&wanted).into_iter().map(|variant| variant.name).collect()
        };
        let all = names(&["all"]);
        assert!(Technique::ALL.into_iter().all(|technique| all.contains(&technique.name())), "{all:?}");
        assert_eq!(all.len(), Technique::ALL.len() + 1);
        assert_eq!(names(&["auto", "lengyel", "auto"]), ["lengyel", "auto"]);
    }
}
