//! Normals and tangents: missing ones are made, broken ones mended.
//!
//! In: a posed `Surface`. Out: one unit normal and one tangent (or zero) per vertex.

use super::surface::Surface;
use glam::{DVec2, DVec3, DVec4};
use zfail_scene::placement::unit_vector;

/// Shorter vectors have no direction worth keeping.
const LEAST_LENGTH: f64 = 1e-12;

/// Flat normals. Vertices must not be shared between triangles.
pub(super) fn flat_normals(surface: &Surface) -> Vec<DVec3> {
    let mut normals = vec![DVec3::Y; surface.positions.len()];
    for &triangle in &surface.triangles {
        if let Some(normal) = area_vector(surface, triangle).try_normalize() {
            triangle.iter().for_each(|&v| normals[v as usize] = normal);
        }
    }
    normals
}

/// Whether `normals`, as the file gives them, point elsewhere than the triangles do: the mean cosine over all corners of
/// triangles with an area is under a half.
pub(super) fn contradicts(surface: &Surface, normals: &[DVec3]) -> bool {
    const LEAST_COSINE: f64 = 0.5;
    let (mut sum, mut count) = (0.0, 0_usize);
    for &triangle in &surface.triangles {
        let Some(face) = area_vector(surface, triangle).try_normalize() else { continue };
        for normal in triangle.iter().filter_map(|&v| normals[v as usize].try_normalize()) {
            sum += face.dot(normal);
            count += 1;
        }
    }
    sum < LEAST_COSINE * count as f64
}

/// Makes every normal a unit vector; those without a direction get the mean of their triangles' normals, weighted by
/// area. Returns how many there were.
pub(super) fn mend_normals(surface: &Surface, normals: &mut [DVec3]) -> usize {
    // Out of this range the square is no measure of the length any more; NaN is outside too.
    let has_direction = |n: &DVec3| (LEAST_LENGTH * LEAST_LENGTH..1e100).contains(&n.length_squared());
    let broken = normals.iter().filter(|n| !has_direction(n)).count();
    if broken > 0 {
        let mut smooth = vec![DVec3::ZERO; normals.len()];
        for &triangle in &surface.triangles {
            let area = area_vector(surface, triangle);
            triangle.iter().for_each(|&v| smooth[v as usize] += area);
        }
        for (normal, smooth) in normals.iter_mut().zip(smooth) {
            if !has_direction(normal) {
                *normal = smooth.try_normalize().unwrap_or(DVec3::Y);
            }
        }
    }
    normals.iter_mut().for_each(|n| *n = unit_vector(*n).unwrap_or(DVec3::Y));
    broken
}

/// Makes given tangents unit vectors with a sign of 1 or -1, and zero where they have no direction.
pub(super) fn mend_tangents(tangents: &[DVec4]) -> Vec<[f32; 4]> {
    let mend = |t: &DVec4| {
        let sign = if t.w < 0.0 { -1.0 } else { 1.0 };
        let direction = unit_vector(t.truncate());
        direction.map_or([0.0; 4], |d| d.extend(sign).as_vec4().to_array())
    };
    tangents.iter().map(mend).collect()
}

/// Tangents from texture coordinates: the direction in which `u` grows, summed over a vertex's triangles and made
/// perpendicular to its normal. Vertices shared across a mirrored seam get the mean of both sides; exporters split
/// vertices there.
pub(super) fn tangents(surface: &Surface, normals: &[DVec3], uv: &[DVec2]) -> Vec<[f32; 4]> {
    let mut along_u = vec![DVec3::ZERO; normals.len()];
    let mut along_v = vec![DVec3::ZERO; normals.len()];
    for &triangle in &surface.triangles {
        let [p0, p1, p2] = triangle.map(|v| surface.positions[v as usize]);
        let [t0, t1, t2] = triangle.map(|v| uv[v as usize]);
        let (e1, e2) = (p1 - p0, p2 - p0);
        let (d1, d2) = (t1 - t0, t2 - t0);
        let sign = d1.perp_dot(d2).signum();
        let u = (e1 * d2.y - e2 * d1.y) * sign;
        let v = (e2 * d1.x - e1 * d2.x) * sign;
        if u.is_finite() && v.is_finite() {
            for i in triangle {
                along_u[i as usize] += u;
                along_v[i as usize] += v;
            }
        }
    }
    let tangent = |((n, u), v): ((&DVec3, DVec3), DVec3)| {
        let direction = (u - *n * n.dot(u)).try_normalize();
        // Green points up in a normal map, but v grows downwards.
        let sign = if n.cross(u).dot(v) > 0.0 { -1.0 } else { 1.0 };
        direction.map_or([0.0; 4], |d| d.extend(sign).as_vec4().to_array())
    };
    normals.iter().zip(along_u).zip(along_v).map(tangent).collect()
}

fn area_vector(surface: &Surface, triangle: [u32; 3]) -> DVec3 {
    let [a, b, c] = triangle.map(|v| surface.positions[v as usize]);
    (b - a).cross(c - a)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quad() -> Surface {
        let positions = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec();
        Surface { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Surface::default() }
    }

    #[test]
    fn flat_normals_follow_the_winding() {
        let mut surface = quad();
        surface.triangles[1] = [0, 3, 2];
        surface.unshare();
        assert_eq!(surface.positions.len(), 6);
        let normals = flat_normals(&surface);
        assert_eq!(normals[..3], [DVec3::Z; 3]);
        assert_eq!(normals[3..], [DVec3::NEG_Z; 3]);
    }

    #[test]
    fn contradicting_normals_are_found() {
        let contradicts = |normals: [DVec3; 4]| contradicts(&quad(), &normals);
        assert!(!contradicts([DVec3::Z; 4]) && !contradicts([DVec3::new(0.5, 0.5, 1.0); 4]));
        assert!(contradicts([DVec3::NEG_Z; 4]) && contradicts([DVec3::X; 4]));
        assert!(!contradicts([DVec3::ZERO; 4]), "none at all");
        // The first and the third corner belong to both triangles.
        assert!(!contradicts([DVec3::Z, DVec3::NEG_Z, DVec3::Z, DVec3::Z]));
        assert!(contradicts([DVec3::NEG_Z, DVec3::Z, DVec3::Z, DVec3::Z]));
    }

    #[test]
    fn broken_normals_are_mended_and_counted() {
        let mut normals = vec![DVec3::NAN, DVec3::ZERO, DVec3::X * 5.0, DVec3::INFINITY];
        assert_eq!(mend_normals(&quad(), &mut normals), 3);
        assert_eq!(normals, [DVec3::Z, DVec3::Z, DVec3::X, DVec3::Z]);
    }

    #[test]
    fn tangents_follow_the_texture() {
        let normals = vec![DVec3::Z; 4];
        let mut surface = quad();
        let uv: Vec<DVec2> = surface.positions.iter().map(|p| DVec2::new(p.y, p.x)).collect();
        assert_eq!(tangents(&surface, &normals, &uv), [[0.0, 1.0, 0.0, 1.0]; 4], "u along y, v along x");
        let uv: Vec<DVec2> = surface.positions.iter().map(|p| DVec2::new(-p.x, -p.y)).collect();
        assert_eq!(tangents(&surface, &normals, &uv), [[-1.0, 0.0, 0.0, -1.0]; 4]);
        surface.triangles.clear();
        assert_eq!(tangents(&surface, &normals, &uv), [[0.0; 4]; 4], "no direction");
    }
}
