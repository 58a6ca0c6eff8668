//! Materials and textures, and what becomes of the extensions that refine them ([`super::extension_treatment`]).

use super::images;
use super::schema::{self, AlphaMode as Mode, Root, TextureInfo};
use zfail_scene::{
    AlphaMode, Clearcoat, Filter, Material, Scene, Sheen, Specular, SpecularGlossiness, Texture, TextureRef,
    Transmission, Wrap,
};

/// The document's textures as the scene holds them. `images` are the scene's, by the document's index, without those
/// that could not be decoded. Returns the scene's textures, and the index of each of the document's among them.
pub(super) fn textures(root: &Root, images: &[Option<usize>]) -> (Vec<Texture>, Vec<Option<usize>>) {
    let mut textures = Vec::new();
    let index = root.textures.iter().map(|texture| {
        let image = texture.images().find_map(|image| images[image])?;
        let sampler = texture.sampler.map(|s| &root.samplers[s]);
        textures.push(sampled(image, sampler.unwrap_or(&schema::Sampler::default())));
        Some(textures.len() - 1)
    });
    let index = index.collect();
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

/// The document's materials; `textures` are those of `scene` by the document's index. Notices go to `scene`.
pub(super) fn materials(root: &Root, textures: &[Option<usize>], scene: &mut Scene) -> Vec<Material> {
    let mut notices = std::mem::take(&mut scene.notices);
    let materials = root
        .materials
        .iter()
        .enumerate()
        .map(|(i, source)| {
            let name = source.name.clone().unwrap_or_else(|| format!("material {i}"));
            Converter { name: &name, root, scene, textures, notices: &mut notices }.convert(source)
        })
        .collect();
    scene.notices = notices;
    materials
}

struct Converter<'a> {
    name: &'a str,
    root: &'a Root,
    scene: &'a Scene,
    textures: &'a [Option<usize>],
    notices: &'a mut Vec<String>,
}

