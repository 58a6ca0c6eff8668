//! What the program and the experiments say, read back.

use super::experiments::Measured;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::error::Error;
use std::fs;
use std::path::Path;

/// Everything that claims are judged by.
pub struct Inputs {
    /// What was run: a name, and the command.
    pub commands: Vec<[String; 2]>,
    pub adapter: Adapter,
    /// Of `zfail bench`.
    pub frames: Vec<Frame>,
    /// Of `zfail compare`, a scene each.
    pub methods: Vec<Comparison>,
    /// The same with shadow maps of several kinds.
    pub maps: Vec<Comparison>,
    pub measured: Measured,
}

/// What `zfail adapters` says of one.
#[derive(Deserialize)]
pub struct Adapter {
    pub name: String,
    pub driver: String,
    #[serde(rename = "type")]
    kind: String,
    default: bool,
}

/// What `zfail bench` says of a scene by one technique.
#[derive(Clone, Deserialize)]
pub struct Frame {
    pub scene: String,
    pub technique: String,
    pub shadows: bool,
    pub cpu_ms: Spread,
    pub wall_ms: Spread,
    pub planning_ms: Spread,
    pub triangles: Triangles,
    pub vertices: f64,
    pub fragments: Option<f64>,
    pub cases: [f64; 3],
}

#[derive(Clone, Deserialize)]
pub struct Spread {
    pub median: f64,
}

#[derive(Clone, Deserialize)]
pub struct Triangles {
    pub sides: f64,
    pub dark_cap: f64,
    pub light_cap: f64,
}

/// What `zfail compare` says of a scene.
#[derive(Deserialize)]
pub struct Comparison {
    pub scene: String,
    pub size: [u32; 2],
    pub verdicts: usize,
    pub lights: Vec<serde_json::Value>,
    pub shadow_map: ShadowMap,
    pub methods: Vec<Method>,
}

#[derive(Deserialize)]
pub struct ShadowMap {
    pub resolution: u32,
    pub bias: f64,
}

#[derive(Deserialize)]
pub struct Method {
    pub method: String,
    pub result: Option<Outcome>,
}

#[derive(Clone, Deserialize)]
pub struct Outcome {
    pub wrong_pixels: usize,
    pub fragments: f64,
    pub planning_ms: f64,
    pub render_ms: f64,
}

impl Inputs {
    /// All that `cargo xtask claims` has put into a folder.
    ///
    /// # Errors
    /// If a file is missing, or not what it ought to be.
    pub fn read(folder: &Path) -> Result<Self, Box<dyn Error>> {
        let commands = text(&folder.join("commands.txt"))?;
        let command = |line: &str| line.split_once(": ").map(|(name, command)| [name, command].map(str::to_owned));
        let adapters: Vec<Adapter> = json(&folder.join("adapters.json"))?;
        Ok(Self {
            commands: commands.lines().filter_map(command).collect(),
            adapter: adapters.into_iter().find(|adapter| adapter.default).ok_or("there is no default adapter")?,
            frames: json(&folder.join("frames.json"))?,
            methods: all(&folder.join("methods"))?,
            maps: all(&folder.join("maps"))?,
            measured: json(&folder.join("measured.json"))?,
        })
    }

    /// Whether the device is a program.
    pub fn software(&self) -> bool {
        self.adapter.kind == "software"
    }

    /// Frames of one scene by one technique.
    pub fn frame(&self, scene: &str, technique: &str, shadows: bool) -> Option<&Frame> {
        let wanted =
            |frame: &&Frame| name(&frame.scene) == scene && frame.technique == technique && frame.shadows == shadows;
        self.frames.iter().find(wanted)
    }

    /// The scenes that were played.
    pub fn scenes(&self) -> impl Iterator<Item = &str> {
        self.frames.chunk_by(|a, b| a.scene == b.scene).map(|frames| name(&frames[0].scene))
    }

    /// Of frames with shadows by one technique: a number for each scene.
    pub fn by_scene(&self, technique: &str, number: impl Fn(&Frame) -> f64) -> Vec<(String, f64)> {
        let of_scene = |scene: &str| Some((scene.to_owned(), number(self.frame(scene, technique, true)?)));
        self.scenes().filter_map(of_scene).collect()
    }
}

impl Frame {
    pub fn drawn(&self) -> f64 {
        self.triangles.sides + self.triangles.dark_cap + self.triangles.light_cap
    }
}

impl Comparison {
    pub fn name(&self) -> &str {
        name(&self.scene)
    }

    pub fn of(&self, method: &str) -> Option<&Outcome> {
        self.methods.iter().find(|row| row.method == method)?.result.as_ref()
    }
}

impl Outcome {
    pub fn milliseconds(&self) -> f64 {
        self.planning_ms + self.render_ms
    }
}

/// A scene's name without where it is from.
pub fn name(scene: &str) -> &str {
    let file = scene.rsplit('/').next().unwrap_or(scene);
    file.split_once('.').map_or(file, |(stem, _)| stem).trim_start_matches("builtin:")
}

fn text(path: &Path) -> Result<String, Box<dyn Error>> {
    fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()).into())
}

fn json<T: DeserializeOwned>(path: &Path) -> Result<T, Box<dyn Error>> {
    serde_json::from_str(&text(path)?).map_err(|e| format!("{}: {e}", path.display()).into())
}

/// The files of a folder, by their names.
fn all<T: DeserializeOwned>(folder: &Path) -> Result<Vec<T>, Box<dyn Error>> {
    let entries = fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut paths = entries.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>, std::io::Error>>()?;
    paths.sort();
    paths.iter().map(|path| json(path)).collect()
}
