//! Which moment of an animation is shown.

use clap::Args;

/// The moment of an animation.
#[derive(Args, Clone, Debug)]
pub struct Moment {
    /// Show the scene this many seconds after the start of its animation.
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds, allow_negative_numbers = true)]
    pub time: Option<f64>,
    /// Animation by index or name; the first one if only --time is given.
    #[arg(long, value_name = "NAME|N")]
    pub animation: Option<String>,
}

impl Moment {
    /// This, if a moment of an animation is asked for and not the scene at rest.
    pub fn shown(&self) -> Option<&Self> {
        Some(self).filter(|moment| moment.animation.is_some() || moment.time.is_some())
    }
}

fn parse_seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds >= 0.0 && seconds.is_finite() => Ok(seconds),
        _ => Err("it must be a number of seconds, 0 or more".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::parse_seconds;

    #[test]
    fn times() {
        assert_eq!(parse_seconds("0"), Ok(0.0));
        assert_eq!(parse_seconds("1.25"), Ok(1.25));
        for wrong in ["", "-1", "nan", "inf", "1s"] {
            assert!(parse_seconds(wrong).is_err(), "{wrong}");
        }
    }
}
