//! A scene on the device: what stays from frame to frame.

pub mod blend_order;
pub mod check;
pub mod draw_list;
pub mod geometry;
pub mod gpu_data;
pub mod layouts;
pub mod lights;
pub mod materials;
pub mod mip_maps;
pub mod shapes;
pub mod surroundings;
pub mod terminator;
pub mod textures;

use crate::scene::draw_list::{DrawList, material_slots};
use crate::scene::geometry::MeshBuffers;
use crate::scene::layouts::Layouts;
use crate::scene::lights::FrameLight;
use crate::scene::shapes::Shapes;
use crate::scene::surroundings::Surroundings;
use crate::{Gpu, RenderError, Settings};
use glam::DVec3;
use zfail::{Caster, Counting, Frame, LightStats, MeshId, ShadowLight, Shadows, Silhouettes, Tiles};
use zfail_plan::bounds::Bounds;
use zfail_plan::view::View;
use zfail_scene::{Instance, Light, Material, Mesh, Pose, Receivers, Scene};

/// Uploaded meshes and materials, registered casters, and the plain data that frames are made from.
#[derive(Debug)]
pub struct SceneOnGpu {
    /// `None` for meshes without triangles.
    pub meshes: Vec<Option<MeshBuffers>>,
    /// The last is the default material.
    pub materials: Vec<wgpu::BindGroup>,
    pub draws: DrawList,
    /// [`crate::scene::blend_order::BlendOrder::indices`] of the frame.
    pub sorted: wgpu::Buffer,
    pub instances: Vec<Instance>,
    pub lights: Vec<Light>,
    pub shapes: Shapes,
    pub bounds: Bounds,
    /// Of every instance, world space.
    pub instance_bounds: Vec<Bounds>,
    /// Of every mesh, object space.
    mesh_bounds: Vec<Bounds>,
    receivers: Receivers,
    /// Boxes around everything that can be seen, world space.
    receiver_boxes: Vec<Bounds>,
    pub surroundings: Surroundings,
    /// Stops, where those of the lights are known.
    pub exposure: Option<f32>,
    /// Radiance of the strongest emission.
    pub emission: [f32; 3],
    /// The least roughness of any material.
    pub roughness: f64,
    pub shadows: Shadows,
    casters: Vec<Caster>,
    /// By mesh, those of which an instance casts.
    caster_meshes: Vec<Option<MeshId>>,
    /// Whether anything has moved: only then may the device be asked for silhouettes.
    posed: bool,
    /// By mesh, how many vertices bend.
    bending: Vec<Option<usize>>,
    /// By instance.
    caster_of: Vec<Option<usize>>,
}

impl SceneOnGpu {
    pub fn new(gpu: &Gpu, layouts: &Layouts, scene: &Scene) -> Result<Self, RenderError> {
        check::scene(scene)?;
        let mut shadows = Shadows::new(&gpu.device, &gpu.queue);
        let mut meshes = Vec::with_capacity(scene.meshes.len());
        let mut ids = Vec::with_capacity(scene.meshes.len());
        for (m, mesh) in scene.meshes.iter().enumerate() {
            if mesh.triangles.is_empty() {
                meshes.push(None);
                ids.push(None);
                continue;
            }
            meshes.push(Some(MeshBuffers::new(gpu, mesh)?));
            let casting = scene.instances.iter().any(|i| i.mesh == m && i.casts_shadow);
            ids.push(if casting { register(&mut shadows, scene, m)? } else { None });
        }
        let emission = scene
            .materials
            .iter()
            .fold([0.0; 3], |greatest, m| std::array::from_fn(|c| f32::max(greatest[c], m.emissive[c])));
        let draws = DrawList::new(scene, |m| meshes[m].as_ref().is_some_and(|mesh| mesh.tilts.is_some()));
        let mut on_gpu = Self {
            meshes,
            materials: materials::upload(gpu, layouts, scene),
            draws,
            sorted: index_buffer(gpu, 12),
            instances: scene.instances.clone(),
            lights: scene.lights.clone(),
            shapes: Shapes::new(gpu, scene)?,
            bounds: Bounds::EMPTY,
            instance_bounds: Vec::new(),
            mesh_bounds: scene.meshes.iter().map(Mesh::bounds).collect(),
            receivers: Receivers::new(scene),
            receiver_boxes: Vec::new(),
            surroundings: Surroundings::new(gpu, scene)?,
            exposure: scene.exposure,
            emission,
            roughness: scene.materials.iter().map(least_roughness).fold(1.0, f64::min),
            shadows,
            casters: Vec::new(),
            caster_meshes: ids,
            posed: false,
            bending: scene.meshes.iter().map(|mesh| mesh.bends().then_some(mesh.positions.len())).collect(),
            caster_of: Vec::new(),
        };
        on_gpu.list_casters();
        on_gpu.bound();
        gpu.check()?;
        Ok(on_gpu)
    }

