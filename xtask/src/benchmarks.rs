//! The page of what shadows cost, made anew by the program and the benches: `cargo xtask benchmarks [small]`.
//!
//! In: the commands below. Out: `docs/benchmarks.md`, which README quotes, or a page of the same form in `target/benchmarks`, of few
//! and small frames, to see in a minute whether all of it works.

use crate::program::{Program, create, example};
use crate::{cargo, root, succeeds};
use std::fs;
use std::path::Path;

/// How much is measured.
struct Scale {
    /// Of `cargo build`.
    profile: &'static [&'static str],
    frames: &'static str,
    growth: &'static str,
    /// Of `cargo`, if any.
    benches: Option<&'static str>,
    /// From the root.
    page: &'static str,
}

const WHOLE: Scale = Scale {
    profile: &["--release"],
    frames: "bench --frames 20",
    growth: "bench --scaling",
    benches: Some("bench --workspace --bench planning --bench frame"),
    page: "docs/benchmarks.md",
};

const SMALL: Scale = Scale {
    profile: &[],
    frames: "bench builtin:container builtin:room --frames 2 --size 160x90",
    growth: "bench --scaling",
    benches: None,
    page: "target/benchmarks/benchmarks.md",
};

/// Makes the whole page, or a small one.
///
/// # Errors
/// Names the command that failed, or the file that cannot be written.
pub fn run(small: bool) -> Result<(), String> {
    let scale = if small { SMALL } else { WHOLE };
    let folder = root().join("target").join("benchmarks");
    create(&folder)?;
    let program = Program::build(scale.profile)?;
    let mut commands = Vec::new();
    for (command, file) in [(scale.frames, "frames.json"), (scale.growth, "growth.json"), ("adapters", "adapters.json")]
    {
        println!("+ zfail {command}");
        write(&folder.join(file), program.run(&folder, command.split(' ').chain(["--json"]))?)?;
        commands.push(format!("zfail {command}"));
    }
    // What it says is no measurement.
    commands.pop();
    let measured = folder.join("criterion");
    if measured.exists() {
        fs::remove_dir_all(&measured).map_err(|e| format!("cannot empty {}: {e}", measured.display()))?;
    }
    if let Some(command) = scale.benches {
        succeeds(cargo().args(command.split(' ')).env("CRITERION_HOME", &measured))?;
        commands.push(format!("cargo {command}"));
    }
    write(&folder.join("commands.txt"), commands.join("\n"))?;
    let page = root().join(scale.page);
    write(&page, example("benchmarks_page", [&folder])?)?;
    println!("{}", page.display());
    Ok(())
}

fn write(path: &Path, text: impl AsRef<[u8]>) -> Result<(), String> {
    fs::write(path, text).map_err(|e| format!("cannot write {}: {e}", path.display()))
}
