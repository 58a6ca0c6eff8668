//! Images of the formats that extensions add, and which of a texture's images is shown.

use crate::build::{Gltf, TRIANGLE, assert_sound};
use crate::files::assets;
use crate::hostile::survive;
use image::codecs::{png::PngEncoder, webp::WebPEncoder};
use image::{ExtendedColorType, ImageEncoder};
use serde_json::{Value, json};
use zfail_scene::Scene;
use zfail_testing::Random;

const RED: [u8; 4] = [200, 10, 20, 255];
const BLUE: [u8; 4] = [10, 20, 200, 128];

fn png(color: [u8; 4]) -> Vec<u8> {
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes).write_image(&color.repeat(6), 3, 2, ExtendedColorType::Rgba8).unwrap();
    bytes
}

fn webp(color: [u8; 4]) -> Vec<u8> {
    let mut bytes = Vec::new();
    WebPEncoder::new_lossless(&mut bytes).write_image(&color.repeat(6), 3, 2, ExtendedColorType::Rgba8).unwrap();
    bytes
}

/// A KTX 2.0 image of 3 times 2 texels without compression.
fn ktx(color: [u8; 4]) -> Vec<u8> {
    let words = |words: &[u32]| words.iter().flat_map(|w| w.to_le_bytes()).collect::<Vec<u8>>();
    let header = words(&[37, 1, 3, 2, 0, 0, 1, 1, 0, 104, 44, 0, 0, 0, 0, 0, 0]);
    let level = words(&[148, 0, 24, 0, 24, 0]);
    let descriptor = words(&[44, 0, 2 | 40 << 16, 1 | 1 << 8 | 1 << 16, 0, 4, 0, 7 << 16, 0, 0, 255]);
    [b"\xabKTX 20\xbb\r\n\x1a\n".as_slice(), &header, &level, &descriptor, &color.repeat(6)].concat()
}

/// A textured triangle whose texture is `texture`, over `images`.
fn textured(images: &[Vec<u8>], texture: Value) -> Gltf {
    let mut gltf = Gltf::with_primitive(|g| json!({"attributes": {"POSITION": g.floats(&TRIANGLE)}, "material": 0}));
    for bytes in images {
        let view = gltf.view(bytes);
        gltf.push("images", json!({"bufferView": view}));
    }
    gltf.push("textures", texture);
    gltf.push("materials", json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}));
    gltf
}

/// The colour that the material's texture shows.
fn shown(scene: &Scene) -> Option<[u8; 4]> {
    assert_sound(scene);
    let texture = scene.materials[0].base_color_texture?;
    let image = &scene.images[scene.textures[texture.texture].image];
    assert_eq!((image.width, image.height), (3, 2));
    assert!(image.rgba.as_chunks::<4>().0.iter().all(|texel| *texel == image.rgba[..4]), "{:?}", image.rgba);
    Some(*image.rgba.first_chunk().unwrap())
}

#[test]
fn the_extension_s_image_comes_first() {
    for (extension, image) in [("EXT_texture_webp", webp(RED)), ("KHR_texture_basisu", ktx(RED))] {
        let both = json!({"source": 1, "extensions": {extension: {"source": 0}}});
        let scene = textured(&[image.clone(), png(BLUE)], both.clone()).scene();
        assert_eq!(shown(&scene), Some(RED), "{extension}");
        assert!(scene.notices.is_empty(), "{:?}", scene.notices);
        let alone = textured(std::slice::from_ref(&image), json!({"extensions": {extension: {"source": 0}}})).scene();
        assert_eq!(shown(&alone), Some(RED), "{extension}");
        // One that cannot be read leaves the place to the other, with a notice.
        let mut broken = image.clone();
        broken[20] ^= 0x55;
        let scene = textured(&[broken, png(BLUE)], both).load();
        if let Ok(scene) = scene {
            assert_eq!(shown(&scene), Some(BLUE), "{extension}");
            assert!(scene.notices[0].contains("image \"image 0\""), "{:?}", scene.notices);
        }
        let scene = textured(&[image], json!({"extensions": {extension: {"source": 4}}})).scene();
        assert_eq!(shown(&scene), None);
        let expected =
            format!("textures[0].extensions.{extension}.source refers to images[4], but the file has 1: left out");
        assert_eq!(scene.notices[0], expected);
    }
}

