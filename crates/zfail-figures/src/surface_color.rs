//! The one colour that stands for a material where the scene itself is drawn as a figure.

use zfail_scene::{Material, Scene};

/// Texels to either side that a mean is taken of.
const GRID: u32 = 16;

/// Base colour times the mean of its texture, sRGB.
pub fn of(scene: &Scene, material: &Material) -> [u8; 3] {
    let mean = material.base_color_texture.and_then(|slot| {
        let image = scene.images.get(scene.textures.get(slot.texture)?.image)?;
        let texel = |i: u32| {
            let x = (2 * (i % GRID) + 1) * image.width / (2 * GRID);
            let y = (2 * (i / GRID) + 1) * image.height / (2 * GRID);
            let at = 4 * (y as usize * image.width as usize + x as usize);
            image.rgba.get(at..at + 3).map(|c| [0, 1, 2].map(|k| linear(c[k])))
        };
        let texels: Vec<[f32; 3]> = (0..GRID * GRID).filter_map(texel).collect();
        let sum = texels.iter().fold([0.0; 3], |sum, c| [0, 1, 2].map(|k| sum[k] + c[k]));
        (!texels.is_empty()).then(|| sum.map(|c| c / texels.len() as f32))
    });
    let mean = mean.unwrap_or([1.0; 3]);
    [0, 1, 2].map(|k| encoded(material.base_color[k] * mean[k] + 0.3 * material.emissive[k].min(1.0)))
}

fn linear(c: u8) -> f32 {
    let c = f32::from(c) / 255.0;
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

fn encoded(c: f32) -> u8 {
    let c = c.clamp(0.0, 1.0);
    let c = if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
    (c * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_survive_the_round_trip() {
        assert!((0..=255).all(|c| encoded(linear(c)) == c));
        assert_eq!(encoded(f32::NAN), 0);
    }
}
