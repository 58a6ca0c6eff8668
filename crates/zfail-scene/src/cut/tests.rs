//! The outline is where alpha says, triangles keep what is inside of it, and meshes stay whole.

use super::field::AlphaField;
use super::limits::Step;
use super::outline::Outline;
use super::simplify::simplify;
use super::trace::{generic, trace};
use super::triangle::{Corner, Cut, UNIT, Weights, cut};
use super::{Limits, Source, cut_masked, derive};
use crate::{AlphaMode, Filter, Image, Instance, Material, Mesh, Primitive, Scene, Texture, TextureRef, Wrap};
use glam::{DAffine3, DVec2, DVec3};
use rustc_hash::FxHashMap;
use zfail_testing::Random;

pub(super) fn image([width, height]: [u32; 2], mut alpha: impl FnMut(f64, f64) -> f64) -> Image {
    let texels = (0..height).flat_map(|y| (0..width).map(move |x| (f64::from(x) + 0.5, f64::from(y) + 0.5)));
    let rgba = texels.flat_map(|(x, y)| [0, 0, 0, alpha(x, y).clamp(0.0, 255.0) as u8]).collect();
    Image { name: "mask".into(), width, height, rgba }
}

pub(super) fn texture(wrap: [Wrap; 2], mag: Filter) -> Texture {
    Texture { image: 0, wrap_u: wrap[0], wrap_v: wrap[1], mag, min: mag, mipmaps: true }
}

const REPEAT: [Wrap; 2] = [Wrap::Repeat; 2];

const RADIUS: f64 = 20.0;

/// A disc of [`RADIUS`] texels in the middle of 64 x 64, with an edge of two texels. The cutoff of one half is its rim.
fn disc() -> Image {
    image([64, 64], |x, y| 127.5 + 64.0 * (RADIUS - (x - 32.0).hypot(y - 32.0)))
}

pub(super) fn noise(size: [u32; 2], random: &mut Random) -> Image {
    image(size, |_, _| 256.0 * random.unit())
}

