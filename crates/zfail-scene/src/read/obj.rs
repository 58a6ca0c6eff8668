//! .obj files with their .mtl files, through `tobj`.
//!
//! In: bytes and the folder that the material libraries lie in. Out: one part per material and set of attributes. Groups
//! and objects stay together in one mesh, so that a body that is cut into groups stays closed.

use super::error::{Result, malformed};
use super::fence::fenced;
use super::limits::Budget;
use super::mtl::Library;
use super::plain::{Part, Plain, Y_UP, check_finite, linear, nothing_to_draw};
use super::polygon::Triangulator;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::io::{BufRead, Read};
use std::path::Path;
use tobj::{LoadOptions, Mesh, Model};

const FORMAT: &str = "OBJ";

/// Bytes that `tobj` needs for a corner of a face: as it is read, as it is triangulated, and to find it again.
const CORNER_COST: u64 = 128;
/// Bytes that `tobj` needs for a line of any other kind, at most three numbers and a colour.
const LINE_COST: u64 = 32;
/// Bytes of a model, which every change of material begins.
const MATERIAL_COST: u64 = 1024;

/// Reads the triangles of a file in `folder`.
pub(super) fn read(bytes: &[u8], folder: &Path, budget: &Budget) -> Result<Plain> {
    budget.charge(bytes.len() as u64, 6, || "the file".into())?;
    let (text, cost) = plain_lines(bytes);
    budget.charge(cost, 1, || "the file".into())?;
    check_corners(&text)?;
    let library = Library::new(folder, budget);
    let models = parse(&text, &library)?;
    let (library, mut notices) = library.finish();
    let mut parts: BTreeMap<Kind, Part> = BTreeMap::new();
    let mut mismatched = 0;
    let mut triangulator = Triangulator::default();
    for Model { mesh, .. } in &models {
        let kind = Kind::of(mesh, library.default_material());
        mismatched += usize::from(kind.mismatched);
        append(parts.entry(kind).or_default(), &kind, mesh, &mut triangulator, budget)?;
    }
    if mismatched > 0 {
        notices.push("some corners lack the normal or the texture coordinates that others have: left out there".into());
    }
    if parts.values().all(|part| part.triangles.is_empty()) {
        return Err(nothing_to_draw(FORMAT, "has no faces"));
    }
    notices.push("OBJ has neither axes nor units: y is taken as up, and one unit as one metre".into());
    let (materials, images) = library.into_materials();
    Ok(Plain {
        format: FORMAT,
        parts: parts.into_values().collect(),
        materials,
        images,
        world_from_file: Y_UP,
        notices,
    })
}

/// What separates parts: the material, and which attributes there are.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Kind {
    material: usize,
    normals: bool,
    uv: bool,
    colors: bool,
    /// Whether some attribute is there for some vertices only, and so for none.
    mismatched: bool,
}

impl Kind {
    fn of(mesh: &Mesh, default_material: usize) -> Self {
        let count = mesh.positions.len() / 3;
        let complete = |values: &[f32], components: usize| !values.is_empty() && values.len() == components * count;
        let (normals, uv, colors) =
            (complete(&mesh.normals, 3), complete(&mesh.texcoords, 2), complete(&mesh.vertex_color, 3));
        let mismatched = normals == mesh.normals.is_empty() || uv == mesh.texcoords.is_empty();
        Self { material: mesh.material_id.unwrap_or(default_material), normals, uv, colors, mismatched }
    }
}

fn append(part: &mut Part, kind: &Kind, mesh: &Mesh, triangulator: &mut Triangulator, budget: &Budget) -> Result<()> {
    let first = part.positions.len();
    let positions: &[[f32; 3]] = mesh.positions.as_chunks().0;
    check_finite(FORMAT, "vertex", positions)?;
    let end = u32::try_from(first + positions.len()).map_err(|_| budget.exceeded("the file".into()))?;
    part.material = kind.material;
    part.positions.extend(positions);
    if kind.normals {
        part.normals.get_or_insert_default().extend(mesh.normals.as_chunks::<3>().0);
    }
    if kind.uv {
        let flipped = mesh.texcoords.as_chunks().0.iter().map(|&[u, v]| [u, 1.0 - v]);
        part.uv.get_or_insert_default().extend(flipped);
    }
    if kind.colors {
        let colors = mesh.vertex_color.as_chunks().0.iter();
        let linear = colors.map(|&[r, g, b]| [linear(r), linear(g), linear(b), 1.0]);
        part.colors.get_or_insert_default().extend(linear);
    }
    let corners: Vec<u32> = mesh.indices.iter().map(|&v| (first as u32).saturating_add(v)).collect();
    if corners.iter().any(|&v| v >= end) {
        return Err(malformed(FORMAT, "the file", "has a face beyond its vertices"));
    }
    if mesh.face_arities.is_empty() {
        part.triangles.extend(corners.as_chunks().0);
    }
    let mut rest = &*corners;
    for &arity in &mesh.face_arities {
        let Some((face, after)) = rest.split_at_checked(arity as usize) else { break };
        triangulator.cut(face, |v| part.positions[v as usize], &mut part.triangles);
        rest = after;
    }
    Ok(())
}

