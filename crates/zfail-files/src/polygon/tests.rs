//! Triangulations are judged by what they must be: bounded by the polygon, wound as it is, and as large.

use super::Triangulator;
use glam::{DVec3, Vec2, Vec3};
use rustc_hash::FxHashMap;
use std::f32::consts::TAU;
use zfail_testing::Random;

/// A number in 0..1.
fn random(numbers: &mut Random) -> f32 {
    (numbers.next() >> 40) as f32 / (1_u32 << 24) as f32
}

/// The triangles of a polygon, and what was wrong with it.
fn cut(points: &[Vec3]) -> (Vec<[u32; 3]>, Option<String>) {
    let mut triangles = Vec::new();
    let corners: Vec<u32> = (0..points.len() as u32).collect();
    let mut triangulator = Triangulator::default();
    triangulator.cut(&corners, |v| points[v as usize].into(), &mut triangles);
    (triangles, triangulator.notice())
}

fn flat(points: &[Vec2]) -> Vec<Vec3> {
    points.iter().map(|p| p.extend(0.0)).collect()
}

fn fan(corners: usize) -> Vec<[u32; 3]> {
    (2..corners as u32).map(|v| [0, v - 1, v]).collect()
}

/// Edges by place, as often as they are run along one way more than the other.
fn net(edges: impl Iterator<Item = [Vec3; 2]>) -> FxHashMap<[[u32; 3]; 2], i32> {
    let mut net = FxHashMap::default();
    for ends in edges {
        let [a, b] = ends.map(|p| (p + 0.0).to_array().map(f32::to_bits));
        if a != b {
            *net.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
        }
    }
    net.retain(|_, count| *count != 0);
    net
}

/// Whether the polygon is the boundary of the triangles.
fn bounds(points: &[Vec3], triangles: &[[u32; 3]]) -> bool {
    let edges = triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]);
    let polygon = points.iter().zip(points.iter().cycle().skip(1)).map(|(a, b)| [*a, *b]);
    net(edges.map(|ends| ends.map(|v| points[v as usize]))) == net(polygon)
}

/// What is wrong with a triangulation of a polygon that does not cross itself, seen along `up`, x and y being exact. With
/// the right boundary, no triangle turned over and the right area, the triangles can neither overlap nor lie outside.
fn fault(points: &[Vec3], triangles: &[[u32; 3]], up: Vec3) -> Option<String> {
    let double = |v: u32| DVec3::from(points[v as usize].to_array().map(f64::from));
    let up = DVec3::from(up.to_array().map(f64::from)).normalize();
    let areas = triangles.iter().map(|t| {
        let [a, b, c] = t.map(double);
        (b - a).cross(c - a).dot(up)
    });
    let (sum, least) = areas.fold((0.0, 0.0_f64), |(sum, least), area| (sum + area, least.min(area)));
    let corners = points.len() as u32;
    let whole: f64 = (0..corners).map(|v| double(v).cross(double((v + 1) % corners)).dot(up)).sum();
    let slack = 1e-6 * whole.abs();
    if !bounds(points, triangles) {
        Some("another boundary".into())
    } else if least < if up.z == 1.0 { 0.0 } else { -slack } {
        Some(format!("a triangle of {least}"))
    } else if (sum - whole).abs() > slack {
        Some(format!("an area of {sum} instead of {whole}"))
    } else {
        None
    }
}

fn star(corners: u32, numbers: &mut Random) -> Vec<Vec2> {
    let spike = |i: u32| Vec2::from_angle(i as f32 * TAU / corners as f32) * (0.1 + random(numbers));
    (0..corners).map(spike).collect()
}