fn length_to(point: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let t = ((point - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    point.distance(a.lerp(b, t))
}

/// The greatest distance from a point of `from` to `to`, which repeat after `period` texels.
fn one_sided_hausdorff(from: &[[DVec2; 2]], to: &[[DVec2; 2]], period: f64) -> f64 {
    let points = from.iter().flat_map(|[a, b]| (0..4).map(|k| a.lerp(*b, f64::from(k) / 4.0)));
    let nearest = |point: DVec2| {
        let shifted = |ends: &[DVec2; 2]| {
            let shift = ((point - ends[0]) / period).round() * period;
            (-1..=1)
                .flat_map(|x| (-1..=1).map(move |y| DVec2::new(f64::from(x), f64::from(y)) * period))
                .map(|tile| length_to(point, ends.map(|end| end + shift + tile)))
                .fold(f64::INFINITY, f64::min)
        };
        to.iter().map(shifted).fold(f64::INFINITY, f64::min)
    };
    points.map(nearest).fold(0.0, f64::max)
}

#[test]
fn a_disc_is_round_to_within_the_tolerance() {
    let (image, texture) = (disc(), texture([Wrap::Clamp; 2], Filter::Linear));
    let outline = |tolerance| Outline::new(AlphaField::new(&image, &texture, 0), 127.5, tolerance, 10_000).unwrap();
    // Bytes and bilinear interpolation leave the disc this far from a circle.
    const ROUNDNESS: f64 = 0.03;
    let worst = |tolerance: f64| {
        let off = |p: DVec2| (p.distance(DVec2::splat(32.0)) - RADIUS).abs();
        let segments = outline(tolerance);
        let middles = segments.segments().iter().flat_map(|[a, b]| [*a, a.midpoint(*b)]);
        middles.map(off).fold(0.0, f64::max)
    };
    for tolerance in [0.1, 0.25, 1.0, 3.0] {
        assert!(worst(tolerance) <= tolerance + ROUNDNESS, "{tolerance}: {}", worst(tolerance));
    }
    assert!(worst(3.0) > 0.25 + ROUNDNESS, "a coarser one is caught");
    let counts = [0.1, 0.25, 1.0, 3.0].map(|tolerance| outline(tolerance).segments().len());
    assert!(counts.is_sorted_by(|a, b| a > b) && counts[3] <= 8, "{counts:?}");
}

#[test]
fn polygons_are_near_the_curve_and_the_curve_near_the_polygons() {
    let mut random = Random(1);
    let image = noise([24, 24], &mut random);
    let texture = texture(REPEAT, Filter::Linear);
    let field = AlphaField::new(&image, &texture, 0);
    let segments = |tolerance| Outline::new(field.clone(), 140.0, tolerance, 100_000).unwrap().segments().to_vec();
    let (fine, middle, coarse) = (segments(1.0 / 64.0), segments(0.5), segments(8.0));
    for other in [[&fine, &middle], [&middle, &fine]] {
        let distance = one_sided_hausdorff(other[0], other[1], 24.0);
        assert!(distance <= 0.5 + 1.0 / 64.0, "{distance}");
    }
    assert!(one_sided_hausdorff(&fine, &coarse, 24.0) > 0.6, "a coarser one is caught");
}

/// Contours of pixels that are there or not meet in points half-way between them, at the height of many a middle.
#[test]
fn contours_that_touch_have_sides() {
    let mut random = Random(4);
    let texture = texture(REPEAT, Filter::Linear);
    let wrong_at = |image: &Image, level: f64| {
        let field = AlphaField::new(image, &texture, 0);
        let outline = Outline::new(field.clone(), 127.5, 1.0 / 64.0, 1_000_000).unwrap();
        let at = |k: i32| DVec2::new(f64::from(k % 128) / 8.0 + 1.0 / 64.0, f64::from(k / 128) / 8.0);
        let is_clear = |p: DVec2| (field.at(p) - level).abs() > 12.0;
        let wrong = |p: DVec2| outline.contains(p) != (field.at(p) >= level);
        (0..128 * 128).map(at).filter(|&p| is_clear(p) && wrong(p)).count()
    };
    for _ in 0..20 {
        let dither = image([16, 16], |_, _| if random.unit() < 0.5 { 0.0 } else { 255.0 });
        assert_eq!(wrong_at(&dither, 127.5), 0);
        assert!(wrong_at(&dither, 160.0) > 0, "another level is caught");
    }
}

/// Pairs of segments that cross, on a plane that repeats after `period` texels.
fn crossings(segments: &[[DVec2; 2]], period: f64) -> usize {
    let side = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a);
    let tiles = || (-2..=2).flat_map(|x| (-2..=2).map(move |y| DVec2::new(f64::from(x), f64::from(y))));
    let mut count = 0;
    for (i, &[a, b]) in segments.iter().enumerate() {
        for other in &segments[..i] {
            for tile in tiles() {
                let [c, d] = other.map(|end| end + tile * period);
                let crosses = side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
                count += usize::from(crosses);
            }
        }
    }
    count
}

#[test]
fn no_contours_cross_and_none_is_lost() {
    let mut random = Random(2);
    for (filter, level) in [(Filter::Linear, 100.0), (Filter::Linear, 128.0), (Filter::Nearest, 128.0)] {
        let image = noise([16, 16], &mut random);
        let texture = texture(REPEAT, filter);
        let field = AlphaField::new(&image, &texture, 0);
        let rings = trace(&field, generic(level), 0.1, 100_000).unwrap();
        for tolerance in [0.2, 1.0, 100.0] {
            let simple = simplify(&rings, field.axes, tolerance);
            assert_eq!(simple.len(), rings.len());
            let segments: Vec<_> = simple
                .iter()
                .flat_map(|ring| {
                    let next = ring.points.iter().skip(1).copied().chain([ring.points[0] + ring.closing]);
                    ring.points.iter().copied().zip(next).map(|(a, b)| [a, b])
                })
                .collect();
            assert_eq!(crossings(&segments, 16.0), 0, "{filter:?} at {level} to within {tolerance}");
        }
    }
    let cross = [[DVec2::ZERO, DVec2::ONE], [DVec2::X, DVec2::Y]];
    assert_eq!(crossings(&cross, 16.0), 1, "a crossing is seen");
}

/// Triangles of pieces on the plane of the texture.
pub(super) fn on_plane(pieces: &[[Weights; 3]], texels: [DVec2; 3]) -> Vec<[DVec2; 3]> {
    let place = |weights: Weights| {
        let [u, v, w] = weights.map(|w| f64::from(w) / f64::from(UNIT));
        texels[0] * u + texels[1] * v + texels[2] * w
    };
    pieces.iter().map(|piece| piece.map(place)).collect()
}

/// How many of some points in random triangles a cut along `drawn` keeps or leaves out wrongly by `expected`; points
/// within a few hundredths of a texel of the contour do not count. Also how many were checked.
fn misjudged(drawn: (&AlphaField<'_>, f64), expected: (&AlphaField<'_>, f64), random: &mut Random) -> [usize; 2] {
    let outline = Outline::new(drawn.0.clone(), drawn.1, 1.0 / 64.0, 1_000_000).unwrap();
    let (field, level) = (expected.0, generic(expected.1));
    let mut counts = [0; 2];
    for _ in 0..20 {
        let corner = |random: &mut Random| DVec2::new(random.unit(), random.unit()) * 40.0 - 16.0;
        let mut texels = [corner(random), corner(random), corner(random)];
        if random.unit() < 0.3 {
            // Through nodes and along the borders of texels.
            texels = texels.map(|p| (2.0 * p).round() / 2.0);
        }
        let position = |k: usize| [random.unit() as f32, k as f32, 0.0];
        let positions = [0, 1, 2].map(position);
        let corners = std::array::from_fn(|k| Corner { position: positions[k], texel: texels[k] });
        let pieces = match cut(&outline, corners) {
            Cut::Whole => vec![[[UNIT, 0, 0], [0, UNIT, 0], [0, 0, UNIT]]],
            Cut::Nothing => Vec::new(),
            Cut::Pieces(pieces) => pieces,
        };
        for &[a, b, c] in &pieces {
            let [a, b, c] = [a, b, c].map(|[_, x, y]| [i64::from(x), i64::from(y)]);
            let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            assert!(twice > 0, "a piece is turned over");
        }
        let pieces = on_plane(&pieces, texels);
        for _ in 0..200 {
            let (mut u, mut v) = (random.unit(), random.unit());
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let point = texels[0] + (texels[1] - texels[0]) * u + (texels[2] - texels[0]) * v;
            let there = field.at(point) >= level;
            let around = (0..16).map(|k| point + DVec2::from_angle(f64::from(k) * std::f64::consts::FRAC_PI_8) * 0.03);
            if around.into_iter().any(|near| (field.at(near) >= level) != there) {
                continue;
            }
            let inside = |[a, b, c]: &[DVec2; 3]| {
                let side = |p: DVec2, q: DVec2| (q - p).perp_dot(point - p);
                let sides = [side(*a, *b), side(*b, *c), side(*c, *a)];
                sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s <= 0.0)
            };
            counts[0] += usize::from(pieces.iter().any(inside) != there);
            counts[1] += 1;
        }
    }
    counts
}