    /// Moves instances, lights and the vertices of meshes that bend in place.
    pub fn pose(&mut self, gpu: &Gpu, pose: &Pose) -> Result<(), RenderError> {
        let bending = |mesh: usize| self.bending.get(mesh).copied().flatten();
        check::pose(pose, self.instances.len(), self.lights.len(), bending)?;
        self.posed = true;
        for bent in &pose.bent {
            if let Some(buffers) = &self.meshes[bent.mesh] {
                buffers.bend(gpu, bent);
            }
            if let Some(caster) = self.caster_meshes[bent.mesh] {
                self.shadows.move_vertices(caster, &bent.positions)?;
            }
            self.receivers.bend(bent.mesh, &bent.positions);
            self.mesh_bounds[bent.mesh] = Bounds::of(bent.positions.iter().map(|p| DVec3::from(p.map(f64::from))));
        }
        for (instance, &world_from_object) in self.instances.iter_mut().zip(&pose.instances) {
            instance.world_from_object = world_from_object;
        }
        for (&caster, &world_from_object) in self.caster_of.iter().zip(&pose.instances) {
            if let Some(caster) = caster {
                self.casters[caster].world_from_object = world_from_object;
            }
        }
        for (light, &kind) in self.lights.iter_mut().zip(&pose.lights) {
            light.kind = kind;
        }
        for (light, &axes) in self.lights.iter_mut().zip(&pose.light_axes) {
            light.shape.axes = axes;
        }
        self.bound();
        Ok(())
    }

    /// Takes all lights from `scene`; whether their shapes are in another buffer now.
    pub fn set_lights(&mut self, gpu: &Gpu, scene: &Scene) -> Result<bool, RenderError> {
        self.check_instances(scene)?;
        check::lights(scene)?;
        let rebuilt = !self.shapes.hold(&scene.lights);
        if rebuilt {
            self.shapes = Shapes::new(gpu, scene)?;
        }
        self.lights.clone_from(&scene.lights);
        Ok(rebuilt)
    }

    /// Takes from `scene` what it stands in.
    pub fn set_surroundings(&mut self, gpu: &Gpu, scene: &Scene) -> Result<(), RenderError> {
        self.surroundings = Surroundings::new(gpu, scene)?;
        Ok(())
    }

    /// Takes from `scene` which instances cast shadows.
    pub fn set_casting(&mut self, scene: &Scene) -> Result<(), RenderError> {
        self.check_instances(scene)?;
        for instance in scene.instances.iter().filter(|instance| instance.casts_shadow) {
            let m = instance.mesh;
            if self.meshes[m].is_some() && self.caster_meshes[m].is_none() {
                self.caster_meshes[m] = register(&mut self.shadows, scene, m)?;
            }
        }
        for (instance, from) in self.instances.iter_mut().zip(&scene.instances) {
            instance.casts_shadow = from.casts_shadow;
        }
        self.list_casters();
        Ok(())
    }

    /// Whether there is anything on which no shadow falls.
    pub fn has_exempt(&self) -> bool {
        self.instances.iter().any(|instance| !instance.receives_shadow)
    }

    /// Whether instance `instance` blocks light number `light`.
    pub fn casts(&self, instance: usize, light: usize) -> bool {
        self.caster_of[instance].is_some() && !self.lights[light].excluded.contains(&instance)
    }

    fn check_instances(&self, scene: &Scene) -> Result<(), RenderError> {
        let same = self.instances.len() == scene.instances.len()
            && self.meshes.len() == scene.meshes.len()
            && self.instances.iter().zip(&scene.instances).all(|(a, b)| a.mesh == b.mesh);
        if same { Ok(()) } else { Err(RenderError::Scene("this is not the scene that was uploaded".to_owned())) }
    }

    /// Lists the instances that cast.
    fn list_casters(&mut self) {
        self.casters.clear();
        self.caster_of.clear();
        for instance in &self.instances {
            self.caster_of.push(self.caster_meshes[instance.mesh].filter(|_| instance.casts_shadow).map(|mesh| {
                self.casters.push(Caster::new(mesh, instance.world_from_object));
                self.casters.len() - 1
            }));
        }
    }

