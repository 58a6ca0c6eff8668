//! Binary STL: 80 bytes of title, the number of triangles, and 50 bytes for each.
//!
//! A file is binary if its length fits its number of triangles: many binary files begin with `solid`, as ASCII ones do.

use super::Facets;
use crate::shared::error::{Result, malformed};
use crate::shared::limits::Budget;

const HEADER: usize = 84;
const RECORD: usize = 50;

/// The records of a file that is binary.
pub(super) struct Layout<'a> {
    records: &'a [[u8; RECORD]],
    /// How many triangles the file says that it has.
    said: usize,
}

impl<'a> Layout<'a> {
    /// `None` of a file that is not binary.
    ///
    /// # Errors
    /// If it is, but its end is missing.
    pub fn of(bytes: &'a [u8]) -> Result<Option<Self>> {
        let Some((header, body)) = bytes.split_first_chunk::<HEADER>() else { return Ok(None) };
        let [.., a, b, c, d] = *header;
        let said = u32::from_le_bytes([a, b, c, d]) as usize;
        let (records, rest) = body.as_chunks();
        let whole = rest.is_empty() && !records.is_empty();
        // Some programs leave bytes behind the last triangle, or never put their number into the title.
        let fits = said.checked_mul(RECORD) == Some(body.len());
        if fits || (!is_text(bytes) && said > 0 && said <= records.len()) {
            return Ok(Some(Self { records: &records[..said], said }));
        }
        if is_text(bytes) {
            return Ok(None);
        }
        if whole {
            return Ok(Some(Self { records, said }));
        }
        if said == 0 || records.is_empty() {
            return Ok(None);
        }
        let problem = format!("says that it has {said} triangles, but ends after {}", records.len());
        Err(malformed("the file", problem, "its end is missing: copy or download it again"))
    }

    pub fn read(&self, budget: &Budget) -> Result<Facets> {
        // A triangle is three corners in double precision, and three in single precision with their indices.
        budget.charge(self.records.len() as u64, 72 + 48, || "the file".into())?;
        let float = |b: &[u8; 4]| f64::from(f32::from_le_bytes(*b));
        let mut corners = Vec::with_capacity(3 * self.records.len());
        for record in self.records {
            corners.extend(record[12..48].as_chunks::<12>().0.iter().map(|corner| {
                let [x, y, z] = [0, 1, 2].map(|c| corner.as_chunks().0[c]);
                [float(&x), float(&y), float(&z)]
            }));
        }
        let mut notices = Vec::new();
        if self.said != self.records.len() {
            notices.push(format!(
                "says that it has {} triangles, but has {}: all are shown",
                self.said,
                self.records.len()
            ));
        }
        Ok(Facets { corners, ends: Vec::new(), notices })
    }
}

/// Whether the file begins as text does, and goes on so.
fn is_text(bytes: &[u8]) -> bool {
    const ENOUGH: usize = 1024;
    let (begin, wide) = match bytes {
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => (bytes, true),
        [0xef, 0xbb, 0xbf, text @ ..] => (text, false),
        _ => (bytes, false),
    };
    let begin = &begin[..begin.len().min(ENOUGH)];
    let wide = wide || matches!(begin, [1..0x80, 0, 1..0x80, 0, ..] | [0, 1..0x80, 0, 1..0x80, ..]);
    wide || !begin.iter().any(|b| *b < b' ' && !b.is_ascii_whitespace() && *b != 0x0b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Limits;

    fn file(title: &[u8], said: u32, triangles: usize) -> Vec<u8> {
        let mut bytes = title.to_vec();
        bytes.resize(80, b' ');
        bytes.extend(said.to_le_bytes());
        bytes.resize(HEADER + RECORD * triangles, 0);
        bytes
    }

    fn triangles(bytes: &[u8]) -> std::result::Result<Option<usize>, String> {
        let layout = Layout::of(bytes).map_err(|e| e.to_string())?;
        let facets = layout.map(|layout| layout.read(&Budget::new(Limits::default())).unwrap());
        Ok(facets.map(|facets| facets.corners.len() / 3))
    }

    #[test]
    fn the_length_decides() {
        for title in [b"".as_slice(), b"solid binary", b"COLOR=abcd"] {
            assert_eq!(triangles(&file(title, 2, 2)), Ok(Some(2)));
            assert_eq!(triangles(&[file(title, 2, 2), vec![7; 3]].concat()), Ok(Some(2)), "bytes behind");
            assert_eq!(triangles(&file(title, 0, 2)), Ok(Some(2)), "never counted");
            assert_eq!(triangles(&file(title, 9, 2)), Ok(Some(2)));
            assert!(triangles(&file(title, 2, 2)[..170]).unwrap_err().contains("ends after 1"));
        }
        assert_eq!(triangles(&[b' '; 900]), Ok(None), "text");
        assert_eq!(triangles(b"solid"), Ok(None));
        assert_eq!(triangles(&file(b"", 0, 0)), Ok(Some(0)));
    }
}
