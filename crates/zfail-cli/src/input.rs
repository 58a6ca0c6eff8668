//! The scene that a command works on, and the camera, lights and GPU that it asks for.

use crate::args::{AlphaShadows, Device, Loading, Moment, Subject};
use crate::console;
use crate::error::Error;
use crate::names;
use std::path::Path;
use zfail_files::{Fault, FileInfo};
use zfail_plan::view::View;
use zfail_render::{Gpu, GpuOptions};
use zfail_scene::{Animated, Camera, GroundChoice, MaskCasting, SavedView, SavedViewError, Scene, Setting, cut};

const BUILTIN: &str = "builtin:";

/// Loads a file as it is, with its animations and what it says about itself, or generates a built-in scene; masked
/// surfaces get the shadows that `masks` asks for.
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

/// The scene at the moment that `--time` and `--animation` ask for: of the first animation unless one is named, at
/// its start unless a time is given, and at rest if neither is.
///
/// # Errors
/// If there is no such animation.
pub fn at_moment(animated: Animated, moment: &Moment) -> Result<Scene, Error> {
    if moment.shown().is_none() {
        return Ok(animated.scene);
    }
    let animation = animation(&animated, moment)?;
    let pose = animated.pose(animation, moment.time.unwrap_or(0.0));
    let mut scene = animated.scene;
    if animated.animations.is_empty() {
        scene.notices.push("the scene has no animation; --time changes nothing".into());
    }
    scene.set_pose(&pose);
    Ok(scene)
}

/// What is seen in one picture.
pub struct Shot {
    /// At its moment.
    pub scene: Scene,
    /// Name of the camera.
    pub camera: String,
    /// The camera.
    pub view: View,
    /// Which lights shine, ascending.
    pub lights: Vec<usize>,
}

/// Loads the scene of a picture that is to be judged, and says its notices.
///
/// # Errors
/// If the scene cannot be loaded, or has no such animation, camera or light.
pub fn shot(subject: &Subject, quiet: bool) -> Result<Shot, Error> {
    let (source, size) = (&subject.scene, subject.size.0);
    let animated = complete(&source.scene, &source.loading, subject.moment.shown(), size, &subject.sunlight.bare())?;
    let scene = at_moment(animated, &subject.moment)?;
    console::notices(&scene.notices, quiet);
    let camera = camera(&scene, &subject.camera)?;
    let view = scene.cameras[camera].view(size, &scene.bounds());
    let lights = lights(&scene, &subject.lights)?;
    let camera = scene.cameras[camera].name.clone();
    Ok(Shot { scene, camera, view, lights })
}

/// Index of the animation that `--animation` numbers or names, or 0, which may not exist.
///
/// # Errors
/// If there is no animation as named.
pub fn animation(animated: &Animated, moment: &Moment) -> Result<usize, Error> {
    let Some(wanted) = &moment.animation else { return Ok(0) };
    let names: Vec<&str> = animated.animations.iter().map(|animation| animation.name.as_str()).collect();
    names::index_of("animation", wanted, &names)
}

/// Names of the built-in scenes.
pub fn builtin_names() -> Vec<&'static str> {
    zfail_builtin::SCENES.iter().map(|entry| entry.name).collect()
}

/// Index of the camera that `wanted` numbers or names.
///
/// # Errors
/// If there is none.
pub fn camera(scene: &Scene, wanted: &str) -> Result<usize, Error> {
    let names: Vec<&str> = scene.cameras.iter().map(|camera| camera.name.as_str()).collect();
    names::index_of("camera", wanted, &names)
}

/// The camera that is asked for: of the scene, or of a saved view, whose lights and casters `scene` has afterwards.
///
/// # Errors
/// If there is none, or the view is not one of this scene.
pub fn eye(scene: &mut Scene, wanted: &str, view: Option<&Path>) -> Result<Camera, Error> {
    let Some(path) = view else { return Ok(scene.cameras[camera(scene, wanted)?].clone()) };
    let failed = |e: SavedViewError| Error::failed(format!("{}: {}", path.display(), chain(&e)));
    SavedView::read(path).and_then(|view| view.apply(scene)).map_err(failed)
}

