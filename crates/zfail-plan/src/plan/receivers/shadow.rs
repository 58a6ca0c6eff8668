//! The shadow volume of a box: the bounds that planning has for a caster's.
//!
//! In: a box's corners and a light. Out: half spaces whose intersection holds everything that the box can shadow.

use glam::{DVec3, DVec4};

/// Pairs of faces of a box (axis, side) that share an edge, with the two corners of that edge.
const EDGES: [([usize; 2], [usize; 2]); 12] = [
    // Along x: faces of y and z.
    ([2, 4], [0, 1]),
    ([3, 4], [2, 3]),
    ([2, 5], [4, 5]),
    ([3, 5], [6, 7]),
    // Along y: faces of x and z.
    ([0, 4], [0, 2]),
    ([1, 4], [1, 3]),
    ([0, 5], [4, 6]),
    ([1, 5], [5, 7]),
    // Along z: faces of x and y.
    ([0, 2], [0, 4]),
    ([1, 2], [1, 5]),
    ([0, 3], [2, 6]),
    ([1, 3], [3, 7]),
];

/// A shadow volume's planes: 6 faces at most face the light, and 12 edges lie between those and the others.
pub(super) const MOST: usize = 6 + 12;

/// The half spaces whose intersection is the shadow volume of a box: the box's faces towards the light, turned round, and
/// the planes through the light and the edges between those faces and the others.
pub(super) fn planes<'p>(corners: &[DVec3; 8], light: DVec4, out: &'p mut [DVec4; MOST]) -> &'p [DVec4] {
    let center = corners.iter().sum::<DVec3>() / 8.0;
    let axes = [1, 2, 4].map(|i| corners[i] - corners[0]);
    let mut used = 0;
    let mut push = |plane: DVec4| {
        // All corners inside, rounding included.
        let n = plane.truncate();
        let least = corners.iter().map(|c| n.dot(*c)).fold(f64::INFINITY, f64::min);
        let margin = 1e-9 * (least.abs() + n.length() * (corners[7] - corners[0]).length());
        out[used] = n.extend(-(least - margin));
        used += 1;
    };
    // Faces by axis and side, as in `EDGES`.
    let faces: [(DVec3, bool); 6] = std::array::from_fn(|i| {
        let (axis, upper) = (i / 2, i % 2 == 1);
        let normal = axes[(axis + 1) % 3].cross(axes[(axis + 2) % 3]);
        let on = if upper { corners[1 << axis] } else { corners[0] };
        let outward = if normal.dot(on - center) >= 0.0 { normal } else { -normal };
        (outward, outward.dot(light.truncate() - on * light.w) > 0.0)
    });
    if faces.iter().all(|face| !face.1) {
        // The light is inside: shadow everywhere.
        return &[];
    }
    for &(outward, _) in faces.iter().filter(|face| face.1) {
        push((-outward).extend(0.0));
    }
    for ([f, g], [a, b]) in EDGES {
        if faces[f].1 != faces[g].1 {
            let a = corners[a];
            let (edge, to_light) = (corners[b] - a, light.truncate() - a * light.w);
            let normal = edge.cross(to_light);
            // Of an edge along the rays, only rounding is left.
            if normal.length_squared() <= 1e-12 * edge.length_squared() * to_light.length_squared() {
                continue;
            }
            let inward = if normal.dot(center - a) >= 0.0 { normal } else { -normal };
            push(inward.extend(0.0));
        }
    }
    &out[..used]
}