impl Converter<'_> {
    fn convert(&mut self, source: &schema::Material) -> Material {
        let pbr = &source.pbr_metallic_roughness;
        let strength = source.extensions.emissive_strength.emissive_strength;
        let glossy = source.extensions.specular_glossiness.as_deref();
        let base = glossy.map_or(&pbr.base_color_texture, |glossy| &glossy.diffuse_texture);
        let base_color_texture = self.texture(base.as_ref());
        let metallic_roughness_texture = self.texture(pbr.metallic_roughness_texture.as_ref());
        let emissive_texture = self.texture(source.emissive_texture.as_ref());
        // These textures mostly take away: of a metal most of it, of a glow all but a spot. Without them, the factors alone
        // would turn a surface into black metal, or make all of it glow.
        let metallic = if self.has_lost(&pbr.metallic_roughness_texture) { 0.0 } else { pbr.metallic_factor };
        let strength = if self.has_lost(&source.emissive_texture) { 0.0 } else { strength };
        let mut material = Material {
            name: self.name.into(),
            base_color: pbr.base_color_factor.map(unit),
            base_color_texture,
            metallic: unit(metallic),
            roughness: unit(pbr.roughness_factor),
            metallic_roughness_texture,
            normal_texture: self.texture(source.normal_texture.as_ref()),
            normal_scale: source.normal_texture.as_ref().map_or(1.0, |t| bounded(t.scale)),
            occlusion_texture: self.texture(source.occlusion_texture.as_ref()),
            occlusion_strength: source.occlusion_texture.as_ref().map_or(1.0, |t| unit(t.strength)),
            emissive: source.emissive_factor.map(|e| bounded(e * strength).max(0.0)),
            emissive_texture,
            alpha: match source.alpha_mode {
                Mode::Mask if self.has_lost(base) => {
                    self.note("its mask is gone with the texture: shown opaque");
                    AlphaMode::Opaque
                }
                Mode::Opaque => AlphaMode::Opaque,
                Mode::Mask => AlphaMode::Mask(bounded(source.alpha_cutoff.unwrap_or(0.5))),
                Mode::Blend => AlphaMode::Blend,
            },
            double_sided: source.double_sided,
            unlit: source.extensions.unlit.is_some(),
            specular_glossiness: None,
            specular: self.specular(&source.extensions),
            clearcoat: source.extensions.clearcoat.as_deref().and_then(|c| self.clearcoat(c)),
            sheen: source.extensions.sheen.as_deref().and_then(|s| self.sheen(s)),
            transmission: self.transmission(&source.extensions),
        };
        if let Some(glossy) = glossy {
            material.base_color = glossy.diffuse_factor.map(unit);
            material.metallic_roughness_texture = None;
            material.specular_glossiness = Some(SpecularGlossiness {
                color: glossy.specular_factor.map(unit),
                glossiness: unit(glossy.glossiness_factor),
                texture: self.texture(glossy.specular_glossiness_texture.as_ref()),
            });
        }
        material
    }

    fn specular(&mut self, extensions: &schema::MaterialExtensions) -> Specular {
        let ior = extensions.ior.ior;
        // The specification: 0, or 1 and more.
        let ior = if ior == 0.0 { 0.0 } else { bounded(ior).max(1.0) };
        let Some(source) = &extensions.specular else { return Specular { ior, ..Specular::default() } };
        if source.specular_texture.is_some() {
            self.note("the texture of the specular strength is left out");
        }
        Specular {
            ior,
            strength: unit(source.specular_factor),
            color: source.specular_color_factor.map(|c| bounded(c).max(0.0)),
            color_texture: self.texture(source.specular_color_texture.as_ref()),
        }
    }

    fn clearcoat(&mut self, source: &schema::Clearcoat) -> Option<Clearcoat> {
        let strength = unit(source.clearcoat_factor);
        if strength == 0.0 {
            return None;
        }
        if source.clearcoat_roughness_texture.is_some() || source.clearcoat_normal_texture.is_some() {
            self.note("textures of the clearcoat's roughness and normals are left out");
        }
        let texture = self.texture(source.clearcoat_texture.as_ref());
        Some(Clearcoat { strength, texture, roughness: unit(source.clearcoat_roughness_factor) })
    }

    fn sheen(&mut self, source: &schema::Sheen) -> Option<Sheen> {
        let color = source.sheen_color_factor.map(unit);
        if color == [0.0; 3] {
            return None;
        }
        if source.sheen_roughness_texture.is_some() {
            self.note("the texture of the sheen's roughness is left out");
        }
        let texture = self.texture(source.sheen_color_texture.as_ref());
        Some(Sheen { color, texture, roughness: unit(source.sheen_roughness_factor) })
    }

    /// What lets most of the light through does not cast. A texture may confine that to a part of the surface: it is taken
    /// for transmissive if it is on average, and for opaque otherwise, since whole triangles cast or do not.
    fn transmission(&mut self, extensions: &schema::MaterialExtensions) -> Option<Transmission> {
        let source = extensions.transmission.as_deref()?;
        let share = unit(source.transmission_factor);
        if share > 0.0 && self.has_lost(&source.transmission_texture) {
            self.note("where it lets light through is lost with the texture: shown opaque");
            return None;
        }
        let texture = self.texture(source.transmission_texture.as_ref());
        let mean = share * texture.map_or(1.0, |texture| self.mean_red(texture));
        if mean < 0.5 {
            if share > 0.0 {
                self.note("little light passes on average; the surface is shown opaque");
            }
            return None;
        }
        Some(Transmission { share, texture, tint: tint(&extensions.volume) })
    }

    fn mean_red(&self, texture: TextureRef) -> f32 {
        let rgba = &self.scene.images[self.scene.textures[texture.texture].image].rgba;
        let sum: u64 = rgba.chunks_exact(4).map(|texel| u64::from(texel[0])).sum();
        sum as f32 / (255 * (rgba.len() / 4).max(1)) as f32
    }

    fn texture(&mut self, info: Option<&TextureInfo>) -> Option<TextureRef> {
        let info = info?;
        let Some(texture) = self.textures.get(info.index).copied().flatten() else {
            self.note_lost(info.index);
            return None;
        };
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

    /// Whether there should be a texture whose image cannot be read.
    fn has_lost(&self, info: &Option<TextureInfo>) -> bool {
        info.as_ref().is_some_and(|info| self.textures.get(info.index).copied().flatten().is_none())
    }

    fn note_lost(&mut self, texture: usize) {
        let images = self.root.textures.get(texture).and_then(|texture| texture.images().last());
        let name = images.map_or_else(|| format!("texture {texture}"), |i| images::name(&self.root.images[i], i));
        self.note(&format!("shown by plain factors instead of \"{name}\", which cannot be read"));
    }

    fn note(&mut self, what: &str) {
        self.notices.push(format!("material \"{}\": {what}", self.name));
    }
}