#[test]
fn every_wrapping_and_filter_is_cut_where_alpha_says() {
    let mut random = Random(3);
    let wraps = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp];
    for (i, &u) in wraps.iter().enumerate() {
        for &v in &wraps {
            for filter in [Filter::Linear, Filter::Nearest] {
                let image = noise([7, 5], &mut random);
                let field = |wrap_u, level: f64| (AlphaField::new(&image, &texture([wrap_u, v], filter), 0), level);
                let (truth, other, level) = (field(u, 128.0), field(wraps[(i + 1) % 3], 128.0), 90.0);
                let [wrong, checked] = misjudged((&truth.0, 128.0), (&truth.0, 128.0), &mut random);
                assert!(wrong == 0 && checked > 1500, "{u:?} {v:?} {filter:?}: {wrong} of {checked}");
                let [wrong, checked] = misjudged((&truth.0, 128.0), (&other.0, 128.0), &mut random);
                assert!(wrong * 20 > checked, "{u:?} {v:?} {filter:?}: another wrapping is caught");
                let [wrong, checked] = misjudged((&truth.0, level), (&truth.0, 128.0), &mut random);
                assert!(wrong * 50 > checked, "{u:?} {v:?} {filter:?}: another cutoff is caught");
            }
        }
    }
}

/// A square of 1 m with its texture `tiles` times across, as two triangles, which share no vertices if `seam`.
pub(super) fn square(image: Image, tiles: f32, seam: bool) -> Scene {
    let at = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let (corners, triangles) = if seam {
        (vec![0, 1, 2, 0, 2, 3], vec![[0, 1, 2], [3, 4, 5]])
    } else {
        (vec![0, 1, 2, 3], vec![[0, 1, 2], [0, 2, 3]])
    };
    let mesh = Mesh {
        name: "square".into(),
        positions: corners.iter().map(|&k: &usize| [at[k][0], at[k][1], 0.37 * at[k][0]]).collect(),
        normals: vec![[0.0, 0.0, 1.0]; corners.len()],
        uv0: corners.iter().map(|&k| at[k].map(|x| x * tiles)).collect(),
        primitives: vec![Primitive { triangles: 0..triangles.len() as u32, material: Some(0) }],
        triangles,
        ..Mesh::default()
    };
    let material =
        Material { base_color_texture: Some(TextureRef::new(0)), alpha: AlphaMode::Mask(0.5), ..Material::default() };
    let textures = vec![texture(REPEAT, Filter::Linear)];
    Scene { meshes: vec![mesh], materials: vec![material], textures, images: vec![image], ..Scene::default() }
}

