//! .mtl files: the materials of an .obj file as metallic-roughness ones.
//!
//! In: the names of material libraries, one by one as the parser meets them. Out: the scene's materials in the parser's
//! order, then a grey one, with the images that they use, and notices about what is missing. Base colours are taken as
//! linear.

use super::error::{Fault, Result};
use super::limits::Budget;
use super::plain::{grey, texture};
use super::schema::{AlphaMode, Material, TextureInfo};
use super::uri;
use rustc_hash::FxHashMap;
use std::cell::RefCell;
use std::path::Path;
use tobj::{LoadError, MTLLoadResult};

/// Looking for files takes time, which a file cannot be allowed to choose.
const MAX_LIBRARIES: usize = 64;
const MAX_TEXTURES: usize = 4096;

pub(super) struct Library<'a> {
    folder: &'a Path,
    budget: &'a Budget,
    state: RefCell<State>,
}

#[derive(Default)]
struct State {
    /// In the order of the parser, with the folder of the library that each comes from.
    materials: Vec<(String, tobj::Material)>,
    libraries: Vec<String>,
    notices: Vec<String>,
    fault: Option<Fault>,
}

impl<'a> Library<'a> {
    pub fn new(folder: &'a Path, budget: &'a Budget) -> Self {
        Self { folder, budget, state: RefCell::default() }
    }

    /// Reads library `name`. One that is missing or damaged leaves its surfaces grey, since the geometry is sound.
    pub fn load(&self, name: &str) -> MTLLoadResult {
        let mut state = self.state.borrow_mut();
        let name = name.replace('\\', "/");
        if state.libraries.contains(&name) || state.libraries.len() == MAX_LIBRARIES {
            return Err(LoadError::GenericFailure);
        }
        state.libraries.push(name.clone());
        let Some(uri) = uri::of_file(&name, self.folder) else {
            state.notices.push(format!("material library `{name}` is not below the file's folder: shown grey"));
            return Err(LoadError::OpenFileFailed);
        };
        let bytes = match uri::read(&uri, self.folder, self.budget, "mtllib") {
            Ok(bytes) => bytes,
            Err(fault) => {
                state.fault = Some(fault);
                return Err(LoadError::ReadError);
            }
        };
        // A material of one line becomes a structure of many fields.
        if let Err(fault) = self.budget.charge(bytes.len() as u64, 128, || format!("mtllib {name}")) {
            state.fault = Some(fault);
            return Err(LoadError::GenericFailure);
        }
        let text = String::from_utf8_lossy(&bytes);
        let parsed = tobj::load_mtl_buf(&mut text.as_bytes());
        match &parsed {
            Ok((materials, _)) => {
                let folder = name.rsplit_once('/').map_or(String::new(), |(folder, _)| format!("{folder}/"));
                state.materials.extend(materials.iter().map(|material| (folder.clone(), material.clone())));
            }
            Err(e) => state.notices.push(format!("material library `{name}` is damaged ({e}): shown grey")),
        }
        parsed
    }

    /// The fault of a library that stops the whole file.
    pub fn fault(&self) -> Result<()> {
        self.state.borrow_mut().fault.take().map_or(Ok(()), Err)
    }

    /// The materials that were read, and notices about those that were not.
    pub fn finish(self) -> (Materials, Vec<String>) {
        let State { materials, mut notices, .. } = self.state.into_inner();
        let mut converter =
            Converter { folder: self.folder, images: Vec::new(), known: FxHashMap::default(), notices: &mut notices };
        let mut converted: Vec<Material> =
            materials.iter().map(|(folder, material)| converter.convert(folder, material)).collect();
        let images = converter.images;
        converted.push(grey("without a material".into()));
        (Materials { materials: converted, images }, notices)
    }
}

/// The materials of an .obj file; the last one is for faces without.
pub(super) struct Materials {
    materials: Vec<Material>,
    images: Vec<String>,
}

impl Materials {
    pub fn default_material(&self) -> usize {
        self.materials.len() - 1
    }

    /// The materials, and the URIs of the images that they use; texture `i` shows image `i`.
    pub fn into_materials(self) -> (Vec<Material>, Vec<String>) {
        (self.materials, self.images)
    }
}

struct Converter<'a> {
    folder: &'a Path,
    images: Vec<String>,
    /// Which image each name has turned out to be, if any.
    known: FxHashMap<String, Option<usize>>,
    notices: &'a mut Vec<String>,
}

impl Converter<'_> {
    fn convert(&mut self, folder: &str, source: &tobj::Material) -> Material {
        let number = |key: &str| source.unknown_param.get(key)?.split_ascii_whitespace().next()?.parse::<f64>().ok();
        let mut material = grey(source.name.clone());
        let alpha = source.dissolve.map(f64::from).or(number("Tr").map(|tr| 1.0 - tr)).unwrap_or(1.0);
        let mut map = |option: Option<&String>| self.texture(folder, option?, &source.name);
        let pbr = &mut material.pbr_metallic_roughness;
        pbr.base_color_texture = map(source.diffuse_texture.as_ref());
        let textured = pbr.base_color_texture.is_some();
        let [r, g, b] = match source.diffuse {
            // Some exporters write black beside a texture, which would hide it.
            Some([0.0, 0.0, 0.0]) | None if textured => [1.0; 3],
            Some(color) => color,
            None => [0.8; 3],
        };
        pbr.base_color_factor = [r.into(), g.into(), b.into(), alpha];
        pbr.metallic_factor = number("Pm").unwrap_or(0.0);
        let from_shininess = |ns: f64| (2.0 / (ns.max(0.0) + 2.0)).powf(0.25);
        let shininess = source.shininess.map(|ns| from_shininess(ns.into()));
        pbr.roughness_factor = number("Pr").or(shininess).unwrap_or(0.8);
        material.normal_texture = map(source.unknown_param.get("norm"));
        material.emissive_factor = source.emissive.unwrap_or_default().map(f64::from);
        material.emissive_texture = map(source.unknown_param.get("map_Ke"));
        material.alpha_mode = match &source.dissolve_texture {
            _ if alpha < 1.0 => AlphaMode::Blend,
            Some(mask) if source.diffuse_texture.as_ref() == Some(mask) => AlphaMode::Mask,
            Some(_) => {
                let name = &source.name;
                self.notices.push(format!("material \"{name}\": an alpha map of its own is left out: shown opaque"));
                AlphaMode::Opaque
            }
            None => AlphaMode::Opaque,
        };
        material
    }

    /// The texture that `value` names after its options, relative to the library or else to the .obj file.
    fn texture(&mut self, folder: &str, value: &str, material: &str) -> Option<TextureInfo> {
        let name = if value.starts_with('-') { value.split_ascii_whitespace().next_back()? } else { value };
        let name = name.replace('\\', "/");
        let beside_library = format!("{folder}{name}");
        if let Some(known) = self.known.get(&beside_library) {
            return known.map(texture);
        }
        if self.known.len() == MAX_TEXTURES {
            return None;
        }
        let found = uri::of_file(&beside_library, self.folder).or_else(|| uri::of_file(&name, self.folder));
        if found.is_none() {
            let problem = format!("texture `{name}` is not below the file's folder: shown without it");
            self.notices.push(format!("material \"{material}\": {problem}"));
        }
        let index = found.map(|uri| {
            self.images.push(uri);
            self.images.len() - 1
        });
        self.known.insert(beside_library, index);
        index.map(texture)
    }
}
