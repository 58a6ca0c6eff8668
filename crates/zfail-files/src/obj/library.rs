//! Material libraries: names to metallic-roughness materials and their textures.
//!
//! In: what an .obj file says after `mtllib` and `usemtl`. Out: the materials that it uses, then a grey one for what has none.
//! Names are compared as bytes. Base colours are taken as linear.

use super::map::Map;
use super::mtl::{self, Source};
use crate::gltf::schema::{AlphaMode, Material, TextureInfo};
use crate::plain::folder::Folder;
use crate::plain::losses::counted;
use crate::plain::text::{decode, shown, trim};
use crate::plain::{Picture, Texture, grey, texture};
use crate::shared::error::Result;
use crate::shared::limits::Budget;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Looking for files takes time, which a file cannot be allowed to choose.
const MAX_LIBRARIES: usize = 64;
const MAX_TEXTURES: usize = 4096;

pub(super) struct Library<'a> {
    folder: Folder<'a>,
    budget: &'a Budget,
    /// Names of files that were looked for.
    asked: BTreeSet<Vec<u8>>,
    loaded: BTreeSet<PathBuf>,
    /// With the folder of the library that each comes from.
    sources: Vec<(PathBuf, Source)>,
    /// The first source of each name.
    whole: BTreeMap<Vec<u8>, usize>,
    /// The same for names without the comment that may follow them.
    cut: BTreeMap<Vec<u8>, usize>,
    /// The sources that are used.
    used: Vec<usize>,
    notices: Vec<String>,
}

/// What an .obj file's faces are made of.
#[derive(Default)]
pub(super) struct Materials {
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
    pub pictures: Vec<Picture>,
    pub notices: Vec<String>,
}

impl<'a> Library<'a> {
    pub fn new(folder: &'a Path, budget: &'a Budget) -> Self {
        let (asked, loaded, sources, whole, cut, used, notices) = Default::default();
        Self { folder: Folder::new(folder, budget), budget, asked, loaded, sources, whole, cut, used, notices }
    }

    /// Reads the libraries that `names`, which follow one `mtllib`, mean: one whose name has spaces in it, or several. One that
    /// is missing leaves its surfaces grey, since the geometry is sound.
    pub fn load(&mut self, names: &[u8]) -> Result<()> {
        if self.asked.len() == MAX_LIBRARIES {
            return Ok(());
        }
        let here = Path::new("");
        let one = [names, without_comment(names)].into_iter().find(|name| self.folder.find(name, here).is_ok());
        for name in one.map_or_else(|| several(without_comment(names)), |name| vec![name]) {
            if self.asked.len() == MAX_LIBRARIES {
                break;
            }
            if !self.asked.insert(name.to_vec()) {
                continue;
            }
            let read = match self.folder.find(name, here) {
                Ok(path) if self.loaded.contains(&path) => continue,
                Ok(path) => self.folder.read(&path)?.map(|bytes| (path, bytes)),
                Err(problem) => Err(problem.into()),
            };
            match read {
                Ok((path, bytes)) => self.add(name, path, &bytes)?,
                Err(problem) => {
                    self.note(format!("material library `{}` {problem}: its materials are shown grey", shown(name)));
                }
            }
        }
        Ok(())
    }

    fn add(&mut self, name: &[u8], path: PathBuf, bytes: &[u8]) -> Result<()> {
        let text = decode(bytes, self.budget)?;
        let contents = mtl::read(&text, self.budget)?;
        if let Some((count, first)) = contents.odd {
            let verb = if count == 1 { "is" } else { "are" };
            let lines = counted(count, "line");
            self.note(format!(
                "material library `{}`: {lines} that cannot be read {verb} ignored ({first})",
                shown(name)
            ));
        }
        if !contents.unused_maps.is_empty() {
            let maps: Vec<String> = contents.unused_maps.into_iter().collect();
            self.note(format!("material library `{}`: maps left out: {}", shown(name), maps.join(", ")));
        }
        let folder = path.parent().unwrap_or(Path::new("")).to_path_buf();
        for source in contents.materials {
            let index = self.sources.len();
            self.whole.entry(source.name.clone()).or_insert(index);
            self.cut.entry(without_comment(&source.name).to_vec()).or_insert(index);
            self.sources.push((folder.clone(), source));
        }
        self.loaded.insert(path);
        Ok(())
    }

