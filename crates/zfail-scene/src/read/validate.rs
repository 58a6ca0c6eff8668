//! The pass before trust: every index in the document leads somewhere, and the node hierarchy is a forest.
//!
//! In: the parsed schema. Out: nothing, or the first fault by its JSON path. After it, indexing into the schema's
//! arrays with the schema's own indices cannot fail. Bytes are checked later, by `document`.

use super::error::{Result, invalid};
use super::schema::{Camera, Material, Primitive, Root, TextureInfo};
use std::collections::BTreeMap;
use std::fmt::Display;

/// Checks versions and references.
pub(super) fn check(root: &Root) -> Result<()> {
    version(root)?;
    let check = References(root);
    check.scene_graph()?;
    check.meshes()?;
    check.skins()?;
    check.animations()?;
    check.materials()?;
    check.data()?;
    root.cameras.iter().enumerate().try_for_each(|(i, camera)| projection(i, camera))
}

fn version(root: &Root) -> Result<()> {
    let parse = |text: &str| {
        let (major, minor) = text.split_once('.')?;
        Some((major.parse::<u32>().ok()?, minor.parse::<u32>().ok()?))
    };
    match parse(&root.asset.version) {
        Some((2, _)) => {}
        Some(_) => {
            let problem = format!("glTF {} cannot be read, only 2.x; convert the file", root.asset.version);
            return Err(invalid("asset.version", problem));
        }
        None => return Err(invalid("asset.version", "is missing or not of the form `2.0`")),
    }
    match root.asset.min_version.as_deref().map(parse) {
        None => Ok(()),
        Some(Some(least)) if least <= (2, 0) => Ok(()),
        Some(_) => Err(invalid("asset.minVersion", "asks for more than glTF 2.0, which is what can be read")),
    }
}

struct References<'a>(&'a Root);

fn within(index: usize, count: usize, what: &str, element: impl Display) -> Result<()> {
    if index < count {
        return Ok(());
    }
    Err(invalid(element.to_string(), format!("refers to {what}[{index}], but the file has {count}")))
}

fn optional(index: Option<usize>, count: usize, what: &str, element: impl Display) -> Result<()> {
    index.map_or(Ok(()), |index| within(index, count, what, element))
}

