//! How far a smooth surface tilts away from the triangles that stand for it.
//!
//! In: a mesh. Out: per vertex its tilt, the sine of the greatest angle between its normal and the normals of the facets
//! around it. A facet that turns away from a light lies in its own shadow, exactly and with a straight border, while the
//! interpolated normal may still face the light: along the terminator of a coarse mesh that shows as teeth. A facet that
//! turns away has, at every one of its points, a cosine of light and interpolated normal of at most the interpolated tilt,
//! whatever the kind of light; `light.wgsl` fades light to 0 there. Stencil and masks know nothing of it.
//!
//! The problem is that of Chiang, Li and Burley, "Taming the Shadow Terminator" (2019), and Hanika, "Hacking the Shadow
//! Terminator" (2021). Both work on the facet at hand, which moves rays or shows every facet of a fade; a bound per vertex
//! is as smooth as the normals.

use std::collections::HashMap;
use zfail_plan::glam::Vec3;
use zfail_scene::Mesh;

/// Sines up to this leave teeth that are darker than a step of the picture: such meshes are fine as they are.
const FINE: f32 = 0.02;
/// Cosines of the angles between which a tilt turns from a curve, which is faded, to a crease: light that ends at a crease
/// is what one expects to see there.
const CURVE: f32 = 0.8;
const CREASE: f32 = 0.5;
/// The sine from which on a tilt counts for less: on a body of very few facets all of it would be in the fade.
const KNEE: f32 = 0.3;

/// The tilt at every vertex of `mesh`, or `None` where nothing needs to be faded: flat-shaded and well-tessellated meshes.
///
/// It depends on positions, normals and triangles alone. Vertices that differ in texture coordinates only have the same.
///
/// A skinned or morphed mesh may keep those of its rest pose: a joint that bends further shows a little of its facets, and
/// nothing flickers.
pub fn tilts(mesh: &Mesh) -> Option<Vec<f32>> {
    let mut tilts = vec![0.0_f32; mesh.positions.len()];
    let normals: Vec<Vec3> = mesh.normals.iter().map(|&n| Vec3::from(n).normalize_or_zero()).collect();
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| Vec3::from(mesh.positions[v as usize]));
        // Scaled first: the product of small edges underflows.
        let (u, v) = ((b - a).normalize_or_zero(), (c - a).normalize_or_zero());
        let facet = u.cross(v).normalize_or_zero();
        for v in triangle.map(|v| v as usize) {
            let Some(normal) = normals.get(v) else { continue };
            tilts[v] = tilts[v].max(tilt(*normal, facet));
        }
    }
    if tilts.iter().all(|&b| b <= FINE) {
        return None;
    }
    let mut welded: HashMap<[u32; 6], f32> = HashMap::new();
    let key = |v: usize| {
        let ([x, y, z], n) = (mesh.positions[v], normals.get(v).copied().unwrap_or_default());
        [x, y, z, n.x, n.y, n.z].map(f32::to_bits)
    };
    for (v, &tilt) in tilts.iter().enumerate() {
        let greatest = welded.entry(key(v)).or_default();
        *greatest = greatest.max(tilt);
    }
    Some((0..tilts.len()).map(|v| welded.get(&key(v)).copied().unwrap_or_default()).collect())
}

/// Normals as the vertex stage reads them: the tilt in w.
pub fn with_tilts(normals: &[[f32; 3]], tilts: Option<&[f32]>, count: usize) -> Vec<[f32; 4]> {
    let tilt = |v: usize| tilts.and_then(|tilts| tilts.get(v)).copied().unwrap_or_default();
    let normal = |v: usize| normals.get(v).copied().unwrap_or_default();
    (0..count).map(|v| [normal(v)[0], normal(v)[1], normal(v)[2], tilt(v)]).collect()
}

/// The sine of the angle between two unit vectors, or less where the two are coarse or a crease.
fn tilt(normal: Vec3, facet: Vec3) -> f32 {
    let curve = (normal.dot(facet) - CREASE) / (CURVE - CREASE);
    let sine = normal.cross(facet).length();
    sine.min(KNEE + 0.4 * (sine - KNEE)) * curve.clamp(0.0, 1.0)
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
    fn facets_of_smooth_edges_are_tilted() {
        let tilts = tilts(&roof(0.4, true)).expect("it is curved");
        let ridge = KNEE + 0.4 * (0.4_f32.sin() - KNEE);
        let expected = [ridge, ridge, 0.0];
        for (v, tilt) in tilts.iter().enumerate() {
            assert!((tilt - expected[v % 3]).abs() < 1e-6, "vertex {v}: {tilt}");
        }
        assert_eq!(super::tilts(&roof(0.2, true)).expect("it is curved")[0], 0.2_f32.sin());
        assert_eq!(super::tilts(&roof(0.4, false)), None);
        assert_eq!(super::tilts(&roof(0.01, true)), None, "well tessellated");
        assert_eq!(super::tilts(&roof(1.1, true)), None, "a crease");
        assert_eq!(super::tilts(&Mesh { normals: Vec::new(), ..roof(0.4, true) }), None);
    }

    #[test]
    fn seams_share_their_tilt() {
        let mut mesh = roof(0.4, true);
        mesh.triangles.truncate(1);
        let tilts = tilts(&mesh).expect("it is curved");
        assert_eq!([tilts[3], tilts[4]], [tilts[0], tilts[1]], "no triangle of their own");
        assert!(tilts[0] > 0.3);
    }
}
