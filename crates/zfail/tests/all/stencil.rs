//! The zero-tolerance tests of the stencil on whatever device there is: closure, order, depth of stack, cameras.

use crate::stage::{self, Random, Setup, Soup, stencil};
use zfail::glam::{DAffine3, DMat3, DQuat, DVec3};
use zfail::{Counting, LightKind, Projection, View};

/// Triangles over few shared vertices: every edge has many of them.
fn soup(random: &mut Random) -> Soup {
    let positions = (0..9).map(|_| random.vector(1.0).as_vec3().to_array()).collect();
    let triangles = (0..18).map(|_| [0; 3].map(|_: u32| random.below(9) as u32)).collect();
    (positions, triangles)
}

fn sheet(y: f32, half: f32) -> Soup {
    let p = |x: f32, z: f32| [x * half, y, z * half];
    (vec![p(-1.0, -1.0), p(1.0, -1.0), p(1.0, 1.0), p(-1.0, 1.0)], vec![[0, 2, 1], [0, 3, 2]])
}

fn look_at(eye: DVec3, target: DVec3) -> DAffine3 {
    let back = (eye - target).normalize();
    let right = back.any_orthonormal_vector().cross(back).normalize();
    DAffine3 { matrix3: DMat3::from_cols(right, back.cross(right), back), translation: eye }
}

const SIZE: [u32; 2] = [160, 120];

fn perspective(world_from_view: DAffine3) -> View {
    View::new(world_from_view, Projection::Perspective { yfov: 1.0, near: 0.05, far: None }, SIZE)
}

fn orthographic(world_from_view: DAffine3) -> View {
    View::new(world_from_view, Projection::Orthographic { ymag: 3.0, near: 0.05, far: 20.0 }, SIZE)
}

/// A scene of soups with the light outside or among them, seen from far outside along the light's direction, where the near
/// rectangle is often lit; [`near_count`] tells.
fn lit_eye(random: &mut Random, directional: bool, ortho: bool) -> (View, Vec<(Soup, DAffine3)>, LightKind) {
    let meshes = (0..3)
        .map(|_| {
            let turn = DMat3::from_quat(DQuat::from_scaled_axis(random.vector(3.0)));
            let scale = DMat3::from_diagonal(DVec3::new(random.real(0.3, 1.0), random.real(-1.0, -0.3), 0.7));
            (soup(random), DAffine3 { matrix3: turn * scale, translation: random.vector(1.2) })
        })
        .collect();
    let outward = random.vector(1.0).normalize();
    let light = if directional {
        LightKind::Directional { direction: -outward }
    } else {
        LightKind::Point { position: outward * random.real(0.0, 1.5), range: f64::INFINITY }
    };
    // The light is at most 1.5 from the centre, casters reach at most 3.3: an eye beside the light would be shadowed
    // where the light is among them.
    let place = look_at(outward * 8.0 + random.vector(0.5), random.vector(0.5));
    (if ortho { orthographic(place) } else { perspective(place) }, meshes, light)
}

/// How many triangles separate the light from the near rectangle's centre, in f64 by brute force; `None` if some
/// corner disagrees.
fn near_count(view: &View, meshes: &[(Soup, DAffine3)], light: &LightKind) -> Option<u32> {
    let (half_y, half_x) = match view.projection {
        Projection::Perspective { yfov, near, .. } => {
            ((0.5 * yfov).tan() * near, (0.5 * yfov).tan() * near * view.aspect())
        }
        Projection::Orthographic { ymag, .. } => (ymag, ymag * view.aspect()),
    };
    let steps = 8;
    let mut counts = (0..=steps).flat_map(|i| (0..=steps).map(move |j| (i, j))).map(|(i, j)| {
        let at = |k: i32| 2.0 * f64::from(k) / f64::from(steps) - 1.0;
        let q = view.world_from_view.transform_point3(DVec3::new(at(i) * half_x, at(j) * half_y, -view.near()));
        let l = light.homogeneous();
        let to = l.truncate() - q * l.w;
        let mut n = 0;
        for ((positions, triangles), world_from_object) in meshes {
            for t in triangles {
                let [a, b, c] = t.map(|v| {
                    world_from_object.transform_point3(DVec3::from_array(positions[v as usize].map(f64::from))) - q
                });
                let det = a.dot(b.cross(c));
                let k = [b.cross(c), c.cross(a), a.cross(b)].map(|m| m.dot(to) / det);
                if k.iter().all(|&x| x > 0.0) && (l.w == 0.0 || k.iter().sum::<f64>() > 1.0) {
                    n += 1;
                }
            }
        }
        n
    });
    let first = counts.next()?;
    counts.all(|n| n == first).then_some(first)
}