pub(super) fn area(mesh: &Mesh) -> f64 {
    let of = |&[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [a, b, c].map(|v| mesh.position(v));
        DVec3::Z.dot((b - a).cross(c - a)) / 2.0
    };
    mesh.triangles.iter().map(of).sum()
}

/// Edges that only one triangle has, by position, as pairs of points.
pub(super) fn open_edges(mesh: &Mesh) -> Vec<[DVec2; 2]> {
    let mut uses: FxHashMap<[[u32; 3]; 2], i32> = FxHashMap::default();
    for triangle in &mesh.triangles {
        for i in 0..3 {
            let ends = [triangle[i], triangle[(i + 1) % 3]].map(|v| mesh.positions[v as usize].map(f32::to_bits));
            *uses.entry([ends[0].min(ends[1]), ends[0].max(ends[1])]).or_default() += 1;
        }
    }
    let place = |[x, y, _]: [u32; 3]| DVec2::new(f32::from_bits(x).into(), f32::from_bits(y).into());
    uses.into_iter().filter(|&(_, uses)| uses == 1).map(|(ends, _)| ends.map(place)).collect()
}

#[test]
fn the_area_is_that_of_the_mask() {
    let cut_area = |tolerance: f64| {
        let mut scene = square(disc(), 3.0, false);
        cut_masked(&mut scene, tolerance, Limits::default());
        area(&scene.meshes[0]) * (3.0 * 64.0_f64).powi(2)
    };
    // Nine discs; the error is at most the area within the tolerance of their rims.
    let truth = 9.0 * std::f64::consts::PI * RADIUS * RADIUS;
    let bound = |tolerance: f64| 9.0 * std::f64::consts::TAU * RADIUS * tolerance;
    for tolerance in [0.05, 0.25, 1.0] {
        assert!((cut_area(tolerance) - truth).abs() <= bound(tolerance + 0.03), "{tolerance}");
    }
    assert!((cut_area(4.0) - truth).abs() > bound(0.25), "a coarser cut is caught");
}

#[test]
fn triangles_that_were_joined_stay_joined() {
    for seam in [false, true] {
        let mut scene = square(disc(), 2.5, seam);
        let cuts = cut_masked(&mut scene, 0.5, Limits::default());
        let mesh = &scene.meshes[0];
        let on_diagonal = |p: DVec2| (p.x - p.y).abs() < 1e-6;
        let cracks = |mesh: &Mesh| open_edges(mesh).into_iter().filter(|e| e.iter().all(|&p| on_diagonal(p))).count();
        assert_eq!(cracks(mesh), 0, "seam: {seam}");
        // Vertices of the same place fold the same way.
        let fold = |p: [f32; 3]| [p[0].sin(), p[1] * 1.7 - 0.3 * p[0], p[0] * p[1]];
        let corners: Vec<_> = mesh.positions[..if seam { 6 } else { 4 }].iter().map(|&p| fold(p)).collect();
        let folded = derive(&cuts[0].sources, &corners);
        let positions: Vec<_> = corners.iter().copied().chain(folded).collect();
        let folded = Mesh { positions, ..mesh.clone() };
        assert_eq!(open_edges(&folded).len(), open_edges(mesh).len(), "seam: {seam}");
        let moved = |v: usize| {
            let mut mesh = mesh.clone();
            mesh.positions[v][2] += 1e-3;
            mesh
        };
        let on_diagonal = |s: &Source| s.weights[2] == 0.0 && s.corners.contains(&0) && s.corners.contains(&2);
        let on_edge = cuts[0].sources.iter().position(on_diagonal);
        let crack = moved(corners.len() + on_edge.expect("a disc lies on the diagonal"));
        assert_eq!(cracks(&crack) > 0, seam, "a crack is seen");
    }
}

