//! The statements of an .obj file, one after the other.
//!
//! In: its text. Out: vertices, attributes and faces as the file numbers them, and the names of materials and libraries.
//! Groups and objects are passed over: a body that is cut into groups stays closed only in one mesh.

use crate::plain::losses::{Flaw, Losses};
use crate::plain::text::{Lines, number, shown, split_word, trim, uncommented, words};
use crate::shared::error::Result;
use crate::shared::limits::Budget;
use std::collections::BTreeMap;

/// An attribute that a corner does not name.
pub(super) const ABSENT: u32 = u32::MAX;
/// An index of something that is not there, whatever else the file holds.
pub(super) const MISSING: u32 = u32::MAX - 1;

/// A polygon.
pub(super) struct Face {
    /// Where it ends among the corners.
    pub end: u32,
    pub line: u32,
    /// Index into [`Statements::materials`].
    pub material: u32,
}

/// What an .obj file says.
#[derive(Default)]
pub(super) struct Statements<'a> {
    /// Not finite where the file has no number.
    pub positions: Vec<[f64; 3]>,
    /// Of each position, as stored, NaN where there is none; empty if there is none at all.
    pub colors: Vec<[f32; 3]>,
    pub uv: Vec<[f32; 2]>,
    pub normals: Vec<[f32; 3]>,
    /// Position, texture coordinates and normal, from 0; they may be beyond what there is.
    pub corners: Vec<[u32; 3]>,
    pub faces: Vec<Face>,
    /// The names after `usemtl`; the first is empty, and stands for all before.
    pub materials: Vec<&'a [u8]>,
    /// What follows each `mtllib`.
    pub libraries: Vec<Vec<u8>>,
    /// The first number of a position that none can have.
    pub odd: Option<i64>,
    pub losses: Losses,
    /// How many points and lines there are.
    pub strokes: usize,
    /// How many free-form surfaces there are.
    pub freeform: usize,
    /// How many other files are called in.
    pub calls: usize,
}

/// What statements are charged with: what they become while vectors grow.
const VERTEX_COST: u64 = 2 * (24 + 12);
const CORNER_COST: u64 = 2 * (12 + 12) + 12;
const FACE_COST: u64 = 2 * (12 + 16);
const NAME_COST: u64 = 256;
/// How much is charged at once.
const BLOCK: u64 = 1 << 16;

impl<'a> Statements<'a> {
    pub fn read(text: &'a [u8], budget: &Budget) -> Result<Self> {
        let mut all = Self { materials: vec![b""], ..Self::default() };
        let mut known = BTreeMap::from([(b"".as_slice(), 0)]);
        let (mut material, mut uncharged) = (0, 0);
        let mut lines = Lines::new(text);
        while let Some(line) = lines.next() {
            let (keyword, rest) = split_word(line);
            uncharged += match keyword {
                b"v" => all.vertex(arguments(&mut lines)),
                b"vt" => {
                    let [u, v] = numbers(arguments(&mut lines), 0.0);
                    all.uv.push([u, v]);
                    VERTEX_COST
                }
                b"vn" => {
                    all.normals.push(numbers(arguments(&mut lines), f32::NAN));
                    VERTEX_COST
                }
                b"f" | b"fo" => {
                    let line = lines.number as u32;
                    all.face(arguments(&mut lines), line, material)
                }
                b"usemtl" => {
                    let name = trim(rest);
                    material = *known.entry(name).or_insert_with(|| {
                        all.materials.push(name);
                        all.materials.len() as u32 - 1
                    });
                    NAME_COST
                }
                b"mtllib" => {
                    all.libraries.push(on_one_line(split_word(lines.joined()).1));
                    NAME_COST
                }
                b"l" | b"p" => {
                    lines.joined();
                    all.strokes += 1;
                    0
                }
                b"surf" | b"bsp" | b"bzp" | b"cdc" | b"cdp" | b"res" => {
                    lines.joined();
                    all.freeform += 1;
                    0
                }
                b"call" => {
                    all.calls += 1;
                    0
                }
                // What they name may end in a backslash.
                b"o" | b"g" | b"" => 0,
                _ => {
                    lines.joined();
                    0
                }
            };
            if uncharged > BLOCK {
                budget.charge(std::mem::take(&mut uncharged), 1, || format!("line {}", lines.number))?;
            }
            if all.corners.len().max(all.positions.len()) > MISSING as usize / 2 {
                return Err(budget.exceeded(format!("line {}", lines.number)));
            }
        }
        budget.charge(uncharged, 1, || "the file".into())?;
        Ok(all)
    }