/// The lights that shine, in ascending order: all of them, or those in `wanted`.
///
/// # Errors
/// If one of them does not exist.
pub fn lights(scene: &Scene, wanted: &[usize]) -> Result<Vec<usize>, Error> {
    if wanted.is_empty() {
        return Ok((0..scene.lights.len()).collect());
    }
    if let Some(light) = wanted.iter().find(|light| **light >= scene.lights.len()) {
        let names: Vec<&str> = scene.lights.iter().map(|light| light.name.as_str()).collect();
        return Err(names::unknown_index("light", &light.to_string(), &names));
    }
    let mut lights = wanted.to_vec();
    lights.sort_unstable();
    lights.dedup();
    Ok(lights)
}

/// What is to be said before shadows that take long: what makes them so, and what takes less.
pub fn effort(scene: &Scene, lights: &[usize]) -> Option<String> {
    /// Triangles of casters under all lights, from which on a picture takes seconds and much memory.
    const MANY: usize = 10_000_000;
    /// What each of them takes in index lists, here and on the device.
    const BYTES: f64 = 70.0;
    let casters = scene.instances.iter().filter(|instance| instance.casts_shadow);
    let triangles: usize = casters.map(|instance| scene.meshes[instance.mesh].triangles.len()).sum();
    let all = triangles.saturating_mul(lights.len());
    (all > MANY).then(|| {
        format!(
            "the shadows of {triangles} triangles in {} instances under {} lights take about {:.1} GB of memory and a \
             while; fewer lights (--light N) or --no-shadows take less",
            scene.instances.len(),
            lights.len(),
            all as f64 * BYTES / 1e9
        )
    })
}

/// Opens the GPU that `device` asks for.
///
/// # Errors
/// If there is none.
pub fn gpu(device: &Device) -> Result<Gpu, Error> {
    Gpu::new(&gpu_options(device)).map_err(|e| Error::failed(chain(&e)))
}

/// Which adapters `device` allows.
pub fn gpu_options(device: &Device) -> GpuOptions {
    let mut options = GpuOptions { adapter: device.adapter.clone(), ..GpuOptions::default() };
    if let Some(backend) = device.backend {
        options.backends = backend.backends();
    }
    options
}

/// An error with its causes, each said once.
pub fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        let reason = error.to_string();
        if !text.contains(&reason) {
            text = format!("{text}: {reason}");
        }
        cause = error.source();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{effort, lights};
    use zfail_plan::light::LightKind;
    use zfail_scene::{Light, LightShape, Scene};

    #[test]
    fn lights_are_chosen_by_the_numbers_of_the_file() {
        let light = Light {
            name: "sun".to_owned(),
            kind: LightKind::Directional { direction: zfail_plan::glam::DVec3::NEG_Y },
            color: [1.0; 3],
            intensity: 1.0,
            excluded: Vec::new(),
            shape: LightShape::default(),
        };
        let scene = Scene { lights: vec![light; 3], ..Scene::default() };
        assert_eq!(lights(&scene, &[]), Ok(vec![0, 1, 2]));
        assert_eq!(lights(&scene, &[2, 0, 2]), Ok(vec![0, 2]));
        assert!(lights(&scene, &[0, 3]).unwrap_err().to_string().starts_with("unknown light '3'; there are: 0 'sun'"));
    }

    #[test]
    fn many_copies_under_many_lights_are_said_to_take_long() {
        let mut scene = zfail_builtin::scene("jail").unwrap();
        assert_eq!(effort(&scene, &[0, 1]), None);
        let copy = scene.instances[0].clone();
        let triangles = scene.meshes[copy.mesh].triangles.len();
        scene.instances = vec![copy; 11_000_000 / triangles];
        let said = effort(&scene, &[0]).unwrap();
        assert!(said.contains("instances") && said.contains("--light N"), "{said}");
        scene.instances.iter_mut().for_each(|instance| instance.casts_shadow = false);
        assert_eq!(effort(&scene, &[0]), None);
    }
}
