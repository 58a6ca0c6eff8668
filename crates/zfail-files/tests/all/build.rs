//! Small glTF files made in memory.

use serde_json::{Value, json};
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;
use zfail_files::{Limits, LoadError};
use zfail_plan::glam::DMat3;
use zfail_scene::{Animated, Scene};

/// A glTF document under construction.
#[derive(Clone)]
pub struct Gltf {
    pub json: Value,
    pub bin: Vec<u8>,
}

pub const F32: u32 = 5126;

impl Gltf {
    /// A document without anything but its version.
    pub fn new() -> Self {
        Self { json: json!({"asset": {"version": "2.0"}}), bin: Vec::new() }
    }

    /// A document with one node and one mesh that has one primitive.
    pub fn with_primitive(make: impl FnOnce(&mut Self) -> Value) -> Self {
        let mut gltf = Self::new();
        let primitive = make(&mut gltf);
        gltf.push("meshes", json!({"primitives": [primitive]}));
        gltf.push("nodes", json!({"mesh": 0}));
        gltf
    }

    /// A triangle with corners at the origin, on x and on y.
    pub fn triangle() -> Self {
        Self::with_primitive(|g| json!({"attributes": {"POSITION": g.floats(&TRIANGLE)}}))
    }

    /// Appends `value` to a top-level array; returns its index.
    pub fn push(&mut self, array: &str, value: Value) -> usize {
        let list = &mut self.json[array];
        if list.is_null() {
            *list = json!([]);
        }
        let list = list.as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    /// A buffer view over `bytes`, four-byte aligned.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let offset = self.bin.len();
        self.bin.extend(bytes);
        self.push("bufferViews", json!({"buffer": 0, "byteOffset": offset, "byteLength": bytes.len()}))
    }

    pub fn accessor(&mut self, bytes: &[u8], component: u32, shape: &str, count: usize) -> usize {
        let view = self.view(bytes);
        let accessor = json!({"bufferView": view, "componentType": component, "type": shape, "count": count});
        self.push("accessors", accessor)
    }

    pub fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = values.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        self.accessor(&bytes, F32, shape(N), values.len())
    }

    pub fn bytes<const N: usize>(&mut self, values: &[[u8; N]]) -> usize {
        self.accessor(values.as_flattened(), 5121, shape(N), values.len())
    }

    pub fn shorts<const N: usize>(&mut self, values: &[[u16; N]]) -> usize {
        let bytes: Vec<u8> = values.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        self.accessor(&bytes, 5123, shape(N), values.len())
    }

    pub fn indices(&mut self, values: &[u16]) -> usize {
        self.shorts(&values.iter().map(|&i| [i]).collect::<Vec<_>>())
    }

    /// The document as a GLB file.
    pub fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        if !self.bin.is_empty() && json["buffers"].is_null() {
            json["buffers"] = json!([{"byteLength": self.bin.len()}]);
        }
        glb(json.to_string().as_bytes(), &self.bin)
    }

    pub fn load(&self) -> Result<Scene, LoadError> {
        load_bytes(&self.glb(), &Limits::default())
    }

    /// The scene with its animations, which must load.
    pub fn animated(&self) -> Animated {
        load_animated_bytes(&self.glb(), &Limits::default()).unwrap_or_else(|e| panic!("{e}"))
    }

    /// The scene, which must load.
    pub fn scene(&self) -> Scene {
        self.load().unwrap_or_else(|e| panic!("{e}"))
    }

    /// Asserts that loading fails with a message that contains `expected`.
    #[track_caller]
    pub fn fails_with(&self, expected: &str) {
        match self.load() {
            Ok(scene) => panic!("loaded, with notices {:?}; expected an error with {expected:?}", scene.notices),
            Err(e) => assert!(e.to_string().contains(expected), "{e}\nlacks {expected:?}"),
        }
    }
}

pub const TRIANGLE: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

fn shape(components: usize) -> &'static str {
    match components {
        1 => "SCALAR",
        2 => "VEC2",
        3 => "VEC3",
        4 => "VEC4",
        16 => "MAT4",
        _ => unreachable!(),
    }
}