impl References<'_> {
    fn scene_graph(&self) -> Result<()> {
        let root = self.0;
        let nodes = root.nodes.len();
        optional(root.scene, root.scenes.len(), "scenes", "scene")?;
        let mut parent = vec![None; nodes];
        for (i, node) in root.nodes.iter().enumerate() {
            optional(node.mesh, root.meshes.len(), "meshes", format_args!("nodes[{i}].mesh"))?;
            optional(node.skin, root.skins.len(), "skins", format_args!("nodes[{i}].skin"))?;
            optional(node.camera, root.cameras.len(), "cameras", format_args!("nodes[{i}].camera"))?;
            if let Some(light) = &node.extensions.light {
                let lights = root.extensions.lights.as_ref().map_or(0, |l| l.lights.len());
                let element = format_args!("nodes[{i}].extensions.KHR_lights_punctual.light");
                within(light.light, lights, "extensions.KHR_lights_punctual.lights", element)?;
            }
            if let Some(instancing) = &node.extensions.instancing {
                let path = format!("nodes[{i}].extensions.EXT_mesh_gpu_instancing.attributes");
                self.attributes(&instancing.attributes, &path)?;
            }
            for (j, &child) in node.children.iter().enumerate() {
                within(child, nodes, "nodes", format_args!("nodes[{i}].children[{j}]"))?;
                if let Some(other) = parent[child].replace(i) {
                    let problem = format!("nodes[{child}] is a child of nodes[{other}] already");
                    return Err(invalid(format!("nodes[{i}].children[{j}]"), problem));
                }
            }
        }
        self.no_loops(&parent)?;
        let mut last_scene = vec![None; nodes];
        for (i, scene) in root.scenes.iter().enumerate() {
            for (j, &node) in scene.nodes.iter().enumerate() {
                let element = || format!("scenes[{i}].nodes[{j}]");
                within(node, nodes, "nodes", format_args!("{}", element()))?;
                if let Some(parent) = parent[node] {
                    let problem = format!("nodes[{node}] is no root: it is a child of nodes[{parent}]");
                    return Err(invalid(element(), problem));
                }
                if last_scene[node].replace(i) == Some(i) {
                    return Err(invalid(element(), format!("names nodes[{node}] twice")));
                }
            }
        }
        Ok(())
    }

    /// With one parent each, nodes that no root leads to lie on or below a loop.
    fn no_loops(&self, parent: &[Option<usize>]) -> Result<()> {
        let mut reached = vec![false; parent.len()];
        let mut stack: Vec<usize> = (0..parent.len()).filter(|&i| parent[i].is_none()).collect();
        while let Some(i) = stack.pop() {
            reached[i] = true;
            stack.extend(&self.0.nodes[i].children);
        }
        match reached.iter().position(|r| !r) {
            None => Ok(()),
            Some(i) => Err(invalid(format!("nodes[{i}]"), "is or hangs below its own descendant, a loop")),
        }
    }

    fn meshes(&self) -> Result<()> {
        for (i, mesh) in self.0.meshes.iter().enumerate() {
            for (j, primitive) in mesh.primitives.iter().enumerate() {
                self.primitive(primitive, &format!("meshes[{i}].primitives[{j}]"))?;
            }
        }
        Ok(())
    }

    fn primitive(&self, primitive: &Primitive, path: &str) -> Result<()> {
        let root = self.0;
        optional(primitive.material, root.materials.len(), "materials", format_args!("{path}.material"))?;
        optional(primitive.indices, root.accessors.len(), "accessors", format_args!("{path}.indices"))?;
        self.attributes(&primitive.attributes, &format!("{path}.attributes"))?;
        for (t, target) in primitive.targets.iter().enumerate() {
            self.attributes(target, &format!("{path}.targets[{t}]"))?;
        }
        for (m, mapping) in primitive.extensions.variants.mappings.iter().enumerate() {
            let element = format_args!("{path}.extensions.KHR_materials_variants.mappings[{m}].material");
            within(mapping.material, root.materials.len(), "materials", element)?;
        }
        if let Some(draco) = &primitive.extensions.draco {
            let element = format_args!("{path}.extensions.KHR_draco_mesh_compression.bufferView");
            within(draco.buffer_view, root.buffer_views.len(), "bufferViews", element)?;
        }
        let Some(&positions) = primitive.attributes.get("POSITION") else { return Ok(()) };
        let count = root.accessors[positions].count;
        let targets = primitive.targets.iter().enumerate();
        let sets = std::iter::once((None, &primitive.attributes)).chain(targets.map(|(t, target)| (Some(t), target)));
        for (target, attributes) in sets {
            for (name, &accessor) in attributes {
                let found = root.accessors[accessor].count;
                if found != count {
                    let list = target.map_or("attributes".into(), |t| format!("targets[{t}]"));
                    let problem = format!("has {found} elements, but POSITION has {count}");
                    return Err(invalid(format!("{path}.{list}.{name}"), problem));
                }
            }
        }
        Ok(())
    }

    fn attributes(&self, attributes: &BTreeMap<String, usize>, path: &str) -> Result<()> {
        let count = self.0.accessors.len();
        attributes.iter().try_for_each(|(name, &a)| within(a, count, "accessors", format_args!("{path}.{name}")))
    }

    fn skins(&self) -> Result<()> {
        let root = self.0;
        for (i, skin) in root.skins.iter().enumerate() {
            for (j, &joint) in skin.joints.iter().enumerate() {
                within(joint, root.nodes.len(), "nodes", format_args!("skins[{i}].joints[{j}]"))?;
            }
            let Some(matrices) = skin.inverse_bind_matrices else { continue };
            let element = format!("skins[{i}].inverseBindMatrices");
            within(matrices, root.accessors.len(), "accessors", &element)?;
            let count = root.accessors[matrices].count;
            if count < skin.joints.len() as u64 {
                return Err(invalid(element, format!("has {count} matrices for {} joints", skin.joints.len())));
            }
        }
        Ok(())
    }

    fn animations(&self) -> Result<()> {
        let root = self.0;
        for (i, animation) in root.animations.iter().enumerate() {
            for (j, sampler) in animation.samplers.iter().enumerate() {
                let path = format!("animations[{i}].samplers[{j}]");
                within(sampler.input, root.accessors.len(), "accessors", format_args!("{path}.input"))?;
                within(sampler.output, root.accessors.len(), "accessors", format_args!("{path}.output"))?;
            }
            for (j, channel) in animation.channels.iter().enumerate() {
                let path = format!("animations[{i}].channels[{j}]");
                within(channel.sampler, animation.samplers.len(), "samplers", format_args!("{path}.sampler"))?;
                optional(channel.target.node, root.nodes.len(), "nodes", format_args!("{path}.target.node"))?;
            }
        }
        Ok(())
    }

    fn materials(&self) -> Result<()> {
        let root = self.0;
        for (i, material) in root.materials.iter().enumerate() {
            for (slot, info) in texture_slots(material) {
                within(info.index, root.textures.len(), "textures", format_args!("materials[{i}].{slot}.index"))?;
            }
        }
        for (i, texture) in root.textures.iter().enumerate() {
            optional(texture.sampler, root.samplers.len(), "samplers", format_args!("textures[{i}].sampler"))?;
            let extensions = &texture.extensions;
            for (source, path) in [
                (texture.source, "source"),
                (extensions.basisu.source, "extensions.KHR_texture_basisu.source"),
                (extensions.webp.source, "extensions.EXT_texture_webp.source"),
            ] {
                optional(source, root.images.len(), "images", format_args!("textures[{i}].{path}"))?;
            }
        }
        for (i, image) in root.images.iter().enumerate() {
            optional(
                image.buffer_view,
                root.buffer_views.len(),
                "bufferViews",
                format_args!("images[{i}].bufferView"),
            )?;
        }
        Ok(())
    }

    fn data(&self) -> Result<()> {
        let root = self.0;
        let views = root.buffer_views.len();
        for (i, view) in root.buffer_views.iter().enumerate() {
            within(view.buffer, root.buffers.len(), "buffers", format_args!("bufferViews[{i}].buffer"))?;
            if let Some((extension, meshopt)) = view.extensions.meshopt() {
                let element = format_args!("bufferViews[{i}].extensions.{extension}.buffer");
                within(meshopt.buffer, root.buffers.len(), "buffers", element)?;
            }
        }
        for (i, accessor) in root.accessors.iter().enumerate() {
            optional(accessor.buffer_view, views, "bufferViews", format_args!("accessors[{i}].bufferView"))?;
            if let Some(sparse) = &accessor.sparse {
                let path = format!("accessors[{i}].sparse");
                let (indices, values) = (sparse.indices.buffer_view, sparse.values.buffer_view);
                within(indices, views, "bufferViews", format_args!("{path}.indices.bufferView"))?;
                within(values, views, "bufferViews", format_args!("{path}.values.bufferView"))?;
            }
        }
        Ok(())
    }
}

