//! A scene by the name of a file or a built-in one, as it is or as it can be rendered.

use super::choice::animation;
use crate::error::{Error, chain};
use crate::groups::{AlphaShadows, Loading, Moment};
use crate::names;
use std::path::Path;
use zfail_files::{Fault, FileInfo};
use zfail_scene::{Animated, GroundChoice, MaskCasting, Setting, cut};

const BUILTIN: &str = "builtin:";

/// Loads a file as it is, with its animations and what it says about itself, or generates a built-in scene; masked
/// surfaces get the shadows that `loading` asks for.
///
/// # Errors
/// If the file cannot be used, or there is no such built-in scene.
pub fn read(scene: &str, loading: &Loading) -> Result<(Animated, Option<FileInfo>), Error> {
    let (mut animated, file) = open(scene, loading)?;
    animated.scene.blended_casts = loading.blended_shadows;
    shape_shadows(&mut animated, loading.alpha_shadows);
    Ok((animated, file))
}

/// Prepares masked surfaces for the shadows that they are to cast.
fn shape_shadows(animated: &mut Animated, masks: AlphaShadows) {
    match masks {
        AlphaShadows::Off => animated.scene.mask_casting = MaskCasting::Off,
        AlphaShadows::Solid => animated.scene.mask_casting = MaskCasting::Solid,
        AlphaShadows::Cut(texels) => {
            animated.cut_masked(texels, cut::Limits::default());
        }
    }
}

fn open(scene: &str, loading: &Loading) -> Result<(Animated, Option<FileInfo>), Error> {
    if let Some(name) = scene.strip_prefix(BUILTIN) {
        let scene =
            zfail_builtin::animated(name).ok_or_else(|| names::unknown("built-in scene", name, &builtin_names()))?;
        return Ok((scene, None));
    }
    let path = Path::new(scene);
    match zfail_files::load_variant(path, &loading.limits(), loading.variant.as_deref()) {
        Ok((scene, info)) => Ok((scene, Some(info))),
        Err(e) if !path.exists() && builtin_names().contains(&scene) => {
            Err(Error::failed(format!("{}; the built-in scene of that name is '{BUILTIN}{scene}'", chain(&e))))
        }
        Err(e) => {
            let remedy = match e.fault {
                Fault::TooLarge { .. } => " with --limit memory=SIZE or --limit image-side=PIXELS",
                _ => "",
            };
            Err(Error::failed(chain(&e) + remedy))
        }
    }
}

/// A scene that can be rendered in a picture of `size` pixels: a file lacks no camera, light or ambient light any more. What
/// `setting` leaves open suits the moments that are asked for.
///
/// # Errors
/// As [`read`], or if there is no animation as named.
pub fn complete(
    scene: &str,
    loading: &Loading,
    moment: Option<&Moment>,
    size: [u32; 2],
    setting: &Setting,
) -> Result<Animated, Error> {
    let (mut animated, file) = read(scene, loading)?;
    // Built-in scenes are whole.
    if file.is_some() || setting.sun.is_some() || matches!(setting.ground, GroundChoice::Height(_)) {
        let animation = moment.map(|moment| animation(&animated, moment)).transpose()?;
        let aspect = f64::from(size[0]) / f64::from(size[1]);
        Setting { aspect, animation, ..setting.clone() }.complete(&mut animated);
    }
    Ok(animated)
}

/// Names of the built-in scenes.
fn builtin_names() -> Vec<&'static str> {
    zfail_builtin::SCENES.iter().map(|entry| entry.name).collect()
}
