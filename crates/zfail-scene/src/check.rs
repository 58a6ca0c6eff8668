//! Whether a scene keeps the rules that the scene types state.

use crate::{Material, Mesh, Scene, TextureRef};
use zfail_plan::light::LightKind;
use zfail_plan::view::Projection;

/// What breaks a rule.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{element} {problem}")]
pub struct Unsound {
    /// Which part of the scene, such as `meshes[2].triangles[7]`.
    pub element: String,
    /// What is wrong with it.
    pub problem: String,
}

type Result<T> = std::result::Result<T, Unsound>;

/// Accepts a scene whose indices are in range, whose attributes have one length, whose primitives cover the triangles
/// in order and whose numbers are finite.
///
/// # Errors
/// Names the first element that is not so.
pub fn check(scene: &Scene) -> std::result::Result<(), Unsound> {
    for (i, mesh) in scene.meshes.iter().enumerate() {
        check_mesh(mesh, scene.materials.len(), &format!("meshes[{i}]"))?;
    }
    for (i, material) in scene.materials.iter().enumerate() {
        let factors = [material.metallic, material.roughness, material.normal_scale, material.occlusion_strength];
        let mut numbers = material.base_color.iter().chain(&material.emissive).chain(&factors);
        require(numbers.all(|x| x.is_finite()), || format!("materials[{i}]"), "has a factor that is not finite")?;
        for texture in textures(material).into_iter().flatten() {
            let element = || format!("materials[{i}]");
            require(texture.texture < scene.textures.len(), element, "uses a texture that is not there")?;
            require(texture.uv_set < 2, element, "uses a third set of texture coordinates")?;
        }
    }
    for (i, texture) in scene.textures.iter().enumerate() {
        require(texture.image < scene.images.len(), || format!("textures[{i}]"), "shows an image that is not there")?;
    }
    for (i, image) in scene.images.iter().enumerate() {
        let bytes = u64::from(image.width) * u64::from(image.height) * 4;
        let fits = bytes > 0 && bytes == image.rgba.len() as u64;
        require(fits, || format!("images[{i}]"), "does not have 4 bytes per pixel")?;
    }
    for (i, instance) in scene.instances.iter().enumerate() {
        let element = || format!("instances[{i}]");
        require(instance.mesh < scene.meshes.len(), element, "places a mesh that is not there")?;
        require(instance.world_from_object.is_finite(), element, "has a transform that is not finite")?;
        let invertible = instance.world_from_object.matrix3.determinant() != 0.0;
        require(invertible, element, "has a transform that flattens it")?;
    }
    for (i, light) in scene.lights.iter().enumerate() {
        let element = || format!("lights[{i}]");
        let known = light.excluded.iter().all(|&i| i < scene.instances.len());
        require(known, element, "excludes an instance that is not there")?;
        let numbers = light.color.iter().chain([&light.intensity]).all(|x| x.is_finite());
        let (finite, unit) = match light.kind {
            LightKind::Point { position, .. } => (position.is_finite(), true),
            LightKind::Spot { position, direction, inner, outer, .. } => {
                (position.is_finite() && inner.is_finite() && outer.is_finite(), direction.is_normalized())
            }
            LightKind::Directional { direction } => (true, direction.is_normalized()),
        };
        require(finite && numbers, element, "is not finite")?;
        require(unit, element, "has a direction that is no unit vector")?;
        let shape = &light.shape;
        for (part, problem) in [
            ("falloff", shape.falloff_problem(&light.kind)),
            ("cookie", shape.cookie_problem(&light.kind, scene.textures.len())),
            ("box", shape.box_problem(&light.kind)),
        ] {
            require(problem.is_none(), || format!("lights[{i}].{part}"), problem.unwrap_or_default())?;
        }
        require(shape.axes.is_finite(), element, "has axes that are not finite")?;
    }
    for (i, camera) in scene.cameras.iter().enumerate() {
        let sound = match camera.projection {
            Projection::Perspective { yfov, near, far } => {
                yfov > 0.0 && yfov < std::f64::consts::PI && near > 0.0 && far.is_none_or(|far| far > near)
            }
            Projection::Orthographic { ymag, near, far } => ymag > 0.0 && far > near && near.is_finite(),
        };
        let sound = sound && camera.world_from_view.is_finite();
        require(sound, || format!("cameras[{i}]"), "has no view volume")?;
    }
    Ok(())
}

fn check_mesh(mesh: &Mesh, materials: usize, element: &str) -> Result<()> {
    let count = mesh.positions.len();
    let lengths = [mesh.normals.len(), mesh.tangents.len(), mesh.uv0.len(), mesh.uv1.len(), mesh.colors.len()];
    require(lengths == [count; 5], || element.into(), "has attributes of different lengths")?;
    let finite = mesh.positions.iter().chain(&mesh.normals).flatten().all(|x| x.is_finite());
    require(finite, || element.into(), "has a position or normal that is not finite")?;
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        let known = triangle.iter().all(|&v| (v as usize) < count);
        require(known, || format!("{element}.triangles[{t}]"), "uses a vertex that is not there")?;
    }
    let mut end = 0;
    for (p, primitive) in mesh.primitives.iter().enumerate() {
        let element = || format!("{element}.primitives[{p}]");
        let follows = primitive.triangles.start == end && primitive.triangles.end >= end;
        require(follows, element, "does not begin where the one before ends")?;
        require(primitive.material.is_none_or(|m| m < materials), element, "has a material that is not there")?;
        end = primitive.triangles.end;
    }
    require(end as usize == mesh.triangles.len(), || element.into(), "has triangles without primitive")
}

fn textures(material: &Material) -> [Option<TextureRef>; 5] {
    [
        material.base_color_texture,
        material.metallic_roughness_texture,
        material.normal_texture,
        material.occlusion_texture,
        material.emissive_texture,
    ]
}

fn require(holds: bool, element: impl FnOnce() -> String, problem: &str) -> Result<()> {
    if holds { Ok(()) } else { Err(Unsound { element: element(), problem: problem.into() }) }
}
