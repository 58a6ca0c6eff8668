//! Materials, textures and embedded PNG images.

use super::{Document, Result, WriteError};
use serde_json::{Value, json};
use zfail_scene::{AlphaMode, Filter, Image, Material, Scene, Specular, Texture, TextureRef, Wrap};

/// Writes all images, textures and materials with the scene's own indices.
pub(super) fn write(document: &mut Document, scene: &Scene) -> Result<()> {
    for (index, image) in scene.images.iter().enumerate() {
        let png = png(image).map_err(|source| WriteError::Image { index, source })?;
        let view = document.buffer.view(png);
        document.images.push(json!({ "name": image.name, "mimeType": "image/png", "bufferView": view }));
    }
    for texture in &scene.textures {
        let sampler = sampler(texture);
        let known = document.samplers.iter().position(|s| *s == sampler);
        let index = known.unwrap_or_else(|| {
            document.samplers.push(sampler);
            document.samplers.len() - 1
        });
        document.textures.push(json!({ "sampler": index, "source": texture.image }));
    }
    for (i, material) in scene.materials.iter().enumerate() {
        let material = Writer { document, element: format!("materials[{i}]") }.material(material)?;
        document.materials.push(material);
    }
    Ok(())
}

fn png(image: &Image) -> std::result::Result<Vec<u8>, png::EncodingError> {
    let opaque = image.rgba.chunks_exact(4).all(|pixel| pixel[3] == 255);
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, image.width, image.height);
    encoder.set_color(if opaque { png::ColorType::Rgb } else { png::ColorType::Rgba });
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_filter(png::Filter::Adaptive);
    let mut writer = encoder.write_header()?;
    if opaque {
        let rgb: Vec<u8> = image.rgba.chunks_exact(4).flat_map(|pixel| &pixel[..3]).copied().collect();
        writer.write_image_data(&rgb)?;
    } else {
        writer.write_image_data(&image.rgba)?;
    }
    writer.finish()?;
    Ok(file)
}

fn sampler(texture: &Texture) -> Value {
    let wrap = |wrap| match wrap {
        Wrap::Repeat => 10497,
        Wrap::Mirror => 33648,
        Wrap::Clamp => 33071,
    };
    let linear = |filter| u32::from(filter == Filter::Linear);
    // Nearest and linear; with mip maps the same, levels always blended.
    let min = if texture.mipmaps { 9986 } else { 9728 } + linear(texture.min);
    json!({
        "magFilter": 9728 + linear(texture.mag),
        "minFilter": min,
        "wrapS": wrap(texture.wrap_u),
        "wrapT": wrap(texture.wrap_v),
    })
}

struct Writer<'a> {
    document: &'a mut Document,
    element: String,
}

