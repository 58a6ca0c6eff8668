//! The weld: vertices with bit-equal positions become one (0.0 and -0.0 are equal). Never by a tolerance.

use super::TopologyError;
use rustc_hash::FxHashMap;

/// Distinct positions in order of first use, and the triangles over them.
pub(super) type Welded = (Vec<[f32; 3]>, Vec<[u32; 3]>);

/// Welds `triangles` over `positions`; vertices that no triangle uses are left out.
pub(super) fn weld(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Result<Welded, TopologyError> {
    let mut ids = FxHashMap::default();
    ids.reserve(positions.len());
    let mut remap = vec![u32::MAX; positions.len()];
    let mut distinct: Vec<[f32; 3]> = Vec::new();
    let mut welded = Vec::with_capacity(triangles.len());
    for (t, triangle) in triangles.iter().enumerate() {
        let mut out = [0; 3];
        for (slot, &vertex) in out.iter_mut().zip(triangle) {
            let Some(known) = remap.get_mut(vertex as usize) else {
                return Err(TopologyError::IndexOutOfRange { triangle: t, vertex, vertices: positions.len() });
            };
            if *known == u32::MAX {
                // Adding 0.0 turns -0.0 into 0.0 and changes nothing else.
                let p = positions[vertex as usize].map(|x| x + 0.0);
                *known = *ids.entry(p.map(f32::to_bits)).or_insert_with(|| {
                    distinct.push(p);
                    distinct.len() as u32 - 1
                });
            }
            *slot = *known;
        }
        welded.push(out);
    }
    Ok((distinct, welded))
}
