//! Steps of closedness for tests.

use rustc_hash::FxHashMap;
use zfail_scene::Mesh;

/// Directed edges, after a weld of bit-equal positions, without an opposite partner.
pub fn unmatched_edges(mesh: &Mesh) -> usize {
    let mut balance: FxHashMap<[[u32; 3]; 2], i32> = FxHashMap::default();
    for t in &mesh.triangles {
        let p = t.map(|v| mesh.positions[v as usize].map(f32::to_bits));
        for k in 0..3 {
            let [a, b] = [p[k], p[(k + 1) % 3]];
            *balance.entry([a, b]).or_default() += 1;
            *balance.entry([b, a]).or_default() -= 1;
        }
    }
    balance.values().filter(|&&n| n > 0).map(|&n| n as usize).sum()
}

/// How many directed edges occur more than once: 0 in a manifold.
pub fn repeated_edges(mesh: &Mesh) -> usize {
    let mut uses: FxHashMap<[[u32; 3]; 2], u32> = FxHashMap::default();
    for t in &mesh.triangles {
        let p = t.map(|v| mesh.positions[v as usize].map(f32::to_bits));
        for k in 0..3 {
            *uses.entry([p[k], p[(k + 1) % 3]]).or_default() += 1;
        }
    }
    uses.values().filter(|&&n| n > 1).count()
}

/// The enclosed volume, negative if the mesh is inside out.
pub fn volume(mesh: &Mesh) -> f64 {
    mesh.triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| mesh.position(v));
            a.dot(b.cross(c)) / 6.0
        })
        .sum()
}

/// Triangles with two corners at one position.
pub fn collapsed_triangles(mesh: &Mesh) -> usize {
    let collapsed = |t: &&[u32; 3]| {
        let [a, b, c] = t.map(|v| mesh.positions[v as usize]);
        a == b || b == c || c == a
    };
    mesh.triangles.iter().filter(collapsed).count()
}
