//! ASCII STL, word by word: no two programs break its lines alike.
//!
//! A facet is the corners between two words that are about facets or loops; of the others only `vertex` and `solid`, with the
//! name after it, matter.

use super::Facets;
use crate::plain::text::{Words, number};
use crate::shared::error::{Result, malformed};
use crate::shared::limits::Budget;

/// Bytes of a corner, as it is read and as it is passed on.
const CORNER_COST: u64 = 2 * 24 + 16;

/// The facets of `text`, or `None` if it has nothing that STL has.
pub(super) fn read(text: &[u8], budget: &Budget) -> Result<Option<Facets>> {
    let mut reader = Reader { words: Words::new(text, 1), facets: Facets::default(), start: 0, known: false };
    let mut bounded = false;
    let mut uncharged = 0;
    while let Some(word) = reader.words.next() {
        match keyword(word) {
            Some(Keyword::Vertex) => {
                reader.vertex();
                uncharged += CORNER_COST;
            }
            Some(Keyword::Bound) => {
                bounded = true;
                reader.bound();
            }
            Some(Keyword::Solid) => {
                reader.bound();
                reader.name();
            }
            None => {}
        }
        if uncharged > 1 << 20 {
            budget.charge(std::mem::take(&mut uncharged), 1, || "the file".into())?;
        }
    }
    budget.charge(uncharged, 1, || "the file".into())?;
    let Reader { mut facets, start, known, .. } = reader;
    if !known {
        return Ok(None);
    }
    // Where there is nothing but corners, they are taken three by three.
    let count = facets.corners.len();
    let whole = if bounded { start == count } else { count.is_multiple_of(3) };
    if !whole {
        return Err(malformed("the file", "ends within a facet", "its end is missing: copy or download it again"));
    }
    if facets.corners.len() == 3 * facets.ends.len() && facets.ends.iter().zip(1..).all(|((end, _), i)| *end == 3 * i) {
        facets.ends.clear();
    }
    Ok(Some(facets))
}

enum Keyword {
    Vertex,
    /// Begins or ends a facet or a loop.
    Bound,
    /// Begins or ends a solid; its name follows.
    Solid,
}

fn keyword(word: &[u8]) -> Option<Keyword> {
    let is = |keyword: &str| word.eq_ignore_ascii_case(keyword.as_bytes());
    let begins = |keyword: &str| word.get(..keyword.len()).is_some_and(|w| w.eq_ignore_ascii_case(keyword.as_bytes()));
    match word.first()?.to_ascii_lowercase() {
        b'v' if is("vertex") => Some(Keyword::Vertex),
        b'f' if is("facet") => Some(Keyword::Bound),
        b'o' if is("outer") => Some(Keyword::Bound),
        b'l' if is("loop") => Some(Keyword::Bound),
        b's' if is("solid") => Some(Keyword::Solid),
        // Of names, some programs write the first word without a space.
        b'e' if begins("endsolid") => Some(Keyword::Solid),
        b'e' if is("end") || begins("endloop") || begins("endfacet") => Some(Keyword::Bound),
        _ => None,
    }
}

struct Reader<'a> {
    words: Words<'a>,
    facets: Facets,
    /// Where the facet begins that is read.
    start: usize,
    /// Whether any word was one of STL's.
    known: bool,
}