    /// Derives all bounds in world space.
    fn bound(&mut self) {
        self.instance_bounds.clear();
        self.bounds = Bounds::EMPTY;
        for instance in &self.instances {
            let world = self.mesh_bounds[instance.mesh].transformed(&instance.world_from_object);
            if !world.is_empty() {
                self.bounds.add(world.min);
                self.bounds.add(world.max);
            }
            self.instance_bounds.push(world);
        }
        self.receivers.place(&self.instances, &mut self.receiver_boxes);
    }

    /// Orders what is drawn for `view`.
    pub fn arrange(&mut self, gpu: &Gpu, view: &View) {
        self.draws.arrange(view, &self.instances, &self.instance_bounds);
        let indices: &[u8] = bytemuck::cast_slice(&self.draws.blend_order.indices);
        if indices.len() as u64 > self.sorted.size() {
            self.sorted = index_buffer(gpu, indices.len() as u64);
        }
        gpu.queue.write_buffer(&self.sorted, 0, indices);
    }

    /// The lights that `settings` choose, as indices into [`Self::lights`].
    pub fn chosen(&self, settings: &Settings) -> Result<Vec<usize>, RenderError> {
        let count = self.lights.len();
        let Some(chosen) = &settings.lights else { return Ok((0..count).collect()) };
        match chosen.iter().find(|&&index| index >= count) {
            None => Ok(chosen.clone()),
            Some(&index) => Err(RenderError::UnknownLight { index, count }),
        }
    }

    /// Plans and uploads the volumes of lights, with shadows on `ground` beside those on surfaces, and
    /// chooses what of them is counted by tiles if the depth can be read.
    #[expect(clippy::too_many_arguments, reason = "what a frame's shadows depend on")]
    pub fn plan(
        &mut self,
        gpu: &Gpu,
        view: &View,
        chosen: &[FrameLight],
        settings: &Settings,
        counting: Counting,
        ground: Option<Bounds>,
        readable: bool,
    ) -> Result<Vec<LightStats>, RenderError> {
        let excluded: Vec<Vec<usize>> = chosen
            .iter()
            .map(|light| {
                self.lights[light.index].excluded.iter().filter_map(|&instance| self.caster_of[instance]).collect()
            })
            .collect();
        let lights: Vec<ShadowLight<'_>> = chosen
            .iter()
            .zip(&excluded)
            .map(|(light, excluded)| ShadowLight::new(light.kind).within(light.bounds).excluding(excluded))
            .collect();
        let steps = settings.steps();
        let surfaces = self.receiver_boxes.len();
        self.receiver_boxes.extend(ground);
        let silhouettes = self.posed && steps.silhouettes == Silhouettes::WhereCheaper;
        if silhouettes || readable && steps.tiles == Tiles::WhereCheaper {
            self.shadows.set_cost_model(gpu.costs());
        }
        let frame = Frame::new(view, &self.casters, &lights).receivers(&self.receiver_boxes).steps(steps);
        let prepared = self.shadows.prepare(&frame.counting(counting).tile_pass(readable));
        self.receiver_boxes.truncate(surfaces);
        let prepared = prepared?;
        Ok((0..chosen.len()).map(|light| prepared.stats(light)).collect())
    }
}

/// Registers mesh `m` as one that casts; `None` if all its triangles let light through.
fn register(shadows: &mut Shadows, scene: &Scene, m: usize) -> Result<Option<MeshId>, RenderError> {
    if !(0..scene.meshes[m].triangles.len()).any(|t| scene.triangle_casts(m, t)) {
        return Ok(None);
    }
    let topology = scene.topology(m).map_err(zfail::Error::from)?;
    Ok(Some(shadows.add_topology(topology)?))
}

fn index_buffer(gpu: &Gpu, size: u64) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("sorted triangles"),
        size,
        usage: wgpu::BufferUsages::INDEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// The least roughness of a material's points.
fn least_roughness(material: &Material) -> f64 {
    let roughness = material.specular_glossiness.map_or(material.roughness, |glossy| 1.0 - glossy.glossiness);
    // A texture may hold 0, and what further layers reflect is less than a mirror does.
    let unknown = material_slots(material)[1].is_some() || material.clearcoat.is_some() || material.sheen.is_some();
    if unknown { 0.0 } else { f64::from(roughness) }
}
