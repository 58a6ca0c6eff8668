//! Faces that cannot be drawn: left out one by one, and told of together.
//!
//! In: what was wrong with each. Out: notices, or the fault of a file that has nothing else.

use super::points::is_usable;
use crate::shared::error::{Fault, malformed};

/// Why a face cannot be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Flaw {
    /// It has fewer than three corners.
    Short,
    /// A corner is not there.
    Missing(u32),
    /// A corner is nowhere.
    Nowhere,
    /// It is not spelt as its format wants it.
    Unreadable,
}

/// The flaw of a face with `corners`, if it has one.
pub(crate) fn flaw(corners: impl ExactSizeIterator<Item = u32>, points: &[[f64; 3]]) -> Option<Flaw> {
    if corners.len() < 3 {
        return Some(Flaw::Short);
    }
    for corner in corners {
        match points.get(corner as usize) {
            None => return Some(Flaw::Missing(corner)),
            Some(point) if !is_usable(point) => return Some(Flaw::Nowhere),
            Some(_) => {}
        }
    }
    None
}

/// How many faces were left out, by flaw, with a word about the first of each.
#[derive(Default)]
pub(crate) struct Losses([(usize, String); 4]);

impl Losses {
    /// Counts a face, or `count` triangles of it; `first` describes it.
    pub fn add(&mut self, flaw: Flaw, count: usize, first: impl FnOnce() -> String) {
        let kind = match flaw {
            Flaw::Nowhere => 0,
            Flaw::Missing(_) => 1,
            Flaw::Unreadable => 2,
            Flaw::Short => 3,
        };
        let (faces, example) = &mut self.0[kind];
        if *faces == 0 {
            *example = first();
        }
        *faces += count;
    }

    /// What to tell of a file of which something else is drawn.
    pub fn notices(&self) -> impl Iterator<Item = String> {
        let notice = |((count, first), (thing, problem)): (&(usize, String), (&str, &str))| {
            let verb = if *count == 1 { "is" } else { "are" };
            (*count > 0).then(|| format!("{} {problem} {verb} left out ({first})", counted(*count, thing)))
        };
        self.0.iter().zip(KINDS).filter_map(notice)
    }

    /// The fault of a file that has no other faces; `otherwise` if it has none at all.
    pub fn fault(&self, otherwise: impl FnOnce() -> Fault) -> Fault {
        let Some(((_, first), (thing, problem))) = self.0.iter().zip(KINDS).find(|((count, _), _)| *count > 0) else {
            return otherwise();
        };
        let problem = format!("has no {thing}s but those {problem} ({first})");
        malformed("the file", problem, "export it again from the program that it comes from")
    }
}

/// What is counted of each flaw, and how it is told of.
const KINDS: [(&str, &str); 4] = [
    ("triangle", "with a vertex that is not finite, or beyond 5e14,"),
    ("face", "with a vertex that is not there"),
    ("face", "that cannot be read"),
    ("face", "of fewer than three corners"),
];

/// `count` of a thing in words.
pub(crate) fn counted(count: usize, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flaws() {
        let points = [[0.0; 3], [1.0; 3], [f64::NAN; 3]];
        let of = |corners: &[u32]| flaw(corners.iter().copied(), &points);
        assert_eq!(of(&[0, 1, 1]), None);
        assert_eq!(of(&[0, 1]), Some(Flaw::Short));
        assert_eq!(of(&[0, 1, 3]), Some(Flaw::Missing(3)));
        assert_eq!(of(&[0, 1, 2]), Some(Flaw::Nowhere));
    }

    #[test]
    fn every_kind_is_told_of_once() {
        let mut losses = Losses::default();
        assert_eq!(losses.notices().count(), 0);
        losses.add(Flaw::Missing(9), 1, || "line 1".into());
        losses.add(Flaw::Missing(8), 1, || unreachable!("only the first is described"));
        losses.add(Flaw::Nowhere, 1, || "line 3".into());
        let notices: Vec<String> = losses.notices().collect();
        assert_eq!(notices[0], "1 triangle with a vertex that is not finite, or beyond 5e14, is left out (line 3)");
        assert_eq!(notices[1], "2 faces with a vertex that is not there are left out (line 1)");
    }
}
