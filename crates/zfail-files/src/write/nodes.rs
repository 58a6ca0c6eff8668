//! Nodes in the order of the scene: instances, lights, cameras.

use super::{Document, unskew};
use glam::{DAffine3, DMat3, DVec3};
use rustc_hash::{FxHashMap, FxHashSet};
use serde_json::{Value, json};
use zfail_plan::light::LightKind;
use zfail_plan::view::Projection;
use zfail_scene::placement::light_placement;
use zfail_scene::{Camera, Light, Scene};

/// Width over height of orthographic cameras, which glTF wants to know; the image's own wins when it is rendered.
const ASPECT: f64 = 16.0 / 9.0;

/// Writes all nodes; `mesh_of` gives the file's index of each mesh.
pub(super) fn write(document: &mut Document, scene: &Scene, mesh_of: &[Option<usize>]) {
    let names = instance_names(scene);
    for (instance, name) in scene.instances.iter().zip(&names) {
        let mut node = json!({ "name": name });
        if let Some(mesh) = mesh_of[instance.mesh] {
            node["mesh"] = json!(mesh);
        }
        for (word, holds) in [("castShadow", instance.casts_shadow), ("receiveShadow", instance.receives_shadow)] {
            if !holds {
                node["extras"][word] = json!(false);
            }
        }
        document.place(node, &instance.world_from_object);
    }
    for light in &scene.lights {
        let mut node = json!({ "name": light.name });
        node["extensions"] = json!({ "KHR_lights_punctual": { "light": document.lights.len() } });
        if !light.excluded.is_empty() {
            let excluded: Vec<&str> = light.excluded.iter().map(|&i| names[i].as_str()).collect();
            node["extras"]["shadowExclude"] = json!(excluded);
        }
        if !light.shape.falloff.is_empty() {
            node["extras"]["falloff"] = json!(light.shape.falloff);
        }
        if let Some(cookie) = light.shape.cookie {
            node["extras"]["cookie"] = json!(cookie);
        }
        if let Some(half) = light.shape.half_extents {
            node["extras"]["box"] = json!(half.to_array());
        }
        document.lights.push(light_json(light));
        document.extensions.insert("KHR_lights_punctual");
        document.place(node, &light_placement(light));
    }
    for camera in &scene.cameras {
        let (json, world_from_view) = camera_json(camera);
        let node = json!({ "name": camera.name, "camera": document.cameras.len() });
        document.cameras.push(json);
        document.place(node, &world_from_view);
    }
}

impl Document {
    /// Adds a root node. A transform that skews is spread over two nodes, for glTF allows none in a single one.
    fn place(&mut self, mut node: Value, world_from_node: &DAffine3) {
        if let Some([outer, inner]) = unskew::split(world_from_node) {
            set_transform(&mut node, &inner);
            self.nodes.push(node);
            let mut parent = json!({ "children": [self.nodes.len() - 1] });
            set_transform(&mut parent, &outer);
            self.nodes.push(parent);
        } else {
            set_transform(&mut node, world_from_node);
            self.nodes.push(node);
        }
        self.roots.push(self.nodes.len() - 1);
    }
}

fn set_transform(node: &mut Value, transform: &DAffine3) {
    if transform.matrix3 != DMat3::IDENTITY {
        let mut matrix = [0.0; 16];
        for (column, values) in
            [transform.x_axis, transform.y_axis, transform.z_axis, transform.w_axis].iter().enumerate()
        {
            matrix[4 * column..4 * column + 3].copy_from_slice(&values.to_array());
        }
        matrix[15] = 1.0;
        node["matrix"] = json!(matrix);
    } else if transform.translation != DVec3::ZERO {
        node["translation"] = json!(transform.translation.to_array());
    }
}

/// The instances' names, made unique where a light excludes an instance by a name that another one bears too.
fn instance_names(scene: &Scene) -> Vec<String> {
    let mut names: Vec<String> = scene.instances.iter().map(|instance| instance.name.clone()).collect();
    let mut bearers: FxHashMap<&str, usize> = FxHashMap::default();
    for instance in &scene.instances {
        *bearers.entry(&instance.name).or_default() += 1;
    }
    let mut taken: FxHashSet<String> = names.iter().cloned().collect();
    let excluded: FxHashSet<usize> = scene.lights.iter().flat_map(|light| &light.excluded).copied().collect();
    for (i, name) in names.iter_mut().enumerate() {
        if excluded.contains(&i) && bearers[name.as_str()] > 1 {
            let fresh = (i..).map(|k| format!("{name} #{k}")).find(|name| !taken.contains(name));
            *name = fresh.unwrap_or_default();
            taken.insert(name.clone());
        }
    }
    names
}

fn light_json(light: &Light) -> Value {
    let mut json = json!({ "name": light.name, "color": light.color, "intensity": light.intensity });
    let range = match light.kind {
        LightKind::Point { range, .. } => {
            json["type"] = json!("point");
            range
        }
        LightKind::Spot { range, inner, outer, .. } => {
            json["type"] = json!("spot");
            json["spot"] = json!({ "innerConeAngle": inner, "outerConeAngle": outer });
            range
        }
        LightKind::Directional { .. } => {
            json["type"] = json!("directional");
            f64::INFINITY
        }
    };
    if range.is_finite() {
        json["range"] = json!(range);
    }
    json
}

/// The camera and its placement. An orthographic one whose near plane is behind the eye is moved back to it.
fn camera_json(camera: &Camera) -> (Value, DAffine3) {
    let mut world_from_view = camera.world_from_view;
    let json = match camera.projection {
        Projection::Perspective { yfov, near, far } => {
            let mut lens = json!({ "yfov": yfov, "znear": near });
            if let Some(far) = far {
                lens["zfar"] = json!(far);
            }
            json!({ "type": "perspective", "perspective": lens, "name": camera.name })
        }
        Projection::Orthographic { ymag, near, far } => {
            let back = (-near).max(0.0);
            world_from_view.translation += world_from_view.matrix3.z_axis * back;
            let lens = json!({ "xmag": ASPECT * ymag, "ymag": ymag, "znear": near + back, "zfar": far + back });
            json!({ "type": "orthographic", "orthographic": lens, "name": camera.name })
        }
    };
    (json, world_from_view)
}
