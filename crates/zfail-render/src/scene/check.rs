//! The rules of the scene types, so that no index goes astray later.

use crate::RenderError;
use crate::scene::draw_list::material_slots;
use zfail_scene::{Pose, Scene};

/// Checks every index and size in `scene`.
pub fn scene(scene: &Scene) -> Result<(), RenderError> {
    let fail = |message: String| Err(RenderError::Scene(message));
    for (i, image) in scene.images.iter().enumerate() {
        let bytes = u64::from(image.width) * u64::from(image.height) * 4;
        if bytes == 0 || bytes != image.rgba.len() as u64 {
            return fail(format!("image {i} is {}x{} and has {} bytes", image.width, image.height, image.rgba.len()));
        }
    }
    for (i, texture) in scene.textures.iter().enumerate() {
        if texture.image >= scene.images.len() {
            return fail(format!("texture {i} refers to image {}, which does not exist", texture.image));
        }
    }
    for (i, m) in scene.materials.iter().enumerate() {
        if let Some(slot) = material_slots(m).into_iter().flatten().find(|slot| slot.texture >= scene.textures.len()) {
            return fail(format!("material {i} refers to texture {}, which does not exist", slot.texture));
        }
    }
    for (i, mesh) in scene.meshes.iter().enumerate() {
        if let Some(v) = mesh.triangles.iter().flatten().find(|&&v| v as usize >= mesh.positions.len()) {
            return fail(format!("mesh {i} refers to vertex {v} of {}", mesh.positions.len()));
        }
        if mesh.bends() && mesh.alike.len() != mesh.positions.len() {
            return fail(format!("mesh {i} has {} vertices, {} of which bend", mesh.positions.len(), mesh.alike.len()));
        }
        if mesh.triangles.len() > u32::MAX as usize / 3 {
            return fail(format!("mesh {i} has {} triangles, too many for 32-bit indices", mesh.triangles.len()));
        }
        for p in &mesh.primitives {
            if p.triangles.start > p.triangles.end || p.triangles.end as usize > mesh.triangles.len() {
                return fail(format!("mesh {i} has a primitive with triangles {:?}", p.triangles));
            }
            if p.material.is_some_and(|m| m >= scene.materials.len()) {
                return fail(format!("mesh {i} refers to material {:?}, which does not exist", p.material));
            }
        }
    }
    for (i, instance) in scene.instances.iter().enumerate() {
        if instance.mesh >= scene.meshes.len() {
            return fail(format!("instance {i} refers to mesh {}, which does not exist", instance.mesh));
        }
        if !instance.world_from_object.is_finite() {
            return fail(format!("instance {i} has a transform that is not finite"));
        }
    }
    surroundings(scene)?;
    lights(scene)
}

/// Checks the ground of `scene`.
pub fn surroundings(scene: &Scene) -> Result<(), RenderError> {
    match &scene.ground {
        Some(ground) if !(ground.middle().is_finite() && ground.radius.is_finite() && ground.radius > 0.0) => {
            Err(RenderError::Scene(format!("a ground of radius {} at {} is none", ground.radius, ground.middle())))
        }
        _ => Ok(()),
    }
}

/// Checks the lights of `scene`.
pub fn lights(scene: &Scene) -> Result<(), RenderError> {
    let fail = |message: String| Err(RenderError::Scene(message));
    for (i, light) in scene.lights.iter().enumerate() {
        if let Some(e) = light.excluded.iter().find(|&&e| e >= scene.instances.len()) {
            return fail(format!("light {i} excludes instance {e}, which does not exist"));
        }
        let shape = &light.shape;
        for (part, problem) in [
            ("falloff", shape.falloff_problem(&light.kind)),
            ("cookie", shape.cookie_problem(&light.kind, scene.textures.len())),
            ("box", shape.box_problem(&light.kind)),
        ] {
            if let Some(problem) = problem {
                return fail(format!("light {i}: its {part} {problem}"));
            }
        }
    }
    Ok(())
}

/// Checks that `pose` fits a scene of so many instances and lights, and of meshes that bend with so many vertices (`None`
/// for those that do not).
pub fn pose(
    pose: &Pose,
    instances: usize,
    lights: usize,
    bending: impl Fn(usize) -> Option<usize>,
) -> Result<(), RenderError> {
    let fail = |message: String| Err(RenderError::Scene(message));
    for (what, posed, count) in [("instances", pose.instances.len(), instances), ("lights", pose.lights.len(), lights)]
    {
        if posed != count {
            return fail(format!("a pose places {posed} {what}, and there are {count}"));
        }
    }
    if let Some(i) = pose.instances.iter().position(|m| !m.is_finite()) {
        return fail(format!("a pose gives instance {i} a transform that is not finite"));
    }
    if let Some(l) = pose.lights.iter().position(|kind| !kind.homogeneous().is_finite()) {
        return fail(format!("a pose gives light {l} a place that is not finite"));
    }
    if let Some(l) = pose.light_axes.iter().position(|axes| !axes.is_finite()) {
        return fail(format!("a pose gives light {l} axes that are not finite"));
    }
    for bent in &pose.bent {
        let (m, found) = (bent.mesh, bent.positions.len());
        let Some(vertices) = bending(m) else {
            return fail(format!("a pose bends mesh {m}, which does not exist or is rigid"));
        };
        if found != vertices || bent.normals.len() > vertices || bent.tangents.len() > vertices {
            return fail(format!("a pose bends {found} vertices of mesh {m}, which has {vertices}"));
        }
        if let Some(v) = bent.positions.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
            return fail(format!("a pose gives vertex {v} of mesh {m} a place that is not finite"));
        }
    }
    Ok(())
}