#[test]
fn dimensions_are_checked_before_texels() {
    let mut large = ktx(RED);
    large[20..24].copy_from_slice(&20_000u32.to_le_bytes());
    let gltf = textured(&[large], json!({"source": 0}));
    let scene = gltf.scene();
    assert!(scene.notices[0].contains("is 20000 times 2 pixels, and the limit is 16384 a side"), "{:?}", scene.notices);
    let mut gone = ktx(RED);
    gone[20..24].copy_from_slice(&16_384u32.to_le_bytes());
    let scene = textured(&[gone], json!({"source": 0})).scene();
    assert!(scene.notices[0].contains("its first level is cut off"), "{:?}", scene.notices);
}

/// The smallest ETC1S image of a model in the model folder; there is no encoder to make one with.
fn etc1s() -> Option<Vec<u8>> {
    let file = std::fs::read(assets()?.join("cesium-balloon-ktx2/cesium-balloon-ktx2.glb")).ok()?;
    let length = u32::from_le_bytes(*file[12..].first_chunk()?) as usize;
    let json: Value = serde_json::from_slice(&file[20..20 + length]).ok()?;
    let image = |image: &Value| {
        let view = &json["bufferViews"][image["bufferView"].as_u64()? as usize];
        let start = 28 + length + view["byteOffset"].as_u64()? as usize;
        Some(file[start..start + view["byteLength"].as_u64()? as usize].to_vec())
    };
    json["images"].as_array()?.iter().filter_map(image).min_by_key(Vec::len)
}

#[test]
fn etc1s_survives_flipped_bits() {
    let Some(original) = etc1s() else { return };
    let load = |bytes: Vec<u8>| textured(&[bytes], json!({"source": 0})).load().map(|scene| scene.images);
    let expected = load(original.clone()).unwrap().remove(0);
    assert_eq!((expected.width, expected.height), (64, 64));
    let mut random = Random(7);
    let (mut changed, mut left_out) = (0, 0);
    for round in 0..400 {
        let mut bytes = original.clone();
        let flips: Vec<usize> = (0..1 + random.below(3)).map(|_| random.below(bytes.len())).collect();
        flips.iter().for_each(|&at| bytes[at] ^= 1 << random.below(8));
        let what = || format!("round {round}, bytes {flips:?}");
        survive(&textured(std::slice::from_ref(&bytes), json!({"source": 0})).glb(), &what);
        match load(bytes) {
            Ok(images) if images.is_empty() => left_out += 1,
            Ok(images) => changed += usize::from(images[0].rgba != expected.rgba),
            Err(_) => {}
        }
    }
    assert!(changed > 0 && left_out > 0, "{changed} changed, {left_out} left out of 400");
}

#[test]
fn flipped_bits_in_images() {
    let mut random = Random(3);
    for original in [webp(RED), ktx(RED), png(RED)] {
        let mut changed = 0;
        for round in 0..400 {
            let mut bytes = original.clone();
            let at = random.below(bytes.len());
            bytes[at] ^= 1 << random.below(8);
            let gltf = textured(&[bytes], json!({"source": 0}));
            survive(&gltf.glb(), &|| format!("round {round}, byte {at}"));
            let other = |scene: &Scene| {
                let texture = scene.materials[0].base_color_texture;
                texture.is_none_or(|t| scene.images[scene.textures[t.texture].image].rgba != RED.repeat(6))
            };
            changed += usize::from(gltf.load().is_ok_and(|scene| other(&scene)));
        }
        assert!(changed > 0, "flips must show");
    }
}
