//! .obj files with their .mtl files.
//!
//! In: bytes and the folder that the material libraries lie in. Out: one part per material and set of attributes.
//!
//! `statements` (text to numbered vertices and faces) -> `library` with `mtl` and `map` (names to materials and textures)
//! -> `assemble` (parts).

mod assemble;
mod library;
mod map;
mod mtl;
mod statements;

use crate::plain::losses::counted;
use crate::plain::text::decode;
use crate::plain::{Plain, Up, not_of_format};
use crate::shared::error::{Result, malformed};
use crate::shared::limits::Budget;
use assemble::Assembly;
use library::Library;
use statements::Statements;
use std::path::Path;

const FORMAT: &str = "OBJ";

/// Reads the triangles of a file in `folder`.
pub(crate) fn read(bytes: &[u8], folder: &Path, budget: &Budget) -> Result<Plain> {
    let text = decode(bytes, budget)?;
    let mut statements = Statements::read(&text, budget)?;
    let (strokes, freeform, calls) = (statements.strokes, statements.freeform, statements.calls);
    let mut library = Library::new(folder, budget);
    for names in &statements.libraries {
        library.load(names)?;
    }
    let materials = library.materials_of(&statements.materials);
    let losses = std::mem::take(&mut statements.losses);
    let Assembly { parts, origin, losses, mut notices } = assemble::assemble(statements, &materials, losses, budget)?;
    if parts.is_empty() {
        return Err(losses.fault(|| nothing_to_draw(bytes, strokes, freeform)));
    }
    notices.extend(losses.notices());
    if strokes > 0 {
        notices.push(format!(
            "{} of points and lines: not drawn, since they have no surface",
            counted(strokes, "statement")
        ));
    }
    if freeform > 0 {
        notices.push(format!("{}: not drawn, since only polygons are", counted(freeform, "free-form surface")));
    }
    if calls > 0 {
        notices.push(format!("{} of other files: not followed", counted(calls, "call")));
    }
    let library::Materials { materials, textures, pictures, notices: of_materials } = library.finish()?;
    notices.extend(of_materials);
    notices.push("OBJ has neither axes nor units: y is taken as up, and one unit as one metre".into());
    Ok(Plain { format: FORMAT, parts, materials, textures, pictures, up: Up::Y, origin, notices })
}

fn nothing_to_draw(bytes: &[u8], strokes: usize, freeform: usize) -> crate::shared::error::Fault {
    not_of_format(FORMAT, bytes, || {
        let (problem, remedy) = match (freeform, strokes) {
            (1.., _) => ("has free-form surfaces and no faces", "export them as polygons"),
            (_, 1..) => {
                ("has points or lines and no faces", "make surfaces of them first, as tubes or by triangulation")
            }
            _ => ("has no faces", "export it again with the faces of its meshes"),
        };
        malformed("the file", problem, remedy)
    })
}