/// Teeth that lean over by `lean` of their height.
fn comb(teeth: u32, lean: f32, numbers: &mut Random) -> Vec<Vec2> {
    let tooth = |i: u32| {
        let (x, height) = (i as f32, 1.0 + 9.0 * random(numbers));
        [Vec2::new(x, 0.0), Vec2::new(x + 0.4 + lean * height, height)]
    };
    let mut points: Vec<Vec2> = (0..teeth).flat_map(tooth).collect();
    points.extend([Vec2::new(teeth as f32, 0.0), Vec2::new(teeth as f32, -1.0), Vec2::new(0.0, -1.0)]);
    points.reverse();
    points
}

/// An arm that winds around `laps` times.
fn spiral(corners: u32, laps: f32) -> Vec<Vec2> {
    let half = corners / 2;
    let at = |i: u32, width: f32| {
        let turn = laps * i as f32 / half as f32;
        Vec2::from_angle(TAU * turn) * (1.0 + turn + width)
    };
    (0..half).map(|i| at(i, 0.5)).chain((0..half).rev().map(|i| at(i, 0.0))).collect()
}

/// A square with square holes, each at the end of a bridge from its corner.
fn holes() -> Vec<Vec2> {
    let square =
        |at: Vec2, size: f32| [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|p| at + size * Vec2::from_array(p));
    let mut points = square(Vec2::ZERO, 10.0).to_vec();
    for (x, y) in [(6.0, 1.0), (4.0, 4.0), (1.0, 6.0)] {
        let [a, b, c, d] = square(Vec2::new(x, y), 2.0);
        points.extend([Vec2::ZERO, a, d, c, b, a]);
    }
    points
}

#[test]
fn convex_ones_become_fans() {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from_array);
    assert_eq!(cut(&flat(&square)).0, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(cut(&flat(&square[..3])).0, [[0, 1, 2]]);
    assert!(cut(&flat(&square[..2])).0.is_empty() && cut(&[]).0.is_empty());
    let round: Vec<Vec2> = (0..500).map(|i| Vec2::from_angle(i as f32 * TAU / 500.0)).collect();
    assert_eq!(cut(&flat(&round)), (fan(500), None));
    assert_eq!(cut(&[Vec3::ONE; 5]).0.len(), 3, "a polygon without area");
}

#[test]
fn every_simple_polygon_is_covered_once() {
    let mut numbers = Random(1);
    let mut polygons = vec![holes(), spiral(1000, 7.0), spiral(133, 2.0)];
    for k in 0..60 {
        polygons.push(star(4 + 7 * k, &mut numbers));
        polygons.push(comb(2 + 3 * k, k as f32 / 10.0, &mut numbers));
    }
    let (mut fans_fail, count) = (0, polygons.len());
    for (i, polygon) in polygons.into_iter().enumerate() {
        for turn in [0.0, 1.1] {
            // Tilted, with rounded corners, and flat, with exact ones.
            let up = Vec3::new(0.6 * turn, -0.7 * turn, 1.0).normalize();
            let (right, ahead) = if turn == 0.0 { (Vec3::X, Vec3::Y) } else { up.any_orthonormal_pair() };
            let mut points: Vec<Vec3> = polygon.iter().map(|p| right * p.x + ahead * p.y).collect();
            for up in [up, -up] {
                let (triangles, notice) = cut(&points);
                assert_eq!((fault(&points, &triangles, up), notice), (None, None), "polygon {i}, towards {up}");
                assert_eq!(triangles.len(), points.len() - 2);
                points.reverse();
            }
            fans_fail += usize::from(fault(&points, &fan(points.len()), up).is_some());
        }
    }
    assert!(fans_fail > count * 3 / 2, "fans are caught: {fans_fail}");
}

#[test]
fn corners_on_edges_and_double_corners_stay() {
    let l = [[2, 1], [1, 1], [1, 1], [1, 2], [1, 3], [0, 3], [0, 0], [1, 0], [1, 0], [2, 0]];
    let points = flat(&l.map(|[x, y]| Vec2::new(x as f32, y as f32)));
    let (triangles, notice) = cut(&points);
    assert_eq!((fault(&points, &triangles, Vec3::Z), notice), (None, None));
    let used = |v: usize| triangles.iter().flatten().any(|&c| points[c as usize] == points[v]);
    assert!((0..points.len()).all(used), "no corner is lost");
    assert!(fault(&points, &triangles[1..], Vec3::Z).is_some(), "a triangle that lacks is seen");
    let turned = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect::<Vec<_>>();
    assert!(fault(&points, &turned, Vec3::Z).is_some(), "triangles that are turned over are seen");
}

