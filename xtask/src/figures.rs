//! The guide's figures and tables, made anew by the program: `cargo xtask figures [FILTER]`.
//!
//! In: the list below. Out: `docs/guide/figures/*.png` and `docs/guide/tables/compare.md`; and the tables of the last chapter,
//! of `sections`. Each command runs in a folder with
//! nothing but the guide's own scenes; one of the files that it leaves there is the figure. Beneath its figure the guide shows the command as it stands here, without
//! the options that only fit the picture into the page.

mod sections;

use crate::program::{Program, create, example};
use crate::root;
use std::fs;
use std::path::{Path, PathBuf};

/// A picture of the guide.
struct Figure {
    /// Its name in `docs/guide/figures`, without `.png`.
    name: &'static str,
    /// What the program is asked for, as the guide shows it.
    command: &'static str,
    kind: Kind,
}

/// Which file of a command is the figure.
#[derive(Clone, Copy)]
enum Kind {
    /// The picture of `zfail render`.
    Picture,
    /// The mask of the first light that `zfail render --aov shadow=.` writes.
    Verdict,
    /// The contact sheet of `zfail compare`.
    Sheet,
}

const fn picture(name: &'static str, command: &'static str) -> Figure {
    Figure { name, command, kind: Kind::Picture }
}

const fn verdict(name: &'static str, command: &'static str) -> Figure {
    Figure { name, command, kind: Kind::Verdict }
}

const fn sheet(name: &'static str, command: &'static str) -> Figure {
    Figure { name, command, kind: Kind::Sheet }
}

/// In the order of the guide.
const FIGURES: &[Figure] = &[
    picture("container", "render builtin:container"),
    verdict("container-verdict", "render builtin:container --aov shadow=."),
    picture("room-volumes", "render builtin:room --light 0 --overlay volumes"),
    picture("container-silhouettes", "render builtin:container --light 0 --overlay silhouettes"),
    picture("open", "render builtin:open"),
    sheet("compare-nested", "compare builtin:nested --method heidmann-two-pass,eye-count,carmack-preload"),
    picture("jail", "render builtin:jail"),
    picture("jail-stencil", "render builtin:jail --light 0 --overlay stencil"),
    sheet("compare-finite", "compare scenes/close-lamp.gltf --method finite-z-fail,everitt-kilgard"),
    sheet("compare-far-plane", "compare builtin:room --light 0 --method finite-z-fail,everitt-kilgard --finite far=16"),
    picture("container-alternate", "render builtin:container --light 0 --overlay alternate"),
    picture("container-clip-space", "render builtin:container --light 0 --overlay clip-space"),
    picture("sun-clip-space", "render builtin:sun --light 0 --overlay clip-space --overlay-from=40,-25"),
    picture("ortho", "render builtin:ortho"),
    picture("stacked", "render builtin:stacked"),
    picture("stacked-stencil", "render builtin:stacked --light 0 --overlay stencil"),
    sheet("compare-stacked", "compare builtin:stacked --method everitt-kilgard,zfail"),
    sheet("compare-stairs", "compare scenes/long-stairs.gltf --method everitt-kilgard,zfail"),
    picture("cathedral-cases", "render builtin:cathedral --camera 1 --light 0 --technique mcguire --overlay cases"),
    picture("container-pyramid", "render builtin:container --light 0 --overlay pyramid"),
    picture("stage-scissors", "render builtin:stage --light 0 --overlay scissors"),
    picture(
        "above-everitt-kilgard",
        "render scenes/lamp-from-above.gltf --technique everitt-kilgard --overlay volumes,scissors",
    ),
    picture("above-mcguire", "render scenes/lamp-from-above.gltf --technique mcguire --overlay volumes,scissors"),
    picture("cathedral-cases-auto", "render builtin:cathedral --camera 1 --light 0 --overlay cases"),
    picture("anemone-silhouettes", "render builtin:anemone --time 1 --light 0 --overlay silhouettes"),
    picture("foliage-wireframe", "render builtin:foliage --overlay wireframe"),
    sheet("compare-all", "compare builtin:nested"),
    sheet("compare-shadow-map", "compare builtin:container --method zfail,shadow-map --shadow-map resolution=256"),
    picture("room-lights", "render builtin:room --overlay volumes-by-light"),
    picture("room-one-light", "render builtin:room --overlay volumes --overlay-light 0"),
];

/// The table's name for those who want it alone.
const TABLE: &str = "compare-table";

/// Those of the last chapter.
const SECTIONS: &str = "sections";

/// Of a picture as wide as the page.
const PAGE: &str = "512x288";
/// Of one picture on a contact sheet.
const SMALL: &str = "240x135";