/// The file line by line as `tobj` can take it, and what it will cost there: in UTF-8, continued lines joined (with
/// their number of lines), and without what names groups, of which nothing is kept.
fn plain_lines(bytes: &[u8]) -> (String, u64) {
    let text = String::from_utf8_lossy(bytes);
    let mut plain = String::with_capacity(text.len());
    let (mut owed, mut cost) = (0, 0);
    for line in text.lines() {
        let mut words = line.split_ascii_whitespace();
        let kind = words.next();
        cost += match kind {
            Some("usemtl") => MATERIAL_COST,
            Some("v" | "vt" | "vn") => LINE_COST,
            _ => CORNER_COST * words.count() as u64,
        };
        if let Some(head) = line.strip_suffix('\\') {
            plain.push_str(head);
            plain.push(' ');
            owed += 1;
            continue;
        }
        if owed > 0 || !matches!(kind, Some("o" | "g" | "s")) {
            plain.push_str(line);
        }
        for _ in 0..=std::mem::take(&mut owed) {
            plain.push('\n');
        }
    }
    (plain, cost)
}

/// Refuses corners before the first vertex or beyond all that fit 32 bits: `tobj` multiplies them before it looks.
fn check_corners(text: &str) -> Result<()> {
    // Positions, texture coordinates and normals so far, to which negative numbers are relative.
    let mut counts = [0_i64; 3];
    for (i, line) in text.lines().enumerate() {
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => counts[0] += 1,
            Some("vt") => counts[1] += 1,
            Some("vn") => counts[2] += 1,
            Some("f" | "l" | "p") => {
                let possible = |(number, count): (&str, i64)| {
                    number.parse().map_or(true, |number: i64| (-count..=i64::from(u32::MAX)).contains(&number))
                };
                if let Some(corner) = words.find(|corner| !corner.split('/').zip(counts).all(possible)) {
                    let problem = format!("the corner {corner} is before the first or beyond the last that can be");
                    return Err(malformed(FORMAT, format!("line {}", i + 1), problem));
                }
            }
            _ => {}
        }
    }
    Ok(())
}

fn parse(text: &str, library: &Library<'_>) -> Result<Vec<Model>> {
    let options = LoadOptions { single_index: true, triangulate: false, ignore_points: true, ignore_lines: true };
    let lines = Cell::new(0);
    let parsed = fenced(|| {
        let mut reader = Counted { text: text.as_bytes(), lines: &lines };
        tobj::load_obj_buf(&mut reader, &options, |name| library.load(&name.to_string_lossy()))
    });
    library.fault()?;
    match parsed {
        Ok(Ok((models, _))) => Ok(models),
        // Faces are looked up when their group ends.
        Ok(Err(e)) => Err(malformed(FORMAT, format!("line {} or the group before it", lines.get()), e.to_string())),
        Err(panic) => Err(malformed(FORMAT, format!("line {}", lines.get()), panic)),
    }
}

/// A reader that knows how many lines have been taken.
struct Counted<'a> {
    text: &'a [u8],
    lines: &'a Cell<usize>,
}

impl Read for Counted<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = buffer.len().min(self.text.len());
        buffer[..count].copy_from_slice(&self.text[..count]);
        self.consume(count);
        Ok(count)
    }
}

impl BufRead for Counted<'_> {
    fn fill_buf(&mut self) -> std::io::Result<&[u8]> {
        Ok(self.text)
    }

    fn consume(&mut self, count: usize) {
        let (taken, left) = self.text.split_at(count);
        self.lines.set(self.lines.get() + taken.iter().filter(|byte| **byte == b'\n').count());
        self.text = left;
    }
}
