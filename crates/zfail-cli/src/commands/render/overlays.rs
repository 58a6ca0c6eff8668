//! `zfail render --overlay`: figures over the picture, or instead of it.
//!
//! In: kinds from the command line, a rendered picture. Out: the picture with the figures on it.

use super::files::PictureFile;
use crate::error::Error;
use crate::input;
use crate::output::Format;
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use zfail_figures::{Figures, Options, Overlay, ThirdPerson};
use zfail_plan::view::View;
use zfail_render::{Gpu, Picture, Renderer, Technique};
use zfail_scene::{Pose, Scene};

/// What `zfail render` draws beside the picture.
#[derive(Args, Clone, Debug)]
pub struct OverlayArgs {
    /// Draw what shadow volumes do over the picture, or instead of it (pyramid, alternate, clip-space); repeat it or
    /// separate kinds by commas for several.
    #[arg(help_heading = "Figures", long = "overlay", value_name = "KIND", value_delimiter = ',', value_parser = kind_parser())]
    pub kinds: Vec<Overlay>,
    /// From where figures that replace the picture are seen: degrees to the left of the eye's direction, degrees above
    /// the horizontal, and how much larger than to fit (1 unless given).
    #[arg(help_heading = "Figures", long, value_name = "YAW,PITCH[,ZOOM]", requires = "kinds", value_parser = parse_from)]
    #[arg(allow_hyphen_values = true)]
    pub overlay_from: Option<ThirdPerson>,
    /// Show what this light's volumes do, whichever others shine; repeat it for several.
    #[arg(help_heading = "Figures", long = "overlay-light", value_name = "N", requires = "kinds")]
    pub overlay_lights: Vec<usize>,
}

impl OverlayArgs {
    /// Whether the picture can have the overlays.
    ///
    /// # Errors
    /// If there are any and the picture is not what they are drawn on.
    pub fn check(&self, output: &PictureFile) -> Result<(), Error> {
        if self.kinds.is_empty() || output.format == Format::Png {
            return Ok(());
        }
        let path = output.path.display();
        Err(Error::usage(format!("overlays are drawn on tone-mapped pictures, and '{path}' is none; use .png")))
    }
}

/// Draws the overlays of a run.
pub struct Overlays<'g> {
    gpu: &'g Gpu,
    figures: Figures<'g>,
    kinds: Vec<Overlay>,
    options: Options,
}

impl<'g> Overlays<'g> {
    /// `None` if none are asked for.
    ///
    /// # Errors
    /// If the scene or the device does not allow it.
    pub fn new(
        gpu: &'g Gpu,
        scene: &Scene,
        args: &OverlayArgs,
        lights: &[usize],
        technique: Technique,
    ) -> Result<Option<Self>, Error> {
        if args.kinds.is_empty() {
            return Ok(None);
        }
        let figures = Figures::new(gpu, scene)?;
        let lights = match &args.overlay_lights[..] {
            [] => lights.to_vec(),
            wanted => input::lights(scene, wanted)?,
        };
        let options = Options { lights: Some(lights), technique, from: args.overlay_from };
        Ok(Some(Self { gpu, figures, kinds: args.kinds.clone(), options }))
    }

    /// Follows the scene.
    ///
    /// # Errors
    /// If the pose does not fit it.
    pub fn set_pose(&mut self, pose: &Pose) -> Result<(), Error> {
        Ok(self.figures.set_pose(pose)?)
    }

    /// Draws onto `picture`, which `renderer` has just rendered.
    ///
    /// # Errors
    /// If a volume cannot be planned or the device fails.
    pub fn draw(&mut self, renderer: &Renderer<'_>, view: &View, picture: &mut Picture) -> Result<(), Error> {
        let shown = renderer.shown().ok_or_else(|| Error::failed("there is no picture to draw on"))?;
        self.figures.draw(&self.kinds, view, &self.options, shown)?;
        picture.rgba8 = self.gpu.read_texture(shown)?;
        Ok(())
    }
}

fn kind_parser() -> impl TypedValueParser<Value = Overlay> {
    let kind = |overlay: Overlay| PossibleValue::new(overlay.name()).help(overlay.description());
    PossibleValuesParser::new(Overlay::ALL.map(kind)).try_map(|name| name.parse::<Overlay>())
}

fn parse_from(text: &str) -> Result<ThirdPerson, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(str::parse).collect();
    let angles = |yaw: f64, pitch: f64, zoom: f64| {
        let fits = yaw.abs() <= 360.0 && pitch.abs() <= 88.0 && (0.01..=100.0).contains(&zoom);
        fits.then(|| ThirdPerson { yaw: yaw.to_radians(), pitch: pitch.to_radians(), zoom })
    };
    let from = match numbers.as_deref() {
        Ok(&[yaw, pitch]) => angles(yaw, pitch, 1.0),
        Ok(&[yaw, pitch, zoom]) => angles(yaw, pitch, zoom),
        _ => return Err("write it as YAW,PITCH or YAW,PITCH,ZOOM, such as 55,25".to_owned()),
    };
    from.ok_or_else(|| "YAW must be from -360 to 360, PITCH from -88 to 88, ZOOM from 0.01 to 100".to_owned())
}

#[cfg(test)]
mod tests {
    use super::parse_from;
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

    #[test]
    fn places_to_look_from() {
        let from = parse_from("-90,45,2").unwrap();
        assert!((from.yaw + FRAC_PI_2).abs() < 1e-9 && (from.pitch - FRAC_PI_4).abs() < 1e-9 && from.zoom == 2.0);
        assert_eq!(parse_from("10,20").unwrap().zoom, 1.0);
        for wrong in ["", "1", "1,2,3,4", "a,b", "nan,0", "0,89", "0,0,0", "361,0"] {
            assert!(parse_from(wrong).is_err(), "{wrong}");
        }
    }
}