    /// A position, perhaps with a colour, and with a weight, which only free-form surfaces have a use for.
    fn vertex(&mut self, arguments: &[u8]) -> u64 {
        let mut values = [f64::NAN; 6];
        let mut count = 0;
        for word in words(arguments).take(6) {
            values[count] = number(word).unwrap_or(f64::NAN);
            count += 1;
        }
        let [x, y, z, r, g, b] = values;
        if count == 6 && self.colors.is_empty() {
            self.colors.resize(self.positions.len(), [f32::NAN; 3]);
        }
        if count == 6 || !self.colors.is_empty() {
            self.colors.push(if count == 6 { [r as f32, g as f32, b as f32] } else { [f32::NAN; 3] });
        }
        self.positions.push([x, y, z]);
        VERTEX_COST
    }

    fn face(&mut self, arguments: &[u8], line: u32, material: u32) -> u64 {
        let first = self.corners.len();
        for word in words(arguments) {
            match self.corner(word) {
                Some(corner) => self.corners.push(corner),
                None => {
                    self.losses.add(Flaw::Unreadable, 1, || format!("line {line}: `{}` is no corner", shown(word)));
                    self.corners.truncate(first);
                    return FACE_COST;
                }
            }
        }
        self.faces.push(Face { end: self.corners.len() as u32, line, material });
        FACE_COST + CORNER_COST * (self.corners.len() - first) as u64
    }

    /// `v`, `v/vt`, `v//vn` or `v/vt/vn`; negative numbers count from the last one so far.
    fn corner(&mut self, word: &[u8]) -> Option<[u32; 3]> {
        let mut parts = word.split(|b| *b == b'/');
        let said = index(parts.next()?)?;
        let position = from_start(said, self.positions.len());
        if position == MISSING {
            self.odd.get_or_insert(said);
        }
        let mut attribute = |count: usize| match parts.next() {
            None | Some(b"") => ABSENT,
            Some(part) => index(part).map_or(MISSING, |said| from_start(said, count)),
        };
        Some([position, attribute(self.uv.len()), attribute(self.normals.len())])
    }
}

/// What follows the keyword of a line, and of those that continue it.
fn arguments<'a>(lines: &mut Lines<'a>) -> &'a [u8] {
    split_word(uncommented(lines.joined())).1
}

/// The first numbers of `arguments`, `missing` where there is none.
fn numbers<const N: usize>(arguments: &[u8], missing: f32) -> [f32; N] {
    let mut values = [missing; N];
    for (value, word) in values.iter_mut().zip(words(arguments)) {
        *value = number(word).map_or(f32::NAN, |x| x as f32);
    }
    values
}

/// The whole number that `word` spells, the greatest there is if it is beyond.
fn index(word: &[u8]) -> Option<i64> {
    let (negative, digits) = match word {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    };
    if digits.is_empty() || !digits.iter().all(u8::is_ascii_digit) {
        let value = number(word).filter(|x| x.fract() == 0.0)?;
        return Some(value as i64);
    }
    let digit = |value: i64, digit: &u8| value.saturating_mul(10).saturating_add(i64::from(digit - b'0'));
    let value = digits.iter().fold(0, digit);
    Some(if negative { -value } else { value })
}

/// The index from 0 that `said` means where there are `count` so far.
fn from_start(said: i64, count: usize) -> u32 {
    let index = if said > 0 {
        said - 1
    } else if said < 0 {
        said.saturating_add(count as i64)
    } else {
        -1
    };
    u32::try_from(index).map_or(MISSING, |index| index.min(MISSING))
}

/// `text` without the ends of lines in it and the backslashes before them.
fn on_one_line(text: &[u8]) -> Vec<u8> {
    let lines = text.split(|b| matches!(b, b'\n' | b'\r')).map(trim);
    let lines: Vec<&[u8]> = lines.map(|line| line.strip_suffix(b"\\").unwrap_or(line)).collect();
    trim(&lines.join(b" ".as_slice())).to_vec()
}
