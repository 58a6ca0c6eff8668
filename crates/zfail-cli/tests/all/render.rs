//! `zfail render` and `zfail gallery` on the machine's adapter: which files appear, and what is in them.

use crate::support::{files, has_gpu, small_scene, zfail};
use image::{DynamicImage, ImageReader};
use serde_json::Value;
use std::fs;
use std::path::Path;

const SIZE: [&str; 2] = ["--size", "64x48"];

fn open(path: &Path) -> DynamicImage {
    ImageReader::open(path).unwrap().with_guessed_format().unwrap().decode().unwrap()
}

#[test]
fn a_picture_has_the_size_that_was_asked_for() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    // Options come before the scene or after it.
    let run = zfail(folder.path(), &["render", "--size", "64x48", "-o", "before.png", "small.gltf"]).ok();
    assert_eq!((run.stdout.as_str(), run.stderr.as_str()), ("", ""));
    zfail(folder.path(), &["render", "small.gltf", "-o", "after.png", "--size", "64x48"]).ok();
    assert_eq!(fs::read(folder.path().join("before.png")).unwrap(), fs::read(folder.path().join("after.png")).unwrap());
    let picture = open(&folder.path().join("after.png")).to_rgb8();
    assert_eq!(picture.dimensions(), (64, 48));
    assert!(picture.pixels().any(|p| p != picture.get_pixel(0, 0)), "the picture shows something");

    zfail(folder.path(), &[&["render", "small.gltf", "-o", "hdr.exr", "--exposure", "-1"][..], &SIZE].concat()).ok();
    assert_eq!(open(&folder.path().join("hdr.exr")).as_rgb32f().unwrap().dimensions(), (64, 48));
}

#[test]
fn shadows_darken_and_no_shadows_does_not() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    let radiance = |file: &str, more: &[&str]| {
        let args = [&["render", "small.gltf", "-o", file, "--exposure", "0"][..], &SIZE, more].concat();
        zfail(folder.path(), &args).ok();
        open(&folder.path().join(file)).into_rgb32f().into_raw()
    };
    let shadowed = radiance("a.exr", &[]);
    let lit = radiance("b.exr", &["--no-shadows"]);
    let darker = shadowed.iter().zip(&lit).filter(|(a, b)| **a < 0.9 * **b).count();
    let brighter = shadowed.iter().zip(&lit).filter(|(a, b)| **a > 1.01 * **b).count();
    assert!(darker > 100, "{darker}");
    assert_eq!(brighter, 0);
    assert_ne!(radiance("c.exr", &["--light", "1"]), shadowed);
    assert_eq!(radiance("d.exr", &["--light", "2", "--light", "0", "--light", "1"]), shadowed);
    assert_ne!(radiance("e.exr", &["--camera", "aside"]), shadowed);
    assert_eq!(radiance("f.exr", &["--camera", "above", "--technique", "everitt-kilgard"]), shadowed);
}

#[test]
fn time_moves_what_is_animated() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    let radiance = |file: &str, more: &[&str]| {
        let args = [&["render", "small.gltf", "-o", file, "--exposure", "0"][..], &SIZE, more].concat();
        let run = zfail(folder.path(), &args).ok();
        assert_eq!(run.stderr, "");
        open(&folder.path().join(file)).into_rgb32f().into_raw()
    };
    let rest = radiance("rest.exr", &[]);
    assert_eq!(radiance("a.exr", &["--time", "0"]), rest, "the animation begins at rest");
    let glided = radiance("b.exr", &["--time", "2"]);
    assert_ne!(glided, rest);
    assert_eq!(radiance("c.exr", &["--time", "9", "--animation", "0"]), glided, "the last key holds");
    let dusk = radiance("d.exr", &["--time", "2", "--animation", "sunset"]);
    assert!(dusk != rest && dusk != glided);
    assert_eq!(radiance("e.exr", &["--time", "1.9", "--animation", "sunset"]), rest, "a step");
    assert_eq!(radiance("f.exr", &["--animation", "sunset"]), rest, "from its start");

    let still = ["render", "builtin:open", "-o", "open.png", "--size", "16x9"];
    assert_eq!(zfail(folder.path(), &still).ok().stderr, "");
    let run = zfail(folder.path(), &[&still[..], &["--time", "1"]].concat()).ok();
    assert_eq!(run.stderr, "zfail: note: the scene has no animation; --time changes nothing\n");
}

