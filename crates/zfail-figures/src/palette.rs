//! All colours of all figures, sRGB. Hues are those of Okabe & Ito, "Color Universal Design" (2008), which people with any
//! kind of colour vision tell apart.

/// Red, green, blue, opacity.
pub type Color = [u8; 4];

const BLUE: [u8; 3] = [0, 114, 178];
const SKY: [u8; 3] = [86, 180, 233];
const GREEN: [u8; 3] = [0, 158, 115];
const YELLOW: [u8; 3] = [240, 228, 66];
const ORANGE: [u8; 3] = [230, 159, 0];
const VERMILION: [u8; 3] = [213, 94, 0];
const PURPLE: [u8; 3] = [204, 121, 167];

/// `color` with an opacity from 0 to 1.
#[must_use]
pub const fn with_opacity([r, g, b]: [u8; 3], opacity: f32) -> Color {
    [r, g, b, (opacity * 255.0 + 0.5) as u8]
}

/// Sides, dark cap and light cap of a volume.
pub const PARTS: [[u8; 3]; 3] = [SKY, VERMILION, YELLOW];
/// Opacity of one layer of each part.
pub const PART_OPACITY: [f32; 3] = [0.13, 0.16, 0.4];

/// McGuire's green is case 3.
pub const CASES: [[u8; 3]; 3] = [SKY, ORANGE, GREEN];
/// Casters that draw nothing.
pub const CULLED: [u8; 3] = [150, 150, 150];

/// A colour for each of several lights, given what they shine with, linear: the one most like it that no earlier light has,
/// or for white light the next. They repeat after seven.
#[must_use]
pub fn lights(shining: &[[f32; 3]]) -> Vec<[u8; 3]> {
    const HUES: [[u8; 3]; 7] = [ORANGE, SKY, GREEN, PURPLE, YELLOW, BLUE, VERMILION];
    /// Less colourful light is white.
    const COLORFUL: f32 = 0.35;
    let hue = |[r, g, b]: [f32; 3]| {
        let mean = (r + g + b) / 3.0;
        let away = [r - mean, g - mean, b - mean];
        let length = away.iter().map(|c| c * c).sum::<f32>().sqrt();
        away.map(|c| c / length.max(1e-6))
    };
    let mut left = Vec::new();
    let pick = |&light: &[f32; 3]| {
        if left.is_empty() {
            left = HUES.to_vec();
        }
        let most = light.into_iter().fold(0.0, f32::max);
        let least = light.into_iter().fold(f32::INFINITY, f32::min);
        let like = |of: &[u8; 3]| hue(of.map(f32::from)).iter().zip(hue(light)).map(|(a, b)| a * b).sum::<f32>();
        let nearest = (0..left.len()).max_by(|&a, &b| like(&left[a]).total_cmp(&like(&left[b])));
        left.remove(nearest.filter(|_| most - least > COLORFUL * most).unwrap_or(0))
    };
    shining.iter().map(pick).collect()
}

/// Stencil counts, as [`level`] numbers them, with their names.
pub const COUNTS: [([u8; 3], &str); 11] = [
    ([18, 16, 24], "0 (lit)"),
    ([122, 28, 74], "1"),
    ([190, 52, 66], "2"),
    ([228, 96, 40], "3"),
    ([245, 146, 34], "4"),
    ([250, 192, 58], "5 to 8"),
    ([252, 228, 122], "9 to 16"),
    ([255, 252, 224], "17 and more"),
    (SKY, "-1"),
    ([58, 134, 220], "-2"),
    ([66, 82, 214], "-3 and less"),
];

/// The entry of [`COUNTS`] for a stencil count; the same as in `figure.wgsl`.
#[must_use]
pub const fn level(count: i32) -> usize {
    match count {
        0..=4 => count as usize,
        5..=8 => 5,
        9..=16 => 6,
        17.. => 7,
        -1 => 8,
        -2 => 9,
        _ => 10,
    }
}

/// Behind figures that replace the picture.
pub const PAPER: [u8; 3] = [246, 246, 243];
/// Letters on the panel of a legend.
pub const LETTERS: [u8; 3] = [240, 240, 240];
/// The panel of a legend.
pub const PANEL: Color = [18, 20, 24, 205];
/// The view frustum, dashed (McGuire et al., Figure 2).
pub const FRUSTUM: [u8; 3] = BLUE;
/// The occlusion pyramid (McGuire et al., Figure 2).
pub const PYRAMID: [u8; 3] = [200, 30, 30];
/// Silhouettes on paper, triangles' edges, and the box of clip space.
pub const INK: [u8; 3] = [24, 24, 28];
/// Triangles' edges over a picture.
pub const WIRE: [u8; 3] = [235, 240, 250];
/// Scissor rectangles and bounds of single casters.
pub const CASTER: [u8; 3] = [235, 235, 235];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lights_look_like_themselves_and_differ() {
        let white = [1.0; 3];
        assert_eq!(lights(&[white, white]), [ORANGE, SKY]);
        assert_eq!(lights(&[[1.0, 0.1, 0.1], [0.1, 1.0, 0.2], [0.1, 0.2, 1.0]]), [VERMILION, GREEN, SKY]);
        let blues = lights(&[[0.1, 0.2, 1.0], white, [0.1, 0.2, 1.0]]);
        assert_eq!(blues, [SKY, ORANGE, BLUE]);
        let mut many = lights(&[[0.9, 0.1, 0.0]; 7]);
        many.sort_unstable();
        many.dedup();
        assert_eq!(many.len(), 7);
        assert_eq!(lights(&[[f32::NAN; 3]; 9]).len(), 9);
    }

    #[test]
    fn counts_have_levels() {
        let levels = [(-9, 10), (-2, 9), (-1, 8), (0, 0), (4, 4), (5, 5), (8, 5), (9, 6), (16, 6), (17, 7), (2000, 7)];
        assert!(levels.into_iter().all(|(count, at)| level(count) == at));
    }
}