/// Closure: with a surface right at the near plane, every fragment of the volume counts, and what is left is the
/// number of layers over the near rectangle, the same at every pixel.
fn closure(setup: Setup, ortho: bool) {
    // Not quite 1: clamping brings what lies before the near plane to 1, and that must not count.
    let setup = Setup { depth_clear: 1.0 - 1e-6, draw_depth: false, ..setup };
    let mut scenes = 0;
    let mut shadowed = 0;
    for seed in 0..40 {
        let mut random = Random(seed);
        let (view, meshes, light) = lit_eye(&mut random, seed % 3 == 0, ortho);
        let mut meshes = meshes;
        if seed % 4 == 1 {
            // A wall large enough to hide the whole near rectangle from the light.
            let before = DAffine3::from_translation(DVec3::NEG_Z * 0.5) * DAffine3::from_rotation_x(1.5);
            meshes.push((sheet(0.0, 9.0), view.world_from_view * before));
        }
        let Some(expected) = near_count(&view, &meshes, &light) else { continue };
        let image = stencil(&setup, &view, &meshes, light);
        let wrong = image.iter().filter(|&&s| u32::from(s) != expected).count();
        assert_eq!(wrong, 0, "seed {seed}: {wrong} open pixels, {expected} layers expected");
        scenes += 1;
        shadowed += usize::from(expected > 0);
    }
    assert!(scenes >= 15, "only {scenes} of 40 scenes have an evenly lit near rectangle");
    assert!(shadowed >= 5, "only {shadowed} scenes have the eye in shadow");
    println!("{scenes} scenes closed, {shadowed} of them with the eye in shadow");
}

#[test]
fn volumes_of_soups_are_closed() {
    if !stage::has_device() {
        return;
    }
    closure(Setup::default(), false);
}

#[test]
fn volumes_of_soups_are_closed_with_four_samples() {
    if !stage::has_device() {
        return;
    }
    closure(Setup { samples: 4, ..Setup::default() }, false);
}

#[test]
fn volumes_of_soups_are_closed_in_24_bits() {
    if !stage::has_device() {
        return;
    }
    closure(Setup { depth_stencil: wgpu::TextureFormat::Depth24PlusStencil8, ..Setup::default() }, false);
}

#[test]
fn volumes_of_soups_are_closed_under_an_orthographic_camera() {
    if !stage::has_device() {
        return;
    }
    closure(Setup::default(), true);
    closure(Setup { samples: 4, ..Setup::default() }, true);
}

#[test]
fn volumes_of_soups_are_closed_when_depth_is_clamped_by_hand() {
    if !stage::has_device() {
        return;
    }
    closure(Setup { clip_control: false, ..Setup::default() }, true);
    closure(Setup { clip_control: false, samples: 4, ..Setup::default() }, true);
}

