//! Materials and textures, reduced to metallic-roughness.

use super::schema::{self, AlphaMode as Mode, Root, TextureInfo};
use zfail_plan::scene::{AlphaMode, Filter, Material, Texture, TextureRef, Wrap};

/// The document's textures as the scene holds them. `images` are the scene's, by the document's index, without those
/// that could not be decoded. Returns the scene's textures, and the index of each of the document's among them.
pub(super) fn textures(
    root: &Root,
    images: &[Option<usize>],
    notices: &mut Vec<String>,
) -> (Vec<Texture>, Vec<Option<usize>>) {
    let mut textures = Vec::new();
    let mut unreadable = 0;
    let index = root.textures.iter().map(|texture| {
        let Some(image) = texture.images().find_map(|image| images[image]) else {
            unreadable += 1;
            return None;
        };
        let sampler = texture.sampler.map(|s| &root.samplers[s]);
        textures.push(sampled(image, sampler.unwrap_or(&schema::Sampler::default())));
        Some(textures.len() - 1)
    });
    let index = index.collect();
    if unreadable > 0 {
        let plural = if unreadable == 1 { "" } else { "s" };
        notices.push(format!("{unreadable} texture{plural} without a readable image: shown by plain factors"));
    }
    (textures, index)
}

fn sampled(image: usize, sampler: &schema::Sampler) -> Texture {
    const CLAMP_TO_EDGE: u32 = 33071;
    const MIRRORED_REPEAT: u32 = 33648;
    const NEAREST: u32 = 9728;
    const LINEAR: u32 = 9729;
    const NEAREST_MIPMAP_NEAREST: u32 = 9984;
    const NEAREST_MIPMAP_LINEAR: u32 = 9986;
    let wrap = |code| match code {
        Some(CLAMP_TO_EDGE) => Wrap::Clamp,
        Some(MIRRORED_REPEAT) => Wrap::Mirror,
        _ => Wrap::Repeat,
    };
    let nearest = [NEAREST, NEAREST_MIPMAP_NEAREST, NEAREST_MIPMAP_LINEAR];
    let filter = |code: Option<u32>| {
        if code.is_some_and(|code| nearest.contains(&code)) { Filter::Nearest } else { Filter::Linear }
    };
    Texture {
        image,
        wrap_u: wrap(sampler.wrap_s),
        wrap_v: wrap(sampler.wrap_t),
        mag: filter(sampler.mag_filter),
        min: filter(sampler.min_filter),
        mipmaps: !matches!(sampler.min_filter, Some(NEAREST | LINEAR)),
    }
}

/// The document's materials; `textures` are the scene's by the document's index.
pub(super) fn materials(root: &Root, textures: &[Option<usize>], notices: &mut Vec<String>) -> Vec<Material> {
    root.materials
        .iter()
        .enumerate()
        .map(|(i, source)| {
            let name = source.name.clone().unwrap_or_else(|| format!("material {i}"));
            Converter { name: &name, textures, notices }.convert(source)
        })
        .collect()
}

struct Converter<'a> {
    name: &'a str,
    textures: &'a [Option<usize>],
    notices: &'a mut Vec<String>,
}

impl Converter<'_> {
    fn convert(&mut self, source: &schema::Material) -> Material {
        let pbr = &source.pbr_metallic_roughness;
        let strength = source.extensions.emissive_strength.emissive_strength;
        let mut material = Material {
            name: self.name.into(),
            base_color: pbr.base_color_factor.map(unit),
            base_color_texture: self.texture(pbr.base_color_texture.as_ref()),
            metallic: unit(pbr.metallic_factor),
            roughness: unit(pbr.roughness_factor),
            metallic_roughness_texture: self.texture(pbr.metallic_roughness_texture.as_ref()),
            normal_texture: self.texture(source.normal_texture.as_ref()),
            normal_scale: source.normal_texture.as_ref().map_or(1.0, |t| bounded(t.scale)),
            occlusion_texture: self.texture(source.occlusion_texture.as_ref()),
            occlusion_strength: source.occlusion_texture.as_ref().map_or(1.0, |t| unit(t.strength)),
            emissive: source.emissive_factor.map(|e| bounded(e * strength).max(0.0)),
            emissive_texture: self.texture(source.emissive_texture.as_ref()),
            alpha: match source.alpha_mode {
                Mode::Opaque => AlphaMode::Opaque,
                Mode::Mask => AlphaMode::Mask(bounded(source.alpha_cutoff.unwrap_or(0.5))),
                Mode::Blend => AlphaMode::Blend,
            },
            double_sided: source.double_sided,
            unlit: source.extensions.unlit.is_some(),
        };
        if let Some(source) = &source.extensions.specular_glossiness {
            self.specular_glossiness(source, &mut material);
        }
        self.transmission(&source.extensions.transmission, &mut material);
        material
    }

    /// The diffuse colour is what shows under any light; the specular colour has no place in this model.
    fn specular_glossiness(&mut self, source: &schema::SpecularGlossiness, material: &mut Material) {
        material.base_color = source.diffuse_factor.map(unit);
        material.base_color_texture = self.texture(source.diffuse_texture.as_ref());
        material.metallic = 0.0;
        material.metallic_roughness_texture = None;
        material.roughness = 1.0 - unit(source.glossiness_factor);
        self.note("specular-glossiness is approximated: the specular colour is left out");
    }

    /// Light passes, so the surface must not cast: blending is the nearest that a renderer without refraction has.
    /// A texture limits transmission to parts of the surface, which blending cannot; such a surface stays as it is.
    fn transmission(&mut self, source: &schema::Transmission, material: &mut Material) {
        let factor = unit(source.transmission_factor);
        if source.transmission_texture.is_some() && factor > 0.0 {
            self.note("textured transmission is ignored: the surface is shown opaque");
        } else if factor > 0.5 && material.alpha == AlphaMode::Opaque {
            material.alpha = AlphaMode::Blend;
            material.base_color[3] = 1.0 - 0.75 * factor;
            self.note("transmission is approximated by blending; the surface casts no shadow");
        }
    }

    fn texture(&mut self, info: Option<&TextureInfo>) -> Option<TextureRef> {
        let info = info?;
        let texture = self.textures[info.index]?;
        let transform = info.extensions.transform.as_ref();
        let set = transform.and_then(|t| t.tex_coord).unwrap_or(info.tex_coord);
        let uv_set = if set <= 1 {
            set as u8
        } else {
            self.note(&format!("TEXCOORD_{set} cannot be read; TEXCOORD_0 is used"));
            0
        };
        let identity = TextureRef::new(texture);
        let uv_from_mesh = transform.map_or(identity.uv_from_mesh, uv_from_mesh);
        Some(TextureRef { uv_set, uv_from_mesh, ..identity })
    }

    fn note(&mut self, what: &str) {
        self.notices.push(format!("material \"{}\": {what}", self.name));
    }
}

