//! More lights than verdicts fit a texel: what each of them sends from a pane of glass, or from a wall, is missing exactly
//! where the oracle finds the pane, or the wall, in its shadow.

use zfail_oracle::{CastTable, Oracle};
use zfail_plan::glam::{DAffine3, DMat3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::{Projection, View};
use zfail_render::{Exposure, Gpu, Renderer, Settings};
use zfail_scene::{AlphaMode, Instance, Light, LightShape, Material, Mesh, Primitive, Scene, Transmission};

const SIZE: [u32; 2] = [72, 54];

/// A rectangle at height z, facing the eye.
fn square(scene: &mut Scene, half: f32, place: DVec3, material: Material) {
    let casts_shadow = material.alpha != AlphaMode::Blend && place.z > 1.5;
    scene.meshes.push(Mesh {
        positions: vec![[-half, -half, 0.0], [half, -half, 0.0], [half, half, 0.0], [-half, half, 0.0]],
        normals: vec![[0.0, 0.0, 1.0]; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        primitives: vec![Primitive { triangles: 0..2, material: Some(scene.materials.len()) }],
        ..Mesh::default()
    });
    scene.materials.push(material);
    let (mesh, world_from_object) = (scene.meshes.len() - 1, DAffine3::from_translation(place));
    scene.instances.push(Instance {
        name: String::new(),
        mesh,
        world_from_object,
        casts_shadow,
        receives_shadow: true,
    });
}

fn matt(color: [f32; 4]) -> Material {
    Material { base_color: color, metallic: 0.0, roughness: 1.0, ..Material::default() }
}

/// A pane of `surface` before nothing, and squares between it and `count` lights.
fn scene(surface: Material, count: usize) -> Scene {
    let mut scene = Scene::default();
    square(&mut scene, 20.0, DVec3::Z, surface);
    for (x, y) in [(-0.9, 0.5), (0.2, -0.6), (1.1, 0.4)] {
        square(&mut scene, 0.3, DVec3::new(x, y, 2.2), matt([0.0, 0.0, 0.0, 1.0]));
    }
    let light = |i: usize| {
        let (turn, k) = (2.4 * i as f64, i as f64 / count as f64);
        let position = DVec3::new(2.5 * k.sqrt() * turn.cos(), 2.5 * k.sqrt() * turn.sin(), 5.0 + (i % 7) as f64 * 0.4);
        Light {
            name: String::new(),
            kind: LightKind::Point { position, range: f64::INFINITY },
            color: [[1.0, 0.6, 0.3], [0.3, 1.0, 0.6], [0.6, 0.3, 1.0]][i % 3],
            intensity: 2.0 + (i % 5) as f32,
            excluded: Vec::new(),
            shape: LightShape::default(),
        }
    };
    scene.lights = (0..count).map(light).collect();
    scene
}

fn view() -> View {
    View::new(
        DAffine3 { matrix3: DMat3::IDENTITY, translation: DVec3::new(0.0, 0.0, 5.0) },
        Projection::Perspective { yfov: 0.9, near: 0.1, far: None },
        SIZE,
    )
}

fn settings() -> Settings {
    Settings { exposure: Exposure::Ev(0.0), ..Settings::default() }
}

fn radiance(renderer: &mut Renderer<'_>, settings: &Settings) -> Vec<[f32; 3]> {
    renderer.picture(&view(), settings).expect("a picture").0.hdr
}

/// Pixels, of those that the oracle is sure about, at which `found` is not the sum of what the lights send that the oracle
/// finds lit; lights from number `capped` on are taken for lit everywhere.
fn differing(found: &[[f32; 3]], alone: &[Vec<[f32; 3]>], lit: &[Vec<Option<bool>>], capped: usize) -> usize {
    let wrong = |&i: &usize| {
        let sure: Option<Vec<bool>> = lit.iter().map(|light| light[i]).collect();
        let Some(sure) = sure else { return false };
        (0..3).any(|c| {
            let shown = (0..).zip(&sure).zip(alone).filter(|&((l, &lit), _)| lit || l >= capped);
            let expected: f32 = shown.map(|(_, light)| light[i][c]).sum();
            (found[i][c] - expected).abs() > 0.01 * expected + 1e-3
        })
    };
    (0..found.len()).filter(wrong).count()
}

/// Renders and compares; counts of differing pixels: as it is, and as if only 32 lights had shadows.
fn judge(gpu: &Gpu, surface: &Material, count: usize) -> [usize; 2] {
    let scene = scene(surface.clone(), count);
    let mut renderer = Renderer::new(gpu, &scene).expect("a renderer");
    let found = radiance(&mut renderer, &settings());
    let alone: Vec<_> = (0..count)
        .map(|l| {
            let settings = Settings { shadows: false, lights: Some(vec![l]), ..settings() };
            radiance(&mut renderer, &settings)
        })
        .collect();
    // The oracle sees no glass.
    let mut opaque = scene;
    opaque.materials[0] = matt([1.0; 4]);
    let (oracle, casts) = (Oracle::new(&opaque), CastTable::double(&opaque));
    let lit = |light: &Light| {
        let truth = oracle.judge(&view(), light, &casts);
        truth.pixels.iter().map(|p| p.mask_doubt.is_none().then_some(p.lit)).collect()
    };
    let lit: Vec<Vec<Option<bool>>> = opaque.lights.iter().map(lit).collect();
    let sure = (0..found.len()).filter(|&i| lit.iter().all(|light| light[i].is_some())).count();
    assert!(sure * 5 > found.len() * 3, "the oracle is sure about {sure} of {} pixels", found.len());
    [count, 32].map(|capped| differing(&found, &alone, &lit, capped))
}

#[test]
fn glass_and_walls_have_the_shadows_of_any_number_of_lights() {
    let Some(gpu) = crate::gpu() else { return };
    let film = Material { alpha: AlphaMode::Blend, ..matt([1.0, 1.0, 1.0, 0.5]) };
    let glass = Transmission { share: 0.6, texture: None, tint: [1.0, 0.9, 0.8] };
    let glass = Material { transmission: Some(glass), ..matt([1.0; 4]) };
    for (name, surface) in [("film", film), ("glass", glass), ("wall", matt([1.0; 4]))] {
        for count in [31, 33, 40, 70] {
            let [wrong, capped] = judge(&gpu, &surface, count);
            assert_eq!(wrong, 0, "{name} under {count} lights");
            assert_eq!(capped > 20, count > 32, "{name} under {count} lights, 32 of which cast shadows: {capped}");
        }
    }
}
