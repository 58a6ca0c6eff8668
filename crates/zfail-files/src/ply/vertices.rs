//! The vertices of a .ply file: of the properties in whatever order, those that a scene knows.

use super::body::Body;
use super::cut_off;
use super::header::{Element, Scalar};
use crate::plain::{full_channel, linear};
use crate::shared::error::{Result, malformed};
use crate::shared::limits::Budget;

/// Attributes have the length of `positions`, or are absent.
#[derive(Default)]
pub(super) struct Vertices {
    /// Not finite where the file has no number.
    pub positions: Vec<[f64; 3]>,
    pub normals: Option<Vec<[f32; 3]>>,
    /// As stored: v grows upwards.
    pub uv: Option<Vec<[f32; 2]>>,
    /// Linear RGBA.
    pub colors: Option<Vec<[f32; 4]>>,
    /// How many rows have ended early.
    pub short: usize,
}

/// Names of properties, by where their values stand in a row.
const NAMES: [&[&str]; 12] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx"],
    &["ny"],
    &["nz"],
    &["s", "u", "texture_u"],
    &["t", "v", "texture_v"],
    &["red", "r", "diffuse_red"],
    &["green", "g", "diffuse_green"],
    &["blue", "b", "diffuse_blue"],
    &["alpha", "a", "diffuse_alpha"],
];
const NORMAL: usize = 3;
const UV: usize = 6;
const COLOR: usize = 8;

/// What a vertex is charged with.
const VERTEX_COST: u64 = 2 * (24 + 12 + 8 + 16 + 12);
/// How many rows are charged together.
const BLOCK: u64 = 4096;

pub(super) fn read(body: &mut Body<'_>, element: &Element<'_>, budget: &Budget) -> Result<Vertices> {
    let slot = |names: &[&str]| element.properties.iter().position(|p| p.list.is_none() && p.is(names));
    let slots = NAMES.map(slot);
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        if slots[axis].is_none() {
            let remedy = "export it again with the coordinates of its vertices";
            return Err(malformed("element vertex", format!("has no property {name}"), remedy));
        }
    }
    let mut slot_of = vec![None; element.properties.len()];
    slots.iter().enumerate().for_each(|(slot, property)| property.iter().for_each(|p| slot_of[*p] = Some(slot)));
    let has = |slot: usize| slots[slot].is_some();
    let mut vertices = Vertices {
        positions: Vec::new(),
        normals: has(NORMAL).then(Vec::new),
        uv: has(UV).then(Vec::new),
        colors: has(COLOR).then(Vec::new),
        short: 0,
    };
    for i in 0..element.count {
        if i % BLOCK == 0 {
            budget.charge(BLOCK.min(element.count - i).min(body.left() as u64 + 1), VERTEX_COST, || {
                "element vertex".into()
            })?;
        }
        let mut row = [0.0; 12];
        row[..3].fill(f64::NAN);
        body.begin();
        if fill(&mut row, body, element, &slot_of).is_err() {
            if !body.goes_on() {
                return Err(cut_off(element, i));
            }
            vertices.short += 1;
        }
        body.end();
        vertices.push(&row);
    }
    let kind = |slot: usize| slots[slot].map(|property| element.properties[property].scalar);
    if let Some(colors) = &mut vertices.colors {
        make_linear(colors, [0, 1, 2, 3].map(|channel| kind(COLOR + channel)));
    }
    Ok(vertices)
}

fn fill(
    row: &mut [f64; 12],
    body: &mut Body<'_>,
    element: &Element<'_>,
    slots: &[Option<usize>],
) -> std::result::Result<(), super::body::End> {
    for (property, slot) in element.properties.iter().zip(slots) {
        match property.list {
            Some(length) => {
                let count = body.length(length, property.scalar)?.ok_or(super::body::End)?;
                body.skip(property.scalar, count as u64)?;
            }
            None => {
                let value = body.scalar(property.scalar)?;
                if let Some(slot) = slot {
                    row[*slot] = value;
                }
            }
        }
    }
    Ok(())
}

/// What a colour channel of type `scalar` has where it is full.
fn full(scalar: Scalar) -> f32 {
    match scalar {
        Scalar::I8 => 127.0,
        Scalar::I16 => 32767.0,
        Scalar::U16 => 65535.0,
        Scalar::F32 | Scalar::F64 => 1.0,
        // Wider integers hold bytes all the same.
        _ => 255.0,
    }
}

/// Colours as they are stored in channels of these types, if there are any, made linear; alpha is.
fn make_linear(colors: &mut [[f32; 4]], kinds: [Option<Scalar>; 4]) {
    let greatest = colors.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).fold(0.0, f32::max);
    let [r, g, b, a] = kinds.map(|kind| match kind.map(full) {
        Some(1.0) => full_channel(greatest),
        full => full.unwrap_or(1.0),
    });
    for color in colors {
        let channel = |i: usize, full: f32| linear((color[i] / full).clamp(0.0, 1.0));
        let alpha = if kinds[3].is_some() { (color[3] / a).clamp(0.0, 1.0) } else { 1.0 };
        *color = [channel(0, r), channel(1, g), channel(2, b), alpha];
    }
}

impl Vertices {
    fn push(&mut self, row: &[f64; 12]) {
        let [x, y, z, nx, ny, nz, u, v, r, g, b, a] = *row;
        self.positions.push([x, y, z]);
        if let Some(normals) = &mut self.normals {
            normals.push([nx, ny, nz].map(|x| x as f32));
        }
        if let Some(uv) = &mut self.uv {
            uv.push([u, v].map(|x| x as f32));
        }
        if let Some(colors) = &mut self.colors {
            colors.push([r, g, b, a].map(|x| x as f32));
        }
    }
}
