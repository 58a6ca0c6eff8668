//! Bodies swept along a line: tubes around closed curves, extruded polygons, stairs.

use super::{CREASE, Facets, Mesh, circle};
use glam::{DVec2, DVec3};

/// A tube around the closed curve through `centers`; `outward[i]` is any direction at `centers[i]` across the curve,
/// varying smoothly, that fixes the twist of the tube.
#[must_use]
pub fn tube(centers: &[DVec3], outward: &[DVec3], radius: f64, sides: usize) -> Mesh {
    let n = centers.len();
    let around = circle(sides);
    let rings: Vec<Vec<DVec3>> = (0..n)
        .map(|i| {
            let tangent = (centers[(i + 1) % n] - centers[(i + n - 1) % n]).normalize();
            let x = outward[i].reject_from(tangent).normalize();
            let y = tangent.cross(x);
            around.iter().map(|c| centers[i] + (x * c.x + y * c.y) * radius).collect()
        })
        .collect();
    let girth = (std::f64::consts::TAU * radius).max(f64::MIN_POSITIVE);
    let mut facets = Facets::default();
    let mut length = 0.0;
    for i in 0..n {
        let next = length + centers[i].distance(centers[(i + 1) % n]);
        for k in 0..sides {
            let corner = |i: usize, k: usize, along: f64| {
                (rings[i % n][k % sides], DVec2::new(girth * k as f64 / sides as f64, along))
            };
            facets.textured_quad([
                corner(i, k, length),
                corner(i, k + 1, length),
                corner(i + 1, k + 1, next),
                corner(i + 1, k, next),
            ]);
        }
        length = next;
    }
    facets.mesh("tube", std::f64::consts::PI)
}

/// The knot that winds `p` times around the y axis while it winds `q` times around the tube of a torus with radii
/// `radius` and `bulge`; coprime `p` and `q` make one strand.
#[must_use]
pub fn torus_knot([p, q]: [u32; 2], radius: f64, bulge: f64, thickness: f64, steps: usize, sides: usize) -> Mesh {
    let (centers, outward): (Vec<DVec3>, Vec<DVec3>) = (0..steps)
        .map(|i| {
            let turn = |times: u32| {
                // Reduced in integers, so that the strand meets itself without rounding.
                let step = (i as u64 * u64::from(times)) % steps as u64;
                DVec2::from_angle(std::f64::consts::TAU * step as f64 / steps as f64)
            };
            let (around, across) = (turn(p), turn(q));
            let out = DVec3::new(around.x, 0.0, -around.y);
            let normal = out * across.x + DVec3::Y * across.y;
            (out * radius + normal * bulge, normal)
        })
        .unzip();
    tube(&centers, &outward, thickness, sides)
}

/// A simple polygon, counter-clockwise in the xy plane, extruded from z = 0 to `depth`.
#[must_use]
pub fn extruded(outline: &[DVec2], depth: f64) -> Mesh {
    let mut facets = Facets::default();
    for [a, b, c] in ears(outline) {
        let at = |i: usize, z: f64| outline[i].extend(z);
        facets.triangle([at(a, depth), at(b, depth), at(c, depth)]);
        facets.triangle([at(a, 0.0), at(c, 0.0), at(b, 0.0)]);
    }
    let mut length = 0.0;
    for (i, &a) in outline.iter().enumerate() {
        let b = outline[(i + 1) % outline.len()];
        let next = length + a.distance(b);
        facets.textured_quad([
            (a.extend(0.0), DVec2::new(length, 0.0)),
            (b.extend(0.0), DVec2::new(next, 0.0)),
            (b.extend(depth), DVec2::new(next, depth)),
            (a.extend(depth), DVec2::new(length, depth)),
        ]);
        length = next;
    }
    facets.mesh("extrusion", CREASE)
}

/// A solid flight of `steps` steps that climbs towards -z from the origin, `width` metres to both sides of x = 0
/// together, each step `rise` high and `run` deep.
#[must_use]
pub fn stairs(steps: usize, rise: f64, run: f64, width: f64) -> Mesh {
    // Profile with x towards +z and y up, so that extruding along z is extruding along the world's -x.
    let mut outline = vec![DVec2::new(-run * steps as f64, 0.0), DVec2::ZERO];
    for i in 0..steps {
        outline.push(DVec2::new(-run * i as f64, rise * (i + 1) as f64));
        outline.push(DVec2::new(-run * (i + 1) as f64, rise * (i + 1) as f64));
    }
    let world_from_profile = glam::DAffine3 {
        matrix3: glam::DMat3::from_cols(DVec3::Z, DVec3::Y, DVec3::NEG_X),
        translation: DVec3::X * (width / 2.0),
    };
    super::moved(extruded(&outline, width), &world_from_profile)
}

/// Cuts a simple counter-clockwise polygon into triangles by clipping, each time, the ear with the shortest new edge.
/// Every vertex is used, also those in the middle of a straight edge, so that neighbours find their edges.
fn ears(outline: &[DVec2]) -> Vec<[usize; 3]> {
    let area = |a: usize, b: usize, c: usize| (outline[b] - outline[a]).perp_dot(outline[c] - outline[a]);
    let mut left: Vec<usize> = (0..outline.len()).collect();
    let mut triangles = Vec::with_capacity(outline.len());
    while left.len() > 3 {
        let n = left.len();
        let ear = (0..n)
            .filter(|&i| {
                let [a, b, c] = [left[(i + n - 1) % n], left[i], left[(i + 1) % n]];
                let inside = |&p: &usize| area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 && area(c, a, p) >= 0.0;
                area(a, b, c) > 0.0 && !left.iter().filter(|p| ![a, b, c].contains(p)).any(inside)
            })
            .min_by(|&i, &j| {
                let gap = |i: usize| outline[left[(i + n - 1) % n]].distance_squared(outline[left[(i + 1) % n]]);
                gap(i).total_cmp(&gap(j))
            });
        // Without an ear the outline is no simple counter-clockwise polygon; what is cut so far is the best there is.
        let Some(i) = ear else { return triangles };
        triangles.push([left[(i + n - 1) % n], left[i], left[(i + 1) % n]]);
        left.remove(i);
    }
    triangles.extend(<[usize; 3]>::try_from(left));
    triangles
}
