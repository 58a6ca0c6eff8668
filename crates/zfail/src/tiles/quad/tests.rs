use super::super::bins::{Bins, TILE};
use super::*;
use glam::DMat3;
use zfail_plan::view::{Projection, View};
use zfail_testing::Random;

const SIZE: [u32; 2] = [320, 200];
const NEAR: f64 = 0.1;

fn view() -> View {
    let projection = Projection::Perspective { yfov: 1.2, near: NEAR, far: None };
    View::new(DAffine3::IDENTITY, projection, SIZE)
}

fn sight() -> Sight {
    let bounds = Bounds { min: DVec3::splat(-9.0), max: DVec3::splat(9.0) };
    Sight { bounds, size: DVec2::new(SIZE[0].into(), SIZE[1].into()) }
}

fn sides<'a>(positions: &'a [[f32; 3]], indices: &'a [u32], light: Vec4) -> Sides<'a> {
    Sides {
        positions,
        clip_from_object: view().clip_from_object(&DAffine3::IDENTITY),
        world_from_object: DAffine3::IDENTITY,
        light,
        indices,
        converging: light.w == 0.0,
        mirrored: false,
        scissor: [0, 0, SIZE[0], SIZE[1]],
    }
}

/// Side from vertex 1 to vertex 0.
fn side(light: Vec4) -> &'static [u32] {
    if light.w == 0.0 { &[0, 2, 1] } else { &[0, 2, 3, 0, 3, 1] }
}

fn values(quad: &Quad, [x, y]: [u32; 2]) -> [f64; 4] {
    let [u, v] = [f64::from(x) + 0.5 - 160.0, f64::from(y) + 0.5 - 100.0];
    std::array::from_fn(|i| f64::from(quad.across[i]) * u + f64::from(quad.down[i]) * v + f64::from(quad.middle[i]))
}

/// Distance in view depth at which the ray through a pixel meets the quad, by solving for the point; `None` if it misses.
fn meets([b, a]: [DVec3; 2], light: Vec4, [x, y]: [u32; 2]) -> Option<(f64, DVec3)> {
    let half = 0.6_f64.tan();
    let [across, down] = [(f64::from(x) + 0.5) / 160.0 - 1.0, 1.0 - (f64::from(y) + 0.5) / 100.0];
    let ray = DVec3::new(across * half * 1.6, down * half, -1.0);
    let light = light.as_dvec4();
    // A point of the quad is p + t * X(p) with p between a and b and t >= 0.
    let found = if light.w == 0.0 {
        // s ray = a + k (b - a) - t light
        let solution = DMat3::from_cols(ray, a - b, light.truncate()).inverse() * a;
        (solution.x, (0.0..=1.0).contains(&solution.y) && solution.z >= 0.0)
    } else {
        // s ray = light + i (a - light) + k (b - light), where i + k = 1 + t
        let l = light.truncate();
        let solution = DMat3::from_cols(ray, l - a, l - b).inverse() * l;
        (solution.x, solution.y >= 0.0 && solution.z >= 0.0 && solution.y + solution.z >= 1.0)
    };
    (found.0 > 0.0 && found.1).then_some((found.0, ray * found.0))
}

#[test]
fn functions_agree_with_solving_for_the_point() {
    let mut random = Random(3);
    let (mut hits, mut behind) = (0, 0);
    for trial in 0..2000 {
        let positions = [random.vector(6.0), random.vector(6.0)].map(|p| p.as_vec3().to_array());
        let light = random.vector(6.0).extend(f64::from(trial % 3).min(1.0)).as_vec4();
        let ends = positions.map(|p| DVec3::from(p.map(f64::from)));
        let mut found = None;
        let mut bins = Bins::default();
        bins.clear(SIZE);
        sight().quads(&sides(&positions, side(light), light), |quad, footprint| {
            bins.add(1, footprint, [0, 0, SIZE[0], SIZE[1]]);
            found = Some(quad);
        });
        let (mut entries, mut groups, mut places) = (Vec::new(), Vec::new(), Vec::new());
        bins.append(&mut entries, &mut groups, &mut places);
        for pixel in (0..64).map(|k| [k % 8 * 40 + trial % 40, k / 8 * 25 + trial % 25]) {
            let met = meets(ends, light, pixel);
            let Some(quad) = &found else {
                assert!(met.is_none_or(|(_, p)| p.abs().max_element() > 9.0), "trial {trial}: not in sight");
                continue;
            };
            let [edge, first, second, depth] = values(quad, pixel);
            // The silhouette edge is off by the grid it is put on.
            if edge.abs() < 0.01 || first.abs().min(second.abs()) < 1e-2 || depth.abs() < 1e-5 {
                continue;
            }
            let inside = edge > 0.0 && first > 0.0 && second < 0.0 && depth > 0.0;
            assert_eq!(inside, met.is_some(), "trial {trial}, pixel {pixel:?}: {quad:?}");
            let Some((distance, point)) = met else { continue };
            assert!((depth * distance / NEAR - 1.0).abs() < 1e-3, "trial {trial}: {depth} at {distance}");
            if point.abs().max_element() < 9.0 && distance > NEAR {
                let tile = ((pixel[1] / TILE) << 16) | (pixel[0] / TILE);
                assert!(places.contains(&tile), "trial {trial}, pixel {pixel:?} is not in the footprint");
            }
            hits += 1;
            behind += usize::from(ends.iter().any(|p| p.z > 0.0));
        }
    }
    assert!(hits > 1000 && behind > 200, "{hits} hits, {behind} of quads that begin behind the eye");
}

