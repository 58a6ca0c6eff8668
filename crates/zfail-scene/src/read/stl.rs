//! .stl files, binary and ASCII.
//!
//! In: bytes. Out: triangles without shared vertices; the format has no others. Stored normals are not used: they follow
//! from the corners, and many programs write zeros.
//!
//! A file is binary if its length fits its triangle count: many binary files begin with `solid` too.

use super::error::{Result, malformed};
use super::limits::Budget;
use super::plain::{Part, Plain, Z_UP, check_finite, grey, nothing_to_draw};

const FORMAT: &str = "STL";
const HEADER: usize = 84;
const RECORD: usize = 50;

/// Reads the solids of a file into one part.
pub(super) fn read(bytes: &[u8], budget: &Budget) -> Result<Plain> {
    // The corners and, of an ASCII file, the text in UTF-8.
    budget.charge(bytes.len() as u64, 4, || "the file".into())?;
    let positions = match records(bytes) {
        Some(records) => binary(records),
        None if bytes.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid")) => {
            ascii(&String::from_utf8_lossy(bytes))?
        }
        None => {
            let problem =
                "is neither ASCII, beginning with `solid`, nor as long as the number of triangles at byte 80 says";
            return Err(malformed(FORMAT, "the file", problem));
        }
    };
    if positions.is_empty() {
        return Err(nothing_to_draw(FORMAT, "has no triangles"));
    }
    check_finite(FORMAT, "corner", &positions)?;
    let count = u32::try_from(positions.len()).map_err(|_| budget.exceeded("the file".into()))?;
    let triangles = (0..count / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    let notices = vec!["STL has neither axes nor units: z is taken as up, and one unit as one metre".into()];
    Ok(Plain {
        format: FORMAT,
        parts: vec![Part { positions, triangles, ..Part::default() }],
        materials: vec![grey("STL".into())],
        images: Vec::new(),
        world_from_file: Z_UP,
        notices,
    })
}

/// The records of a binary file. Some programs leave bytes behind the last one.
fn records(bytes: &[u8]) -> Option<&[[u8; RECORD]]> {
    let count = u32::from_le_bytes(*bytes.get(80..HEADER)?.first_chunk()?) as usize;
    let records = bytes.get(HEADER..HEADER.checked_add(count.checked_mul(RECORD)?)?)?;
    let text = bytes.starts_with(b"solid") && bytes.len() != HEADER + records.len();
    if text { None } else { Some(records.as_chunks().0) }
}

fn binary(records: &[[u8; RECORD]]) -> Vec<[f32; 3]> {
    let float = |b: &[u8; 4]| f32::from_le_bytes(*b);
    let corners = records.iter().flat_map(|record| record[12..48].as_chunks::<12>().0);
    corners
        .map(|corner| {
            let [x, y, z] = [0, 1, 2].map(|c| corner.as_chunks().0[c]);
            [float(&x), float(&y), float(&z)]
        })
        .collect()
}

/// Takes `vertex` lines three by three; of the words around them, only the end of a facet matters.
fn ascii(text: &str) -> Result<Vec<[f32; 3]>> {
    let mut corners: Vec<[f32; 3]> = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let fault = |problem: &str| malformed(FORMAT, format!("line {}", i + 1), problem);
        let mut words = line.split_ascii_whitespace();
        match words.next().map(str::to_ascii_lowercase).as_deref() {
            Some("vertex") => {
                let mut number = || words.next()?.parse::<f32>().ok();
                let corner = (number(), number(), number());
                let (Some(x), Some(y), Some(z)) = corner else {
                    return Err(fault("needs three numbers after `vertex`"));
                };
                corners.push([x, y, z]);
            }
            Some("endfacet") if !corners.len().is_multiple_of(3) => {
                return Err(fault("ends a facet that has not three corners"));
            }
            None | Some("facet" | "outer" | "endloop" | "endfacet" | "solid" | "endsolid" | "color") => {}
            Some(_) => return Err(fault("is not a line of an ASCII STL file")),
        }
    }
    if corners.len().is_multiple_of(3) {
        Ok(corners)
    } else {
        Err(malformed(FORMAT, "the file", "ends within a facet"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read::Limits;

    const ASCII: &str = "solid a\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   \
                         vertex 0 1e0 -.5\n  endloop\n endfacet\nendsolid a\n";

    fn positions(bytes: &[u8]) -> std::result::Result<Vec<[f32; 3]>, String> {
        read(bytes, &Budget::new(Limits::default())).map(|mut p| p.parts.remove(0).positions).map_err(|e| e.to_string())
    }

    fn file(title: &[u8], corners: &[[f32; 3]]) -> Vec<u8> {
        let mut bytes = title.to_vec();
        bytes.resize(80, 0);
        bytes.extend((corners.len() as u32 / 3).to_le_bytes());
        for triangle in corners.chunks(3) {
            bytes.extend([0; 12]);
            bytes.extend(triangle.iter().flatten().flat_map(|x| x.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    #[test]
    fn both_encodings() {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, -0.5]];
        for bytes in [ASCII.into(), file(b"solid binary", &corners), file(b"", &corners), ASCII.to_uppercase().into()] {
            assert_eq!(positions(&bytes).unwrap(), corners);
        }
        let twice = positions(ASCII.repeat(2).as_bytes()).unwrap();
        assert_eq!(twice, [corners, corners].concat(), "every solid of a file");
        let padded = [file(b"", &corners), vec![7; 3]].concat();
        assert_eq!(positions(&padded).unwrap(), corners);
    }

    #[test]
    fn damage_is_reported() {
        for (bytes, expected) in [
            (b"".to_vec(), "neither ASCII"),
            (file(b"", &[]), "no triangles"),
            (b"solid nothing".to_vec(), "no triangles"),
            (file(b"", &[[0.0; 3]; 3])[..130].to_vec(), "neither ASCII"),
            (file(b"", &[[0.0; 3], [f32::NAN, 0.0, 0.0], [0.0; 3]]), "corner 1: has a coordinate"),
            (ASCII.replace("1e0", "x").into(), "line 6: needs three numbers"),
            (ASCII.replace("   vertex 1 0 0\n", "").into(), "line 7: ends a facet"),
            (ASCII.replace("outer", "inner").into(), "line 3: is not a line"),
            (ASCII[..ASCII.find("   vertex 0 1e0").unwrap()].into(), "within a facet"),
        ] {
            let error = positions(&bytes).unwrap_err();
            assert!(error.contains(expected), "{error:?} lacks {expected:?}");
        }
    }
}
