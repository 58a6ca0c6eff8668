//! The value of a texture statement in an .mtl file: options, then the name of a file.

use crate::gltf::schema::TextureTransform;
use crate::plain::text::{number, split_word, trim};

/// A texture and how it lies on the surface.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Map {
    /// The name, as it is spelt.
    pub file: Vec<u8>,
    /// `-s`: how often the picture repeats over the unit square.
    pub scale: [f64; 2],
    /// `-o` and `-t`.
    pub offset: [f64; 2],
    /// `-clamp on`.
    pub clamped: bool,
    /// `-mm`: what is added to a texel's value, and its factor.
    pub base_and_gain: [f64; 2],
    /// `-bm`.
    pub bump: f64,
}

impl Map {
    /// `None` if no file is named.
    pub fn parse(value: &[u8]) -> Option<Self> {
        let mut map = Self {
            file: Vec::new(),
            scale: [1.0; 2],
            offset: [0.0; 2],
            clamped: false,
            base_and_gain: [0.0, 1.0],
            bump: 1.0,
        };
        let mut rest = trim(value);
        loop {
            let (option, after) = split_word(rest);
            let mut arguments = Arguments(after);
            match option {
                b"-s" => map.scale = arguments.pair(map.scale).map(|s| if s == 0.0 { 1.0 } else { s }),
                b"-o" | b"-t" => map.offset = arguments.pair(map.offset),
                b"-mm" => map.base_and_gain = arguments.pair(map.base_and_gain),
                b"-bm" => map.bump = arguments.number().unwrap_or(map.bump),
                b"-boost" | b"-texres" => drop(arguments.number()),
                b"-clamp" => map.clamped = arguments.word() == b"on",
                b"-blendu" | b"-blendv" | b"-cc" | b"-imfchan" | b"-type" | b"-colorspace" => drop(arguments.word()),
                _ => break,
            }
            rest = arguments.0;
        }
        map.file = trim(rest).to_vec();
        (!map.file.is_empty()).then_some(map)
    }

    /// What it does to texture coordinates as glTF has them, whose v grows downwards; `None` if nothing.
    pub fn transform(&self) -> Option<TextureTransform> {
        let ([su, sv], [ou, ov]) = (self.scale, self.offset);
        let transform =
            TextureTransform { offset: [ou, 1.0 - sv - ov], scale: [su, sv], ..TextureTransform::default() };
        (self.scale != [1.0; 2] || self.offset != [0.0; 2]).then_some(transform)
    }
}

/// What follows an option; the last word is the file's.
struct Arguments<'a>(&'a [u8]);

impl<'a> Arguments<'a> {
    fn word(&mut self) -> &'a [u8] {
        let (word, rest) = split_word(self.0);
        self.0 = rest;
        word
    }

    fn number(&mut self) -> Option<f64> {
        let (word, rest) = split_word(self.0);
        let value = number(word).filter(|x| x.is_finite() && !trim(rest).is_empty())?;
        self.0 = rest;
        Some(value)
    }

    /// The first two of up to three numbers.
    fn pair(&mut self, default: [f64; 2]) -> [f64; 2] {
        let pair = default.map(|default| self.number().unwrap_or(default));
        self.number();
        pair
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_come_before_the_name() {
        let plain = Map::parse(b" a b.png ").unwrap();
        assert_eq!((plain.file.as_slice(), plain.transform().is_none()), (b"a b.png".as_slice(), true));
        let text = b"-blendu on -s 2 3 1 -o 0.5 -clamp on -mm 0 2 -bm .25 -imfchan m -texres 512 wood 2.png";
        let map = Map::parse(text).unwrap();
        assert_eq!((map.file.as_slice(), map.scale, map.offset), (b"wood 2.png".as_slice(), [2.0, 3.0], [0.5, 0.0]));
        assert_eq!((map.clamped, map.base_and_gain, map.bump), (true, [0.0, 2.0], 0.25));
        assert_eq!(Map::parse(b"-s 2 2 7").unwrap().file, b"7", "the last word is the file's");
        assert_eq!(Map::parse(b"-strange.png").unwrap().file, b"-strange.png");
        assert_eq!((Map::parse(b"-clamp on "), Map::parse(b"")), (None, None));
    }

    #[test]
    fn the_transform_turns_v_over() {
        let transform = Map::parse(b"-s 2 3 -o 0.5 0.25 a").unwrap().transform().unwrap();
        let (u, v) = (0.3, 0.7);
        let expected = [2.0 * u + 0.5, 1.0 - (3.0 * v + 0.25)];
        let got = [transform.scale[0] * u + transform.offset[0], transform.scale[1] * (1.0 - v) + transform.offset[1]];
        assert!(got.iter().zip(expected).all(|(got, expected)| (got - expected).abs() < 1e-12), "{got:?} {expected:?}");
    }
}
