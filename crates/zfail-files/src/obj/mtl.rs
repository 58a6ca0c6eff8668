//! .mtl files: what they say of materials.
//!
//! In: the text of a file. Out: its materials with what can be used of them. A line that cannot be read costs that line.

use super::map::Map;
use crate::plain::text::{Lines, number, shown, split_word, trim, uncommented, words};
use crate::shared::error::Result;
use crate::shared::limits::Budget;
use std::collections::BTreeSet;

/// A material as a library tells of it.
#[derive(Default)]
pub(super) struct Source {
    pub name: Vec<u8>,
    pub diffuse: Option<[f64; 3]>,
    pub emissive: Option<[f64; 3]>,
    pub shininess: Option<f64>,
    /// Opacity.
    pub dissolve: Option<f64>,
    pub transparency: Option<f64>,
    pub roughness: Option<f64>,
    pub metallic: Option<f64>,
    pub diffuse_map: Option<Map>,
    pub dissolve_map: Option<Map>,
    pub emissive_map: Option<Map>,
    pub normal_map: Option<Map>,
}

/// What a file holds.
#[derive(Default)]
pub(super) struct Contents {
    pub materials: Vec<Source>,
    /// How many lines cannot be read, and the first with its number.
    pub odd: Option<(usize, String)>,
    /// Keywords of maps that nothing here has a use for.
    pub unused_maps: BTreeSet<String>,
}

/// A material of one line becomes structures of many fields.
const MATERIAL_COST: u64 = 4096;

/// Reads the text of a library.
pub(super) fn read(text: &[u8], budget: &Budget) -> Result<Contents> {
    let mut contents = Contents::default();
    let mut lines = Lines::new(text);
    while let Some(line) = lines.next() {
        let (keyword, rest) = split_word(line);
        let keyword = String::from_utf8_lossy(keyword).to_ascii_lowercase();
        if keyword == "newmtl" {
            budget.charge(1, MATERIAL_COST, || format!("line {} of a material library", lines.number))?;
            contents.materials.push(Source { name: trim(rest).to_vec(), ..Source::default() });
            continue;
        }
        let Some(material) = contents.materials.last_mut() else { continue };
        if !material.set(&keyword, rest, &mut contents.unused_maps) {
            let first = || (0, format!("line {}, `{}`", lines.number, shown(trim(line))));
            contents.odd.get_or_insert_with(first).0 += 1;
        }
    }
    Ok(contents)
}

impl Source {
    /// Takes the value after `keyword`. Returns whether it could be read, or need not be.
    fn set(&mut self, keyword: &str, rest: &[u8], unused_maps: &mut BTreeSet<String>) -> bool {
        match keyword {
            "kd" => set(&mut self.diffuse, color(rest)),
            "ke" => set(&mut self.emissive, color(rest)),
            "ns" => set(&mut self.shininess, scalar(rest)),
            "d" => set(&mut self.dissolve, scalar(rest)),
            "tr" => set(&mut self.transparency, scalar(rest)),
            "pr" => set(&mut self.roughness, scalar(rest)),
            "pm" => set(&mut self.metallic, scalar(rest)),
            "map_kd" => set(&mut self.diffuse_map, Map::parse(rest)),
            "map_d" | "map_opacity" => set(&mut self.dissolve_map, Map::parse(rest)),
            "map_ke" => set(&mut self.emissive_map, Map::parse(rest)),
            "norm" | "map_kn" => set(&mut self.normal_map, Map::parse(rest)),
            // Which maps of this kind are heights and which are normals, nobody can tell.
            "bump" | "map_bump" | "disp" | "decal" | "map_ks" | "map_ns" | "map_pr" | "map_pm" | "map_rma"
            | "map_orm" => {
                if Map::parse(rest).is_some() {
                    unused_maps.insert(keyword.to_owned());
                }
                true
            }
            _ => true,
        }
    }
}

/// Returns whether there is a value. An odd one leaves the slot as it was.
fn set<T>(slot: &mut Option<T>, value: Option<T>) -> bool {
    let there = value.is_some();
    *slot = value.or(slot.take());
    there
}

/// The number in `rest`, perhaps behind an option such as `-halo`.
fn scalar(rest: &[u8]) -> Option<f64> {
    let mut words = words(uncommented(rest));
    let word = words.find(|word| !word.starts_with(b"-halo"))?;
    number(word).filter(|x| x.is_finite())
}

/// Three numbers, or one for all three.
fn color(rest: &[u8]) -> Option<[f64; 3]> {
    let mut words = words(uncommented(rest));
    let mut value = || words.next().map(|word| number(word).filter(|x| x.is_finite()));
    let first = value()??;
    match (value(), value()) {
        (None, _) => Some([first; 3]),
        (Some(second), Some(third)) => Some([first, second?, third?]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Limits;

    fn parse(text: &str) -> Contents {
        read(text.as_bytes(), &Budget::new(Limits::default())).unwrap()
    }

    #[test]
    fn statements() {
        let text = "Kd 9 9 9\nnewmtl a b\r\n\tKd +.5 2. 1e0 # c\n KD_x 1\nd -halo 0.5\nTr .25\rNs 30\nmap_KD -s 2 2 a b.png\n\
                    newmtl c\nKd 0.5\nKe 1 2 3\nillum 2\nmap_Bump b.png\nnorm n.png";
        let contents = parse(text);
        let [a, c] = &contents.materials[..] else { panic!() };
        assert_eq!((a.name.as_slice(), a.diffuse), (b"a b".as_slice(), Some([0.5, 2.0, 1.0])));
        assert_eq!((a.dissolve, a.transparency, a.shininess), (Some(0.5), Some(0.25), Some(30.0)));
        assert_eq!(a.diffuse_map.as_ref().unwrap().file, b"a b.png");
        assert_eq!((c.diffuse, c.emissive), (Some([0.5; 3]), Some([1.0, 2.0, 3.0])));
        assert!(c.normal_map.is_some() && contents.odd.is_none());
        assert_eq!(contents.unused_maps.into_iter().collect::<Vec<_>>(), ["map_bump"]);
    }

    #[test]
    fn odd_lines_cost_themselves() {
        let contents = parse("newmtl a\nKd 1 0 0\nNs high\nKd 1 0\nd nan\nKd spectral a.rfl\nPr 0.5\n");
        let a = &contents.materials[0];
        assert_eq!((a.diffuse, a.shininess, a.dissolve, a.roughness), (Some([1.0, 0.0, 0.0]), None, None, Some(0.5)));
        assert_eq!(contents.odd, Some((4, "line 3, `Ns high`".into())));
    }
}
