//! Numbered vertices and faces to parts.
//!
//! In: statements, and the material of each name. Out: one part per material and set of attributes; corners with the same
//! position and attributes share a vertex.

use super::statements::{ABSENT, Face, MISSING, Statements};
use crate::plain::losses::{Flaw, Losses, counted, flaw};
use crate::plain::{Part, full_channel, linear, points};
use crate::polygon::Triangulator;
use crate::shared::error::Result;
use crate::shared::limits::Budget;
use std::collections::BTreeMap;
use std::ops::Range;

/// The parts of a file.
pub(super) struct Assembly {
    pub parts: Vec<Part>,
    pub origin: [f64; 3],
    pub losses: Losses,
    pub notices: Vec<String>,
}

/// What separates parts: the material, and which attributes there are.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Kind {
    material: usize,
    normals: bool,
    uv: bool,
    colors: bool,
}

/// A face that is drawn: its corners, and its part.
struct Drawn {
    corners: Range<usize>,
    part: u32,
}

/// Bytes of a part and of the primitive that it becomes.
const PART_COST: u64 = 1024;
/// Bytes of a corner while vertices are sought: its part, its place in their order, and its vertex.
const CORNER_COST: u64 = 12;

pub(super) fn assemble(
    mut statements: Statements<'_>,
    materials: &[usize],
    mut losses: Losses,
    budget: &Budget,
) -> Result<Assembly> {
    budget.charge(statements.corners.len() as u64, CORNER_COST, || "the faces".into())?;
    budget.charge(statements.positions.len() as u64, 4, || "the vertices".into())?;
    let mut notices = Vec::new();
    let (faces, kinds) = sort_faces(&statements, materials, &mut losses, &mut notices, budget)?;
    let corners = &mut statements.corners;
    let mut part_of = vec![u32::MAX; corners.len()];
    for face in &faces {
        let kind = &kinds[face.part as usize];
        part_of[face.corners.clone()].fill(face.part);
        for [_, uv, normal] in &mut corners[face.corners.clone()] {
            *uv = if kind.uv { *uv } else { ABSENT };
            *normal = if kind.normals { *normal } else { ABSENT };
        }
    }
    let used = faces.iter().flat_map(|face| &statements.corners[face.corners.clone()]);
    let origin = points::origin(used.map(|[v, ..]| statements.positions[*v as usize]));
    let mut parts: Vec<Part> = kinds.iter().map(Kind::part).collect();
    let vertex_of = place_vertices(&statements, &part_of, &origin, &mut parts);
    let mut triangulator = Triangulator::default();
    for face in faces {
        let Part { positions, triangles, .. } = &mut parts[face.part as usize];
        match &vertex_of[face.corners] {
            [a, b, c] => triangles.push([*a, *b, *c]),
            polygon => triangulator.cut(polygon, |v| positions[v as usize], triangles),
        }
    }
    notices.extend(triangulator.notice());
    Ok(Assembly { parts, origin, losses, notices })
}

impl Kind {
    fn part(&self) -> Part {
        Part {
            material: self.material,
            normals: self.normals.then(Vec::new),
            uv: self.uv.then(Vec::new),
            colors: self.colors.then(Vec::new),
            ..Part::default()
        }
    }
}

