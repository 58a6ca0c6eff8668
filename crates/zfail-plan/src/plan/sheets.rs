//! Casting triangles that hang together: across edges on which no side of a volume stands.
//!
//! In: topology and weights. Out: a number per triangle, alike for those of one sheet. Batches are divided between sheets
//! where that can be: a batch that ends within one has sides along edges in the midst of a lit surface, whose depth there is
//! the surface's own, and which of the two a rasteriser puts first is up to its rounding.

use crate::topology::Topology;

/// The sheet of every triangle: the least triangle in it. Triangles without a weight are alone.
pub(super) fn sheets(topology: &Topology, weights: &[i8]) -> Vec<u32> {
    let mut sheet: Vec<u32> = (0..weights.len() as u32).collect();
    let (mut along, mut against) = (Vec::new(), Vec::new());
    for (_, incident) in topology.incidence() {
        along.clear();
        against.clear();
        for (t, orientation) in incident.iter() {
            match i32::from(weights[t]) * orientation {
                0 => {}
                way if way > 0 => along.push(t as u32),
                _ => against.push(t as u32),
            }
        }
        // What cancels; where several do, in the order of the mesh.
        for (&a, &b) in along.iter().zip(&against) {
            let (a, b) = (root(&mut sheet, a), root(&mut sheet, b));
            sheet[a.max(b) as usize] = a.min(b);
        }
    }
    for t in 0..sheet.len() as u32 {
        sheet[t as usize] = root(&mut sheet, t);
    }
    sheet
}

fn root(sheet: &mut [u32], mut t: u32) -> u32 {
    while sheet[t as usize] != t {
        // Halves the way for those who come after.
        sheet[t as usize] = sheet[sheet[t as usize] as usize];
        t = sheet[t as usize];
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A strip of four triangles over six points.
    const STRIP: [[u32; 3]; 4] = [[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5]];

    fn points() -> Vec<[f32; 3]> {
        (0..6_u8).map(|i| [f32::from(i / 2), f32::from(i % 2), 0.0]).collect()
    }

    #[test]
    fn sheets_end_where_sides_stand() {
        let topology = Topology::new(&points(), &STRIP, |_| true).expect("a strip");
        assert_eq!(sheets(&topology, &[1, 1, 1, 1]), [0, 0, 0, 0]);
        assert_eq!(sheets(&topology, &[-1, -1, -1, -1]), [0, 0, 0, 0]);
        assert_eq!(sheets(&topology, &[1, 1, 0, 1]), [0, 0, 2, 3], "one without a weight");
        assert_eq!(sheets(&topology, &[1, 1, -1, -1]), [0, 0, 2, 2], "the light sees both sides");
    }

    #[test]
    fn every_one_of_many_layers_is_a_sheet() {
        let layers = STRIP.repeat(3);
        let topology = Topology::new(&points(), &layers, |_| true).expect("three strips");
        assert_eq!(sheets(&topology, &[1; 12]), [0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8]);
    }
}
