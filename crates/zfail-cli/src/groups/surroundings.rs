//! What scenes without cameras or lights are given, and what they stand in.

use clap::{ArgAction, Args};
use zfail_scene::{GroundChoice, Setting, Sun};

const HEADING: &str = "Surroundings";

/// The light of scenes that have none.
#[derive(Args, Clone, Debug)]
pub struct Sunlight {
    /// Where the sun of a scene without lights stands: degrees clockwise from north, which is -z, seen from above, and degrees
    /// above the horizon. Unless given, where its shadows are seen best.
    #[arg(help_heading = HEADING, long, value_name = "AZIMUTH,ELEVATION", value_parser = parse_sun, allow_hyphen_values = true)]
    pub sun: Option<Sun>,
}

/// What is around a scene. None of it casts a shadow.
#[derive(Args, Clone, Debug)]
pub struct Surroundings {
    /// Light from all sides: 'auto' is a sky over scenes without lights, 'none' is never a sky.
    #[arg(help_heading = HEADING, long, value_name = "auto|none", default_value = "auto", value_parser = parse_sky)]
    #[arg(action = ArgAction::Set)]
    pub sky: bool,
    /// A ground on which shadows fall: 'auto' is one below the lowest point of a scene without lights, unless there is a floor;
    /// it fades out, and no AOV holds it. 'none' is never one. HEIGHT is a y in metres; AOVs hold that ground as any surface.
    #[arg(help_heading = HEADING, long, value_name = "auto|none|HEIGHT", default_value = "auto", value_parser = parse_ground)]
    #[arg(allow_hyphen_values = true)]
    pub ground: GroundChoice,
}

impl Surroundings {
    /// The flags without which a saved view does not fit the scene: it holds what catches shadows, but no surfaces.
    #[cfg(feature = "view")]
    pub fn flags(&self) -> Vec<String> {
        match self.ground {
            GroundChoice::Height(height) => vec![format!("--ground={height}")],
            GroundChoice::Auto | GroundChoice::None => Vec::new(),
        }
    }
}

impl Sunlight {
    /// What is added to a scene that is judged: what is around it is left out.
    pub fn bare(&self) -> Setting {
        Setting { sun: self.sun, surroundings: false, ..Setting::default() }
    }

    /// What is added to a scene that is shown.
    pub fn with(&self, surroundings: &Surroundings) -> Setting {
        Setting { sun: self.sun, sky: surroundings.sky, ground: surroundings.ground, ..Setting::default() }
    }
}

fn parse_sun(text: &str) -> Result<Sun, String> {
    let angles = text.split_once(',').and_then(|(a, e)| Some((a.trim().parse().ok()?, e.trim().parse().ok()?)));
    let Some((azimuth, elevation)) = angles else {
        return Err("write it as AZIMUTH,ELEVATION in degrees, such as 225,40 for a sun in the south-west".to_owned());
    };
    if !(-360.0..=360.0).contains(&azimuth) {
        return Err("the azimuth must be from -360 to 360 degrees".to_owned());
    }
    if !(elevation > 0.0 && elevation <= 90.0) {
        return Err("the elevation must be more than 0 degrees, the horizon, and at most 90, straight above".to_owned());
    }
    Ok(Sun { azimuth, elevation })
}

fn parse_sky(text: &str) -> Result<bool, String> {
    match text {
        "auto" => Ok(true),
        "none" => Ok(false),
        _ => Err("it must be auto or none".to_owned()),
    }
}

fn parse_ground(text: &str) -> Result<GroundChoice, String> {
    /// As far as coordinates of scenes may be.
    const HIGHEST: f64 = 1e15;
    match (text, text.parse::<f64>()) {
        ("auto", _) => Ok(GroundChoice::Auto),
        ("none", _) => Ok(GroundChoice::None),
        (_, Ok(height)) if height.abs() <= HIGHEST => Ok(GroundChoice::Height(height)),
        _ => Err("it must be auto, none or a height in metres, such as -0.5".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suns() {
        assert_eq!(parse_sun("225,40"), Ok(Sun { azimuth: 225.0, elevation: 40.0 }));
        assert_eq!(parse_sun("-90, 90"), Ok(Sun { azimuth: -90.0, elevation: 90.0 }));
        for wrong in
            ["", "225", "225,", ",40", "a,b", "0,0", "0,-10", "0,91", "400,40", "nan,40", "0,nan", "0,inf", "1,2,3"]
        {
            assert!(parse_sun(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn grounds_and_skies() {
        assert_eq!(parse_ground("auto"), Ok(GroundChoice::Auto));
        assert_eq!(parse_ground("none"), Ok(GroundChoice::None));
        assert_eq!(parse_ground("-1.5"), Ok(GroundChoice::Height(-1.5)));
        for wrong in ["", "Auto", "nan", "inf", "1m", "1e16"] {
            assert!(parse_ground(wrong).is_err(), "{wrong}");
        }
        assert_eq!((parse_sky("auto"), parse_sky("none")), (Ok(true), Ok(false)));
        assert!(parse_sky("blue").is_err());
    }
}
