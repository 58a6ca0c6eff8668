//! The papers' claims, judged: `claims measure [small]` prints what the experiments found, as JSON; `claims page FOLDER` prints the
//! page.
//!
//! In: for the page, a folder in which `cargo xtask claims` has put what the program and the experiments say. Out, on the
//! standard output: JSON or Markdown.

mod judged;
#[path = "../shared/wrap.rs"]
mod wrap;

use judged::experiments::Extent;
use judged::{Inputs, experiments, page};
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["measure"] => println!("{}", serde_json::to_string_pretty(&experiments::run(Extent::Whole)?)?),
        ["measure", "small"] => println!("{}", serde_json::to_string_pretty(&experiments::run(Extent::Small)?)?),
        ["page", folder] => print!("{}", wrap::wrapped(&page::page(&Inputs::read(Path::new(folder))?)?)),
        _ => return Err("usage: claims measure [small] | claims page FOLDER".into()),
    }
    Ok(())
}
