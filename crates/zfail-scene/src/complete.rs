//! What a scene needs to be looked at, where the file leaves it out.

use glam::{DAffine3, DMat3, DVec3};
use std::f64::consts::PI;
use zfail_plan::scene::{Bounds, Camera, Light, LightKind, LightShape, Scene, world_triangle};
use zfail_plan::view::Projection;

/// Adds what is missing: a camera that frames the scene, a directional light (with a notice), ambient light and
/// background.
///
/// Light intensities in files differ by orders of magnitude and pictures are exposed to match, so the ambient light
/// is set relative to what the lights give a typical surface: about a tenth, so that shadows are dark but not black.
pub fn complete(scene: &mut Scene) {
    if scene.cameras.is_empty() {
        scene.cameras.push(framing_camera(&scene.bounds()));
    }
    if scene.lights.is_empty() {
        scene.lights.push(default_light(&scene.cameras[0]));
        scene.notices.push("the scene has no light; one directional light is added".into());
    }
    // A white diffuse surface under irradiance E has the radiance E / pi.
    let white = (typical_irradiance(scene) / PI).min(1e30) as f32;
    if scene.ambient == [0.0; 3] {
        scene.ambient = [0.085, 0.095, 0.115].map(|x| x * white);
    }
    if scene.background == [0.0; 3] {
        scene.background = [0.10, 0.13, 0.18].map(|x| x * white);
    }
}

/// Looks at the scene from the front, the right and above, near enough to fill a square picture.
fn framing_camera(bounds: &Bounds) -> Camera {
    const YFOV: f64 = PI / 4.0;
    let unit = Bounds { min: DVec3::splat(-1.0), max: DVec3::ONE };
    let bounds = if bounds.is_empty() { &unit } else { bounds };
    let back = DVec3::new(0.5, 0.4, 0.8).normalize();
    let right = DVec3::Y.cross(back).normalize();
    let up = back.cross(right);
    let slope = (0.5 * YFOV).tan();
    // The least distance at which each corner is inside the pyramid.
    let distance = |corner: DVec3| {
        let from_center = corner - bounds.center();
        from_center.dot(back) + from_center.dot(right).abs().max(from_center.dot(up).abs()) / slope
    };
    let distance = bounds.corners().map(distance).into_iter().fold(0.0, f64::max);
    let distance = if distance > 0.0 { 1.05 * distance } else { 1.0 };
    Camera {
        name: "framing".into(),
        world_from_view: DAffine3 {
            matrix3: DMat3::from_cols(right, up, back),
            translation: bounds.center() + distance * back,
        },
        projection: Projection::Perspective { yfov: YFOV, near: 0.005 * distance, far: None },
    }
}

/// From above, over the camera's left shoulder.
fn default_light(camera: &Camera) -> Light {
    let axes = camera.world_from_view.matrix3;
    let horizontal = |v: DVec3, otherwise: DVec3| v.with_y(0.0).try_normalize().unwrap_or(otherwise);
    let forward = horizontal(-axes.z_axis, DVec3::NEG_Z);
    let right = horizontal(axes.x_axis, DVec3::X);
    Light {
        name: "default".into(),
        kind: LightKind::Directional { direction: (0.45 * right + 0.55 * forward - DVec3::Y).normalize() },
        color: [1.0; 3],
        // Gives a white surface the radiance 1, which is also what emissive factors are relative to.
        intensity: std::f32::consts::PI,
        excluded: Vec::new(),
        shape: LightShape::default(),
    }
}

/// Median, over a sample of the triangles that any light reaches, of the irradiance from all lights, shadows aside;
/// pi if none is reached.
fn typical_irradiance(scene: &Scene) -> f64 {
    const SAMPLES: usize = 1024;
    let triangles = |i: usize| scene.meshes[scene.instances[i].mesh].triangles.len();
    let total: usize = (0..scene.instances.len()).map(triangles).sum();
    let step = total.div_ceil(SAMPLES).max(1);
    let mut irradiances = Vec::new();
    let mut skip = 0;
    for (i, instance) in scene.instances.iter().enumerate() {
        let mesh = &scene.meshes[instance.mesh];
        for t in (skip..triangles(i)).step_by(step) {
            let [a, b, c] = world_triangle(mesh, &instance.world_from_object, t);
            if let Some(normal) = (b - a).cross(c - a).try_normalize() {
                irradiances.push(irradiance(&scene.lights, (a + b + c) / 3.0, normal));
            }
        }
        skip = (skip + step - triangles(i) % step) % step;
    }
    irradiances.retain(|e| e.is_finite() && *e > 0.0);
    irradiances.sort_by(f64::total_cmp);
    irradiances.get(irradiances.len() / 2).copied().unwrap_or(PI)
}

