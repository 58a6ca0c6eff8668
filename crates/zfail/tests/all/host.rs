//! The images of the example host against rays, and against themselves without shadows.

use zfail::glam::DVec3;
use zfail::{LightKind, View};

#[path = "../../examples/host/forward.rs"]
mod forward;
#[path = "../../examples/host/scene.rs"]
mod scene;

use forward::Host;
use scene::{Scene, scene, view};

type Error = Box<dyn std::error::Error>;

const SIZE: [u32; 2] = [192, 108];

/// World-space triangles of the scene.
fn triangles(scene: &Scene) -> Vec<[DVec3; 3]> {
    let corner = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    scene
        .objects
        .iter()
        .flat_map(|o| {
            let mesh = &scene.meshes[o.mesh];
            mesh.triangles
                .iter()
                .map(|t| t.map(|v| o.world_from_object.transform_point3(corner(mesh.positions[v as usize]))))
        })
        .collect()
}

/// Distance along the ray to the triangle.
fn hit([a, b, c]: &[DVec3; 3], origin: DVec3, along: DVec3) -> Option<f64> {
    let (e, f) = (b - a, c - a);
    let p = along.cross(f);
    let det = e.dot(p);
    let s = origin - a;
    let (u, v) = (s.dot(p) / det, along.dot(s.cross(e)) / det);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| f.dot(s.cross(e)) / det).filter(|&t| t > 1e-6)
}

/// Per light whether it reaches what pixel (x, y) sees; `None` where nothing is seen.
fn reached(scene: &Scene, view: &View, all: &[[DVec3; 3]], x: f64, y: f64) -> Option<Vec<bool>> {
    let tangent = (0.5_f64 * 0.8).tan();
    let ndc = [2.0 * x / f64::from(SIZE[0]) - 1.0, 1.0 - 2.0 * y / f64::from(SIZE[1])];
    let along = DVec3::new(ndc[0] * tangent * view.aspect(), ndc[1] * tangent, -1.0);
    let along = view.world_from_view.transform_vector3(along);
    let seen = all.iter().filter_map(|t| hit(t, view.eye(), along)).fold(f64::INFINITY, f64::min);
    if seen.is_infinite() {
        return None;
    }
    // The point just on the eye's side of the surface.
    let point = view.eye() + along * (seen - 1e-6);
    let blocked = |kind: &LightKind| {
        let l = kind.homogeneous();
        let to = l.truncate() - point * l.w;
        let end = if l.w == 0.0 { f64::INFINITY } else { 1.0 };
        all.iter().any(|t| hit(t, point, to).is_some_and(|d| d < end))
    };
    Some(scene.lights.iter().map(|l| !blocked(&l.kind)).collect())
}

/// Pixels whose whole neighbourhood has one verdict, and which of them contradict the image pair.
fn compare(time: f64, with: &[u8], without: &[u8]) -> (usize, usize) {
    let (scene, view) = (scene(time), view(time, SIZE));
    let all = triangles(&scene);
    let (mut checked, mut wrong) = (0, 0);
    for y in (1..SIZE[1] - 1).step_by(3) {
        for x in (1..SIZE[0] - 1).step_by(3) {
            let at = |dx: f64, dy: f64| reached(&scene, &view, &all, f64::from(x) + dx, f64::from(y) + dy);
            let Some(verdict) = at(0.5, 0.5) else { continue };
            // Nothing thinner than a quarter of a pixel goes unnoticed.
            let steps = || (0..25).map(|i| (f64::from(i % 5) / 4.0, f64::from(i / 5) / 4.0));
            if steps().any(|(dx, dy)| at(dx, dy).as_ref() != Some(&verdict)) {
                continue;
            }
            let i = ((y * SIZE[0] + x) * 4) as usize;
            let same = with[i..i + 3] == without[i..i + 3];
            // Where every light arrives shadows change nothing. Where one is blocked they do, unless the surface is
            // turned away from it, so only the first direction is certain at every pixel.
            checked += 1;
            if verdict.iter().all(|&lit| lit) && !same {
                wrong += 1;
            }
            if verdict.iter().all(|&lit| !lit) && with[i..i + 3].iter().any(|&c| c > 90) {
                wrong += 1;
            }
        }
    }
    (checked, wrong)
}

#[test]
fn the_images_have_the_shadows_that_rays_find() -> Result<(), Error> {
    if !crate::stage::has_device() {
        return Ok(());
    }
    let mut host = Host::new(&scene(0.0), SIZE)?;
    for time in [0.0, 2.5] {
        let (scene, view) = (scene(time), view(time, SIZE));
        let with = host.render(&scene, &view, true)?;
        let without = host.render(&scene, &view, false)?;
        let (checked, wrong) = compare(time, &with, &without);
        assert!(checked > 1000, "{checked} pixels checked");
        assert_eq!(wrong, 0, "{wrong} of {checked} pixels contradict the rays at {time} s");

        // Negative control: the same comparison notices that the shadows are missing, or that they moved.
        let (_, missing) = compare(time, &without, &without);
        assert!(missing > 3, "{missing} pixels noticed without shadows");
        let mut moved = with.clone();
        moved.rotate_left(SIZE[0] as usize * 4 * 3);
        let (_, shifted) = compare(time, &moved, &without);
        assert!(shifted > 50, "{shifted} pixels noticed with moved shadows");
        let (_, stale) = compare(2.5 - time, &with, &without);
        assert!(stale > 50, "{stale} pixels noticed with the shadows of another moment");
    }
    Ok(())
}
