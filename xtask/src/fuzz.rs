//! Coverage-guided fuzzing of the loaders with the stable toolchain: what `cargo fuzz run -s none` does, and nothing to
//! install but a C++ compiler, which builds libFuzzer.

use crate::{cargo, root};
use std::env;
use std::fs;
use std::path::Path;
use std::process::Command;

/// LLVM's coverage instrumentation as libFuzzer wants it.
const COVERAGE: &str = "--cfg fuzzing -Cpasses=sancov-module \
                        -Cllvm-args=-sanitizer-coverage-level=4 \
                        -Cllvm-args=-sanitizer-coverage-inline-8bit-counters \
                        -Cllvm-args=-sanitizer-coverage-pc-table \
                        -Cllvm-args=-sanitizer-coverage-trace-compares -Ccodegen-units=1";

/// Fuzzes each target that is named, or all of them, for `seconds`, one after the other. What is found lies in
/// `fuzz/artifacts`, and what was learned in `fuzz/corpus`.
///
/// # Errors
/// If the targets cannot be built or one of them finds something.
pub fn run(seconds: &str, targets: &[&str]) -> Result<(), String> {
    let seconds: u64 = seconds.parse().map_err(|_| format!("'{seconds}' is no number of seconds"))?;
    let fuzz = root().join("fuzz");
    let all = all_targets(&fuzz)?;
    if let Some(unknown) = targets.iter().find(|target| !all.iter().any(|known| known == *target)) {
        return Err(format!("there is no target '{unknown}'; there are: {}", all.join(", ")));
    }
    let host = host()?;
    let status = cargo()
        .args(["build", "--release", "--bins", "--target", &host, "--manifest-path", "fuzz/Cargo.toml"])
        .args(["--target-dir", "fuzz/target"])
        .env("RUSTFLAGS", COVERAGE)
        .status()
        .map_err(|e| format!("cannot start cargo: {e}"))?;
    if !status.success() {
        return Err(format!("the fuzz targets were not built ({status})"));
    }
    let programs = fuzz.join("target").join(host).join("release");
    let chosen = all.iter().filter(|target| targets.is_empty() || targets.contains(&target.as_str()));
    let mut found = Vec::new();
    for target in chosen {
        if !fuzz_target(&programs.join(target), target, seconds)? {
            found.push(target.as_str());
        }
    }
    match &found[..] {
        [] => Ok(()),
        found => Err(format!("found something: {}; see fuzz/artifacts", found.join(", "))),
    }
}

/// Whether nothing was found.
fn fuzz_target(program: &Path, target: &str, seconds: u64) -> Result<bool, String> {
    println!("\n+ {target} for {seconds} s");
    let learned = format!("fuzz/corpus/{target}");
    let seeds = ["seeds", "found"].map(|kind| format!("crates/zfail-files/tests/corpus/{kind}/{target}"));
    for folder in [root().join(&learned), root().join("fuzz/artifacts")] {
        fs::create_dir_all(&folder).map_err(|e| format!("cannot make {}: {e}", folder.display()))?;
    }
    let mut command = Command::new(program);
    command.current_dir(root()).arg(learned).args(seeds.iter().filter(|folder| root().join(folder).is_dir()));
    command.args([format!("-max_total_time={seconds}"), format!("-artifact_prefix=fuzz/artifacts/{target}-")]);
    command.args(["-max_len=65536", "-timeout=10", "-rss_limit_mb=1024", "-print_final_stats=1"]);
    // Every input is written to a file before it is loaded.
    if env::var_os("TMPDIR").is_none() && Path::new("/dev/shm").is_dir() {
        command.env("TMPDIR", "/dev/shm");
    }
    let status = command.status().map_err(|e| format!("cannot start {}: {e}", program.display()))?;
    Ok(status.success())
}

/// One per file in `fuzz/targets`.
fn all_targets(fuzz: &Path) -> Result<Vec<String>, String> {
    let entries = fs::read_dir(fuzz.join("targets")).map_err(|e| format!("cannot read fuzz/targets: {e}"))?;
    let stem = |path: &Path| path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    let mut targets: Vec<String> = entries.flatten().filter_map(|entry| stem(&entry.path())).collect();
    targets.sort();
    Ok(targets)
}

/// The toolchain's own target; named, so that instrumentation keeps away from build scripts.
pub fn host() -> Result<String, String> {
    let output = Command::new("rustc").arg("-vV").output().map_err(|e| format!("cannot start rustc: {e}"))?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let host = text.lines().find_map(|line| line.strip_prefix("host: "));
    host.map(str::to_owned).ok_or_else(|| "rustc -vV names no host".to_owned())
}