fn irradiance(lights: &[Light], point: DVec3, normal: DVec3) -> f64 {
    let from = |light: &Light| {
        let luminance = glam::Vec3::from(light.color).dot(glam::Vec3::new(0.2126, 0.7152, 0.0722));
        let strength = f64::from(light.intensity * luminance);
        if !light.reaches(point) {
            return 0.0;
        }
        match light.kind {
            LightKind::Directional { direction } => strength * normal.dot(direction).abs(),
            LightKind::Point { position, range } | LightKind::Spot { position, range, .. } => {
                let to = position - point;
                let distance = to.length();
                let falloff = light.shape.falloff_at(distance / range).unwrap_or_else(|| distance.powi(-2));
                strength * falloff * normal.dot(to).abs() / distance
            }
        }
    };
    lights.iter().map(from).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use zfail_plan::scene::{Instance, Mesh, Primitive};

    fn floor(size: f32) -> Scene {
        let mesh = Mesh {
            positions: [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]].map(|[x, z]| [size * x, 0.0, size * z]).to_vec(),
            triangles: vec![[0, 1, 2]],
            primitives: vec![Primitive { triangles: 0..1, material: None }],
            ..Mesh::default()
        };
        let instance =
            Instance { name: "floor".into(), mesh: 0, world_from_object: DAffine3::IDENTITY, casts_shadow: true };
        Scene { meshes: vec![mesh], instances: vec![instance], ..Scene::default() }
    }

    #[test]
    fn the_camera_sees_everything() {
        for size in [1e-3, 1.0, 1e6] {
            let mut scene = floor(size);
            complete(&mut scene);
            let view = scene.cameras[0].view([100, 100], &scene.bounds());
            let clip = view.clip_from_view() * glam::DMat4::from(view.view_from_object(&DAffine3::IDENTITY));
            let mut widest: f64 = 0.0;
            for corner in scene.bounds().corners() {
                let p = clip * corner.extend(1.0);
                assert!(p.w > view.near() && p.x.abs() < p.w && p.y.abs() < p.w, "{size}: {p}");
                widest = widest.max(p.x.abs().max(p.y.abs()) / p.w);
            }
            assert!(widest > 0.9, "{size}: it fills the picture");
        }
    }

    #[test]
    fn what_is_there_stays() {
        let mut scene = floor(1.0);
        complete(&mut scene);
        let (cameras, lights, notices) = (scene.cameras.len(), scene.lights.len(), scene.notices.clone());
        assert_eq!((cameras, lights, notices.len()), (1, 1, 1));
        let ambient = scene.ambient;
        complete(&mut scene);
        assert_eq!((scene.cameras.len(), scene.lights.len(), &scene.notices), (1, 1, &notices));
        assert_eq!(scene.ambient, ambient);
    }

    #[test]
    fn ambient_light_follows_the_lights() {
        let ambient = |intensity: f32| {
            let mut scene = floor(1.0);
            let kind = LightKind::Point { position: DVec3::Y, range: f64::INFINITY };
            scene.lights = vec![Light {
                name: String::new(),
                kind,
                color: [1.0; 3],
                intensity,
                excluded: Vec::new(),
                shape: LightShape::default(),
            }];
            complete(&mut scene);
            scene.ambient[0]
        };
        assert!((ambient(1000.0) / ambient(1.0) - 1000.0).abs() < 1e-2);
        assert!(ambient(1.0) > 0.0);
    }

    #[test]
    fn an_empty_scene_gets_a_camera_too() {
        let mut scene = Scene::default();
        complete(&mut scene);
        assert!(scene.cameras[0].world_from_view.is_finite() && scene.ambient[0] > 0.0);
    }
}
