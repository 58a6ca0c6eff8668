//! The faces of a .ply file: polygons, and strips of triangles as Stanford's scans have them.

use super::body::{Body, End};
use super::cut_off;
use super::header::{Element, Property};
use crate::plain::losses::{Flaw, Losses};
use crate::shared::error::Result;
use crate::shared::limits::Budget;

/// Corners, polygon by polygon.
#[derive(Default)]
pub(super) struct Faces {
    /// Vertices, or [`MISSING`].
    pub corners: Vec<u32>,
    /// Where each face ends among the corners.
    pub ends: Vec<u32>,
    /// The first index that no vertex can have.
    pub odd: Option<f64>,
    pub losses: Losses,
}

/// A vertex that no file has: there are fewer bytes.
pub(super) const MISSING: u32 = u32::MAX;

/// What corners and faces are charged with, the triangles that they become included.
const CORNER_COST: u64 = 2 * (4 + 12);
const FACE_COST: u64 = 2 * 4 + 16;
/// How much is charged at once.
const BLOCK: u64 = 1 << 16;

/// How the corners of an element are listed.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    Polygons,
    Strips,
}

impl Faces {
    /// Adds the rows of `element`. One without corners in it is passed over.
    pub fn read(&mut self, shape: Shape, body: &mut Body<'_>, element: &Element<'_>, budget: &Budget) -> Result<()> {
        let chosen = corners_of(element);
        let mut uncharged = 0;
        let mut row = Vec::new();
        for i in 0..element.count {
            body.begin();
            let line = body.line();
            let whole = fill(&mut row, chosen, body, element, budget)?;
            if whole.is_err() && !body.goes_on() {
                return Err(cut_off(element, i));
            }
            body.end();
            uncharged += FACE_COST + CORNER_COST * row.len() as u64;
            if uncharged > BLOCK {
                let element = || format!("element {}", String::from_utf8_lossy(element.name));
                budget.charge(std::mem::take(&mut uncharged), 1, element)?;
            }
            if whole.is_err() || row.iter().any(|index| index.is_nan()) {
                let place = || line.map_or_else(|| format!("face {i}"), |line| format!("line {line}"));
                self.losses.add(Flaw::Unreadable, 1, place);
            } else if shape == Shape::Polygons {
                row.iter().for_each(|index| self.corner(*index));
                self.ends.push(self.corners.len() as u32);
            } else {
                self.strip(&row);
            }
            if self.corners.len() > u32::MAX as usize / 2 {
                return Err(budget.exceeded("the faces".into()));
            }
        }
        budget.charge(uncharged, 1, || "the faces".into())
    }

    fn corner(&mut self, index: f64) {
        let valid = index >= 0.0 && index < f64::from(MISSING) && index.fract() == 0.0;
        if !valid {
            self.odd.get_or_insert(index);
        }
        self.corners.push(if valid { index as u32 } else { MISSING });
    }

    /// Every second triangle of a strip is turned, so that all face the same way; a negative index begins a new strip.
    fn strip(&mut self, row: &[f64]) {
        // As an unsigned number, -1 is greater than any vertex.
        let restarts = |index: &f64| *index < 0.0 || *index >= f64::from(MISSING);
        for strip in row.split(restarts) {
            for (i, w) in strip.windows(3).enumerate() {
                let [a, b, c] = if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] };
                // Strips are joined by triangles without area.
                if a != b && b != c && c != a {
                    [a, b, c].into_iter().for_each(|index| self.corner(index));
                    self.ends.push(self.corners.len() as u32);
                }
            }
        }
    }
}

/// The property of `element` that lists corners, by name or else because no other can.
fn corners_of(element: &Element<'_>) -> Option<usize> {
    let lists = |property: &Property<'_>| property.list.is_some();
    let known = |p: &Property<'_>| lists(p) && p.is(&["vertex_indices", "vertex_index", "vertex_indexes", "vertices"]);
    let possible = |p: &Property<'_>| lists(p) && p.scalar.is_integer();
    element.properties.iter().position(known).or_else(|| element.properties.iter().position(possible))
}

/// Reads a row, and of it the list `chosen` into `row`.
fn fill(
    row: &mut Vec<f64>,
    chosen: Option<usize>,
    body: &mut Body<'_>,
    element: &Element<'_>,
    budget: &Budget,
) -> Result<std::result::Result<(), End>> {
    row.clear();
    for (p, property) in element.properties.iter().enumerate() {
        let count = match property.list {
            None => Ok(Some(1)),
            Some(length) => body.length(length, property.scalar),
        };
        let Ok(Some(count)) = count else { return Ok(Err(End)) };
        if Some(p) != chosen {
            if body.skip(property.scalar, count as u64).is_err() {
                return Ok(Err(End));
            }
            continue;
        }
        if count as u64 > BLOCK {
            budget.charge(count as u64, 16, || "the faces".into())?;
        }
        for _ in 0..count {
            match body.scalar(property.scalar) {
                Ok(index) => row.push(index),
                Err(end) => return Ok(Err(end)),
            }
        }
    }
    Ok(Ok(()))
}