#[test]
fn neighbours_share_their_edge_to_the_bit() {
    let mut random = Random(5);
    for trial in 0..200 {
        let positions = [0; 3].map(|_| random.vector(4.0).as_vec3().to_array());
        let light = (random.vector(4.0) + DVec3::Y * 9.0).extend(1.0).as_vec4();
        // Sides from 1 to 0 and from 2 to 1.
        let indices = [0, 2, 3, 0, 3, 1, 2, 4, 5, 2, 5, 3];
        let mut quads = Vec::new();
        sight().quads(&sides(&positions, &indices, light), |quad, _| quads.push(quad));
        let [q, r] = quads[..] else { continue };
        let edge = |quad: &Quad, i: usize| [quad.across[i], quad.down[i], quad.middle[i]].map(f32::to_bits);
        let shared = [1, 2].iter().flat_map(|&i| [1, 2].map(|j| (edge(&q, i), edge(&r, j)))).filter(|(e, f)| e == f);
        assert_eq!(shared.count(), 1, "trial {trial}: {q:?} {r:?}");
    }
}

#[test]
fn repeated_and_mirrored_sides_have_their_weight() {
    let light = Vec4::new(0.0, 5.0, -3.0, 1.0);
    let positions = [[-1.0, 0.0, -3.5], [1.0, 0.0, -3.0]];
    let once = side(light);
    let weights = |indices: &[u32], mirrored| {
        let mut weights = Vec::new();
        let sides = Sides { mirrored, ..sides(&positions, indices, light) };
        sight().quads(&sides, |quad, _| weights.push(quad.weight[0]));
        weights
    };
    let [weight] = weights(once, false)[..] else { panic!("one quad") };
    assert_eq!(weight.abs(), 1);
    assert_eq!(weights(&[once, once].concat(), false), [2 * weight]);
    assert_eq!(weights(once, true), [-weight]);
}

/// A volume is closed only if all edges of a vertex run through one point. Rounding some of them to the rasteriser's grid once
/// let light through at vertices of models, in the middle of their shadows.
#[test]
fn the_edges_of_a_quad_meet_in_its_corners() {
    let mut random = Random(77);
    let light = Vec4::new(0.3, 2.0, -3.0, 1.0);
    let mut seen = 0;
    for _ in 0..200 {
        let points = [0; 2].map(|_: u32| DVec3::new(0.0, 0.0, -4.0) + random.vector(1.5));
        let positions = points.map(|p| p.as_vec3().to_array());
        sight().quads(&sides(&positions, side(light), light), |quad, _| {
            for p in positions {
                let p = DVec3::from(p.map(f64::from));
                let c = view().clip_from_view() * p.extend(1.0);
                let [u, v] = [160.0 * c.x / c.w, -100.0 * c.y / c.w];
                let value =
                    |i: usize| f64::from(quad.across[i]) * u + f64::from(quad.down[i]) * v + f64::from(quad.middle[i]);
                // On the silhouette edge and on one of the others; in pixels.
                assert!(value(0).abs() < 1e-4, "{} pixels beside the silhouette edge", value(0));
                assert!(value(1).abs().min(value(2).abs()) < 1e-4, "{} and {}", value(1), value(2));
            }
            seen += 1;
        });
    }
    assert!(seen > 100, "{seen} quads");
}