#[test]
fn a_surface_cut_by_the_near_plane_of_an_orthographic_view_does_not_shadow_itself() {
    if !stage::has_device() {
        return;
    }
    // A floor that reaches before the near plane, under a grazing sun behind it: its light cap has to be clipped as
    // the depth pass was, or their depths differ.
    let back = DVec3::new(0.4, 0.5, 0.76).normalize();
    let right = DVec3::Y.cross(back).normalize();
    let place =
        DAffine3 { matrix3: DMat3::from_cols(right, back.cross(right), back), translation: DVec3::new(2.7, 2.9, 3.9) };
    let view = View { projection: Projection::Orthographic { ymag: 2.65, near: 2.0, far: 30.0 }, ..perspective(place) };
    let light = LightKind::Directional { direction: DVec3::new(0.445, -0.061, 0.893).normalize() };
    for clip_control in [true, false] {
        let setup = Setup { clip_control, ..Setup::default() };
        let image = stencil(&setup, &view, &[(sheet(0.0, 9.0), DAffine3::IDENTITY)], light);
        let shadowed = image.iter().filter(|&&s| s > 0).count();
        assert_eq!(shadowed, 0, "clip control {clip_control}: {shadowed} pixels of a lit floor in shadow");
    }
}

#[test]
fn an_open_volume_is_noticed() {
    if !stage::has_device() {
        return;
    }
    // The negative control of closure: with depth cleared to infinity sides pass the depth test and do not count, which
    // leaves dark caps alone, as if the volumes were open.
    let setup = Setup { depth_clear: 0.0, draw_depth: false, ..Setup::default() };
    let mut noticed = 0;
    for seed in [1, 4, 7, 10, 13] {
        let mut random = Random(seed);
        let (view, meshes, _) = lit_eye(&mut random, false, false);
        // The light beside the eye: the caps at infinity are in view.
        let light = LightKind::Point { position: view.eye() + DVec3::splat(0.2), range: f64::INFINITY };
        let Some(expected) = near_count(&view, &meshes, &light) else { continue };
        let image = stencil(&setup, &view, &meshes, light);
        noticed += usize::from(image.iter().any(|&s| u32::from(s) != expected));
    }
    assert!(noticed >= 4, "open volumes were noticed in {noticed} of 5 scenes");
}

#[test]
fn the_order_of_triangles_does_not_matter() {
    if !stage::has_device() {
        return;
    }
    for seed in 0..6 {
        let mut random = Random(100 + seed);
        let (view, meshes, light) = lit_eye(&mut random, false, false);
        let mut shuffled = meshes.clone();
        for ((_, triangles), _) in &mut shuffled {
            for i in (1..triangles.len()).rev() {
                triangles.swap(i, random.below(i + 1));
            }
        }
        shuffled.reverse();
        let a = stencil(&Setup::default(), &view, &meshes, light);
        let b = stencil(&Setup::default(), &view, &shuffled, light);
        zfail_testing::assert_alike(&format!("another order, seed {seed}"), SIZE, &b, &a, 0);
        assert!(a.iter().any(|&s| s > 0));
    }
}

/// `layers` sheets between a light above and a floor; one mesh each or all in one.
fn stack(layers: u32, one_mesh: bool) -> Vec<(Soup, DAffine3)> {
    let mut meshes = vec![(sheet(0.0, 20.0), DAffine3::IDENTITY)];
    let height = |i: u32| 2.0 + 2.0 * i as f32 / layers as f32;
    if one_mesh {
        let mut all: Soup = (Vec::new(), Vec::new());
        for i in 0..layers {
            let (positions, triangles) = sheet(height(i), 1.0);
            let base = all.0.len() as u32;
            all.0.extend(positions);
            all.1.extend(triangles.iter().map(|t| t.map(|v| v + base)));
        }
        meshes.push((all, DAffine3::IDENTITY));
    } else {
        meshes.extend((0..layers).map(|i| (sheet(height(i), 1.0), DAffine3::IDENTITY)));
    }
    meshes
}

/// Looks at the floor under the stack, from the side and from below the lowest sheet.
fn beside_the_stack() -> View {
    perspective(look_at(DVec3::new(4.0, 1.8, 0.3), DVec3::ZERO))
}