/// Every texture slot of `material` with its JSON path.
fn texture_slots(material: &Material) -> impl Iterator<Item = (&'static str, &TextureInfo)> {
    let pbr = &material.pbr_metallic_roughness;
    let extensions = &material.extensions;
    let glossy = extensions.specular_glossiness.as_deref();
    let (clearcoat, sheen) = (extensions.clearcoat.as_deref(), extensions.sheen.as_deref());
    let transmission = extensions.transmission.as_deref();
    let specular = extensions.specular.as_deref();
    [
        ("pbrMetallicRoughness.baseColorTexture", pbr.base_color_texture.as_ref()),
        ("pbrMetallicRoughness.metallicRoughnessTexture", pbr.metallic_roughness_texture.as_ref()),
        ("normalTexture", material.normal_texture.as_ref()),
        ("occlusionTexture", material.occlusion_texture.as_ref()),
        ("emissiveTexture", material.emissive_texture.as_ref()),
        (
            "extensions.KHR_materials_pbrSpecularGlossiness.diffuseTexture",
            glossy.and_then(|s| s.diffuse_texture.as_ref()),
        ),
        (
            "extensions.KHR_materials_pbrSpecularGlossiness.specularGlossinessTexture",
            glossy.and_then(|s| s.specular_glossiness_texture.as_ref()),
        ),
        (
            "extensions.KHR_materials_transmission.transmissionTexture",
            transmission.and_then(|t| t.transmission_texture.as_ref()),
        ),
        (
            "extensions.KHR_materials_specular.specularColorTexture",
            specular.and_then(|s| s.specular_color_texture.as_ref()),
        ),
        ("extensions.KHR_materials_clearcoat.clearcoatTexture", clearcoat.and_then(|c| c.clearcoat_texture.as_ref())),
        ("extensions.KHR_materials_sheen.sheenColorTexture", sheen.and_then(|s| s.sheen_color_texture.as_ref())),
    ]
    .into_iter()
    .filter_map(|(slot, info)| Some((slot, info?)))
}

fn projection(i: usize, camera: &Camera) -> Result<()> {
    let require = |holds: bool, property: &str, problem: &str| {
        if holds { Ok(()) } else { Err(invalid(format!("cameras[{i}].{property}"), problem)) }
    };
    match (&camera.perspective, &camera.orthographic) {
        (Some(p), None) => {
            require(p.yfov > 0.0 && p.yfov < std::f64::consts::PI, "perspective.yfov", "must lie between 0 and pi")?;
            require(p.znear > 0.0, "perspective.znear", "must be positive")?;
            require(p.zfar.is_none_or(|far| far > p.znear), "perspective.zfar", "must exceed znear")
        }
        (None, Some(o)) => {
            require(o.ymag != 0.0, "orthographic.ymag", "must not be zero")?;
            require(o.zfar > o.znear, "orthographic.zfar", "must exceed znear")
        }
        _ => require(false, "type", "needs exactly one of `perspective` and `orthographic`"),
    }
}