impl Reader<'_> {
    /// Takes the numbers after `vertex`. One that is missing or none makes a corner that is nowhere.
    fn vertex(&mut self) {
        let mut corner = [f64::NAN; 3];
        for coordinate in &mut corner {
            let before = self.words.clone();
            match self.words.next().map(|word| (number(word), keyword(word))) {
                Some((Some(value), _)) => *coordinate = value,
                Some((None, Some(_))) => {
                    self.words = before;
                    break;
                }
                _ => {}
            }
        }
        self.known = true;
        self.facets.corners.push(corner);
    }

    /// Ends the facet, if one has begun.
    fn bound(&mut self) {
        self.known = true;
        let end = self.facets.corners.len();
        if end > self.start {
            // The number of corners is checked when all are known.
            self.facets.ends.push((end as u32, self.words.line as u32));
            self.start = end;
        }
    }

    /// Passes over a name, which may hold any words: it ends with the line, or before `facet normal`.
    fn name(&mut self) {
        let mut before = self.words.clone();
        let mut facet = false;
        while let Some(word) = self.words.on_line() {
            if facet && word.eq_ignore_ascii_case(b"normal") {
                self.words = before;
                return;
            }
            facet = word.eq_ignore_ascii_case(b"facet");
            if facet {
                self.bound();
            }
            before = self.words.clone();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Limits;

    const FILE: &str = "solid a\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   \
                        vertex 0 1e0 -.5\n  endloop\n endfacet\nendsolid a\n";

    fn facets(text: &str) -> Facets {
        read(text.as_bytes(), &Budget::new(Limits::default())).unwrap().unwrap()
    }

    #[test]
    fn however_it_is_written() {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, -0.5]];
        for text in [
            FILE.to_owned(),
            FILE.to_uppercase(),
            FILE.replace('\n', "\r"),
            FILE.replace('\n', "\r\n"),
            FILE.replace('\n', " "),
            FILE.replace("   vertex", " \n\n\tvertex\n"),
            FILE.replace("\n   vertex", " vertex"),
            FILE.replace("endloop", "end loop").replace("endfacet", "end facet").replace("endsolid", "end solid"),
            FILE.replace("endsolid a", "endsolida"),
            FILE.replace("solid a", "solid a vertex loop # facet"),
            FILE.replace("solid a", "solid my facet").replace('\n', " "),
            FILE.replace("solid a\n", ""),
            FILE.replace("endsolid a\n", ""),
            FILE.replace("0 0 0\n", "0 0 0 # first\n").replace(" facet", "# one\n facet"),
            FILE.replace(" facet normal 0 0 1\n  outer loop\n", ""),
            FILE.replace("normal 0 0 1", "normal 0 0 1 color 0.1 0.2 0.3"),
            FILE.lines().filter(|line| line.contains("vertex")).collect::<Vec<_>>().join("\n"),
        ] {
            let facets = facets(&text);
            assert_eq!((facets.corners.as_slice(), facets.ends.len()), (corners.as_slice(), 0), "{text:?}");
        }
        assert_eq!(facets(&FILE.repeat(2)).corners, [corners, corners].concat(), "every solid of a file");
    }

    #[test]
    fn one_odd_facet_changes_no_other() {
        for (odd, expected) in [
            ("vertex 0 0 0 vertex 1 0 0", [3, 5, 8]),
            ("vertex 0 0 0 vertex 1 0 0 vertex 1 1 0 vertex 0 1 0", [3, 7, 10]),
        ] {
            let text = format!("{FILE}facet normal 0 0 0 outer loop {odd} endloop endfacet\n{FILE}");
            let facets = facets(&text);
            assert_eq!(facets.ends.iter().map(|(end, _)| *end).collect::<Vec<_>>(), expected);
            assert_eq!(facets.ends[1].1, 10, "its line");
        }
    }

    #[test]
    fn numbers_that_are_none() {
        let corner = |text: &str| facets(&FILE.replace("1 0 0", text)).corners[1];
        assert_eq!(corner("0,5 +1 2."), [0.5, 1.0, 2.0]);
        assert!(corner("1 x 0")[1].is_nan() && corner("1 x 0")[2] == 0.0);
        assert!(corner("1 2")[2].is_nan());
        assert_eq!(facets(&FILE.replace("1 0 0", "1 2")).corners.len(), 3);
    }

    #[test]
    fn what_is_not_stl() {
        let of = |text: &str| read(text.as_bytes(), &Budget::new(Limits::default())).map_err(|e| e.to_string());
        assert!(of("").unwrap().is_none() && of("something else").unwrap().is_none());
        assert!(of(&FILE[..FILE.find("   vertex 0 1e0").unwrap()]).is_err_and(|e| e.contains("within a facet")));
    }
}