#[test]
fn any_number_of_layers_is_shadow() {
    if !stage::has_device() {
        return;
    }
    let lamps = [
        LightKind::Point { position: DVec3::new(0.0, 10.0, 0.0), range: f64::INFINITY },
        LightKind::Directional { direction: DVec3::NEG_Y },
    ];
    for light in lamps {
        let setup = |counting| Setup { counting, ..Setup::default() };
        let one = stencil(&setup(Counting::Verdict), &beside_the_stack(), &stack(1, true), light);
        assert!(one.iter().filter(|&&s| s > 0).count() > 500, "the shadow of one layer is in view");
        for (layers, one_mesh) in [(256, true), (256, false), (1000, true), (1000, false)] {
            let meshes = stack(layers, one_mesh);
            let many = stencil(&setup(Counting::Verdict), &beside_the_stack(), &meshes, light);
            // Wherever one layer shadows the floor, many do; the sheets themselves hide parts of the view.
            let centre = one.iter().zip(&many).filter(|&(&o, &m)| o > 0 && m == 0).count();
            let exposed = one.iter().zip(&many).filter(|&(&o, _)| o > 0).count();
            assert!(centre * 50 < exposed, "{layers} layers: {centre} of {exposed} pixels wrongly lit");
            if layers == 256 {
                let raw = stencil(&setup(Counting::Raw), &beside_the_stack(), &meshes, light);
                let wrapped = one.iter().zip(&raw).filter(|&(&o, &m)| o > 0 && m == 0).count();
                assert!(wrapped * 2 > exposed, "negative control: the plain count of 256 layers wraps to zero");
            }
        }
    }
}

#[test]
fn distance_from_the_origin_changes_nothing() {
    if !stage::has_device() {
        return;
    }
    let far = DVec3::new(1e6, -2e6, 5e5);
    for seed in 0..4 {
        let mut random = Random(300 + seed);
        let (view, mut meshes, _) = lit_eye(&mut random, false, false);
        let light = |offset| LightKind::Point { position: DVec3::new(0.3, 4.0, 1.0) + offset, range: f64::INFINITY };
        let near = stencil(&Setup::default(), &view, &meshes, light(DVec3::ZERO));
        let mut moved = view;
        moved.world_from_view.translation += far;
        for (_, place) in &mut meshes {
            place.translation += far;
        }
        let there = stencil(&Setup::default(), &moved, &meshes, light(far));
        let different = near.iter().zip(&there).filter(|(a, b)| a != b).count();
        // f64 keeps 10^-10 m at this distance: a pixel on an edge may change, an area may not.
        assert!(different <= 2, "seed {seed}: {different} pixels differ");
        assert!(near.iter().any(|&s| s > 0));
    }
}

#[test]
fn a_finite_far_plane_gives_the_same_verdicts() {
    if !stage::has_device() {
        return;
    }
    for seed in 0..4 {
        let mut random = Random(400 + seed);
        let (view, mut meshes, light) = lit_eye(&mut random, seed % 2 == 0, false);
        // Without a surface there is no verdict, and clamped depth ties with the background.
        let backdrop =
            view.world_from_view * DAffine3::from_translation(DVec3::NEG_Z * 15.0) * DAffine3::from_rotation_x(1.5);
        meshes.push((sheet(0.0, 30.0), backdrop));
        let finite = View { projection: Projection::Perspective { yfov: 1.0, near: 0.05, far: Some(40.0) }, ..view };
        let infinite = stencil(&Setup::default(), &view, &meshes, light);
        for clip_control in [true, false] {
            let setup = Setup { clip_control, ..Setup::default() };
            let clamped = stencil(&setup, &finite, &meshes, light);
            let different = infinite.iter().zip(&clamped).filter(|(a, b)| a != b).count();
            assert!(different <= 4, "seed {seed}, clip control {clip_control}: {different} pixels differ");
        }
    }
}
