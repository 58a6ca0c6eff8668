//! The weld: vertices with bit-equal positions become one (0.0 and -0.0 are equal), and in a mesh that bends those that
//! move alike. Never by a tolerance.

use super::TopologyError;
use rustc_hash::FxHashMap;

/// What the weld makes of a mesh.
pub(super) struct Welded {
    /// Distinct positions in order of first use.
    pub positions: Vec<[f32; 3]>,
    /// The vertex from which each of them comes.
    pub sources: Vec<u32>,
    /// The triangles over them.
    pub triangles: Vec<[u32; 3]>,
}

/// Welds `triangles` over `positions`; vertices that no triangle uses are left out. Where `alike` is given, it decides
/// instead of the position which vertices are one.
pub(super) fn weld(
    positions: &[[f32; 3]],
    triangles: &[[u32; 3]],
    alike: Option<&[u32]>,
) -> Result<Welded, TopologyError> {
    let mut ids = FxHashMap::default();
    ids.reserve(positions.len());
    let mut remap = vec![u32::MAX; positions.len()];
    let mut out = Welded { positions: Vec::new(), sources: Vec::new(), triangles: Vec::with_capacity(triangles.len()) };
    for (t, triangle) in triangles.iter().enumerate() {
        let mut corners = [0; 3];
        for (slot, &vertex) in corners.iter_mut().zip(triangle) {
            let Some(known) = remap.get_mut(vertex as usize) else {
                return Err(TopologyError::IndexOutOfRange { triangle: t, vertex, vertices: positions.len() });
            };
            if *known == u32::MAX {
                // Adding 0.0 turns -0.0 into 0.0 and changes nothing else.
                let p = positions[vertex as usize].map(|x| x + 0.0);
                let key = alike.map_or(p.map(f32::to_bits), |alike| [alike[vertex as usize], 0, 0]);
                *known = *ids.entry(key).or_insert_with(|| {
                    out.positions.push(p);
                    out.sources.push(vertex);
                    out.positions.len() as u32 - 1
                });
            }
            *slot = *known;
        }
        out.triangles.push(corners);
    }
    Ok(out)
}