impl Writer<'_> {
    fn material(&mut self, material: &Material) -> Result<Value> {
        let mut pbr = json!({
            "baseColorFactor": material.base_color,
            "metallicFactor": material.metallic,
            "roughnessFactor": material.roughness,
        });
        self.texture(&mut pbr, "baseColorTexture", material.base_color_texture, None)?;
        self.texture(&mut pbr, "metallicRoughnessTexture", material.metallic_roughness_texture, None)?;
        let mut json = json!({ "name": material.name, "pbrMetallicRoughness": pbr });
        let scale = Some(("scale", material.normal_scale));
        let strength = Some(("strength", material.occlusion_strength));
        self.texture(&mut json, "normalTexture", material.normal_texture, scale)?;
        self.texture(&mut json, "occlusionTexture", material.occlusion_texture, strength)?;
        self.texture(&mut json, "emissiveTexture", material.emissive_texture, None)?;
        self.emission(&mut json, material.emissive);
        match material.alpha {
            AlphaMode::Opaque => {}
            AlphaMode::Mask(cutoff) => {
                json["alphaMode"] = json!("MASK");
                json["alphaCutoff"] = json!(cutoff);
            }
            AlphaMode::Blend => json["alphaMode"] = json!("BLEND"),
        }
        if material.double_sided {
            json["doubleSided"] = json!(true);
        }
        if material.unlit {
            self.extend(&mut json, "KHR_materials_unlit", json!({}));
        }
        self.reflections(&mut json, material)?;
        Ok(json)
    }

    fn reflections(&mut self, json: &mut Value, material: &Material) -> Result<()> {
        if let Some(glossy) = material.specular_glossiness {
            let mut value = json!({
                "diffuseFactor": material.base_color,
                "specularFactor": glossy.color,
                "glossinessFactor": glossy.glossiness,
            });
            self.texture(&mut value, "diffuseTexture", material.base_color_texture, None)?;
            self.texture(&mut value, "specularGlossinessTexture", glossy.texture, None)?;
            self.extend(json, "KHR_materials_pbrSpecularGlossiness", value);
        }
        let (specular, plain) = (material.specular, Specular::default());
        if specular.ior != plain.ior {
            self.extend(json, "KHR_materials_ior", json!({ "ior": specular.ior }));
        }
        if specular != (Specular { ior: specular.ior, ..plain }) {
            let mut value = json!({ "specularFactor": specular.strength, "specularColorFactor": specular.color });
            self.texture(&mut value, "specularColorTexture", specular.color_texture, None)?;
            self.extend(json, "KHR_materials_specular", value);
        }
        if let Some(coat) = material.clearcoat {
            let mut value = json!({ "clearcoatFactor": coat.strength, "clearcoatRoughnessFactor": coat.roughness });
            self.texture(&mut value, "clearcoatTexture", coat.texture, None)?;
            self.extend(json, "KHR_materials_clearcoat", value);
        }
        if let Some(sheen) = material.sheen {
            let mut value = json!({ "sheenColorFactor": sheen.color, "sheenRoughnessFactor": sheen.roughness });
            self.texture(&mut value, "sheenColorTexture", sheen.texture, None)?;
            self.extend(json, "KHR_materials_sheen", value);
        }
        if let Some(transmission) = material.transmission {
            let mut value = json!({ "transmissionFactor": transmission.share });
            self.texture(&mut value, "transmissionTexture", transmission.texture, None)?;
            self.extend(json, "KHR_materials_transmission", value);
            if transmission.tint != [1.0; 3] {
                // Beer's law over the distance that leaves just this tint.
                let volume =
                    json!({ "thicknessFactor": 1, "attenuationDistance": 1, "attenuationColor": transmission.tint });
                self.extend(json, "KHR_materials_volume", volume);
            }
        }
        Ok(())
    }

    /// Factors beyond 1 are split into a factor and a strength, a power of two so that nothing is rounded.
    fn emission(&mut self, json: &mut Value, emissive: [f32; 3]) {
        let brightest = emissive.into_iter().fold(0.0, f32::max);
        let mut strength = 1.0;
        while strength < brightest {
            strength *= 2.0;
        }
        if brightest > 0.0 {
            json["emissiveFactor"] = json!(emissive.map(|e| e / strength));
        }
        if strength > 1.0 {
            self.extend(json, "KHR_materials_emissive_strength", json!({ "emissiveStrength": strength }));
        }
    }

    fn texture(
        &mut self,
        owner: &mut Value,
        slot: &str,
        texture: Option<TextureRef>,
        factor: Option<(&str, f32)>,
    ) -> Result<()> {
        let Some(texture) = texture else { return Ok(()) };
        let mut json = json!({ "index": texture.texture });
        if texture.uv_set != 0 {
            json["texCoord"] = json!(texture.uv_set);
        }
        if let Some((name, factor)) = factor {
            json[name] = json!(factor);
        }
        if texture.uv_from_mesh != TextureRef::new(0).uv_from_mesh {
            let transform = transform(texture.uv_from_mesh).ok_or_else(|| WriteError::Invalid {
                element: format!("{}.{slot}", self.element),
                problem: "skews texture coordinates, which KHR_texture_transform cannot".into(),
            })?;
            self.extend(&mut json, "KHR_texture_transform", transform);
        }
        owner[slot] = json;
        Ok(())
    }

    fn extend(&mut self, json: &mut Value, extension: &'static str, value: Value) {
        json["extensions"][extension] = value;
        self.document.extensions.insert(extension);
    }
}

/// Offset, rotation and scale that make up the matrix; `None` if it skews. Without rotation they are exact.
fn transform([[a, b, x], [c, d, y]]: [[f32; 3]; 2]) -> Option<Value> {
    let [a, b, c, d] = [a, b, c, d].map(f64::from);
    let (rotation, scale) = if b == 0.0 && c == 0.0 {
        (0.0, [a, d])
    } else if a == 0.0 && c == 0.0 {
        (b.atan2(d), [0.0, b.hypot(d)])
    } else {
        let width = a.hypot(c);
        ((-c).atan2(a), [width, (a * d - b * c) / width])
    };
    let skew = (a * b + c * d).abs();
    (skew <= 1e-6 * a.hypot(c) * b.hypot(d)).then(|| json!({ "offset": [x, y], "rotation": rotation, "scale": scale }))
}
