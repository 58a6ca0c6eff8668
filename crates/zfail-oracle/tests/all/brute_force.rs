//! The oracle against a plain O(triangles) ray caster that shares no code with it.

use crate::common::{Random, at, cube, floor, look, point_light, scene, soup, sphere};
use zfail_oracle::{Cast, CastTable, Oracle};
use zfail_plan::glam::{DAffine3, DMat3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::{Projection, View};
use zfail_scene::{Light, Scene, world_triangle};

struct Triangle {
    v: [DVec3; 3],
    key: (usize, usize),
}

fn triangles(scene: &Scene) -> Vec<Triangle> {
    let mut list = Vec::new();
    for (i, instance) in scene.instances.iter().enumerate() {
        let mesh = &scene.meshes[instance.mesh];
        for t in 0..mesh.triangles.len() {
            let mut v = world_triangle(mesh, &instance.world_from_object, t);
            if instance.world_from_object.matrix3.determinant() < 0.0 {
                v.reverse();
            }
            list.push(Triangle { v, key: (i, t) });
        }
    }
    list
}

/// Moeller-Trumbore: parameter along the ray and whether it meets the front.
fn intersect(v: &[DVec3; 3], origin: DVec3, direction: DVec3) -> Option<(f64, bool)> {
    let (e1, e2) = (v[1] - v[0], v[2] - v[0]);
    let p = direction.cross(e2);
    let det = e1.dot(p);
    let s = origin - v[0];
    let (u, q) = (s.dot(p) / det, s.cross(e1));
    let w = direction.dot(q) / det;
    (det != 0.0 && u >= 0.0 && w >= 0.0 && u + w <= 1.0).then(|| (e2.dot(q) / det, det > 0.0))
}

/// Mask and count at every pixel's centre; `None` for background.
fn render(scene: &Scene, view: &View, light: &Light, cast: fn(usize, usize) -> Cast) -> Vec<Option<(u8, i32)>> {
    let list = triangles(scene);
    let [width, height] = view.size;
    let clip = view.clip_from_view().inverse();
    (0..width * height)
        .map(|i| {
            let x = 2.0 * (f64::from(i % width) + 0.5) / f64::from(width) - 1.0;
            let y = 1.0 - 2.0 * (f64::from(i / width) + 0.5) / f64::from(height);
            let through = clip * DVec3::new(x, y, 1.0).extend(1.0);
            let near = view.world_from_view.transform_point3(through.truncate() / through.w);
            let direction = match view.projection {
                Projection::Perspective { .. } => near - view.eye(),
                Projection::Orthographic { .. } => -view.world_from_view.matrix3.z_axis,
            };
            let hit =
                |t: &Triangle| intersect(&t.v, near, direction).filter(|h| h.0 > 0.0 && h.1).map(|h| (h.0, t.key));
            let (depth, face) = list.iter().filter_map(hit).min_by(|a, b| a.0.total_cmp(&b.0))?;
            let point = near + direction * depth;
            let (to_light, reach) = match light.kind {
                LightKind::Point { position, .. } | LightKind::Spot { position, .. } => (position - point, 1.0),
                LightKind::Directional { direction } => (-direction, f64::INFINITY),
            };
            let (mut count, mut blocked) = (0, false);
            for t in &list {
                let normal = (t.v[1] - t.v[0]).cross(t.v[2] - t.v[0]);
                let front = normal.dot(to_light) > 0.0;
                let crossed = match t.key == face {
                    true => !front,
                    false => intersect(&t.v, point, to_light).is_some_and(|h| h.0 > 0.0 && h.0 < reach),
                };
                blocked |= crossed;
                count += i32::from(crossed) * cast(t.key.0, t.key.1).weight(front);
            }
            Some((if !blocked && light.kind.reaches(point) { 255 } else { 0 }, count))
        })
        .collect()
}

/// Compares all pixels that are free of doubt; returns how many.
fn agree(name: &str, scene: &Scene, view: &View, cast: fn(usize, usize) -> Cast) -> usize {
    let light = &scene.lights[0];
    let truth = Oracle::new(scene).judge(view, light, &CastTable::from_fn(scene, cast));
    let plain = render(scene, view, light, cast);
    let (mut checked, mut doubtful) = (0, 0);
    for (i, (pixel, plain)) in truth.pixels.iter().zip(plain).enumerate() {
        let place = format!("{name} ({}, {}): {pixel:?} {plain:?}", i as u32 % view.size[0], i as u32 / view.size[0]);
        doubtful += usize::from(pixel.mask_doubt.is_some() || pixel.count_doubt.is_some());
        if pixel.mask_doubt.is_none() {
            assert_eq!(pixel.surface, plain.is_some(), "{place}");
            assert_eq!(pixel.mask(), plain.map_or(0, |p| p.0), "{place}");
            checked += usize::from(pixel.surface);
        }
        if pixel.count_doubt.is_none() && pixel.surface {
            assert_eq!(Some(pixel.count), plain.map(|p| p.1), "{place}");
        }
    }
    assert!(doubtful * 10 < truth.pixels.len() * 3, "{name}: {doubtful} doubtful");
    println!("{name}: {checked} checked, {doubtful} doubtful");
    checked
}

const POLICIES: [fn(usize, usize) -> Cast; 4] = [
    |_, _| Cast::Double,
    |_, _| Cast::Front,
    |_, _| Cast::Back,
    |_, t| [Cast::None, Cast::Front, Cast::Back, Cast::Double][t % 4],
];

#[test]
fn solids_over_a_floor() {
    let parts = vec![
        (floor(6.0), DAffine3::IDENTITY),
        (sphere(0.9, 12), at(0.0, 1.5, 0.0)),
        (cube(0.5), DAffine3::from_rotation_y(0.5) * at(1.4, 0.9, 0.6)),
        (cube(0.4), at(-1.5, 0.7, 0.5) * DAffine3::from_scale(DVec3::new(-1.0, 1.2, 0.7))),
    ];
    let lights = [
        point_light(2.0, 4.0, 1.0),
        point_light(0.1, 1.5, 0.1),
        LightKind::Directional { direction: DVec3::new(-0.4, -1.0, -0.3).normalize() },
        LightKind::Spot {
            position: DVec3::new(1.0, 4.0, 2.0),
            direction: DVec3::new(-0.2, -1.0, -0.4).normalize(),
            range: 5.5,
            inner: 0.2,
            outer: 0.45,
        },
    ];
    let view = look(DVec3::new(2.5, 3.0, 4.0), DVec3::new(0.0, 0.6, 0.0), [128, 72]);
    let flat = View { projection: Projection::Orthographic { ymag: 2.0, near: -1.0, far: 30.0 }, ..view };
    for (i, light) in lights.into_iter().enumerate() {
        let scene = scene(parts.clone(), light);
        for (j, cast) in POLICIES.into_iter().enumerate() {
            assert!(agree(&format!("light {i} policy {j}"), &scene, &view, cast) > 4000);
            assert!(agree(&format!("ortho {i} policy {j}"), &scene, &flat, cast) > 4000);
        }
    }
}

#[test]
fn random_soups() {
    let mut checked = 0;
    for seed in 0..40 {
        let mut random = Random(seed);
        let light = match seed % 3 {
            0 => LightKind::Directional { direction: random.vector(1.0).normalize() },
            _ => LightKind::Point { position: random.vector(1.0), range: f64::INFINITY },
        };
        let shear = DMat3::from_cols(random.vector(1.0), random.vector(1.0), random.vector(1.0));
        let parts = vec![
            (soup(&mut random, 12, 1.0), DAffine3::IDENTITY),
            (soup(&mut random, 12, 1.0), DAffine3::from_mat3(shear)),
        ];
        let view = look(random.vector(2.0), random.vector(0.3), [64, 48]);
        checked += agree(&format!("soup {seed}"), &scene(parts, light), &view, POLICIES[seed as usize % 4]);
    }
    assert!(checked > 20_000, "{checked}");
}

/// The same scene a million metres away has the same truth.
#[test]
fn far_from_the_origin() {
    let offset = DVec3::new(1.0e6, -3.0e5, 7.0e5);
    let parts = vec![(floor(6.0), DAffine3::IDENTITY), (sphere(0.9, 12), at(0.0, 1.5, 0.0))];
    let moved = parts.iter().map(|(m, a)| (m.clone(), DAffine3::from_translation(offset) * *a)).collect();
    let view = look(DVec3::new(2.5, 3.0, 4.0), DVec3::new(0.0, 0.6, 0.0), [128, 72]);
    let mut far = view;
    far.world_from_view.translation += offset;
    let near_scene = scene(parts, point_light(2.0, 4.0, 1.0));
    let far_scene = scene(moved, point_light(2.0 + offset.x, 4.0 + offset.y, 1.0 + offset.z));
    let judge = |s: &Scene, v| Oracle::new(s).judge(v, &s.lights[0], &CastTable::double(s));
    let (a, b) = (judge(&near_scene, &view), judge(&far_scene, &far));
    let differing = a.pixels.iter().zip(&b.pixels).filter(|(a, b)| {
        a.mask_doubt.is_none() && b.mask_doubt.is_none() && (a.mask(), a.count) != (b.mask(), b.count)
    });
    assert_eq!(differing.count(), 0);
    assert!(a.pixels.iter().filter(|p| p.mask_doubt.is_none() && p.surface).count() > 5000);
}