#[test]
fn masked_materials_become_opaque_where_they_are_cut() {
    let mut scene = square(disc(), 1.0, false);
    let before = scene.clone();
    let cuts = cut_masked(&mut scene, 1.0, Limits::default());
    let mesh = &scene.meshes[0].clone();
    assert_eq!((cuts.len(), cuts[0].mesh, cuts[0].tolerance), (1, 0, 1.0));
    assert_eq!(mesh.positions.len(), 4 + cuts[0].sources.len());
    assert!(mesh.positions.len() == mesh.normals.len() && mesh.positions.len() == mesh.uv0.len());
    assert_eq!(mesh.positions[..4], before.meshes[0].positions);
    assert_eq!(derive(&cuts[0].sources, &before.meshes[0].uv0), mesh.uv0[4..]);
    assert_eq!(mesh.primitives[0].material, Some(1));
    assert_eq!((scene.materials[0].alpha, scene.materials[1].alpha), (AlphaMode::Mask(0.5), AlphaMode::Opaque));
    assert!(scene.notices.is_empty());
    assert!(cut_masked(&mut scene, 1.0, Limits::default()).is_empty(), "nothing is left to cut");

    let mut wider = before.clone();
    wider.materials[0].alpha = AlphaMode::Mask(0.1);
    cut_masked(&mut wider, 1.0, Limits::default());
    assert!(area(&wider.meshes[0]) > 1.02 * area(mesh), "a lower cutoff keeps more");
    let mut even = before.clone();
    even.materials[0].base_color[3] = 0.4;
    cut_masked(&mut even, 1.0, Limits::default());
    assert!(even.meshes[0].triangles.is_empty(), "alpha is below the cutoff everywhere");
    even = before.clone();
    even.materials[0].base_color_texture = None;
    cut_masked(&mut even, 1.0, Limits::default());
    assert_eq!(even.meshes[0].triangles, before.meshes[0].triangles);
}

#[test]
fn meshes_beyond_the_limits_are_cut_coarsely_or_not_at_all() {
    let cut = |limits: Limits| {
        let mut scene = square(disc(), 4.0, false);
        scene.instances.push(Instance {
            name: "square".into(),
            mesh: 0,
            world_from_object: DAffine3::from_scale(DVec3::splat(2.0)),
            casts_shadow: true,
            receives_shadow: true,
        });
        let cuts = cut_masked(&mut scene, 0.05, limits);
        (cuts.first().map(|cut| cut.tolerance), scene.meshes[0].triangles.len() as u64, scene.notices)
    };
    let (tolerance, all, notices) = cut(Limits::default());
    assert!(tolerance == Some(0.05) && all > 500 && notices.is_empty());
    for part in [2, 4, 16] {
        // Of what a scene may have beyond its growth, a mesh gets half.
        let (tolerance, some, notices) = cut(Limits { triangles: 2 * all / part, growth: 0, ..Limits::default() });
        assert!(tolerance > Some(0.05) && some <= all / part && notices.len() == 1, "{tolerance:?}, {notices:?}");
        assert!(notices[0].contains("--alpha-shadows solid") && notices[0].contains(" m)"), "{notices:?}");
    }
    let (tolerance, grown, _) = cut(Limits { triangles: 0, growth: all, ..Limits::default() });
    assert!((tolerance, grown) == (Some(0.05), all));
    let (tolerance, whole, notices) = cut(Limits { triangles: 0, growth: 0, ..Limits::default() });
    assert!(tolerance.is_none() && whole == 2 && notices[0].contains("whole triangles"), "{notices:?}");
}