#[test]
fn masks_are_named_after_the_lights_of_the_file() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    let common = [&["render", "small.gltf", "-o", "a.png", "--quiet"][..], &SIZE].concat();
    zfail(folder.path(), &[&common[..], &["--aov", "shadow=all/masks", "--aov", "stencil=counts"]].concat()).ok();
    let all = folder.path().join("all/masks");
    assert_eq!(files(&all), ["light-0.png", "light-1.png", "light-2.png"]);
    assert_eq!(files(&folder.path().join("counts")), ["light-0.png", "light-1.png", "light-2.png"]);

    let mask = open(&all.join("light-0.png"));
    let mask = mask.as_luma8().expect("8-bit grey");
    assert_eq!(mask.dimensions(), (64, 48));
    let count = |value: u8| mask.pixels().filter(|p| p.0[0] == value).count();
    assert_eq!(count(0) + count(255), 64 * 48);
    assert!(count(0) > 20 && count(255) > 20, "{} in shadow, {} lit", count(0), count(255));
    // On the floor a count of zero and being lit are the same.
    let counts = open(&folder.path().join("counts/light-0.png")).into_luma8();
    assert!(mask.pixels().zip(counts.pixels()).all(|(m, c)| m.0[0] != 255 || c.0[0] == 0));
    assert!(counts.pixels().any(|c| c.0[0] == 1));

    zfail(folder.path(), &[&common[..], &["--light", "1", "--aov", "shadow=one"]].concat()).ok();
    let one = folder.path().join("one");
    assert_eq!(files(&one), ["light-1.png"]);
    assert_eq!(fs::read(one.join("light-1.png")).unwrap(), fs::read(all.join("light-1.png")).unwrap());
    assert_ne!(fs::read(one.join("light-1.png")).unwrap(), fs::read(all.join("light-0.png")).unwrap());
}

#[test]
fn measured_results_agree_with_the_scene() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    let aovs = ["depth=d.exr", "position=p.exr", "normal=n.exr", "albedo=a.exr", "normal=n.png", "albedo=a.png"];
    let mut args = [&["render", "small.gltf", "-o", "picture.png"][..], &SIZE].concat();
    aovs.iter().for_each(|aov| args.extend(["--aov", aov]));
    zfail(folder.path(), &args).ok();
    let pixel = |file: &str, x: u32, y: u32| open(&folder.path().join(file)).into_rgb32f().get_pixel(x, y).0;

    // The camera looks straight down from 6 m: the hovering square is 5 m away, the floor beside it 6 m.
    let near = |a: f32, b: f32| (a - b).abs() < 1e-3;
    assert!(near(pixel("d.exr", 32, 24)[0], 5.0), "{:?}", pixel("d.exr", 32, 24));
    assert!(near(pixel("d.exr", 4, 24)[0], 6.0), "{:?}", pixel("d.exr", 4, 24));
    assert!(near(pixel("p.exr", 32, 24)[1], 1.0) && near(pixel("p.exr", 4, 24)[1], 0.0));
    assert!(pixel("p.exr", 4, 24)[0] < -1.0, "left of the picture is -x");
    assert!(near(pixel("n.exr", 4, 24)[1], 1.0));
    assert!(near(pixel("a.exr", 4, 24)[0], 1.0));
    let png = |file: &str| open(&folder.path().join(file)).to_rgb8().get_pixel(4, 24).0;
    assert_eq!(png("a.png"), [255; 3]);
    assert!(png("n.png")[1] >= 254 && (127..=128).contains(&png("n.png")[0]), "{:?}", png("n.png"));
}

#[test]
fn stats_have_the_keys_of_the_contract() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    zfail(folder.path(), &[&["render", "small.gltf", "-o", "a.png", "--stats", "s.json"][..], &SIZE].concat()).ok();
    let stats: Value = serde_json::from_slice(&fs::read(folder.path().join("s.json")).unwrap()).unwrap();
    for key in ["adapter", "backend", "depth_format", "planning_ms", "lights"] {
        assert!(stats.get(key).is_some(), "{key}");
    }
    assert!(!stats["adapter"].as_str().unwrap().is_empty());
    let lights = stats["lights"].as_array().unwrap();
    let kinds: Vec<_> = lights.iter().map(|light| light["kind"].clone()).collect();
    assert_eq!(kinds, ["directional", "point", "spot"]);
    for light in lights {
        for key in ["casters", "culled", "cases", "extracted", "tiled", "triangles", "vertices", "fragments", "scissor"]
        {
            assert!(light.get(key).is_some(), "{key}");
        }
        for key in ["shadow_ms", "light_ms"] {
            assert!(light.get(key).is_some(), "{key}");
        }
        for key in ["sides", "dark_cap", "light_cap"] {
            assert!(light["triangles"][key].is_u64(), "{key}");
        }
        assert_eq!(light["casters"], 1);
        assert!(light["triangles"]["sides"].as_u64().unwrap() > 0);
        assert_eq!(light["cases"].as_array().unwrap().len(), 3);
        assert_eq!(light["scissor"].as_array().unwrap().len(), 4);
    }
}

