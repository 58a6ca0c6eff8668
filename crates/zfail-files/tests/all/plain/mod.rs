//! .obj, .stl and .ply files, written here and loaded.

mod mtl;
mod obj;
mod ply;
mod stl;

use crate::build::assert_sound;
use obj::OBJ;
use ply::{PLY, binary_ply};
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};
use stl::STL;
use tempfile::TempDir;
use zfail_files::{Limits, LoadError};
use zfail_plan::glam::DVec3;
use zfail_scene::{Scene, world_triangle};
use zfail_testing::Random;

/// Loads the first of `files`, which lie in one folder.
fn load(files: &[(&str, &[u8])]) -> Result<Scene, LoadError> {
    let folder = TempDir::new().unwrap();
    for (name, bytes) in files {
        let path = folder.path().join("model").join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    fs::write(folder.path().join("secret.mtl"), "newmtl a\n").unwrap();
    zfail_files::load_with(&folder.path().join("model").join(files[0].0), &Limits { bytes: 1 << 26, image_side: 64 })
}

#[track_caller]
fn loaded(files: &[(&str, &[u8])]) -> Scene {
    let scene = load(files).unwrap_or_else(|e| panic!("{e}"));
    assert_sound(&scene);
    scene
}

#[track_caller]
fn fails(files: &[(&str, &[u8])], expected: &str) {
    let error = load(files).map(|_| ()).unwrap_err().to_string();
    assert!(error.contains(expected) && !error.contains("glTF validator"), "{error}\nlacks {expected:?}");
}

fn world_triangles(scene: &Scene) -> Vec<[DVec3; 3]> {
    let of = |i: &zfail_scene::Instance| {
        let mesh = &scene.meshes[i.mesh];
        (0..mesh.triangles.len()).map(|t| world_triangle(mesh, &i.world_from_object, t)).collect::<Vec<_>>()
    };
    scene.instances.iter().flat_map(of).collect()
}

fn png() -> Vec<u8> {
    use image::ImageEncoder;
    let mut bytes = Vec::new();
    let encoder = image::codecs::png::PngEncoder::new(&mut bytes);
    encoder.write_image(&[9; 4], 1, 1, image::ExtendedColorType::Rgba8).unwrap();
    bytes
}

/// How many triangles there are, and the notices but the last, which is about axes and units.
#[track_caller]
fn told(files: &[(&str, &[u8])]) -> (usize, Vec<String>) {
    let mut scene = loaded(files);
    let last = scene.notices.pop().unwrap_or_default();
    assert!(last.contains("has neither axes nor units"), "{last}");
    (world_triangles(&scene).len(), scene.notices)
}

#[test]
fn names_and_contents_must_agree() {
    let wrong = load(&[("a.glb", OBJ.as_bytes())]).map(|_| ()).unwrap_err().to_string();
    assert!(wrong.contains("is not a glTF 2.0 file") && wrong.contains(".obj, .stl or .ply"), "{wrong}");
    assert!(zfail_files::load(Path::new("/nonexistent/a.obj")).is_err());
    fails(&[("a.obj", &png())], "the file: has no faces");
    fails(&[("a.stl", &png())], "neither ASCII");
    fails(&[("a.ply", &png())], "line 1: is not `ply`");
    fails(
        &[("a.stl", OBJ.trim_start_matches("# a quad and a triangle\r\n").as_bytes())],
        "is OBJ, not STL; let its name end in .obj",
    );
    fails(&[("a.obj", PLY.as_bytes())], "the file: is PLY, not OBJ; let its name end in .ply");
    for name in ["a.obj", "a.stl", "a.ply"] {
        let pointer = b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n";
        fails(&[(name, pointer)], "is a pointer of Git LFS");
        fails(&[(name, b"<!DOCTYPE html>\n<html></html>")], "is a page of a web site");
    }
}

#[test]
fn flipped_and_cut_files() {
    let mut random = Random(5);
    let files: [(&str, Vec<u8>); 4] =
        [("a.obj", OBJ.into()), ("a.stl", STL.into()), ("a.ply", PLY.into()), ("b.ply", binary_ply(true))];
    for (name, original) in files {
        let mut same = 0;
        for round in 0..300 {
            let mut bytes = original.clone();
            if round % 3 == 0 {
                bytes.truncate(random.below(bytes.len()));
            }
            for _ in 0..random.below(4) {
                let at = random.below(original.len());
                if let Some(byte) = bytes.get_mut(at) {
                    *byte ^= 1 << random.below(8);
                }
            }
            let start = Instant::now();
            let result = load(&[(name, &bytes), ("sub/wood.mtl", &bytes)]);
            assert!(start.elapsed() < Duration::from_secs(5), "{name}, round {round}: slow");
            match result {
                Ok(scene) => {
                    assert_sound(&scene);
                    same += 1;
                }
                Err(e) => assert!(!e.to_string().contains('\n') && !e.to_string().contains("decoder failed"), "{e}"),
            }
        }
        assert!(same > 10 && same < 290, "{name}: {same} of 300 loaded");
    }
}
