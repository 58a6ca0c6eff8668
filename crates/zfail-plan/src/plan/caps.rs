//! Dark caps at a finite distance, for orthographic views.
//!
//! All rays of an orthographic view meet in one point at infinity, so a dark cap there has no area on the image and
//! cannot count. Instead every vertex is extruded to the same distance from a point light, or by the same distance along
//! parallel rays (whose point of convergence not every rasteriser can place), so far that the extruded triangles lie beyond
//! everything in view. Where a vertex goes depends on nothing but the vertex and the light: the volume is closed as it is
//! at infinity, whatever the weights, with the light anywhere.
//!
//! In: the weights of one pair, then the view. Out: the distance.

use crate::bounds::Bounds;
use crate::casting::ObjectLight;
use crate::topology::Topology;
use crate::view::{Projection, View};
use glam::{DAffine3, DVec2, DVec3};

/// Triangles of which one on the unit sphere comes nearer to the light cast nothing: seen so nearly edge-on that f32 could
/// not extrude them. Their shadow is a hundred thousand times thinner than long.
const EDGE_ON: f64 = 1e-5;
/// Nearer than this no triangle needs to be looked for.
const NARROW: f64 = 0.5;

/// How near to the light the casting triangles come when their vertices are moved along their rays to a distance of 1, at
/// most [`NARROW`]; takes the weight of those that would come too near. Meaningless for directional lights.
pub(super) fn nearest(topology: &Topology, weights: &mut [i8], light: ObjectLight) -> f64 {
    let mut nearest = NARROW;
    if light.w == 0.0 {
        return nearest;
    }
    let origin = light.truncate().as_dvec3();
    for (t, weight) in weights.iter_mut().enumerate().filter(|(_, weight)| **weight != 0) {
        let directions = topology.corners(t).map(|p| (p - origin).normalize_or_zero());
        let middle = directions.iter().sum::<DVec3>().normalize_or_zero();
        if directions.iter().all(|d| d.dot(middle) >= NARROW) {
            continue;
        }
        let distance = distance_from_origin(directions);
        if distance < EDGE_ON {
            *weight = 0;
        } else {
            nearest = nearest.min(distance);
        }
    }
    nearest
}

/// Of the nearest point of a triangle.
fn distance_from_origin([a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let edges = [[a, b], [b, c], [c, a]];
    if normal != DVec3::ZERO && edges.iter().all(|[p, q]| normal.dot(p.cross(*q)) >= 0.0) {
        return normal.dot(a).abs() / normal.length();
    }
    let along = |[p, q]: [DVec3; 2]| {
        let edge = q - p;
        let t = (-p.dot(edge) / edge.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (p + t * edge).length()
    };
    edges.map(along).into_iter().fold(f64::INFINITY, f64::min)
}

/// How far to extrude the vertices of a caster within `bounds`, object space: the distance from a point light, or along
/// parallel rays. `nearest` is what [`nearest()`] found. 0 is infinity: what perspective views want.
pub(super) fn reach(
    bounds: &Bounds,
    nearest: f64,
    light: ObjectLight,
    view: &View,
    object_from_relative: &DAffine3,
) -> f32 {
    /// Clear of the farthest corner.
    const MARGIN: f64 = 1.01;
    let Projection::Orthographic { near, far, .. } = view.projection else { return 0.0 };
    let [lower, upper] = [-1.0, 1.0].map(|border| view.on_image_plane(DVec2::splat(border)));
    let corner = |i: u8| {
        let [x, y, z] = [(1, upper.x, lower.x), (2, upper.y, lower.y), (4, -near, -far)]
            .map(|(bit, one, other)| if i & bit == 0 { one } else { other });
        object_from_relative.transform_point3(view.world_from_view.matrix3 * DVec3::new(x, y, z))
    };
    let corners = (0..8).map(corner);
    let light_at = light.truncate().as_dvec3();
    let reach = if light.w == 0.0 {
        let farthest = corners.map(|p| -light_at.dot(p)).fold(f64::NEG_INFINITY, f64::max);
        let first = bounds.corners().map(|p| -light_at.dot(p)).into_iter().fold(f64::INFINITY, f64::min);
        // Casters beyond everything in view reach as far as those at its end.
        (farthest - first).max(bounds.half().length())
    } else {
        corners.map(|p| p.distance(light_at)).fold(0.0, f64::max) / nearest
    };
    (reach * MARGIN) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_on_the_sphere_come_as_near_as_their_nearest_point() {
        let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z];
        let third = 1.0 / 3.0_f64.sqrt();
        for (triangle, expected) in [
            ([x, y, z], third),
            ([z, y, x], third),
            // Beside the origin, it is an edge that comes nearest.
            ([x, y, (x + y + 0.1 * z).normalize()], 0.5_f64.sqrt()),
            ([x, x, x], 1.0),
            ([x, y, -x], 0.0),
        ] {
            let found = distance_from_origin(triangle);
            assert!((found - expected).abs() < 1e-12, "{triangle:?}: {found}, not {expected}");
        }
    }

    #[test]
    fn wide_triangles_are_extruded_farther_and_those_seen_edge_on_not_at_all() {
        // A floor below the light, and a wall that it lies in the plane of, but for rounding.
        let positions = [
            [-9.0, 0.0, -9.0],
            [9.0, 0.0, -9.0],
            [0.0, 0.0, 9.0],
            [4.0, -1.0, 0.0],
            [4.0, 1.0, 0.0],
            [-4.0, 0.0, 1e-9],
        ];
        let topology = Topology::new(&positions, &[[0, 1, 2], [3, 4, 5]], |_| true).expect("two triangles");
        let at = |height: f32| {
            let mut weights = vec![1, 1];
            let nearest = nearest(&topology, &mut weights, glam::Vec4::new(0.0, height, 0.0, 1.0));
            (nearest, weights)
        };
        let (high, low) = (at(9.0).0, at(0.1).0);
        assert!(high > 0.4 && low < 0.02 && low > 0.1 / 13.0, "{high} {low}");
        assert_eq!(at(0.0).1, [0, 0]);
        assert_eq!(at(0.1).1, [1, 0]);
    }
}
