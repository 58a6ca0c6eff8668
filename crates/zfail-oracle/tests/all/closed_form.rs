//! The oracle against shadows whose outline is known in closed form.

use crate::common::{at, cube, floor, point_light, scene, sphere};
use zfail_oracle::{Cast, CastTable, Doubt, Oracle, Truth};
use zfail_plan::glam::{DAffine3, DMat3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::{Projection, View};
use zfail_scene::{AlphaMode, Material, Mesh, Scene};

/// Looks straight down; world x and z of every pixel of the plane y = 0 follow.
const SIZE: [u32; 2] = [200, 200];

fn from_above() -> View {
    let down = DAffine3::from_translation(DVec3::new(0.0, 9.0, 0.0));
    let world_from_view = down * DAffine3::from_rotation_x(-std::f64::consts::FRAC_PI_2);
    View::new(world_from_view, Projection::Orthographic { ymag: 4.0, near: 8.0, far: 20.0 }, SIZE)
}

fn judge(scene: &Scene) -> Truth {
    Oracle::new(scene).judge(&from_above(), &scene.lights[0], &CastTable::double(scene))
}

/// Asserts that the shadow on the floor is where `shadowed(x, z, margin)` says, which is `None` within the margin.
fn expect(scene: &Scene, shadowed: impl Fn(f64, f64) -> Option<bool>) {
    let truth = judge(scene);
    let (mut lit, mut dark) = (0, 0);
    for (i, pixel) in truth.pixels.iter().enumerate() {
        let x = ((i as u32 % SIZE[0]) as f64 + 0.5 - 100.0) * 0.04;
        let z = ((i as u32 / SIZE[0]) as f64 + 0.5 - 100.0) * 0.04;
        assert!(pixel.surface);
        let Some(expected) = shadowed(x, z) else { continue };
        assert_eq!(pixel.mask_doubt, None, "({x}, {z})");
        assert_eq!(pixel.lit, !expected, "({x}, {z})");
        lit += u32::from(!expected);
        dark += u32::from(expected);
    }
    assert!(lit > 5000 && dark > 1000, "{lit} lit, {dark} dark");
}

/// `None` if `distance` to the outline is less than `margin`, else whether it is negative.
fn clear(distance: f64, margin: f64) -> Option<bool> {
    (distance.abs() > margin).then_some(distance < 0.0)
}

#[test]
fn a_sphere_throws_a_disc() {
    // Light and centre on one vertical: the tangent cone meets the floor in a circle around the origin.
    let (light, center, radius) = (6.0f64, 3.0, 0.7f64);
    let parts = vec![(floor(5.0), DAffine3::IDENTITY), (sphere(radius, 64), at(0.0, center, 0.0))];
    let sine = radius / (light - center);
    let disc = light * sine / (1.0 - sine * sine).sqrt();
    // The polyhedron's outline lies at most this much inside the circle.
    let flat = disc * (1.0 - (std::f64::consts::PI / 64.0).cos()) * 1.5;
    let scene = scene(parts, point_light(0.0, light, 0.0));
    // The camera starts below the sphere: near is 8 and the eye at 9.
    expect(&scene, |x, z| clear(x.hypot(z) - disc, flat + 0.01));
}

#[test]
fn a_cube_throws_its_top_face_enlarged() {
    // Seen from straight above, the outline of the shadow is that of the top face, from (1.3, 8, 0) to y = 0.
    let (half, height, light) = (0.5, 4.0, DVec3::new(1.3, 8.0, -0.4));
    let scene = scene(
        vec![(floor(5.0), DAffine3::IDENTITY), (cube(half as f32), at(0.0, height, 0.0))],
        point_light(light.x, light.y, light.z),
    );
    let project = |y: f64, x: f64, l: f64| l + (x - l) * light.y / (light.y - y);
    let corners = |l: f64| {
        let all = [height - half, height + half].map(|y| [-half, half].map(|x| project(y, x, l)));
        (all[1][0].min(all[0][0]), all[1][1].max(all[0][1]))
    };
    let ((x0, x1), (z0, z1)) = (corners(light.x), corners(light.z));
    // The hull of both faces differs from its bounding box near two corners, where this test does not look.
    expect(&scene, |x, z| {
        let distance = (x0 - x).max(x - x1).max(z0 - z).max(z - z1);
        let bottom = [light.x, light.z].map(|l| [-half, half].map(|x| project(height - half, x, l)));
        let sure = (bottom[0][0]..bottom[0][1]).contains(&x) && (bottom[1][0]..bottom[1][1]).contains(&z);
        match () {
            () if distance > 0.01 => Some(false),
            () if sure => clear(distance, 0.01),
            () => None,
        }
    });
}

#[test]
fn the_sun_shifts_a_square() {
    let direction = DVec3::new(0.5, -1.0, 0.25);
    let parts = vec![(floor(5.0), DAffine3::IDENTITY), (floor(1.0), at(0.0, 2.0, 0.0))];
    let scene = scene(parts, LightKind::Directional { direction: direction.normalize() });
    expect(&scene, |x, z| clear((x - 1.0).abs().max((z - 0.5).abs()) - 1.0, 0.01));
}

#[test]
fn a_spot_reaches_a_disc_and_counts_stop_there() {
    let kind = LightKind::Spot {
        position: DVec3::new(0.0, 4.0, 0.0),
        direction: DVec3::NEG_Y,
        range: 100.0,
        inner: 0.1,
        outer: 0.5,
    };
    let scene = scene(vec![(floor(5.0), DAffine3::IDENTITY)], kind);
    let truth = judge(&scene);
    let disc = 4.0 * 0.5f64.tan();
    for (i, pixel) in truth.pixels.iter().enumerate() {
        let x = (f64::from(i as u32 % SIZE[0]) + 0.5 - 100.0) * 0.04;
        let z = (f64::from(i as u32 / SIZE[0]) + 0.5 - 100.0) * 0.04;
        if let Some(reached) = clear(x.hypot(z) - disc, 0.01) {
            assert_eq!((pixel.reached, pixel.mask_doubt), (reached, None));
            assert_eq!(pixel.mask(), if reached { 255 } else { 0 });
        }
    }
}

#[test]
fn a_light_in_a_box_reaches_no_farther() {
    let mut scene = scene(vec![(floor(5.0), DAffine3::IDENTITY)], point_light(0.5, 3.0, 0.0));
    let shape = &mut scene.lights[0].shape;
    shape.half_extents = Some(DVec3::new(2.0, 3.5, 0.8));
    shape.axes = DMat3::from_rotation_y(0.6);
    let across = shape.axes.transpose();
    let mut inside = 0;
    for (i, pixel) in judge(&scene).pixels.iter().enumerate() {
        let x = (f64::from(i as u32 % SIZE[0]) + 0.5 - 100.0) * 0.04;
        let z = (f64::from(i as u32 / SIZE[0]) + 0.5 - 100.0) * 0.04;
        let local = (across * DVec3::new(x - 0.5, 0.0, z)).abs();
        if let Some(reached) = clear((local.x - 2.0).max(local.z - 0.8), 0.01) {
            assert_eq!((pixel.reached, pixel.mask_doubt), (reached, None), "({x}, {z})");
            inside += u32::from(reached);
        }
    }
    assert!((3500..4500).contains(&inside), "{inside} pixels inside");
    scene.lights[0].shape.half_extents = Some(DVec3::new(2.0, 2.5, 0.8));
    assert!(judge(&scene).pixels.iter().all(|pixel| !pixel.reached), "the floor is below the box");
}

fn stack(count: u32) -> Scene {
    let sheets = (0..count).map(|i| (floor(1.0), at(0.0, 2.0 + f64::from(i) * 0.01, 0.0)));
    let parts = std::iter::once((floor(5.0), DAffine3::IDENTITY)).chain(sheets).collect();
    scene(parts, LightKind::Directional { direction: DVec3::NEG_Y })
}

#[test]
fn three_hundred_sheets_count_three_hundred() {
    let scene = stack(300);
    let truth = judge(&scene);
    let centre = truth.pixels[100 * 200 + 90];
    assert_eq!((centre.lit, centre.count, centre.count_doubt), (false, 300, None));
    let double = truth.compare_count(&truth.counts()).unwrap();
    assert_eq!((double.wrong.len(), double.max_count), (0, 300));
    let backs = CastTable::from_fn(&scene, |_, _| Cast::Back);
    let truth = Oracle::new(&scene).judge(&from_above(), &scene.lights[0], &backs);
    assert_eq!(truth.pixels[100 * 200 + 90].count, 0);
}

#[test]
fn materials_and_exclusions() {
    let with = |change: fn(&mut Scene)| {
        let mut scene = stack(1);
        scene.materials.push(Material::default());
        scene.meshes[1].primitives[0].material = Some(1);
        change(&mut scene);
        judge(&scene).pixels[100 * 200 + 90]
    };
    assert!(!with(|_| {}).lit);
    assert!(with(|s| s.materials[1].alpha = AlphaMode::Blend).lit);
    let cast = with(|s| (s.materials[1].alpha, s.blended_casts) = (AlphaMode::Blend, true));
    assert!(!cast.lit && cast.surface);
    let unseen = with(|s| (s.materials[0].alpha, s.blended_casts) = (AlphaMode::Blend, true));
    assert!(!unseen.surface, "blended surfaces cast without being seen");
    assert!(!with(|s| s.materials[1].alpha = AlphaMode::Mask(0.5)).lit, "masked triangles cast as solid ones");
    assert!(with(|s| s.instances[1].casts_shadow = false).lit);
    assert!(with(|s| s.lights[0].excluded = vec![1]).lit);
    let masked = with(|s| s.materials[0].alpha = AlphaMode::Mask(0.5));
    assert_eq!(masked.mask_doubt, Some(Doubt::Alpha));
}

/// The lit point is on the eye's side of its own triangle; back faces are seen only of double-sided materials.
#[test]
fn the_eye_below_a_sheet_sees_its_dark_side() {
    let mut scene = scene(vec![(floor(5.0), DAffine3::IDENTITY)], point_light(0.3, 2.0, 0.2));
    let mut below = from_above();
    below.world_from_view = DAffine3::from_rotation_x(std::f64::consts::PI) * below.world_from_view;
    let look =
        |scene: &Scene| Oracle::new(scene).judge(&below, &scene.lights[0], &CastTable::double(scene)).pixels[8123];
    assert!(!look(&scene).surface);
    scene.materials[0].double_sided = true;
    let pixel = look(&scene);
    assert_eq!((pixel.surface, pixel.lit, pixel.count, pixel.mask_doubt), (true, false, 1, None));
    scene.instances[0].casts_shadow = false;
    assert!(look(&scene).lit, "what casts no shadow does not shade its own back");
    // Two coincident sheets, wound oppositely, are two crossings.
    scene.instances[0].casts_shadow = true;
    let mut twin: Mesh = scene.meshes[0].clone();
    twin.triangles.iter_mut().for_each(|t| t.reverse());
    scene.meshes.push(twin);
    let mut instance = scene.instances[0].clone();
    instance.mesh = 1;
    scene.instances.push(instance);
    let pixel = look(&scene);
    assert_eq!((pixel.lit, pixel.count, pixel.mask_doubt), (false, 2, None));
}

/// A light exactly on a face, an edge or a vertex of a cube shines outwards only: the far faces block the rest.
#[test]
fn lights_on_a_cube() {
    for light in [DVec3::new(0.25, 4.0, 0.25), DVec3::new(1.0, 4.0, 0.0), DVec3::new(1.0, 4.0, 1.0)] {
        let parts = vec![(floor(5.0), DAffine3::IDENTITY), (cube(1.0), at(0.0, 3.0, 0.0))];
        let truth = judge(&scene(parts, point_light(light.x, light.y, light.z)));
        let below = truth.pixels[100 * 200 + 100];
        assert_eq!((below.lit, below.count, below.mask_doubt), (false, 1, None), "{light}");
    }
}