/// Noise, dither and a board of single pixels take as long as one likes unless they are counted first.
#[test]
fn detail_without_end_is_thinned_out() {
    let mut random = Random(11);
    let limits = Limits { triangles: 20_000, growth: 64, points: 40_000, ..Limits::default() };
    let board = image([256, 200], |x, y| if (x + y).rem_euclid(2.0) < 1.0 { 255.0 } else { 0.0 });
    for (image, tiles) in [(noise([301, 257], &mut random), 1.0), (noise([64, 64], &mut random), 30.0), (board, 1.0)] {
        let mut scene = square(image, tiles, false);
        let cuts = cut_masked(&mut scene, 1.0, limits);
        assert!(scene.meshes[0].triangles.len() <= 10_128);
        assert!(cuts[0].tolerance > 2.0 && scene.notices.len() == 1, "{:?}", scene.notices);
    }
}

/// What is drawn of a thinned mask is near to what is there: the bound that the notice states.
#[test]
fn edges_of_thinned_masks_are_near_true_ones() {
    let (disc, texture) = (disc(), texture([Wrap::Clamp; 2], Filter::Linear));
    let worst = |halvings: u32, tolerance: f64| {
        let field = AlphaField::new(&disc, &texture, halvings);
        let outline = Outline::new(field, 127.5, tolerance, 10_000).unwrap();
        let stretch = f64::from(halvings).exp2();
        let off = |p: DVec2| ((stretch * p).distance(DVec2::splat(32.0)) - RADIUS).abs();
        outline.segments().iter().flat_map(|&[a, b]| [off(a), off(a.midpoint(b))]).fold(0.0, f64::max)
    };
    for halvings in 1..4 {
        let bound = Step { halvings, tolerance: 1.0 }.error(f64::from(halvings).exp2());
        let off = worst(halvings, 1.0);
        assert!(off <= bound && off > 0.0, "{halvings}: {off} beyond {bound}");
    }
    let bound = Step { halvings: 1, tolerance: 1.0 }.error(2.0);
    assert!(worst(1, 30.0) > bound, "a coarser one is caught: {} within {bound}", worst(1, 30.0));
}

/// As much stays there as was, where an average would be all or nothing.
#[test]
fn thinned_masks_keep_their_share() {
    let mut random = Random(12);
    let texture = texture(REPEAT, Filter::Nearest);
    let share = |image: &Image, halvings: u32| {
        let field = AlphaField::new(image, &texture, halvings);
        let [w, h] = field.size().to_array().map(|x| x as i64);
        let there = (0..w * h).filter(|k| field.at_node([k % w, k / w]) >= 100.0).count();
        ([w, h], there as f64 / (w * h) as f64)
    };
    let board = image([128, 128], |x, y| if (x + y).rem_euclid(2.0) < 1.0 { 255.0 } else { 0.0 });
    let odd = noise([401, 203], &mut random);
    assert_eq!((share(&odd, 2).0, share(&odd, 30).0), ([100, 50], [1, 1]));
    for (image, expected) in [(&board, 0.5), (&odd, 156.0 / 256.0)] {
        for halvings in 0..3 {
            let (_, share) = share(image, halvings);
            assert!((share - expected).abs() < 0.04, "{halvings}: {share} instead of {expected}");
        }
    }
    assert!((share(&odd, 1).1 - 0.5).abs() > 0.04, "another share is caught");
}

#[test]
fn what_cannot_be_cut_stays() {
    let mut far = square(disc(), 1e30, false);
    far.meshes[0].uv0[1] = [f32::MAX, f32::MIN];
    assert!(cut_masked(&mut far, 1.0, Limits::default()).is_empty());
    assert_eq!((far.meshes[0].triangles.len(), far.notices.len()), (2, 1));
    let mut nothing = square(disc(), 1.0, false);
    nothing.meshes[0].uv0.clear();
    cut_masked(&mut nothing, f64::NAN, Limits::default());
    assert!(nothing.meshes[0].triangles.is_empty(), "all of it is at the texture's corner, where nothing is");
}