#[test]
fn steps_that_times_decide_elsewhere_are_taken_where_one_says_so() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let render = |name: &str, more: &[&str]| {
        let [picture, stats] = ["png", "json"].map(|extension| format!("{name}.{extension}"));
        let args = ["render", "builtin:container", "--size", "160x90", "-o", &picture, "--stats", &stats];
        zfail(folder.path(), &[&args[..], more].concat()).ok();
        let stats: Value = serde_json::from_slice(&fs::read(folder.path().join(&stats)).unwrap()).unwrap();
        let sum = |key: &str| stats["lights"].as_array().unwrap().iter().map(|l| l[key].as_u64().unwrap()).sum::<u64>();
        (["tiled", "extracted", "vertices"].map(sum), open(&folder.path().join(picture)).into_rgb8())
    };
    let (plain, picture) = render("plain", &[]);
    assert_eq!(plain[..2], [0, 0], "neither unless asked for");
    assert!(plain[2] > 0);
    for (name, more) in [("tiles", ["--tiles", "always"]), ("device", ["--silhouettes", "device"])] {
        let (figures, other) = render(name, &more);
        assert_eq!([figures[0] > 0, figures[1] > 0], [name == "tiles", name == "device"], "{name}: {figures:?}");
        // The tile pass may differ in pixels whose centre lies on an edge.
        let differing = picture.pixels().zip(other.pixels()).filter(|(a, b)| a != b).count();
        assert!(differing <= 2, "{name}: {differing} pixels differ");
    }
    let refused = |more: &[&str], words: &[&str]| {
        zfail(folder.path(), &[&["render", "builtin:container", "-o", "x.png"], more].concat()).fails(2, words);
    };
    refused(&["--tiles", "always", "--technique", "mcguire"], &["--technique auto", "mcguire"]);
    refused(&["--tiles", "always", "--samples", "4"], &["--samples 1"]);
    refused(&["--silhouettes", "device", "--technique", "lengyel"], &["--technique auto", "lengyel"]);
}

#[test]
fn a_failed_run_leaves_what_was_there() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    let picture = folder.path().join("a.png");
    fs::write(&picture, "old").unwrap();
    // The folder in the place of a mask is noticed only when everything is rendered and about to be written.
    fs::create_dir_all(folder.path().join("masks/light-2.png")).unwrap();
    let args = [&["render", "small.gltf", "-o", "a.png", "--stats", "new.json", "--aov", "shadow=masks"][..], &SIZE];
    zfail(folder.path(), &args.concat()).fails(1, &["light-2.png", "it is a folder"]);
    assert_eq!(fs::read(&picture).unwrap(), b"old");
    assert_eq!(files(folder.path()), ["a.png", "masks", "small.bin", "small.gltf"]);
    assert_eq!(files(&folder.path().join("masks")), ["light-2.png"]);

    // The negative control: without the obstacle the same command replaces the picture.
    fs::remove_dir(folder.path().join("masks/light-2.png")).unwrap();
    zfail(folder.path(), &args.concat()).ok();
    assert_eq!(open(&picture).width(), 64);
    assert_eq!(files(folder.path()), ["a.png", "masks", "new.json", "small.bin", "small.gltf"]);
    assert_eq!(files(&folder.path().join("masks")), ["light-0.png", "light-1.png", "light-2.png"]);
}

#[test]
fn what_the_device_cannot_do_is_one_line() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    let run = zfail(folder.path(), &["render", "small.gltf", "-o", "a.png", "--adapter", "Voodoo 9"]);
    run.fails(1, &["Voodoo 9", "there are"]);
    let huge = ["render", "small.gltf", "-o", "a.png", "--size", "16384x16384", "--samples", "4"];
    zfail(folder.path(), &huge).fails(1, &["16384x16384", "too large"]);
    assert_eq!(files(folder.path()), ["small.bin", "small.gltf"]);
}

#[test]
fn the_gallery_holds_every_scene_as_file_and_picture() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let run = zfail(folder.path(), &["gallery", "new/gallery", "--size", "32x18", "--samples", "1"]).ok();
    assert_eq!(run.stdout, "");
    let gallery = folder.path().join("new/gallery");
    let names = files(&gallery);
    let scenes: Vec<&str> = names.iter().filter_map(|name| name.strip_suffix(".glb")).collect();
    assert!(scenes.len() >= 8, "{names:?}");
    for scene in scenes {
        let pictures: Vec<_> = names.iter().filter(|name| name.starts_with(scene) && name.ends_with(".png")).collect();
        assert!(!pictures.is_empty(), "{scene}");
        for picture in pictures {
            assert_eq!(open(&gallery.join(picture)).to_rgb8().dimensions(), (32, 18));
        }
        zfail(&gallery, &["info", &format!("{scene}.glb")]).ok();
    }
    let page = fs::read_to_string(gallery.join("index.html")).unwrap();
    assert!(names.iter().filter(|name| name.ends_with(".png")).all(|name| page.contains(name.as_str())));
}
