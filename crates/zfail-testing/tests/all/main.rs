//! Every WGSL file of the workspace, wherever it lies.

use std::fs;
use std::path::{Path, PathBuf};
use zfail_testing::{naga::valid::Capabilities, wgsl::validate};

/// Parts of programs; tests of their crates validate what is put together of them.
const PARTS: [&str; 3] = [
    "zfail-render/src/passes/shaders/",
    "zfail-methods/src/shadow_map.wgsl",
    "zfail-methods/src/ray_query/ray_query.wgsl",
];

fn find(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            find(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "wgsl") {
            found.push(path);
        }
    }
}

#[test]
fn every_file_is_valid_or_part_of_a_program_that_is_tested() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().expect("the crates");
    let mut files = Vec::new();
    find(&crates, &mut files);
    let (mut whole, mut parts) = (0, [0; PARTS.len()]);
    for file in &files {
        let name = file.strip_prefix(&crates).expect("below the crates").to_string_lossy().replace('\\', "/");
        if let Some(part) = PARTS.iter().position(|part| name.starts_with(part)) {
            parts[part] += 1;
            continue;
        }
        let source = fs::read_to_string(file).expect("a text file");
        validate(&source, Capabilities::MULTISAMPLED_SHADING).unwrap_or_else(|message| panic!("{name}: {message}"));
        // The comparison can fail, in this very file.
        let faulty = format!("{source}fn wrong() -> f32 {{ return 1u; }}");
        assert!(validate(&faulty, Capabilities::MULTISAMPLED_SHADING).is_err(), "{name}");
        whole += 1;
    }
    // A file that moved must not go untested.
    assert!(whole >= 12 && parts.iter().all(|&count| count > 0), "{whole} whole, {parts:?} parts");
}
