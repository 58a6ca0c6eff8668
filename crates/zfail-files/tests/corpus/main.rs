//! Every input in `seeds`, which is where fuzzing starts, and in `found`, which is what it has found, loaded as the fuzz
//! targets do: no panic, no more memory than allowed, no long wait.

mod loading;

use cap::Cap;
use std::alloc::System;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

#[global_allocator]
static ALLOCATOR: Cap<System> = Cap::new(System, loading::MEMORY);

#[test]
fn inputs_keep_the_promises_of_loading() {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus");
    for (name, target) in loading::TARGETS {
        let folders = ["seeds", "found"].map(|kind| corpus.join(kind).join(name));
        let files = folders.iter().flat_map(|folder| fs::read_dir(folder).into_iter().flatten().flatten());
        for file in files.map(|entry| entry.path()) {
            let bytes = fs::read(&file).unwrap();
            let start = Instant::now();
            println!("{}", file.display());
            target(&bytes);
            let time = start.elapsed();
            assert!(time < Duration::from_secs(10), "{}: {time:?}", file.display());
        }
        assert!(folders[0].is_dir(), "the target {name} has no seeds");
    }
}

#[test]
fn seeds_show_what_they_are_for() {
    let seed = |name: &str| {
        let bytes = fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus/seeds/glb").join(name)).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("seed.glb");
        fs::write(&file, bytes).unwrap();
        zfail_files::load_animated(&file, &loading::LIMITS).unwrap()
    };
    let (scene, _) = seed("surfaces");
    assert!(!scene.scene.images.is_empty() && scene.scene.lights.len() == 3 && !scene.scene.cameras.is_empty());
    assert!(seed("instances").0.scene.instances.len() > 2);
    assert!(seed("skin").0.animations.len() == 1 && seed("skin").1.skins.len() == 1);
    assert!(seed("morph").1.channels[0].weights == 1);
}

#[test]
fn the_checks_can_fail() {
    let mut scene = zfail_builtin::scene("open").unwrap();
    loading::assert_sound(&scene);
    scene.meshes[0].positions[0][1] = f32::NAN;
    assert!(std::panic::catch_unwind(|| loading::assert_sound(&scene)).is_err());
    assert!(Vec::<u8>::new().try_reserve(loading::MEMORY / 4).is_ok());
    assert!(Vec::<u8>::new().try_reserve(loading::MEMORY).is_err(), "beyond the limit there is no memory");
}
