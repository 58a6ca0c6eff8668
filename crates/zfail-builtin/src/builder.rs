//! Puts a scene together from meshes, materials, lights and cameras.
//!
//! In: what to place and where. Out: a [`Scene`].

use glam::{DAffine3, DMat3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::Projection;
use zfail_scene::{
    Camera, Filter, Image, Instance, Light, LightShape, Material, Mesh, Scene, Texture, TextureRef, Wrap,
};

use super::shapes;

/// A scene in the making.
pub(super) struct SceneBuilder(Scene);

impl SceneBuilder {
    /// An empty scene with ambient and background radiance, linear RGB.
    pub fn new(name: &str, ambient: [f32; 3], background: [f32; 3]) -> Self {
        Self(Scene { name: name.to_owned(), ambient, background, ..Scene::default() })
    }

    /// The finished scene.
    pub fn finish(self) -> Scene {
        self.0
    }

    /// Adds a material as it is.
    pub fn material(&mut self, material: Material) -> usize {
        self.0.materials.push(material);
        self.0.materials.len() - 1
    }

    /// Adds a dielectric of one colour, `0xRRGGBB` in sRGB.
    pub fn matte(&mut self, name: &str, color: u32, roughness: f32) -> usize {
        let [r, g, b] = linear(color);
        self.material(Material {
            name: name.to_owned(),
            base_color: [r, g, b, 1.0],
            metallic: 0.0,
            roughness,
            ..Material::default()
        })
    }

    /// Adds a dielectric that shows `image` once every `tile` metres.
    pub fn textured(&mut self, image: Image, tile: f32, roughness: f32) -> usize {
        let name = image.name.clone();
        let texture = self.texture(image);
        let scale = 1.0 / tile;
        let uv_from_mesh = [[scale, 0.0, 0.0], [0.0, scale, 0.0]];
        self.material(Material {
            name,
            metallic: 0.0,
            roughness,
            base_color_texture: Some(TextureRef { uv_from_mesh, ..TextureRef::new(texture) }),
            ..Material::default()
        })
    }

    /// Adds an image as a texture that tiles.
    pub fn texture(&mut self, image: Image) -> usize {
        self.0.images.push(image);
        self.0.textures.push(Texture {
            image: self.0.images.len() - 1,
            wrap_u: Wrap::Repeat,
            wrap_v: Wrap::Repeat,
            mag: Filter::Linear,
            min: Filter::Linear,
            mipmaps: true,
        });
        self.0.textures.len() - 1
    }

    /// Makes a material's back faces visible.
    pub fn double_sided(&mut self, material: usize) -> usize {
        self.0.materials[material].double_sided = true;
        material
    }

    /// Adds a mesh to be placed any number of times.
    pub fn mesh(&mut self, name: &str, mut mesh: Mesh) -> usize {
        name.clone_into(&mut mesh.name);
        self.0.meshes.push(mesh);
        self.0.meshes.len() - 1
    }

    /// Places a mesh.
    pub fn place(&mut self, name: &str, mesh: usize, world_from_object: DAffine3) -> usize {
        self.0.instances.push(Instance {
            name: name.to_owned(),
            mesh,
            world_from_object,
            casts_shadow: true,
            receives_shadow: true,
        });
        self.0.instances.len() - 1
    }

    /// Adds a mesh in one material and places it once.
    pub fn add(&mut self, name: &str, mesh: Mesh, material: usize, world_from_object: DAffine3) -> usize {
        let mesh = self.mesh(name, shapes::painted(mesh, material));
        self.place(name, mesh, world_from_object)
    }

    /// Adds a box between two corners.
    pub fn block(&mut self, name: &str, min: [f64; 3], max: [f64; 3], material: usize) {
        let (min, max) = (DVec3::from(min), DVec3::from(max));
        let center = 0.5 * (min + max);
        let mesh = shapes::cuboid(min - center, max - center);
        self.add(name, mesh, material, DAffine3::from_translation(center));
    }

    /// Adds a light; `color` is sRGB `0xRRGGBB`, `intensity` candela or lux.
    pub fn light(&mut self, name: &str, kind: LightKind, color: u32, intensity: f32) {
        let light = Light {
            name: name.to_owned(),
            kind,
            color: linear(color),
            intensity,
            excluded: Vec::new(),
            shape: LightShape::default(),
        };
        self.0.lights.push(light);
    }

    /// A point light without a body.
    pub fn point(&mut self, name: &str, position: DVec3, color: u32, candela: f32) {
        self.light(name, LightKind::Point { position, range: f64::INFINITY }, color, candela);
    }

    /// A point light in a small glowing ball that casts no shadow.
    pub fn bulb(&mut self, name: &str, position: DVec3, radius: f64, color: u32, candela: f32) {
        self.point(name, position, color, candela);
        let glow = self.glow(name, color, 4.0);
        let ball = self.add(name, shapes::ico_sphere(radius, 3, true), glow, DAffine3::from_translation(position));
        self.0.instances[ball].casts_shadow = false;
    }

    /// A spot light at `position` that looks at `target`, `outer` its half angle in degrees.
    pub fn spot(&mut self, name: &str, position: DVec3, target: DVec3, outer: f64, color: u32, candela: f32) {
        let direction = (target - position).normalize();
        let outer = outer.to_radians();
        let kind = LightKind::Spot { position, direction, range: f64::INFINITY, inner: 0.8 * outer, outer };
        self.light(name, kind, color, candela);
    }

    /// Gives the light added last a range and a shape; a spot light's picture stands upright.
    pub fn shape(&mut self, to: f64, shape: LightShape) {
        let Some(light) = self.0.lights.last_mut() else { return };
        light.shape = shape;
        match &mut light.kind {
            LightKind::Point { range, .. } => *range = to,
            LightKind::Spot { position, direction, range, .. } => {
                *range = to;
                light.shape.axes = looking_at(*position, *position + *direction).matrix3;
            }
            LightKind::Directional { .. } => {}
        }
    }

    /// A material that glows with `radiance` times its colour.
    pub fn glow(&mut self, name: &str, color: u32, radiance: f32) -> usize {
        self.material(Material {
            name: format!("{name} glow"),
            base_color: [0.0, 0.0, 0.0, 1.0],
            metallic: 0.0,
            emissive: linear(color).map(|c| c * radiance),
            ..Material::default()
        })
    }

    /// A perspective camera with a vertical field of view in degrees.
    pub fn camera(&mut self, name: &str, eye: DVec3, target: DVec3, yfov: f64) {
        let projection = Projection::Perspective { yfov: yfov.to_radians(), near: 0.05, far: None };
        self.0.cameras.push(Camera { name: name.to_owned(), world_from_view: looking_at(eye, target), projection });
    }

    /// An orthographic camera that shows `height` metres.
    pub fn orthographic_camera(&mut self, name: &str, eye: DVec3, target: DVec3, height: f64) {
        let far = 2.0 * eye.distance(target);
        let projection = Projection::Orthographic { ymag: height / 2.0, near: 0.0, far };
        self.0.cameras.push(Camera { name: name.to_owned(), world_from_view: looking_at(eye, target), projection });
    }
}

/// World from a view at `eye` that looks at `target`, upright.
fn looking_at(eye: DVec3, target: DVec3) -> DAffine3 {
    let back = (eye - target).normalize();
    let right = DVec3::Y.cross(back).normalize_or(DVec3::X);
    DAffine3 { matrix3: DMat3::from_cols(right, back.cross(right), back), translation: eye }
}

/// Linear RGB of an sRGB colour `0xRRGGBB`.
pub(super) fn linear(color: u32) -> [f32; 3] {
    [16, 8, 0].map(|shift| {
        let c = (color >> shift & 0xff) as f32 / 255.0;
        if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    })
}

/// A transform that stands at (x, y, z), turned about y by `degrees`.
pub(super) fn at(x: f64, y: f64, z: f64, degrees: f64) -> DAffine3 {
    DAffine3::from_translation(DVec3::new(x, y, z)) * DAffine3::from_rotation_y(degrees.to_radians())
}
