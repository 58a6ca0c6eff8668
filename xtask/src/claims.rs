//! The page on which the papers' claims are judged, made anew by the program and by experiments: `cargo xtask claims [small]`.
//!
//! In: the commands below. Out: `docs/claims.md`, or a page of the same form in `target/claims`, of few and small frames, to see
//! in half a minute whether all of it works.

use crate::figures::{HARD_SCENES, guide};
use crate::program::{Program, create, example};
use crate::root;
use std::fs;
use std::path::Path;

/// How much is measured.
struct Scale {
    /// Of `zfail`.
    frames: &'static str,
    /// Scenes in which methods are compared.
    methods: &'static [&'static str],
    /// Pixels at which methods are compared.
    size: &'static str,
    /// Scenes in which shadow maps are tried.
    mapped: &'static [&'static str],
    /// Resolutions and biases that are tried: three resolutions at the usual bias, biases at the usual resolution.
    maps: &'static [(u32, &'static str)],
    /// Of the experiments.
    measure: &'static [&'static str],
    /// From the root.
    page: &'static str,
}

const WHOLE: Scale = Scale {
    frames: "bench --frames 20",
    methods: &HARD_SCENES,
    size: "160x100",
    mapped: &["builtin:cathedral", "builtin:container", "builtin:jail", "builtin:room"],
    maps: &[(256, "0.001"), (1024, "0.0001"), (1024, "0.0003"), (1024, "0.001"), (1024, "0.003"), (4096, "0.001")],
    measure: &["measure"],
    page: "docs/claims.md",
};

const SMALL: Scale = Scale {
    frames: "bench builtin:room builtin:stage --frames 2 --size 96x54",
    methods: &["builtin:container", "builtin:jail", "builtin:stacked", "scenes/close-lamp.gltf"],
    size: "64x40",
    mapped: &["builtin:container", "builtin:jail"],
    maps: &[(256, "0.001"), (512, "0.001"), (1024, "0.0003"), (1024, "0.001")],
    measure: &["measure", "small"],
    page: "target/claims/claims.md",
};

/// Those of which something is claimed.
const METHODS: &str = "heidmann-two-pass,heidmann-two-sided,carmack-preload,everitt-kilgard,mcguire,zfail,shadow-map";

impl Scale {
    /// Options for one shadow map.
    fn map(&self, (resolution, bias): (u32, &str)) -> String {
        format!("--size {} --method shadow-map --shadow-map resolution={resolution},bias={bias}", self.size)
    }
}

/// Makes the whole page, or a small one.
///
/// # Errors
/// Names the command that failed, or the file that cannot be written.
pub fn run(small: bool) -> Result<(), String> {
    let scale = if small { SMALL } else { WHOLE };
    let folder = root().join("target").join("claims");
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(|e| format!("cannot empty {}: {e}", folder.display()))?;
    }
    for part in ["methods", "maps"] {
        create(&folder.join(part))?;
    }
    let program = Program::build(&[])?;
    let zfail = |command: &str, file: &str| {
        println!("+ zfail {command}");
        write(&folder.join(file), program.run(&guide(), command.split(' ').chain(["--json", "-q"]))?)
    };
    write(&folder.join("adapters.json"), program.run(&guide(), ["adapters", "--json"])?)?;
    zfail(scale.frames, "frames.json")?;
    // Pictures that nobody wants.
    let pictures = folder.join("pictures");
    let pictures = pictures.to_str().ok_or("the checkout's path is not Unicode")?;
    let methods = format!("--size {} --method {METHODS}", scale.size);
    for (i, scene) in scale.methods.iter().enumerate() {
        zfail(&format!("compare {scene} {methods} -o {pictures}"), &format!("methods/{i}.json"))?;
    }
    for (i, scene) in scale.mapped.iter().enumerate() {
        for (k, &map) in scale.maps.iter().enumerate() {
            zfail(&format!("compare {scene} {} -o {pictures}", scale.map(map)), &format!("maps/{i}-{k}.json"))?;
        }
    }
    let measure = scale.measure.join(" ");
    println!("+ claims {measure}");
    write(&folder.join("measured.json"), example("claims", scale.measure)?)?;
    let mut commands = vec![
        format!("frames: zfail {}", scale.frames),
        format!("methods: zfail compare SCENE {methods}"),
        format!("all others: cargo run --workspace --example claims {measure}"),
    ];
    commands.extend(scale.maps.iter().map(|&map| format!("maps: zfail compare SCENE {}", scale.map(map))));
    write(&folder.join("commands.txt"), commands.join("\n"))?;
    let page = root().join(scale.page);
    write(&page, example("claims", ["page".as_ref(), folder.as_os_str()])?)?;
    println!("{}", page.display());
    Ok(())
}

fn write(path: &Path, text: impl AsRef<[u8]>) -> Result<(), String> {
    fs::write(path, text).map_err(|e| format!("cannot write {}: {e}", path.display()))
}
