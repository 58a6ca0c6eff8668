//! How far a smooth surface bends away from the triangles that stand for it.
//!
//! In: a mesh. Out: per vertex its bend, the sine of the greatest angle between its normal and the normals of the
//! facets around it. A facet that
//! turns away from a light lies in its own shadow, exactly and with a straight border, while the interpolated normal may
//! still face the light: along the terminator of a coarse mesh that shows as teeth. Where the light's angle to the normal
//! leaves no facet that could have turned away, nothing of this happens; `light.wgsl` fades the light to 0 before.
//!
//! The problem is that of Chiang, Li and Burley, "Taming the Shadow Terminator" (2019), and Hanika, "Hacking the Shadow
//! Terminator" (2021). Both work on the facet at hand, which moves rays or shows every facet of a fade; a bound per vertex
//! is as smooth as the normals.

use std::collections::HashMap;
use zfail_plan::glam::Vec3;
use zfail_plan::scene::Mesh;

/// Sines up to this leave teeth that are darker than a step of the picture: such meshes are fine as they are.
const FINE: f32 = 0.02;
/// Cosines of the angles between which a bend turns from a curve, which is faded, to a crease: light that ends at a crease
/// is what one expects to see there.
const CURVE: f32 = 0.8;
const CREASE: f32 = 0.5;
/// The sine from which on a bend counts for less: on a body of very few facets all of it would be in the fade.
const COARSE: f32 = 0.3;

/// The bend at every vertex of `mesh`, or `None` where nothing needs to be faded: flat-shaded and well-tessellated meshes.
///
/// It depends on positions, normals and triangles alone. Vertices that differ in texture coordinates only have the same.
pub fn bends(mesh: &Mesh) -> Option<Vec<f32>> {
    let mut bends = vec![0.0_f32; mesh.positions.len()];
    let normals: Vec<Vec3> = mesh.normals.iter().map(|&n| Vec3::from(n).normalize_or_zero()).collect();
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| Vec3::from(mesh.positions[v as usize]));
        // Scaled first: the product of small edges underflows.
        let (u, v) = ((b - a).normalize_or_zero(), (c - a).normalize_or_zero());
        let facet = u.cross(v).normalize_or_zero();
        for v in triangle.map(|v| v as usize) {
            let Some(normal) = normals.get(v) else { continue };
            bends[v] = bends[v].max(bend(*normal, facet));
        }
    }
    if bends.iter().all(|&b| b <= FINE) {
        return None;
    }
    let mut welded: HashMap<[u32; 6], f32> = HashMap::new();
    let key = |v: usize| {
        let ([x, y, z], n) = (mesh.positions[v], normals.get(v).copied().unwrap_or_default());
        [x, y, z, n.x, n.y, n.z].map(f32::to_bits)
    };
    for (v, &bend) in bends.iter().enumerate() {
        let greatest = welded.entry(key(v)).or_default();
        *greatest = greatest.max(bend);
    }
    Some((0..bends.len()).map(|v| welded.get(&key(v)).copied().unwrap_or_default()).collect())
}

/// The sine of the angle between two unit vectors, or less where the two are coarse or a crease.
fn bend(normal: Vec3, facet: Vec3) -> f32 {
    let curve = (normal.dot(facet) - CREASE) / (CURVE - CREASE);
    let sine = normal.cross(facet).length();
    sine.min(COARSE + 0.4 * (sine - COARSE)) * curve.clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A roof of two slopes of `angle` radians, its vertices apart; the normals on the ridge point upwards if `smooth`.
    fn roof(angle: f32, smooth: bool) -> Mesh {
        let (sin, cos) = angle.sin_cos();
        let slope = |side: f32| [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [side * cos, -sin, 0.0]];
        let normal = |side: f32| [side * sin, cos, 0.0];
        let ridge = |side: f32| if smooth { [0.0, 1.0, 0.0] } else { normal(side) };
        Mesh {
            positions: [slope(1.0), slope(-1.0)].concat(),
            normals: [1.0, -1.0].iter().flat_map(|&s| [ridge(s), ridge(s), normal(s)]).collect(),
            triangles: vec![[0, 1, 2], [3, 5, 4]],
            ..Mesh::default()
        }
    }

    #[test]
    fn smooth_edges_bend_and_flat_ones_do_not() {
        let bends = bends(&roof(0.4, true)).expect("it is bent");
        let ridge = COARSE + 0.4 * (0.4_f32.sin() - COARSE);
        let expected = [ridge, ridge, 0.0];
        for (v, bend) in bends.iter().enumerate() {
            assert!((bend - expected[v % 3]).abs() < 1e-6, "vertex {v}: {bend}");
        }
        assert_eq!(super::bends(&roof(0.2, true)).expect("it is bent")[0], 0.2_f32.sin());
        assert_eq!(super::bends(&roof(0.4, false)), None);
        assert_eq!(super::bends(&roof(0.01, true)), None, "well tessellated");
        assert_eq!(super::bends(&roof(1.1, true)), None, "a crease");
        assert_eq!(super::bends(&Mesh { normals: Vec::new(), ..roof(0.4, true) }), None);
    }

    #[test]
    fn seams_share_their_bend() {
        let mut mesh = roof(0.4, true);
        mesh.triangles.truncate(1);
        let bends = bends(&mesh).expect("it is bent");
        assert_eq!([bends[3], bends[4]], [bends[0], bends[1]], "no triangle of their own");
        assert!(bends[0] > 0.3);
    }
}