/// The faces that can be drawn, and the kinds of parts that they belong to.
fn sort_faces(
    statements: &Statements<'_>,
    materials: &[usize],
    losses: &mut Losses,
    notices: &mut Vec<String>,
    budget: &Budget,
) -> Result<(Vec<Drawn>, Vec<Kind>)> {
    let Statements { positions, colors, uv, normals, corners, faces, .. } = statements;
    let mut drawn = Vec::with_capacity(faces.len());
    let (mut kinds, mut known) = (Vec::new(), BTreeMap::new());
    let (mut broken, mut partial, mut colorless) = (0, 0, 0);
    let mut start = 0;
    for face in faces {
        let range = start..face.end as usize;
        start = range.end;
        let corners = &corners[range.clone()];
        if let Some(flaw) = flaw(corners.iter().map(|[v, ..]| *v), positions) {
            let triangles = if flaw == Flaw::Nowhere { corners.len() - 2 } else { 1 };
            losses.add(flaw, triangles, || describe(flaw, face, statements));
            continue;
        }
        let mut whole = |which: usize, there: &dyn Fn(usize) -> bool| {
            let named = corners.iter().filter(|corner| corner[which] != ABSENT).count();
            let usable = corners.iter().filter(|corner| there(corner[which] as usize)).count();
            broken += usize::from(usable < named);
            partial += usize::from(usable == named && 0 < usable && usable < corners.len());
            usable == corners.len()
        };
        let uv = whole(1, &|i| uv.get(i).is_some_and(|uv| uv.iter().all(|x| x.is_finite())));
        let normals = whole(2, &|i| normals.get(i).is_some_and(|normal| normal.iter().all(|x| x.is_finite())));
        let colored = |[v, ..]: &&[u32; 3]| colors.get(*v as usize).is_some_and(|c| c[0].is_finite());
        let colored = if colors.is_empty() { 0 } else { corners.iter().filter(colored).count() };
        colorless += usize::from(colored < corners.len());
        let kind = Kind { material: materials[face.material as usize], normals, uv, colors: colored > 0 };
        let part = match known.get(&kind) {
            Some(part) => *part,
            None => {
                budget.charge(1, PART_COST, || format!("line {}", face.line))?;
                kinds.push(kind);
                known.insert(kind, kinds.len() as u32 - 1);
                kinds.len() as u32 - 1
            }
        };
        drawn.push(Drawn { corners: range, part });
    }
    for (count, problem) in [
        (broken, "with normals or texture coordinates that are not there, or not finite: shown without them"),
        (partial, "with normals or texture coordinates at some corners only: shown without them"),
        (
            if colors.is_empty() { 0 } else { colorless },
            "with vertices that lack the colour that others have: white there",
        ),
    ] {
        if count > 0 {
            notices.push(format!("{} {problem}", counted(count, "face")));
        }
    }
    Ok((drawn, kinds))
}

/// A word about a face that cannot be drawn.
fn describe(flaw: Flaw, face: &Face, statements: &Statements<'_>) -> String {
    let (line, count) = (face.line, statements.positions.len());
    match flaw {
        Flaw::Missing(corner) => {
            let said = statements.odd.filter(|_| corner == MISSING).unwrap_or(i64::from(corner) + 1);
            format!("line {line}: refers to vertex {said}, but there are {count}")
        }
        _ => format!("line {line}"),
    }
}

/// Makes a vertex of each set of corners that are alike, in the part of their face. Returns the vertex of each corner.
///
/// Corners are sorted by position first, in linear time; those at one position then among themselves, so that no file can
/// make this slow.
fn place_vertices(statements: &Statements<'_>, part_of: &[u32], origin: &[f64; 3], parts: &mut [Part]) -> Vec<u32> {
    let Statements { positions, colors, uv, normals, corners, .. } = statements;
    let drawn = || (0..corners.len() as u32).filter(|c| part_of[*c as usize] != u32::MAX);
    let mut ends = vec![0_u32; positions.len() + 1];
    drawn().for_each(|c| ends[corners[c as usize][0] as usize + 1] += 1);
    for v in 1..ends.len() {
        ends[v] += ends[v - 1];
    }
    let mut order = vec![0_u32; *ends.last().unwrap_or(&0) as usize];
    // Each number moves from the begin of its position's corners to their end.
    for c in drawn() {
        let next = &mut ends[corners[c as usize][0] as usize];
        order[*next as usize] = c;
        *next += 1;
    }
    let full = full_channel(colors.iter().flatten().copied().fold(0.0, f32::max));
    let mut vertex_of = vec![0; corners.len()];
    let mut start = 0;
    for (position, end) in positions.iter().zip(ends) {
        let alike = &mut order[start as usize..end as usize];
        start = end;
        let key = |c: &u32| (part_of[*c as usize], corners[*c as usize]);
        if alike.len() > 1 {
            alike.sort_unstable_by_key(key);
        }
        for corners in alike.chunk_by(|a, b| key(a) == key(b)) {
            let (part, [v, t, n]) = key(&corners[0]);
            let part = &mut parts[part as usize];
            let vertex = part.positions.len() as u32;
            part.positions.push(points::relative(position, origin));
            if let Some(list) = &mut part.uv {
                let [u, v] = uv[t as usize];
                list.push([u, 1.0 - v]);
            }
            if let Some(list) = &mut part.normals {
                list.push(normals[n as usize]);
            }
            if let Some(list) = &mut part.colors {
                let color = colors.get(v as usize).filter(|c| c.iter().all(|x| x.is_finite()));
                let [r, g, b] = color.map_or([1.0; 3], |c| c.map(|x| linear((x / full).clamp(0.0, 1.0))));
                list.push([r, g, b, 1.0]);
            }
            corners.iter().for_each(|c| vertex_of[*c as usize] = vertex);
        }
    }
    vertex_of
}
