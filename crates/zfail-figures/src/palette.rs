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

/// The colour of light number `light`; it repeats after seven.
#[must_use]
pub const fn light(light: usize) -> [u8; 3] {
    [ORANGE, SKY, GREEN, PURPLE, YELLOW, BLUE, VERMILION][light % 7]
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
