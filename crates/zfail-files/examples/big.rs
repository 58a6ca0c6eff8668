//! Large scenes as files, to see what loading and rendering cost: `cargo run --release --example big -- KIND N OUT.glb`.
//!
//! In: a kind and a number. `detail` is one closed knot of N triangles over a terrain of N / 4; `crowd` is N instances of
//! five bodies on a plain. Out: a `.glb` file, the same on every run.

use std::error::Error;
use std::{env, fs};
use zfail_builtin::shapes;
use zfail_files::write;
use zfail_plan::glam::{DAffine3, DMat3, DQuat, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::Projection;
use zfail_scene::{Camera, Instance, Light, LightShape, Material, Mesh, Scene};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [kind, number, path] = &arguments[..] else { return Err("usage: big detail|crowd N OUT.glb".into()) };
    let number: usize = number.parse()?;
    let scene = match kind.as_str() {
        "detail" => detail(number),
        "crowd" => crowd(number),
        _ => return Err(format!("there is no kind '{kind}'; there are: detail, crowd").into()),
    };
    let triangles: usize = scene.instances.iter().map(|instance| scene.meshes[instance.mesh].triangles.len()).sum();
    fs::write(path, write::to_glb(&scene)?)?;
    println!("{path}: {triangles} triangles in {} instances", scene.instances.len());
    Ok(())
}

/// A tube of so many triangles, knotted, and a field of hills below it.
fn detail(triangles: usize) -> Scene {
    let sides = ((triangles as f64 / 400.0).sqrt() as usize).max(3);
    let steps = (triangles / (2 * sides)).max(3);
    let knot = shapes::torus_knot([2, 3], 3.0, 1.2, 0.55, steps, sides);
    let cells = ((triangles as f64 / 8.0).sqrt() as usize).max(1);
    let hills = shapes::sheet(cells, cells, |column, row| {
        // With z against the rows, the front is on top.
        let [x, z] = [column, cells - row].map(|i| 40.0 * (i as f64 / cells as f64 - 0.5));
        DVec3::new(x, 0.4 * (0.9 * x).sin() * (0.7 * z).cos() + 0.05 * (7.0 * x + 5.0 * z).sin() - 5.0, z)
    });
    let mut scene = stage("detail", DVec3::new(9.0, 7.0, 14.0));
    place(&mut scene, 0, DAffine3::IDENTITY);
    place(&mut scene, 1, DAffine3::IDENTITY);
    scene.meshes = vec![painted("knot", knot), painted("hills", hills)];
    scene
}

/// So many bodies on a square grid, each turned and scaled in its own way.
fn crowd(instances: usize) -> Scene {
    let side = (instances as f64).sqrt().ceil() as usize;
    let half = side as f64;
    let mut scene = stage("crowd", DVec3::new(0.0, 0.35 * half, 1.2 * half));
    let plain = shapes::cuboid(DVec3::new(-2.0 * half, -1.0, -2.0 * half), DVec3::new(2.0 * half, 0.0, 2.0 * half));
    let bodies = [
        ("plain", plain),
        ("knot", shapes::torus_knot([2, 3], 0.4, 0.15, 0.08, 96, 8)),
        ("ball", shapes::ico_sphere(0.5, 3, true)),
        ("ring", shapes::torus(0.45, 0.15, 32, 16)),
        ("box", shapes::cuboid(DVec3::splat(-0.4), DVec3::splat(0.4))),
        ("cone", shapes::cone(0.4, 1.2, 24)),
    ];
    scene.meshes = bodies.into_iter().map(|(name, mesh)| painted(name, mesh)).collect();
    place(&mut scene, 0, DAffine3::IDENTITY);
    for i in 0..instances {
        let [x, z] = [i % side, i / side].map(|k| 2.0 * k as f64 - half);
        let turn = DQuat::from_rotation_y(i as f64) * DQuat::from_rotation_x(0.7 * (i % 9) as f64);
        let scale = DVec3::splat(0.6 + 0.1 * (i % 7) as f64);
        let place_at = DVec3::new(x, 1.0 + 0.2 * (i % 4) as f64, z);
        place(&mut scene, 1 + i % 5, DAffine3::from_scale_rotation_translation(scale, turn, place_at));
    }
    scene
}

/// A sun, a lamp, a grey material and a camera at `eye` that looks at the origin.
fn stage(name: &str, eye: DVec3) -> Scene {
    let back = eye.normalize();
    let right = DVec3::Y.cross(back).normalize();
    let light = |name: &str, kind, intensity| Light {
        name: name.to_owned(),
        kind,
        color: [1.0; 3],
        intensity,
        excluded: Vec::new(),
        shape: LightShape::default(),
    };
    let direction = DVec3::new(-0.5, -1.0, -0.3).normalize();
    let range = 4.0 * eye.length();
    Scene {
        name: name.to_owned(),
        materials: vec![Material { name: "clay".to_owned(), metallic: 0.0, ..Material::default() }],
        lights: vec![
            light("sun", LightKind::Directional { direction }, 2.0),
            light("lamp", LightKind::Point { position: DVec3::new(0.5, 6.0, 0.5), range }, 60.0),
        ],
        cameras: vec![Camera {
            name: "camera".to_owned(),
            world_from_view: DAffine3 { matrix3: DMat3::from_cols(right, back.cross(right), back), translation: eye },
            projection: Projection::Perspective { yfov: 0.9, near: 0.1, far: None },
        }],
        ambient: [0.1; 3],
        ..Scene::default()
    }
}

fn painted(name: &str, mesh: Mesh) -> Mesh {
    Mesh { name: name.to_owned(), ..shapes::painted(mesh, 0) }
}

fn place(scene: &mut Scene, mesh: usize, world_from_object: DAffine3) {
    let name = format!("{}", scene.instances.len());
    scene.instances.push(Instance { name, mesh, world_from_object, casts_shadow: true, receives_shadow: true });
}