    /// Index among [`Materials::materials`] of each of `names`, of which the first stands for no name at all.
    pub fn materials_of(&mut self, names: &[&[u8]]) -> Vec<usize> {
        let mut index_of = vec![None; self.sources.len()];
        let (mut unknown, mut example) = (0, None);
        let mut found = Vec::with_capacity(names.len());
        for (i, name) in names.iter().enumerate() {
            let bare = without_comment(name);
            let source = self.whole.get(*name).or_else(|| self.whole.get(bare)).or_else(|| self.cut.get(bare)).copied();
            if source.is_none() && i > 0 {
                unknown += 1;
                example.get_or_insert(*name);
            }
            found.push(source.filter(|_| i > 0).map(|source| {
                *index_of[source].get_or_insert_with(|| {
                    self.used.push(source);
                    self.used.len() - 1
                })
            }));
        }
        if let Some(example) = example {
            let verb = if unknown == 1 { "is" } else { "are" };
            let materials = counted(unknown, "material");
            self.note(format!("{materials} that no library has {verb} shown grey (`{}`)", shown(example)));
        }
        let default = self.used.len();
        found.into_iter().map(|index| index.unwrap_or(default)).collect()
    }

    /// The materials that are used, and the grey one.
    pub fn finish(self) -> Result<Materials> {
        let materials = Materials { notices: self.notices, ..Materials::default() };
        let (known, of_path, of_texture) = Default::default();
        let mut converter = Converter { folder: &self.folder, materials, known, of_path, of_texture };
        for source in self.used {
            let (folder, source) = &self.sources[source];
            let material = converter.convert(folder, source)?;
            converter.materials.materials.push(material);
        }
        converter.materials.materials.push(grey("without a material".into()));
        Ok(converter.materials)
    }

    fn note(&mut self, notice: String) {
        self.notices.push(notice);
    }
}

/// `name` before a `#` that follows a space. Some programs write comments behind names, and others `Material #25`.
fn without_comment(name: &[u8]) -> &[u8] {
    let comment = name.windows(2).position(|pair| pair[0] <= b' ' && pair[1] == b'#');
    comment.map_or(name, |at| trim(&name[..at]))
}

/// The names in `names`, each of which ends in `.mtl` and may hold spaces.
fn several(names: &[u8]) -> Vec<&[u8]> {
    const ENDING: &[u8] = b".mtl";
    let mut list = Vec::new();
    let mut start = 0;
    for end in 0..=names.len() {
        let last = end == names.len();
        let ends = !last && names[end] <= b' ' && names[start..end].len() >= ENDING.len();
        if last || ends && names[end - ENDING.len()..end].eq_ignore_ascii_case(ENDING) {
            list.push(trim(&names[start..end]));
            start = end;
        }
    }
    list.retain(|name| !name.is_empty());
    list
}

struct Converter<'a> {
    folder: &'a Folder<'a>,
    materials: Materials,
    /// Which picture each name in each folder has turned out to be, if any.
    known: BTreeMap<(PathBuf, Vec<u8>), Option<usize>>,
    of_path: BTreeMap<PathBuf, usize>,
    of_texture: BTreeMap<Texture, usize>,
}

