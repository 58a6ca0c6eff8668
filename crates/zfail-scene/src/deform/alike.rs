//! Which vertices of a mesh that bends move as one.
//!
//! In: its sections. Out: a number per vertex, equal where position, joints, weights and displacements are equal bit for bit,
//! so that every pose computes the same position. Duplicates along seams of texture or normals are alike; vertices that
//! merely lie in one place before they are bent are not, and stay apart for shadow volumes.

use super::Section;
use rayon::prelude::*;
use std::cmp::Ordering;

/// One vertex.
#[derive(Clone, Copy)]
struct At<'a> {
    section: &'a Section,
    vertex: usize,
}

/// A number per vertex, over all sections in order.
pub fn alike(sections: &[Section]) -> Vec<u32> {
    let targets = sections.iter().map(|section| section.targets.len()).max().unwrap_or(0);
    let mut order: Vec<(At<'_>, usize)> = sections.iter().flat_map(vertices).zip(0..).collect();
    order.par_sort_unstable_by(|a, b| compare(a.0, b.0, targets).then(a.1.cmp(&b.1)));
    let mut numbers = vec![0; order.len()];
    let mut number = 0;
    for (i, &(at, index)) in order.iter().enumerate() {
        if i > 0 && compare(order[i - 1].0, at, targets).is_ne() {
            number += 1;
        }
        numbers[index] = number;
    }
    numbers
}

fn vertices(section: &Section) -> impl Iterator<Item = At<'_>> {
    (0..section.positions.len()).map(move |vertex| At { section, vertex })
}

fn compare(a: At<'_>, b: At<'_>, targets: usize) -> Ordering {
    let position = |at: At<'_>| bits(at.section.positions[at.vertex]);
    position(a)
        .cmp(&position(b))
        .then_with(|| a.influences().cmp(b.influences()))
        .then_with(|| a.displacements(targets).cmp(b.displacements(targets)))
}

impl<'a> At<'a> {
    fn influences(self) -> impl Iterator<Item = (u32, u32)> + 'a {
        self.section.influences_of(self.vertex).map(|(joint, weight)| (joint, weight.to_bits()))
    }

    /// A missing target displaces as one of zeros does.
    fn displacements(self, targets: usize) -> impl Iterator<Item = [u32; 3]> + 'a {
        let target = move |t: usize| self.section.targets.get(t)?.positions.get(self.vertex).copied();
        (0..targets).map(move |t| bits(target(t).unwrap_or_default()))
    }
}

/// Equal exactly for equal vectors: -0.0 becomes 0.0.
fn bits(v: [f32; 3]) -> [u32; 3] {
    v.map(|x| (x + 0.0).to_bits())
}

#[cfg(test)]
mod tests {
    use super::super::{Influences, Target};
    use super::*;

    fn section(positions: &[[f32; 3]]) -> Section {
        Section { positions: positions.to_vec(), ..Section::default() }
    }

    #[test]
    fn everything_that_moves_a_vertex_counts() {
        let p = [1.0, 2.0, 3.0];
        let two = section(&[p, p]);
        assert_eq!(alike(std::slice::from_ref(&two)), [0, 0]);
        assert_eq!(alike(&[section(&[[0.0; 3], [-0.0; 3]])]), [0, 0]);
        assert_ne!(alike(&[section(&[p, [1.0, 2.0, 3.5]])]), [0, 0]);

        let influences = |joints: [u32; 4], weights: [f32; 4]| {
            let influences = Influences { width: 2, joints: joints.to_vec(), weights: weights.to_vec() };
            alike(&[Section { influences: Some(influences), ..two.clone() }])
        };
        assert_eq!(influences([0, 1, 0, 1], [0.5; 4]), [0, 0]);
        assert_eq!(influences([0, 1, 0, 9], [1.0, 0.0, 1.0, 0.0]), [0, 0], "unused joints do not count");
        assert_ne!(influences([0, 1, 0, 2], [0.5; 4]), [0, 0]);
        assert_ne!(influences([0, 1, 0, 1], [0.5, 0.5, 0.5, 0.25]), [0, 0]);

        let target = |by: [f32; 3]| Target { positions: vec![[0.0; 3], by], ..Target::default() };
        let displaced = |by| alike(&[Section { targets: vec![Target::default(), target(by)], ..two.clone() }]);
        assert_eq!(displaced([0.0; 3]), [0, 0]);
        assert_ne!(displaced([0.0, 0.0, 1.0]), [0, 0]);
    }

    #[test]
    fn sections_are_compared_with_each_other() {
        let [a, b] = [[0.0; 3], [1.0; 3]];
        assert_eq!(alike(&[section(&[a, b]), section(&[b, a])]), [0, 1, 1, 0]);
        let still = Section { targets: vec![Target::default()], ..section(&[a]) };
        assert_eq!(alike(&[section(&[a]), still]), [0, 0], "a target of zeros is none");
    }
}