/// What a body of the given thickness leaves of the light (KHR_materials_volume, Beer's law).
fn tint(volume: &schema::Volume) -> [f32; 3] {
    let (Some(color), Some(distance)) = (volume.attenuation_color, volume.attenuation_distance) else {
        return [1.0; 3];
    };
    let depth = (volume.thickness_factor.max(0.0) / distance.max(1e-30)).min(1e30);
    color.map(|c| unit(c.clamp(0.0, 1.0).powf(depth)))
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
    // No negative zero.
    x.clamp(-1e30, 1e30) as f32 + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use zfail_scene::Image;

    fn convert(json: &str) -> (Material, Vec<String>) {
        let root: Root = serde_json::from_str(&format!(r#"{{"materials": [{json}]}}"#)).unwrap();
        let image = Image { name: String::new(), width: 2, height: 1, rgba: vec![51; 8] };
        let texture = sampled(0, &schema::Sampler::default());
        let mut scene = Scene { images: vec![image], textures: vec![texture; 2], ..Scene::default() };
        let material = materials(&root, &[Some(0), None, Some(1)], &mut scene).remove(0);
        (material, scene.notices)
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
        assert_eq!((m.metallic, m.roughness), (0.0, 0.25), "what would say where there is metal cannot be read");
        assert_eq!(m.base_color_texture, Some(TextureRef { uv_set: 1, ..TextureRef::new(1) }));
        assert_eq!(m.metallic_roughness_texture, None, "its image could not be read");
        assert_eq!((m.normal_scale, m.occlusion_strength), (0.5, 0.75));
        assert_eq!(m.emissive, [4.0, 0.0, 2.0]);
        assert_eq!(m.alpha, AlphaMode::Mask(0.5));
        assert!(m.double_sided && m.unlit);
        let lost = "material \"m\": shown by plain factors instead of \"texture 1\", which cannot be read";
        assert_eq!(notices, [lost]);
    }

    #[test]
    fn transmissive_surfaces_are_blended_if_most_light_passes() {
        let glass = |properties: &str| {
            convert(&format!(
                r#"{{"extensions": {{"KHR_materials_transmission": {{{properties}}}, "KHR_materials_volume":
                    {{"thicknessFactor": 2, "attenuationDistance": 1, "attenuationColor": [1, 0.5, 0]}}}}}}"#
            ))
        };
        let (clear, notices) = glass(r#""transmissionFactor": 1"#);
        assert!(clear.is_blended() && clear.alpha == AlphaMode::Opaque && notices.is_empty());
        assert_eq!(clear.transmission.map(|t| (t.share, t.tint)), Some((1.0, [1.0, 0.25, 0.0])));
        // The texture's red is 51 of 255 on average.
        for properties in
            [r#""transmissionFactor": 0.4"#, r#""transmissionFactor": 1, "transmissionTexture": {"index": 0}"#]
        {
            let (dull, notices) = glass(properties);
            assert!(!dull.is_blended() && notices.len() == 1, "{properties}: {notices:?}");
        }
        assert!(!glass("").0.is_blended());
    }

    #[test]
    fn layers_and_reflections() {
        let (m, notices) = convert(
            r#"{"extensions": {
                "KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.5, 0.5, 0.5, 1], "glossinessFactor": 0.75,
                    "specularFactor": [1, 0.5, 0], "specularGlossinessTexture": {"index": 2}},
                "KHR_materials_ior": {"ior": 3}, "KHR_materials_specular": {"specularColorFactor": [0.5, 1, 9]},
                "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessTexture": {"index": 0}},
                "KHR_materials_sheen": {"sheenColorFactor": [0, 0, 1], "sheenRoughnessFactor": 0.5}}}"#,
        );
        let expected =
            SpecularGlossiness { color: [1.0, 0.5, 0.0], glossiness: 0.75, texture: Some(TextureRef::new(1)) };
        assert_eq!((m.base_color, m.specular_glossiness), ([0.5, 0.5, 0.5, 1.0], Some(expected)));
        assert_eq!(m.specular.normal_reflectance(), [0.125, 0.25, 1.0]);
        assert_eq!(m.clearcoat, Some(Clearcoat { strength: 1.0, texture: None, roughness: 0.0 }));
        assert_eq!(m.sheen, Some(Sheen { color: [0.0, 0.0, 1.0], texture: None, roughness: 0.5 }));
        assert_eq!(notices.len(), 1, "{notices:?}");
        let (plain, _) = convert(r#"{"extensions": {"KHR_materials_clearcoat": {}, "KHR_materials_sheen": {}}}"#);
        assert_eq!((plain.clearcoat, plain.sheen, plain.specular), (None, None, Specular::default()));
        assert!((Specular::default().normal_reflectance()[0] - 0.04).abs() < 1e-7);
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
