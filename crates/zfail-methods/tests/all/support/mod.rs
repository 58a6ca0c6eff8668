//! Scenes whose truth is known, and how many pixels methods get wrong of them.

use zfail_methods::{Error, Method, Methods, Options, Shadow};
use zfail_oracle::{CastTable, Oracle, Truth};
use zfail_plan::glam::{DAffine3, DMat3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::{Projection, View};
use zfail_render::{Gpu, GpuOptions};
use zfail_scene::{Instance, Light, LightShape, Material, Mesh, Primitive, Scene};

pub const SIZE: [u32; 2] = [160, 100];

/// A device, or `None` if the test is to be skipped.
pub fn gpu() -> Option<Gpu> {
    zfail_testing::gpu(Gpu::new(&GpuOptions::default()))
}

/// A scene under a view, with the truth for every light.
pub struct Case<'g> {
    pub methods: Methods<'g>,
    pub view: View,
    pub truths: Vec<Truth>,
}

impl<'g> Case<'g> {
    pub fn new(gpu: &'g Gpu, scene: &Scene, view: View) -> Self {
        let oracle = Oracle::new(scene);
        let judge = |light| oracle.judge(&view, light, &CastTable::double(scene));
        let truths: Vec<Truth> = scene.lights.iter().map(judge).collect();
        Self { methods: Methods::new(gpu, scene).expect("a valid scene"), view, truths }
    }

    /// A built-in scene under its first camera, with one of its lights.
    pub fn builtin(gpu: &'g Gpu, name: &str, light: usize) -> Self {
        let mut scene = zfail_builtin::scene(name).expect("a built-in scene");
        scene.lights = vec![scene.lights[light].clone()];
        let view = scene.cameras[0].view(SIZE, &scene.bounds());
        Self::new(gpu, &scene, view)
    }

    pub fn shadow(&mut self, method: Method, light: usize, options: &Options) -> Result<Shadow, Error> {
        self.methods.shadow(method, &self.view, light, options)
    }

    /// Wrong pixels of one light.
    pub fn wrong_of(&mut self, method: Method, light: usize, options: &Options) -> usize {
        let shadow = self.shadow(method, light, options).unwrap_or_else(|error| panic!("{error}"));
        let report = self.truths[light].compare_mask(&shadow.mask).expect("a mask of the same size");
        assert!(4 * report.checked > 3 * report.surfaces && report.checked > 2000, "{method} is hardly compared");
        report.wrong.len()
    }

    /// Wrong pixels of all lights.
    pub fn wrong(&mut self, method: Method) -> usize {
        (0..self.truths.len()).map(|light| self.wrong_of(method, light, &Options::default())).sum()
    }
}

/// A view from `eye` towards `target`.
pub fn look(eye: DVec3, target: DVec3, near: f64) -> View {
    let back = (eye - target).normalize();
    let right = DVec3::Y.cross(back).try_normalize().unwrap_or(DVec3::X);
    View::new(
        DAffine3 { matrix3: DMat3::from_cols(right, back.cross(right), back), translation: eye },
        Projection::Perspective { yfov: 1.0, near, far: None },
        SIZE,
    )
}

/// A horizontal square around `center`, seen from both sides.
pub fn plate(scene: &mut Scene, center: DVec3, half: f32) {
    if scene.materials.is_empty() {
        scene.materials.push(Material { double_sided: true, ..Material::default() });
    }
    scene.instances.push(Instance {
        name: "plate".into(),
        mesh: scene.meshes.len(),
        world_from_object: DAffine3::from_translation(center),
        casts_shadow: true,
        receives_shadow: true,
    });
    scene.meshes.push(Mesh {
        name: "plate".into(),
        positions: vec![[-half, 0.0, -half], [-half, 0.0, half], [half, 0.0, half], [half, 0.0, -half]],
        normals: vec![[0.0, 1.0, 0.0]; 4],
        tangents: vec![[0.0; 4]; 4],
        uv0: vec![[0.0; 2]; 4],
        uv1: vec![[0.0; 2]; 4],
        colors: vec![[1.0; 4]; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        primitives: vec![Primitive { triangles: 0..2, material: Some(0) }],
        ..Mesh::default()
    });
}

pub fn light(kind: LightKind) -> Light {
    Light {
        name: "light".into(),
        kind,
        color: [1.0; 3],
        intensity: 1.0,
        excluded: Vec::new(),
        shape: LightShape::default(),
    }
}

pub fn point(position: DVec3) -> Light {
    light(LightKind::Point { position, range: f64::INFINITY })
}
