//! What is drawn, how it looks, and in which order: one draw for all instances of a mesh that share a material.

use crate::scene::blend_order::BlendOrder;
use crate::scene::geometry::Vertices;
use std::cmp::Ordering;
use std::ops::Range;
use zfail_plan::bounds::Bounds;
use zfail_plan::glam::DVec3;
use zfail_plan::scissor;
use zfail_plan::view::View;
use zfail_scene::{AlphaMode, Instance, Material, Mesh, Scene, Specular, TextureRef};

/// One primitive of a mesh.
#[derive(Clone, Debug)]
pub struct Part {
    /// Index into the scene's meshes.
    pub mesh: usize,
    /// Index into the uploaded materials, of which the last is the default one.
    pub material: usize,
    /// Range of the mesh's index buffer.
    pub indices: Range<u32>,
    pub look: Look,
    /// Centre of its bounds, object space.
    center: DVec3,
}

/// What a pipeline depends on, transforms aside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Look {
    pub alpha: Alpha,
    /// Both sides are visible.
    pub double_sided: bool,
    /// No light applies.
    pub unlit: bool,
    /// Which of [`material_slots`] have textures.
    pub textured: [bool; SLOTS],
    pub layers: Layers,
    /// The mesh has vertex colours.
    pub colored: bool,
    /// Roughness is 1 everywhere.
    pub rough: bool,
    /// Light fades before facets turn away.
    pub coarse: bool,
}

/// What a material has beyond metallic-roughness.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Layers {
    pub specular_glossiness: bool,
    pub specular: bool,
    pub clearcoat: bool,
    pub sheen: bool,
    pub transmission: bool,
}

/// [`AlphaMode`] without its number; transmissive surfaces are blended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Alpha {
    Opaque,
    Mask,
    Blend,
}

impl Look {
    /// The override constants of `material.wgsl` and `light.wgsl`.
    pub fn constants(self) -> impl Iterator<Item = (&'static str, f64)> {
        const TEXTURED: [&str; SLOTS] = [
            "BASE_COLOR",
            "METALLIC_ROUGHNESS",
            "NORMAL",
            "OCCLUSION",
            "EMISSIVE",
            "SPECULAR_COLOR",
            "CLEARCOAT_TEXTURE",
            "SHEEN_TEXTURE",
            "TRANSMISSION_TEXTURE",
        ];
        let layers = [
            ("SPECULAR_GLOSSINESS", self.layers.specular_glossiness),
            ("SPECULAR", self.layers.specular),
            ("CLEARCOAT", self.layers.clearcoat),
            ("SHEEN", self.layers.sheen),
            ("TRANSMISSION", self.layers.transmission),
        ];
        TEXTURED.into_iter().zip(self.textured).chain(layers).map(|(name, value)| (name, f64::from(u8::from(value))))
    }

    fn new(material: &Material, mesh: &Mesh, coarse: bool) -> Self {
        let slots = material_slots(material);
        Self {
            alpha: match material.alpha {
                _ if material.is_blended() => Alpha::Blend,
                AlphaMode::Mask(_) => Alpha::Mask,
                _ => Alpha::Opaque,
            },
            double_sided: material.double_sided,
            unlit: material.unlit,
            textured: slots.map(|slot| slot.is_some()),
            colored: mesh.colors.iter().any(|&c| c != [1.0; 4]),
            layers: Layers {
                specular_glossiness: material.specular_glossiness.is_some(),
                specular: material.specular != Specular::default(),
                clearcoat: material.clearcoat.is_some(),
                sheen: material.sheen.is_some(),
                transmission: material.transmission.is_some(),
            },
            rough: material.roughness >= 1.0
                && material.metallic_roughness_texture.is_none()
                && material.specular_glossiness.is_none(),
            coarse,
        }
    }

    /// What its vertex stage has to read.
    pub fn vertices(self) -> Vertices {
        if self.textured[2] {
            Vertices::Mapped
        } else if self.colored || self.textured.contains(&true) {
            Vertices::Textured
        } else {
            Vertices::Plain
        }
    }
}

/// Textures of a material.
pub const SLOTS: usize = 9;

/// The texture slots in the order of the shaders: base colour, metallic-roughness or specular-glossiness, normal, occlusion,
/// emissive, specular colour, clearcoat, sheen, transmission.
pub fn material_slots(material: &Material) -> [Option<TextureRef>; SLOTS] {
    [
        material.base_color_texture,
        material.specular_glossiness.map_or(material.metallic_roughness_texture, |glossy| glossy.texture),
        material.normal_texture,
        material.occlusion_texture,
        material.emissive_texture,
        material.specular.color_texture,
        material.clearcoat.and_then(|coat| coat.texture),
        material.sheen.and_then(|sheen| sheen.texture),
        material.transmission.and_then(|transmission| transmission.texture),
    ]
}

/// A part with the instances that show it.
#[derive(Clone, Debug)]
pub struct Draw {
    /// Index into [`DrawList::parts`].
    pub part: usize,
    /// The instances' transforms turn triangles inside out.
    pub mirrored: bool,
    /// Range of [`DrawList::order`].
    pub slots: Range<u32>,
    /// Range of [`BlendOrder::indices`], if its triangles are sorted.
    pub sorted: Option<Range<u32>>,
}