pub fn glb(json: &[u8], bin: &[u8]) -> Vec<u8> {
    let chunk = |kind: &[u8; 4], data: &[u8], pad: u8| {
        let mut data = data.to_vec();
        data.resize(data.len().next_multiple_of(4), pad);
        [&(data.len() as u32).to_le_bytes(), kind.as_slice(), &data].concat()
    };
    let body = [chunk(b"JSON", json, b' '), chunk(b"BIN\0", bin, 0)].concat();
    [b"glTF".as_slice(), &2u32.to_le_bytes(), &(12 + body.len() as u32).to_le_bytes(), &body].concat()
}

pub fn load_bytes(bytes: &[u8], limits: &Limits) -> Result<Scene, LoadError> {
    load_animated_bytes(bytes, limits).map(|animated| animated.scene)
}

pub fn load_animated_bytes(bytes: &[u8], limits: &Limits) -> Result<Animated, LoadError> {
    let folder = TempDir::new().unwrap();
    let path: PathBuf = folder.path().join("test.glb");
    fs::write(&path, bytes).unwrap();
    zfail_files::load_animated(&path, limits).map(|(animated, _)| animated)
}

/// Asserts what the scene types promise, whatever the file was.
#[track_caller]
pub fn assert_sound(scene: &Scene) {
    for mesh in &scene.meshes {
        let count = mesh.positions.len();
        let lengths = [mesh.normals.len(), mesh.tangents.len(), mesh.uv0.len(), mesh.uv1.len(), mesh.colors.len()];
        assert_eq!(lengths, [count; 5], "{}", mesh.name);
        assert!(mesh.positions.iter().flatten().all(|x| x.is_finite()), "{}: positions", mesh.name);
        let length = |n: &[f32]| n.iter().map(|x| x * x).sum::<f32>().sqrt();
        assert!(mesh.normals.iter().all(|n| (length(n) - 1.0).abs() < 1e-5), "{}: normals", mesh.name);
        let unit_or_zero = |t: &[f32; 4]| length(&t[..3]) == 0.0 || (length(&t[..3]) - 1.0).abs() < 1e-5;
        assert!(mesh.tangents.iter().all(unit_or_zero), "{}: tangents", mesh.name);
        assert!(mesh.uv0.iter().chain(&mesh.uv1).flatten().all(|x| x.is_finite()), "{}: uv", mesh.name);
        assert!(mesh.colors.iter().flatten().all(|x| x.is_finite()), "{}: colours", mesh.name);
        assert!(mesh.triangles.iter().flatten().all(|&v| (v as usize) < count), "{}: indices", mesh.name);
        let mut next = 0;
        for primitive in &mesh.primitives {
            assert_eq!(primitive.triangles.start, next, "{}: runs", mesh.name);
            next = primitive.triangles.end;
            assert!(primitive.material.is_none_or(|m| m < scene.materials.len()));
        }
        assert_eq!(next as usize, mesh.triangles.len(), "{}: runs", mesh.name);
    }
    for instance in &scene.instances {
        assert!(instance.mesh < scene.meshes.len());
        assert!(instance.world_from_object.is_finite() && instance.world_from_object.matrix3.determinant() != 0.0);
    }
    for light in &scene.lights {
        assert!(light.intensity.is_finite() && light.color.iter().all(|c| c.is_finite()));
        assert!(light.kind.homogeneous().is_finite());
        assert!(light.excluded.iter().all(|&i| i < scene.instances.len()));
    }
    for camera in &scene.cameras {
        let rotation = camera.world_from_view.matrix3;
        assert!((rotation.transpose() * rotation).abs_diff_eq(DMat3::IDENTITY, 1e-9));
    }
    let textures = scene.materials.iter().flat_map(|m| {
        let slots = [m.base_color_texture, m.metallic_roughness_texture, m.normal_texture];
        slots.into_iter().chain([m.occlusion_texture, m.emissive_texture]).flatten()
    });
    textures.for_each(|t| assert!(t.texture < scene.textures.len() && t.uv_set <= 1));
    assert!(scene.textures.iter().all(|t| t.image < scene.images.len()));
    for image in &scene.images {
        assert_eq!(image.rgba.len(), image.width as usize * image.height as usize * 4);
        assert!(image.width > 0 && image.height > 0);
    }
}
