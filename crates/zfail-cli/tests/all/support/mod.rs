//! Running the program, and a small scene for it.

pub mod papers;

use std::f64::consts::FRAC_1_SQRT_2;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;

/// How a run ended.
pub struct Run {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

/// Runs `zfail` in the folder `cwd`.
pub fn zfail(cwd: &Path, args: &[&str]) -> Run {
    let output = command(cwd, args).output().expect("the program starts");
    let Output { status, stdout, stderr } = output;
    Run {
        code: status.code(),
        stdout: String::from_utf8(stdout).expect("standard output is UTF-8"),
        stderr: String::from_utf8(stderr).expect("standard error is UTF-8"),
    }
}

/// `zfail` with `args`, ready to start in the folder `cwd`.
pub fn command(cwd: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_zfail"));
    command.current_dir(cwd).args(args).stdin(Stdio::null());
    // Without a desktop session, Mesa's device-selection layer complains on our standard error.
    command.env("NODEVICE_SELECT", "1");
    command
}

impl Run {
    /// Asserts success.
    #[track_caller]
    pub fn ok(self) -> Self {
        assert_eq!(self.code, Some(0), "{}", self.stderr);
        self
    }

    /// Asserts one line of error with this exit code, and all of `words` in it.
    #[track_caller]
    pub fn fails(self, code: i32, words: &[&str]) -> Self {
        let line = &self.stderr;
        assert_eq!(self.code, Some(code), "{line}");
        assert!(line.starts_with("zfail: error: ") && line.ends_with('\n'), "{line:?}");
        assert_eq!(line.lines().count(), 1, "{line:?}");
        assert_eq!(self.stdout, "");
        for word in words {
            assert!(line.contains(word), "'{word}' is not in {line:?}");
        }
        for debris in ["panicked", "Os {", "Error(", "Some(", "RUST_BACKTRACE"] {
            assert!(!line.contains(debris), "{line:?}");
        }
        self
    }
}

/// Whether there is a graphics adapter; if not, the test is to be skipped.
pub fn has_gpu() -> bool {
    static FOUND: OnceLock<bool> = OnceLock::new();
    let found = *FOUND.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        small_scene(folder.path());
        let run = zfail(folder.path(), &["render", "small.gltf", "-o", "probe.png", "--size", "8x8"]);
        !(run.code == Some(1) && run.stderr.contains("no graphics adapter"))
    });
    zfail_testing::gpu(found.then_some(()).ok_or("no graphics adapter found")).is_some()
}

/// The names in a folder, sorted.
pub fn files(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder exists");
    let mut names: Vec<_> = entries.flatten().map(|e| e.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Writes `small.gltf`: a floor of 8 m, a square of 1 m that hovers 1 m above it, the cameras 'above' and 'aside',
/// the lights 'sun' (directional), 'lamp' (point) and 'torch' (spot), and the animations 'glide' (of 'above') and
/// 'sunset' (of the sun), both of 2 s.
pub fn small_scene(folder: &Path) -> PathBuf {
    let square = |half: f32, y: f32| [[-half, y, half], [half, y, half], [half, y, -half], [-half, y, -half]];
    let positions: Vec<[f32; 3]> = [square(4.0, 0.0), square(0.5, 1.0)].concat();
    let indices: [u16; 12] = [0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7];
    let normals = [[0.0, 1.0, 0.0]; 8];
    let mut bytes: Vec<u8> = positions.iter().chain(&normals).flatten().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend(indices.iter().flat_map(|i| i.to_le_bytes()));
    // Key times, camera 'above' to x = 0.5, the sun to the horizon.
    let keys: [f32; 16] = [0.0, 2.0, 0.0, 6.0, 0.0, 0.5, 6.0, 0.0, -0.8944272, 0.0, 0.0, 0.4472136, 0.0, 0.0, 0.0, 1.0];
    bytes.extend(keys.iter().flat_map(|x| x.to_le_bytes()));
    fs::write(folder.join("small.bin"), &bytes).expect("the buffer is written");
    // A quarter turn about the x axis.
    let down = [-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2];
    let json = serde_json::json!({
        "asset": { "version": "2.0" },
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": { "KHR_lights_punctual": { "lights": [
            { "type": "directional", "name": "sun", "intensity": 2.0 },
            { "type": "point", "name": "lamp", "intensity": 40.0 },
            { "type": "spot", "name": "torch", "intensity": 40.0, "spot": { "outerConeAngle": 0.5 } },
        ] } },
        "buffers": [{ "uri": "small.bin", "byteLength": bytes.len() }],
        "bufferViews": [
            { "buffer": 0, "byteOffset": 0, "byteLength": 96 },
            { "buffer": 0, "byteOffset": 96, "byteLength": 96 },
            { "buffer": 0, "byteOffset": 192, "byteLength": 24 },
            { "buffer": 0, "byteOffset": 216, "byteLength": 64 },
        ],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3",
              "min": [-4.0, 0.0, -4.0], "max": [4.0, 1.0, 4.0] },
            { "bufferView": 1, "componentType": 5126, "count": 8, "type": "VEC3" },
            { "bufferView": 2, "componentType": 5123, "count": 12, "type": "SCALAR" },
            { "bufferView": 3, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0.0], "max": [2.0] },
            { "bufferView": 3, "byteOffset": 8, "componentType": 5126, "count": 2, "type": "VEC3" },
            { "bufferView": 3, "byteOffset": 32, "componentType": 5126, "count": 2, "type": "VEC4" },
        ],
        "animations": [
            { "name": "glide", "samplers": [{ "input": 3, "output": 4 }],
              "channels": [{ "sampler": 0, "target": { "node": 1, "path": "translation" } }] },
            { "name": "sunset", "samplers": [{ "input": 3, "output": 5, "interpolation": "STEP" }],
              "channels": [{ "sampler": 0, "target": { "node": 3, "path": "rotation" } }] },
        ],
        "materials": [{ "name": "paper", "doubleSided": true, "pbrMetallicRoughness": { "metallicFactor": 0.0 } }],
        "meshes": [{ "name": "squares", "primitives": [
            { "attributes": { "POSITION": 0, "NORMAL": 1 }, "indices": 2, "material": 0 } ] }],
        "cameras": [
            { "type": "perspective", "name": "above", "perspective": { "yfov": 0.9, "znear": 0.1 } },
            { "type": "perspective", "name": "aside", "perspective": { "yfov": 0.9, "znear": 0.1 } },
        ],
        "nodes": [
            { "mesh": 0, "name": "squares" },
            { "camera": 0, "translation": [0.0, 6.0, 0.0], "rotation": down },
            { "camera": 1, "translation": [0.0, 2.0, 8.0] },
            // Looks down, tilted by about 37 degrees, so that the shadow lies beside the square.
            { "rotation": [-0.8944272, 0.0, 0.0, 0.4472136], "extensions": { "KHR_lights_punctual": { "light": 0 } } },
            { "translation": [1.5, 3.0, 0.0], "extensions": { "KHR_lights_punctual": { "light": 1 } } },
            { "translation": [0.0, 4.0, 0.0], "rotation": down,
              "extensions": { "KHR_lights_punctual": { "light": 2 } } },
        ],
        "scenes": [{ "nodes": [0, 1, 2, 3, 4, 5] }],
        "scene": 0,
    });
    let path = folder.join("small.gltf");
    fs::write(&path, json.to_string()).expect("the scene is written");
    path
}
