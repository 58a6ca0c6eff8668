//! Convex parts: what they hide from a light is a cone with planes for sides.
//!
//! In: parts with their shapes. Out: the largest part that is proved convex, with its edges. All predicates are exact.

use super::{Shape, Topology};
use robust::{Coord3D, orient3d};

/// More faces are not worth the planes.
const MOST: usize = 64;

/// A solid part with every vertex on or behind the plane of every face.
#[derive(Clone, Debug)]
pub struct ConvexPart {
    /// Its faces, wound counter-clockwise seen from outside, as vertices of the topology.
    pub faces: Vec<[u32; 3]>,
    /// Its edges with the two faces (indices into `faces`) that meet there.
    pub edges: Vec<([u32; 2], [u8; 2])>,
}

/// The convex part of `topology` with the largest bounds.
pub(super) fn largest(topology: &Topology) -> Option<ConvexPart> {
    let mut candidates: Vec<usize> = (0..topology.parts.len())
        .filter(|&p| {
            let part = &topology.parts[p];
            part.triangles.len() <= MOST && part.shape == Shape::Solid { inside: 1 }
        })
        .collect();
    let size = |p: &usize| topology.parts[*p].bounds.half().length();
    candidates.sort_by(|a, b| size(b).total_cmp(&size(a)));
    candidates.into_iter().take(8).find_map(|p| convex(topology, p))
}

fn convex(topology: &Topology, part: usize) -> Option<ConvexPart> {
    let faces: Vec<[u32; 3]> = topology.triangles_of(part).iter().map(|&t| topology.triangles[t as usize]).collect();
    let at = |v: u32| {
        let [x, y, z] = topology.positions[v as usize].map(f64::from);
        Coord3D { x, y, z }
    };
    // Positive where the vertex lies on the side from which a, b, c appear clockwise.
    let behind = |[a, b, c]: [u32; 3], v: u32| orient3d(at(a), at(b), at(c), at(v)) >= 0.0;
    if !faces.iter().all(|&face| faces.iter().flatten().all(|&v| behind(face, v))) {
        return None;
    }
    let mut uses: Vec<([u32; 2], u8)> = Vec::new();
    for (f, &[a, b, c]) in faces.iter().enumerate() {
        uses.extend([(a, b), (b, c), (c, a)].map(|(a, b)| ([a.min(b), a.max(b)], f as u8)));
    }
    uses.sort_unstable();
    let pairs = uses.chunk_by(|a, b| a.0 == b.0);
    let edges = pairs.map(|pair| if let [(edge, f), (_, g)] = *pair { Some((edge, [f, g])) } else { None });
    Some(ConvexPart { edges: edges.collect::<Option<_>>()?, faces })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box, with corner 7 moved by `dent`.
    fn hexahedron(dent: f32) -> Topology {
        let mut positions: Vec<[f32; 3]> =
            (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2 & 1].map(|bit| bit as f32)).collect();
        positions[7] = [1.0 - dent; 3];
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        // Diagonals through corner 7, so that a dent makes an edge re-entrant.
        let triangles: Vec<[u32; 3]> = quads
            .iter()
            .flat_map(|&[a, b, c, d]| if c == 7 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] })
            .collect();
        Topology::new(&positions, &triangles, |_| true).expect("valid")
    }

    #[test]
    fn a_box_is_convex_and_a_dented_one_is_not() {
        let convex = hexahedron(0.0).convex.expect("a box is convex");
        assert_eq!((convex.faces.len(), convex.edges.len()), (12, 18));
        assert!(hexahedron(0.3).convex.is_none());
    }
}
