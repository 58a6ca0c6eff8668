//! What is made of a scene's file.

use crate::names;
use clap::Args;
use std::ops::RangeInclusive;
use zfail_files::Limits;

/// What is made of a scene's file, and what that may cost.
#[derive(Args, Clone, Debug)]
pub struct Loading {
    /// Refuse scenes beyond this; repeat it for several. memory=SIZE is what all data of a scene may take while it is
    /// loaded, such as 512MiB or 16GiB (8GiB unless given), image-side=PIXELS the width and height of an image (16384).
    #[arg(help_heading = "Loading", long = "limit", value_name = "NAME=VALUE", value_parser = Limit::parse)]
    limits: Vec<Limit>,
    /// Shadows of masked surfaces (foliage, fences): off (none), solid (of their whole triangles), or cut=PIXELS (of the
    /// mask's shape: triangles are cut along the contour of alpha on load, at most PIXELS of the texture's pixels off).
    #[arg(help_heading = "Loading", long, value_name = "off|solid|cut=PIXELS", default_value = "cut=1", value_parser = AlphaShadows::parse)]
    pub alpha_shadows: AlphaShadows,
    /// Let blended and transmissive surfaces cast shadows as if they were solid.
    #[arg(help_heading = "Loading", long)]
    pub blended_shadows: bool,
    /// Show the file with the materials of this variant, by name or index, instead of its default ones.
    #[arg(help_heading = "Loading", long, value_name = "NAME|N")]
    pub variant: Option<String>,
}

impl Loading {
    /// The limits; of two of a kind the later one holds.
    pub fn limits(&self) -> Limits {
        let mut limits = Limits::default();
        for limit in &self.limits {
            match *limit {
                Limit::Memory(bytes) => limits.bytes = bytes,
                Limit::ImageSide(pixels) => limits.image_side = pixels,
            }
        }
        limits
    }

    /// The flags that another command needs to load a scene in the same way.
    #[cfg(feature = "view")]
    pub fn flags(&self) -> Vec<String> {
        let mut flags = Vec::new();
        for limit in &self.limits {
            flags.push("--limit".to_owned());
            flags.push(match limit {
                Limit::Memory(bytes) => format!("memory={bytes}B"),
                Limit::ImageSide(pixels) => format!("image-side={pixels}"),
            });
        }
        match self.alpha_shadows {
            AlphaShadows::Off => flags.push("--alpha-shadows=off".to_owned()),
            AlphaShadows::Solid => flags.push("--alpha-shadows=solid".to_owned()),
            AlphaShadows::Cut(1.0) => {}
            AlphaShadows::Cut(pixels) => flags.push(format!("--alpha-shadows=cut={pixels}")),
        }
        flags.extend(self.blended_shadows.then(|| "--blended-shadows".to_owned()));
        flags.extend(self.variant.iter().flat_map(|variant| ["--variant".to_owned(), variant.clone()]));
        flags
    }
}

/// A bound on what loading a scene may cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Limit {
    /// Bytes.
    Memory(u64),
    /// Pixels.
    ImageSide(u32),
}

impl Limit {
    const NAMES: [&str; 2] = ["memory", "image-side"];

    fn parse(text: &str) -> Result<Self, String> {
        let Some((name, value)) = text.split_once('=') else {
            return Err("write it as NAME=VALUE, such as memory=16GiB".to_owned());
        };
        match name {
            "memory" => parse_bytes(value).map(Self::Memory).ok_or("write memory as 512MiB or 16GiB".to_owned()),
            "image-side" => match value.parse() {
                Ok(pixels @ 1..) => Ok(Self::ImageSide(pixels)),
                _ => Err("image-side must be a number of pixels, 1 or more".to_owned()),
            },
            _ => {
                let hint = names::nearest(name, &Self::NAMES).map(|name| format!(" (did you mean '{name}'?)"));
                let names = Self::NAMES.join(", ");
                Err(format!("unknown limit '{name}'{}; there are: {names}", hint.unwrap_or_default()))
            }
        }
    }
}

/// How masked surfaces cast shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AlphaShadows {
    /// Not at all.
    Off,
    /// As whole triangles.
    Solid,
    /// Cut along the contour of alpha, at most so many texels from it.
    Cut(f64),
}

impl AlphaShadows {
    fn parse(text: &str) -> Result<Self, String> {
        const TOLERANCES: RangeInclusive<f64> = 0.02..=1000.0;
        match (text, text.strip_prefix("cut=").map(str::parse)) {
            ("off", _) => Ok(Self::Off),
            ("solid", _) => Ok(Self::Solid),
            (_, Some(Ok(pixels))) if TOLERANCES.contains(&pixels) => Ok(Self::Cut(pixels)),
            (_, Some(_)) => Err(format!(
                "PIXELS must be a number from {} to {}, such as cut=1",
                TOLERANCES.start(),
                TOLERANCES.end()
            )),
            _ => Err("it must be off, solid or cut=PIXELS, such as cut=1".to_owned()),
        }
    }
}

/// A number with one of the units B, KiB, MiB, GiB and TiB, or without.
fn parse_bytes(text: &str) -> Option<u64> {
    const UNITS: [(&str, u32); 5] = [("KiB", 10), ("MiB", 20), ("GiB", 30), ("TiB", 40), ("B", 0)];
    let unit = UNITS.iter().find_map(|(unit, shift)| Some((text.strip_suffix(unit)?, *shift)));
    let (number, shift) = unit.unwrap_or((text, 0));
    number.trim_end().parse::<u64>().ok()?.checked_mul(1 << shift)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alpha_shadows() {
        assert_eq!(AlphaShadows::parse("off"), Ok(AlphaShadows::Off));
        assert_eq!(AlphaShadows::parse("solid"), Ok(AlphaShadows::Solid));
        assert_eq!(AlphaShadows::parse("cut=0.5"), Ok(AlphaShadows::Cut(0.5)));
        for wrong in ["", "cut", "cut=", "cut=0", "cut=-1", "cut=nan", "cut=inf", "cut=1px", "on", "Solid"] {
            assert!(AlphaShadows::parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn limits() {
        assert_eq!(Limit::parse("memory=16GiB"), Ok(Limit::Memory(16 << 30)));
        assert_eq!(Limit::parse("memory=512 MiB"), Ok(Limit::Memory(512 << 20)));
        assert_eq!(Limit::parse("memory=1000"), Ok(Limit::Memory(1000)));
        assert_eq!(Limit::parse("image-side=64"), Ok(Limit::ImageSide(64)));
        for wrong in ["", "memory", "memory=", "memory=-1", "memory=8GB", "memory=99999999TiB", "image-side=0", "x=1"] {
            assert!(Limit::parse(wrong).is_err(), "{wrong}");
        }
        let limits = vec![Limit::Memory(1), Limit::ImageSide(2), Limit::Memory(3)];
        let loading = Loading { limits, alpha_shadows: AlphaShadows::Solid, blended_shadows: false, variant: None };
        let Limits { bytes, image_side, .. } = loading.limits();
        assert_eq!((bytes, image_side), (3, 2));
    }
}