/// Everything the scene shows, ordered for one view. Its memory is kept from frame to frame.
#[derive(Clone, Debug)]
pub struct DrawList {
    /// By mesh.
    pub parts: Vec<Part>,
    /// Instances in the order in which the device has them: those of a mesh that are wound alike follow each other, from
    /// the nearest to the farthest.
    pub order: Vec<usize>,
    /// Opaque and masked.
    pub solid: Vec<Draw>,
    /// Those in view, from the farthest to the nearest, equals in scene order.
    pub blended: Vec<Draw>,
    /// Of the triangles of each.
    pub blend_order: BlendOrder,
    /// Has any blended part.
    pub blends: bool,
    distances: Vec<f64>,
    mirrored: Vec<bool>,
}

impl DrawList {
    /// Triangles of [`Self::solid`], every instance counted.
    pub fn solid_triangles(&self) -> u32 {
        let triangles = |draw: &Draw| self.parts[draw.part].indices.len() / 3 * draw.slots.len();
        self.solid.iter().map(triangles).sum::<usize>().try_into().unwrap_or(u32::MAX)
    }

    /// Lists the parts of a scene that has passed [`crate::scene::check::scene`]; `coarse` tells which meshes are.
    pub fn new(scene: &Scene, coarse: impl Fn(usize) -> bool) -> Self {
        let default = Material::default();
        let mut parts = Vec::new();
        for (m, mesh) in scene.meshes.iter().enumerate() {
            for primitive in mesh.primitives.iter().filter(|p| !p.triangles.is_empty()) {
                let triangles = &mesh.triangles[primitive.triangles.start as usize..primitive.triangles.end as usize];
                parts.push(Part {
                    mesh: m,
                    material: primitive.material.unwrap_or(scene.materials.len()),
                    indices: primitive.triangles.start * 3..primitive.triangles.end * 3,
                    look: Look::new(primitive.material.map_or(&default, |m| &scene.materials[m]), mesh, coarse(m)),
                    center: Bounds::of(triangles.iter().flatten().map(|&v| mesh.position(v))).center(),
                });
            }
        }
        let blended = parts.iter().enumerate().filter(|(_, p)| p.look.alpha == Alpha::Blend);
        let blend_order = BlendOrder::new(&scene.meshes, blended);
        let blends = parts.iter().any(|p| p.look.alpha == Alpha::Blend);
        Self {
            parts,
            order: (0..scene.instances.len()).collect(),
            solid: Vec::new(),
            blended: Vec::new(),
            blend_order,
            blends,
            distances: Vec::new(),
            mirrored: Vec::new(),
        }
    }

    /// Orders everything for `view`; `bounds` are the instances' in world space. What ends first is in front: rooms and
    /// floors come last, wherever their centres are.
    pub fn arrange(&mut self, view: &View, instances: &[Instance], bounds: &[Bounds]) {
        let back = view.world_from_view.matrix3.z_axis;
        let end = |b: &Bounds| back.dot(view.eye() - b.center()) + back.abs().dot(b.half());
        self.distances.clear();
        self.distances.extend(bounds.iter().map(end));
        self.mirrored.clear();
        self.mirrored.extend(instances.iter().map(|i| i.world_from_object.matrix3.determinant() < 0.0));
        let (distances, mirrored) = (&self.distances, &self.mirrored);
        self.order.sort_unstable_by(|&a, &b| {
            let group = |i: usize| (instances[i].mesh, mirrored[i]);
            group(a).cmp(&group(b)).then(distances[a].total_cmp(&distances[b])).then(a.cmp(&b))
        });

        self.solid.clear();
        self.blended.clear();
        let mut start = 0;
        for run in self.order.chunk_by(|&a, &b| instances[a].mesh == instances[b].mesh && mirrored[a] == mirrored[b]) {
            let slots = start..start + run.len() as u32;
            start = slots.end;
            let (mesh, mirrored) = (instances[run[0]].mesh, mirrored[run[0]]);
            let first = self.parts.partition_point(|p| p.mesh < mesh);
            for (part, p) in self.parts.iter().enumerate().skip(first).take_while(|(_, p)| p.mesh == mesh) {
                if p.look.alpha == Alpha::Blend {
                    let seen = slots.clone().filter(|&s| in_view(view, &bounds[self.order[s as usize]]));
                    self.blended.extend(seen.map(|s| Draw { part, mirrored, slots: s..s + 1, sorted: None }));
                } else {
                    self.solid.push(Draw { part, mirrored, slots: slots.clone(), sorted: None });
                }
            }
        }
        let (order, parts) = (&self.order, &self.parts);
        let instance = |d: &Draw| order[d.slots.start as usize];
        self.solid.sort_by(|a, b| distances[instance(a)].total_cmp(&distances[instance(b)]));
        let depth = |d: &Draw| {
            let center = instances[instance(d)].world_from_object.transform_point3(parts[d.part].center);
            back.dot(center - view.eye())
        };
        self.blended.sort_by(|a, b| match depth(a).total_cmp(&depth(b)) {
            Ordering::Equal => (instance(a), a.part).cmp(&(instance(b), b.part)),
            order => order,
        });
        self.blend_order.arrange(view, instances, order, parts, &mut self.blended);
    }
}

/// Whether anything within `bounds` (world space) can be seen.
fn in_view(view: &View, bounds: &Bounds) -> bool {
    scissor::of_ball(view, bounds.center() - view.eye(), bounds.half().length()).is_some()
}