/// Both ends of a bridge are two corners, which may differ in all but their place.
#[test]
fn corners_at_one_place_are_told_apart() {
    let points = flat(&holes());
    let (triangles, _) = cut(&points);
    let mut used = vec![false; points.len()];
    triangles.iter().flatten().for_each(|&v| used[v as usize] = true);
    assert!(used.iter().all(|&used| used), "{used:?}");
}

#[test]
fn edges_that_touch_others_stay_edges() {
    // A notch whose tip lies on the opposite edge.
    let notch = [[0, 0], [4, 0], [4, 4], [2, 0], [0, 4]].map(|[x, y]| Vec2::new(x as f32, y as f32));
    let points = flat(&notch);
    let (triangles, notice) = cut(&points);
    assert_eq!((fault(&points, &triangles, Vec3::Z), notice), (None, None));
}

#[test]
fn polygons_that_cross_themselves_keep_their_edges() {
    let mut numbers = Random(5);
    for corners in 4..80 {
        let scattered: Vec<Vec3> = (0..corners)
            .map(|_| Vec3::new(random(&mut numbers), random(&mut numbers), 0.1 * random(&mut numbers)))
            .collect();
        let (triangles, notice) = cut(&scattered);
        assert!(bounds(&scattered, &triangles), "{corners} corners");
        assert!(corners < 6 || notice.is_some(), "{corners} corners");
        assert!(triangles.len() <= 64 * scattered.len());
    }
    // One crossing, far from most of the polygon: the rest is as it should be.
    let mut twisted = comb(100, 0.0, &mut numbers);
    twisted.extend([Vec2::new(-2.0, -1.0), Vec2::new(-2.0, 0.0)]);
    let points = flat(&twisted);
    let (triangles, notice) = cut(&points);
    assert!(bounds(&points, &triangles) && notice.unwrap().contains("near the crossings"));
    let net: f32 =
        points.iter().zip(points.iter().cycle().skip(1)).map(|(a, b)| a.truncate().perp_dot(b.truncate())).sum();
    let all = triangles.iter().map(|t| {
        let [a, b, c] = t.map(|v| points[v as usize].truncate());
        (b - a).perp_dot(c - a).abs()
    });
    let overlap = all.sum::<f32>() - net;
    assert!((0.5..8.0).contains(&overlap), "{overlap}");
    // Scribbles, and corners that hide each other.
    let scribble: Vec<Vec3> = (0..20_000).map(|_| Vec3::new(random(&mut numbers), random(&mut numbers), 0.0)).collect();
    let (triangles, notice) = cut(&scribble);
    assert!(bounds(&scribble, &triangles) && notice.unwrap().contains("all over"));
    let step = [[0, 0, 0], [3, 0, 0], [1, 1, 0], [1, 1, 1], [0, 3, 0]].map(|p| Vec3::from_array(p.map(|x| x as f32)));
    assert!(bounds(&step, &cut(&step).0));
}

#[test]
fn many_corners_take_little_time() {
    let mut numbers = Random(9);
    let many = [
        star(100_000, &mut numbers),
        comb(50_000, 0.0, &mut numbers),
        comb(50_000, 1000.0, &mut numbers),
        spiral(100_000, 50.0),
    ];
    for polygon in many {
        let points = flat(&polygon);
        let started = std::time::Instant::now();
        let (triangles, notice) = cut(&points);
        println!("{} corners: {:?} {notice:?}", points.len(), started.elapsed());
        assert_eq!(fault(&points, &triangles, Vec3::Z), None);
    }
}