impl Converter<'_> {
    fn convert(&mut self, folder: &Path, source: &Source) -> Result<Material> {
        let name = shown(&source.name).into_owned();
        let mut material = grey(name.clone());
        let note =
            |materials: &mut Materials, what: &str| materials.notices.push(format!("material \"{name}\": {what}"));
        let alpha = source.dissolve.or(source.transparency.map(|tr| 1.0 - tr)).unwrap_or(1.0);
        // MeshLab, OpenMVS and others mean the opposite, and nobody saves what cannot be seen.
        let alpha = if alpha > 0.0 {
            alpha.min(1.0)
        } else {
            let statement = if source.dissolve.is_some() { "d 0" } else { "Tr 1" };
            note(&mut self.materials, &format!("`{statement}` would make it invisible: shown opaque"));
            1.0
        };
        let pbr = &mut material.pbr_metallic_roughness;
        let diffuse_map = source.diffuse_map.as_ref();
        pbr.base_color_texture = self.texture(folder, diffuse_map, &name)?;
        let [base, gain] = diffuse_map.map_or([0.0, 1.0], |map| map.base_and_gain);
        if base != 0.0 {
            note(&mut self.materials, "what `-mm` adds to its texture is left out");
        }
        let [r, g, b] = match source.diffuse {
            // Some exporters write black beside a texture, which would hide it.
            Some([0.0, 0.0, 0.0]) | None if pbr.base_color_texture.is_some() => [1.0; 3],
            Some([0.0, 0.0, 0.0]) | None if diffuse_map.is_some() => [0.8; 3],
            color => color.unwrap_or([0.8; 3]),
        };
        let gain = if pbr.base_color_texture.is_some() { gain } else { 1.0 };
        pbr.base_color_factor = [r * gain, g * gain, b * gain, alpha];
        pbr.metallic_factor = source.metallic.unwrap_or(0.0);
        let from_shininess = |ns: f64| (2.0 / (ns.max(0.0) + 2.0)).powf(0.25);
        pbr.roughness_factor = source.roughness.or(source.shininess.map(from_shininess)).unwrap_or(0.8);
        material.normal_texture = self.texture(folder, source.normal_map.as_ref(), &name)?;
        if let (Some(texture), Some(map)) = (&mut material.normal_texture, &source.normal_map) {
            texture.scale = map.bump;
        }
        material.emissive_factor = source.emissive.unwrap_or_default();
        material.emissive_texture = self.texture(folder, source.emissive_map.as_ref(), &name)?;
        material.alpha_mode = match &source.dissolve_map {
            _ if alpha < 1.0 => AlphaMode::Blend,
            Some(mask) if diffuse_map.is_some_and(|map| map.file == mask.file) => AlphaMode::Mask,
            Some(_) => {
                note(&mut self.materials, "an alpha map of its own is left out: shown opaque");
                AlphaMode::Opaque
            }
            None => AlphaMode::Opaque,
        };
        Ok(material)
    }

    /// The texture that `map` names, relative to the library or else to the .obj file.
    fn texture(&mut self, folder: &Path, map: Option<&Map>, material: &str) -> Result<Option<TextureInfo>> {
        let Some(map) = map else { return Ok(None) };
        let key = (folder.to_path_buf(), map.file.clone());
        let picture = match self.known.get(&key) {
            Some(known) => *known,
            None if self.known.len() >= MAX_TEXTURES => None,
            None => {
                let picture = self.picture(folder, &map.file, material)?;
                self.known.insert(key, picture);
                picture
            }
        };
        Ok(picture.map(|picture| {
            let wanted = Texture { picture, clamped: map.clamped };
            let textures = &mut self.materials.textures;
            let index = *self.of_texture.entry(wanted).or_insert_with(|| {
                textures.push(wanted);
                textures.len() - 1
            });
            let mut info = texture(index);
            info.extensions.transform = map.transform();
            info
        }))
    }

    fn picture(&mut self, folder: &Path, name: &[u8], material: &str) -> Result<Option<usize>> {
        let found = self.folder.find(name, folder).or_else(|problem| {
            let bare = without_comment(name);
            if bare.len() < name.len() { self.folder.find(bare, folder) } else { Err(problem) }
        });
        let read = match found {
            Ok(path) => match self.of_path.get(&path) {
                Some(index) => return Ok(Some(*index)),
                None => self.folder.read(&path)?.map(|bytes| (path, bytes)),
            },
            Err(problem) => Err(problem.into()),
        };
        Ok(match read {
            Ok((path, bytes)) => {
                let pictures = &mut self.materials.pictures;
                self.of_path.insert(path, pictures.len());
                pictures.push(Picture { name: shown(name).into_owned(), bytes });
                Some(pictures.len() - 1)
            }
            Err(problem) => {
                let texture = shown(name);
                let notice = format!("material \"{material}\": texture `{texture}` {problem}: shown without it");
                self.materials.notices.push(notice);
                None
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_name_or_several() {
        let split =
            |names: &str| several(names.as_bytes()).into_iter().map(|n| shown(n).into_owned()).collect::<Vec<_>>();
        assert_eq!(split("a.mtl  b c.MTL d.mtl"), ["a.mtl", "b c.MTL", "d.mtl"]);
        assert_eq!(split("a b"), ["a b"]);
        assert_eq!(split("a.mtl b"), ["a.mtl", "b"]);
        assert!(split("").is_empty());
    }

    #[test]
    fn comments_behind_names() {
        assert_eq!(without_comment(b"red # bright"), b"red");
        assert_eq!(without_comment(b"red#2"), b"red#2");
        assert_eq!(without_comment(b"# red"), b"# red");
    }
}