/// The scenes on which the papers' claims are shown.
pub const HARD_SCENES: [&str; 10] = [
    "builtin:container",
    "builtin:nested",
    "builtin:cathedral",
    "builtin:stage",
    "builtin:room",
    "builtin:sun",
    "builtin:jail",
    "builtin:staircase",
    "builtin:stacked",
    "scenes/close-lamp.gltf",
];

/// Makes the figures whose names contain `filter` (all without one), and with them the table.
///
/// # Errors
/// Names the command that failed or the file that it did not write; says so if no name contains `filter`.
pub fn run(filter: Option<&str>) -> Result<(), String> {
    let wanted = |name: &str| filter.is_none_or(|part| name.contains(part));
    if !FIGURES.iter().map(|figure| figure.name).chain([TABLE, SECTIONS]).any(wanted) {
        return Err(format!("no figure has '{}' in its name", filter.unwrap_or_default()));
    }
    if wanted(SECTIONS) {
        chapter()?;
    }
    if filter == Some(SECTIONS) {
        return Ok(());
    }
    let program = Program::build(&[])?;
    let figures = guide().join("figures");
    create(&figures)?;
    for figure in FIGURES.iter().filter(|figure| wanted(figure.name)) {
        let made = figure.make(&program)?;
        example("palette", [&made])?;
        let file = figures.join(figure.name).with_extension("png");
        fs::copy(&made, &file).map_err(|e| format!("cannot write {}: {e}", file.display()))?;
        println!("{}", file.display());
    }
    if wanted(TABLE) { table(&program) } else { Ok(()) }
}

impl Figure {
    /// Runs the command in an empty folder; the path of the file that is the figure.
    fn make(&self, program: &Program) -> Result<PathBuf, String> {
        let (options, file): (&[&str], _) = match self.kind {
            Kind::Picture => (&["--size", PAGE, "--samples", "4", "-o", "picture.png"], "picture.png"),
            Kind::Verdict => (&["--size", PAGE, "-o", "picture.png"], "light-0.png"),
            Kind::Sheet => (&["--size", SMALL, "-o", "sheet"], "sheet/contact-sheet.png"),
        };
        let folder = scratch()?;
        let words = self.command.split_whitespace().chain(options.iter().copied());
        program.run(&folder, words)?;
        let made = folder.join(file);
        if made.is_file() { Ok(made) } else { Err(format!("`zfail {}` wrote no {file}", self.command)) }
    }
}

/// The table of wrong pixels, from what the program writes for programs.
fn table(program: &Program) -> Result<(), String> {
    let folder = scratch()?;
    let mut results = Vec::new();
    for (i, scene) in HARD_SCENES.iter().enumerate() {
        let output = i.to_string();
        program.run(&folder, ["compare", scene, "--size", "160x100", "-o", &output])?;
        results.push(folder.join(output).join("compare.json"));
    }
    let text = example("compare_table", &results)?;
    let file = guide().join("tables").join("compare.md");
    create(&guide().join("tables"))?;
    fs::write(&file, text).map_err(|e| format!("cannot write {}: {e}", file.display()))?;
    println!("{}", file.display());
    Ok(())
}

/// The tables of the last chapter.
fn chapter() -> Result<(), String> {
    let path = guide().join(sections::CHAPTER);
    let read = |path: &Path| fs::read_to_string(path).map_err(|e| format!("cannot read {}: {e}", path.display()));
    let mut text = read(&path)?;
    for list in [sections::SECTIONS, sections::CORRECTIONS] {
        text = list.put_into(&text, &read(&guide().join("tables").join(list.file))?)?;
    }
    fs::write(&path, text).map_err(|e| format!("cannot write {}: {e}", path.display()))?;
    println!("{}", path.display());
    Ok(())
}

/// A folder with nothing but the guide's own scenes.
fn scratch() -> Result<PathBuf, String> {
    let folder = root().join("target").join("figures");
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(|e| format!("cannot empty {}: {e}", folder.display()))?;
    }
    copy_files(&guide().join("scenes"), &folder.join("scenes"))?;
    Ok(folder)
}

fn copy_files(from: &Path, to: &Path) -> Result<(), String> {
    create(to)?;
    let fault = |e: std::io::Error| format!("cannot copy {}: {e}", from.display());
    for entry in fs::read_dir(from).map_err(fault)? {
        let entry = entry.map_err(fault)?;
        fs::copy(entry.path(), to.join(entry.file_name())).map_err(fault)?;
    }
    Ok(())
}

/// The folder of the guide.
pub fn guide() -> PathBuf {
    root().join("docs").join("guide")
}

#[cfg(test)]
mod tests;
