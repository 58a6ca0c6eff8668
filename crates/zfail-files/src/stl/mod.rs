//! .stl files, binary and ASCII.
//!
//! In: bytes. Out: triangles without shared vertices; the format has no others. Stored normals are not used: they follow
//! from the corners, and many programs write zeros.

mod ascii;
mod binary;

use crate::plain::losses::{Flaw, Losses, counted, flaw};
use crate::plain::{Part, Plain, Up, grey, not_of_format, points, text};
use crate::polygon::Triangulator;
use crate::shared::error::{Result, malformed};
use crate::shared::limits::Budget;
use binary::Layout;

const FORMAT: &str = "STL";

/// What the file holds, as it is spelt.
#[derive(Default)]
struct Facets {
    /// Corners, one facet after the other.
    corners: Vec<[f64; 3]>,
    /// Where the facets end among the corners, with their lines, if any has not three.
    ends: Vec<(u32, u32)>,
    notices: Vec<String>,
}

/// Reads the solids of a file into one part.
pub(crate) fn read(bytes: &[u8], budget: &Budget) -> Result<Plain> {
    let facets = match Layout::of(bytes).map_err(|fault| not_of_format(FORMAT, bytes, || fault))? {
        Some(layout) => layout.read(budget)?,
        None => {
            let text = text::decode(bytes, budget)?;
            let unknown = || {
                let problem =
                    "is neither ASCII, made of facets, nor as long as the number of triangles at byte 80 says";
                malformed("the file", problem, "copy or download it again, or export it again as binary STL")
            };
            ascii::read(&text, budget)?.ok_or_else(|| not_of_format(FORMAT, bytes, unknown))?
        }
    };
    assemble(facets, budget)
}

fn assemble(facets: Facets, budget: &Budget) -> Result<Plain> {
    let Facets { corners, ends, mut notices } = facets;
    let count = u32::try_from(corners.len()).map_err(|_| budget.exceeded("the file".into()))?;
    let mut losses = Losses::default();
    let mut faces = Vec::with_capacity(corners.len() / 3);
    let mut face = |start: u32, end: u32, line: u32| match flaw(start..end, &corners) {
        None => faces.push(start..end),
        Some(flaw) => {
            let triangles = if flaw == Flaw::Nowhere { (end - start) as usize - 2 } else { 1 };
            let place = || if line == 0 { format!("facet {}", start / 3) } else { format!("line {line}") };
            losses.add(flaw, triangles, place);
        }
    };
    if ends.is_empty() {
        (0..count / 3).for_each(|t| face(3 * t, 3 * t + 3, 0));
    } else {
        let starts = [0].into_iter().chain(ends.iter().map(|(end, _)| *end));
        starts.zip(&ends).for_each(|(start, &(end, line))| face(start, end, line));
    }
    if faces.is_empty() {
        let none = || malformed("the file", "has no triangles", "export it again with the parts to print visible");
        return Err(losses.fault(none));
    }
    let used = faces.iter().flat_map(|face| &corners[face.start as usize..face.end as usize]);
    let origin = points::origin(used.copied());
    let near = |p: &[f64; 3]| if points::is_usable(p) { points::relative(p, &origin) } else { [0.0; 3] };
    let positions: Vec<[f32; 3]> = corners.iter().map(near).collect();
    let (mut triangles, mut triangulator) = (Vec::with_capacity(faces.len()), Triangulator::default());
    let mut polygons = 0;
    for face in faces {
        if face.len() == 3 {
            triangles.push([face.start, face.start + 1, face.start + 2]);
        } else {
            let polygon: Vec<u32> = face.collect();
            triangulator.cut(&polygon, |v| positions[v as usize], &mut triangles);
            polygons += 1;
        }
    }
    notices.extend(triangulator.notice());
    notices.extend(losses.notices());
    if polygons > 0 {
        notices.push(format!("{} of more than three corners: taken as polygons", counted(polygons, "facet")));
    }
    notices.push("STL has neither axes nor units: z is taken as up, and one unit as one metre".into());
    Ok(Plain {
        format: FORMAT,
        parts: vec![Part { positions, triangles, ..Part::default() }],
        materials: vec![grey("STL".into())],
        textures: Vec::new(),
        pictures: Vec::new(),
        up: Up::Z,
        origin,
        notices,
    })
}
