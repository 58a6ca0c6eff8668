//! The page of what shadows cost, as Markdown: `benchmarks_page FOLDER`.
//!
//! In: a folder in which `cargo xtask benchmarks` has put what the program and the benches say for programs. Out, on the
//! standard output: the page.

mod page;
#[path = "../shared/wrap.rs"]
mod wrap;

use page::{Inputs, benches};
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1).map(PathBuf::from).ok_or("name the folder with the measurements")?;
    print!("{}", wrap::wrapped(&read(&folder)?.page()?));
    Ok(())
}

fn read(folder: &Path) -> Result<Inputs, Box<dyn Error>> {
    let text = |name: &str| {
        let path = folder.join(name);
        fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))
    };
    Ok(Inputs {
        commands: text("commands.txt")?.lines().map(str::to_owned).collect(),
        adapters: serde_json::from_str(&text("adapters.json")?)?,
        cores: std::thread::available_parallelism()?.get(),
        frames: serde_json::from_str(&text("frames.json")?)?,
        growth: serde_json::from_str(&text("growth.json")?)?,
        benches: benches::read(&folder.join("criterion"))?,
    })
}