/// Scale, then rotation from u towards -v (counter-clockwise in an image, whose v points down), then offset.
fn uv_from_mesh(t: &schema::TextureTransform) -> [[f32; 3]; 2] {
    let (sin, cos) = t.rotation.sin_cos();
    [
        [bounded(cos * t.scale[0]), bounded(sin * t.scale[1]), bounded(t.offset[0])],
        [bounded(-sin * t.scale[0]), bounded(cos * t.scale[1]), bounded(t.offset[1])],
    ]
}

fn unit(x: f64) -> f32 {
    x.clamp(0.0, 1.0) as f32
}

fn bounded(x: f64) -> f32 {
    x.clamp(-1e30, 1e30) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn convert(json: &str) -> (Material, Vec<String>) {
        let root: Root = serde_json::from_str(&format!(r#"{{"materials": [{json}]}}"#)).unwrap();
        let mut notices = Vec::new();
        let material = materials(&root, &[Some(0), None, Some(1)], &mut notices).remove(0);
        (material, notices)
    }

    #[test]
    fn factors_and_textures() {
        let (m, notices) = convert(
            r#"{"name": "m", "pbrMetallicRoughness": {"baseColorFactor": [2, 0.5, -1, 1], "roughnessFactor": 0.25,
                "baseColorTexture": {"index": 2, "texCoord": 1}, "metallicRoughnessTexture": {"index": 1}},
                "emissiveFactor": [1, 0, 0.5], "alphaMode": "MASK", "doubleSided": true,
                "normalTexture": {"index": 0, "scale": 0.5}, "occlusionTexture": {"index": 0, "strength": 0.75},
                "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}, "KHR_materials_unlit": {}}}"#,
        );
        assert_eq!(m.base_color, [1.0, 0.5, 0.0, 1.0]);
        assert_eq!((m.metallic, m.roughness), (1.0, 0.25));
        assert_eq!(m.base_color_texture, Some(TextureRef { uv_set: 1, ..TextureRef::new(1) }));
        assert_eq!(m.metallic_roughness_texture, None, "its image could not be read");
        assert_eq!((m.normal_scale, m.occlusion_strength), (0.5, 0.75));
        assert_eq!(m.emissive, [4.0, 0.0, 2.0]);
        assert_eq!(m.alpha, AlphaMode::Mask(0.5));
        assert!(m.double_sided && m.unlit && notices.is_empty());
    }

    #[test]
    fn approximations_are_noted() {
        let (glass, notices) = convert(r#"{"extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}}"#);
        assert_eq!((glass.alpha, glass.base_color[3], notices.len()), (AlphaMode::Blend, 0.25, 1));
        let (shiny, notices) = convert(
            r#"{"extensions": {"KHR_materials_pbrSpecularGlossiness":
                {"diffuseFactor": [0.5, 0.5, 0.5, 1], "glossinessFactor": 0.75}}}"#,
        );
        assert_eq!((shiny.metallic, shiny.roughness, notices.len()), (0.0, 0.25, 1));
    }

    #[test]
    fn texture_transforms() {
        let apply = |json: &str, u: f32, v: f32| {
            uv_from_mesh(&serde_json::from_str(json).unwrap())
                .map(|[a, b, c]| ((a * u + b * v + c) * 1e4).round() / 1e4)
        };
        assert_eq!(apply(r#"{"offset": [1, 2], "scale": [3, 4]}"#, 1.0, 1.0), [4.0, 6.0]);
        let quarter = r#"{"rotation": 1.5707963267948966, "scale": [2, 4]}"#;
        assert_eq!(apply(quarter, 1.0, 0.0), [0.0, -2.0]);
        assert_eq!(apply(quarter, 0.0, 1.0), [4.0, 0.0]);
    }

    #[test]
    fn samplers() {
        let sampler = |json: &str| sampled(0, &serde_json::from_str(json).unwrap());
        let default = sampler("{}");
        assert_eq!(
            (default.wrap_u, default.mag, default.min, default.mipmaps),
            (Wrap::Repeat, Filter::Linear, Filter::Linear, true)
        );
        let set = sampler(r#"{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728, "minFilter": 9729}"#);
        assert_eq!(
            (set.wrap_u, set.wrap_v, set.mag, set.min, set.mipmaps),
            (Wrap::Clamp, Wrap::Mirror, Filter::Nearest, Filter::Linear, false)
        );
        assert!(sampler(r#"{"minFilter": 9986}"#).mipmaps);
    }
}
