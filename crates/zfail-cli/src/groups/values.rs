//! Values of options that several commands have.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use zfail_render::{Exposure, Technique, Terminator};

/// Width and height in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size(pub [u32; 2]);

impl Size {
    /// No GPU of today makes larger images; the renderer knows what the one at hand can do.
    const MAX_SIDE: u32 = 16_384;

    /// Reads WIDTHxHEIGHT.
    ///
    /// # Errors
    /// If it is none, or too large for any device.
    pub fn parse(text: &str) -> Result<Self, String> {
        let parsed = text.split_once(['x', 'X']).and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
        let Some([width, height]) = parsed else {
            return Err("write it as WIDTHxHEIGHT, such as 1280x720".to_owned());
        };
        let side = 1..=Self::MAX_SIDE;
        if !side.contains(&width) || !side.contains(&height) {
            return Err(format!("each side must be from 1 to {} pixels", Self::MAX_SIDE));
        }
        Ok(Self([width, height]))
    }
}

/// Samples per pixel: 1 or 4.
pub fn parse_samples(text: &str) -> Result<u32, String> {
    match text {
        "1" => Ok(1),
        "4" => Ok(4),
        _ => Err("it must be 1 or 4".to_owned()),
    }
}

/// How light ends on smooth surfaces.
pub fn parse_terminator(text: &str) -> Result<Terminator, String> {
    match text {
        "soft" => Ok(Terminator::Soft),
        "exact" => Ok(Terminator::Exact),
        _ => Err("it must be soft or exact".to_owned()),
    }
}

/// Stops, or `auto`.
pub fn parse_exposure(text: &str) -> Result<Exposure, String> {
    if text == "auto" {
        return Ok(Exposure::Auto);
    }
    match text.parse::<f32>() {
        Ok(stops) if (-64.0..=64.0).contains(&stops) => Ok(Exposure::Ev(stops)),
        _ => Err("it must be 'auto' or a number of stops from -64 to 64".to_owned()),
    }
}

/// Frames per second.
pub fn parse_fps(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(fps) if fps > 0.0 && fps.is_finite() => Ok(fps),
        _ => Err("it must be a number of frames per second, more than 0".to_owned()),
    }
}

/// The number of a light.
pub fn parse_light(text: &str) -> Result<usize, String> {
    text.parse().map_err(|_| "it must be the number of a light, counted from 0".to_owned())
}

/// Accepts the names of techniques.
pub fn technique_parser() -> impl TypedValueParser<Value = Technique> {
    PossibleValuesParser::new(Technique::ALL.map(Technique::name)).try_map(|name| name.parse::<Technique>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!(Size::parse("640x480"), Ok(Size([640, 480])));
        assert_eq!(Size::parse("1X16384"), Ok(Size([1, 16_384])));
        for wrong in ["", "640", "640x", "x480", "0x480", "640x0", "16385x1", "1x100000", "-1x5", "1x2x3"] {
            assert!(Size::parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn exposures() {
        assert_eq!(parse_exposure("auto"), Ok(Exposure::Auto));
        assert_eq!(parse_exposure("-1.5"), Ok(Exposure::Ev(-1.5)));
        for wrong in ["", "x", "nan", "inf", "65"] {
            assert!(parse_exposure(wrong).is_err(), "{wrong}");
        }
    }
}
