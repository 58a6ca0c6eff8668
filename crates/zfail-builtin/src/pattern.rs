//! Small tileable images: boards, bricks, tiles, stone, plaster, grass, wire; a window and a twig.
//!
//! In: sRGB colours `0xRRGGBB`. Out: an [`Image`] of 256 x 256 pixels, the same on every run.

use glam::{DVec2, DVec3};
use zfail_scene::Image;

const SIZE: u32 = 256;

/// Fills an image from a function of (u, v) in 0..1, v downwards, that gives sRGB in 0..1.
fn image(name: &str, color: impl Fn(f64, f64) -> DVec3) -> Image {
    masked(name, |u, v| (color(u, v), f64::INFINITY))
}

/// [`image`] with a shape cut out of it: `color` also gives the distance to the shape's rim, above 0 inside. Alpha is one
/// half on the rim and goes from 0 to 1 over two pixels.
fn masked(name: &str, color: impl Fn(f64, f64) -> (DVec3, f64)) -> Image {
    let mut rgba = Vec::with_capacity((SIZE * SIZE * 4) as usize);
    for y in 0..SIZE {
        for x in 0..SIZE {
            let at = |k: u32| (f64::from(k) + 0.5) / f64::from(SIZE);
            let (color, depth) = color(at(x), at(y));
            let rgb = (color.clamp(DVec3::ZERO, DVec3::ONE) * 255.0).round();
            let alpha = (0.5 + 0.5 * depth * f64::from(SIZE)).clamp(0.0, 1.0) * 255.0;
            rgba.extend([rgb.x as u8, rgb.y as u8, rgb.z as u8, alpha.round() as u8]);
        }
    }
    Image { name: name.to_owned(), width: SIZE, height: SIZE, rgba }
}

fn srgb(color: u32) -> DVec3 {
    DVec3::from([16, 8, 0].map(|shift| f64::from(color >> shift & 0xff) / 255.0))
}

/// A number in 0..1 that only looks random.
fn hash(x: u32, y: u32, seed: u32) -> f64 {
    let mut h = x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca6b) ^ seed.wrapping_mul(0xc2b2_ae35);
    for shift in [15, 13, 16] {
        h = (h ^ h >> shift).wrapping_mul(0x2c1b_3c6d);
    }
    f64::from(h ^ h >> 16) / f64::from(u32::MAX)
}

/// Smooth noise in 0..1 that repeats after `cells` lattice points per unit.
fn noise(u: f64, v: f64, cells: [u32; 2], seed: u32) -> f64 {
    let split = |t: f64, n: u32| {
        let t = t.rem_euclid(1.0) * f64::from(n);
        let f = t.fract();
        (t as u32 % n, (t as u32 + 1) % n, f * f * (3.0 - 2.0 * f))
    };
    let (x0, x1, fx) = split(u, cells[0]);
    let (y0, y1, fy) = split(v, cells[1]);
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    mix(mix(hash(x0, y0, seed), hash(x1, y0, seed), fx), mix(hash(x0, y1, seed), hash(x1, y1, seed), fx), fy)
}

/// Four octaves of [`noise`], about -1..1.
fn clouds(u: f64, v: f64, [x, y]: [u32; 2], seed: u32) -> f64 {
    (0..4).map(|k| (noise(u, v, [x << k, y << k], seed + k) - 0.5) * 0.5_f64.powi(k as i32)).sum::<f64>() * 1.2
}

/// 0 within `width` of a whole number, 1 farther away, with an edge of one pixel or so.
fn joint(t: f64, width: f64, blur: f64) -> f64 {
    let distance = (t - t.round()).abs();
    ((distance - width) / blur).clamp(0.0, 1.0)
}

/// Mottled rock.
pub(super) fn stone(name: &str, color: u32, contrast: f64) -> Image {
    image(name, |u, v| srgb(color) * (1.0 + contrast * (clouds(u, v, [5, 5], 1) + 0.3 * clouds(u, v, [40, 40], 9))))
}

/// Rows of bricks or ashlar, `columns` x `rows` per image, every second row shifted by half a brick.
pub(super) fn bricks(name: &str, [columns, rows]: [u32; 2], color: u32, mortar: u32) -> Image {
    image(name, |u, v| {
        let y = v * f64::from(rows);
        let row = y as u32;
        let x = u * f64::from(columns) + 0.5 * f64::from(row % 2);
        let tone = 1.0 + 0.28 * (hash(x as u32 % columns, row, 3) - 0.5) + 0.22 * clouds(u, v, [10, 10], 5);
        let width = 0.02 * f64::from(rows) / 8.0;
        let inside = joint(x, width * f64::from(columns) / f64::from(rows), 0.03) * joint(y, width * 1.5, 0.06);
        (srgb(mortar) * (1.0 + 0.2 * clouds(u, v, [30, 30], 7))).lerp(srgb(color) * tone, inside)
    })
}

/// A checker of `n` x `n` polished tiles with joints.
pub(super) fn tiles(name: &str, n: u32, colors: [u32; 2], grout: u32) -> Image {
    image(name, |u, v| {
        let [x, y] = [u, v].map(|t| t * f64::from(n));
        let color = srgb(colors[((x as u32 + y as u32) % 2) as usize]);
        let tone = 1.0 + 0.12 * (hash(x as u32, y as u32, 11) - 0.5) + 0.12 * clouds(u, v, [7, 7], 13);
        srgb(grout).lerp(color * tone, joint(x, 0.012, 0.02) * joint(y, 0.012, 0.02))
    })
}

/// `n` boards whose grain runs along u.
pub(super) fn planks(name: &str, n: u32, color: u32, gap: u32) -> Image {
    image(name, |u, v| srgb(gap).lerp(srgb(color) * grain(u, v, n), joint(v * f64::from(n), 0.025, 0.03)))
}

/// The side of a wooden crate: boards in a frame.
pub(super) fn crate_side(name: &str, color: u32, gap: u32) -> Image {
    image(name, |u, v| {
        let edge = |t: f64| t.min(1.0 - t);
        let framed = edge(u).min(edge(v)) < 0.13;
        let (tone, seam) = if framed {
            let upright = edge(u) < edge(v);
            let tone = if upright { grain(v, u, 7) } else { grain(u, v, 7) };
            let nail = [0.065, 0.935].iter().any(|&x| [0.065, 0.935].iter().any(|&y| (u - x).hypot(v - y) < 0.012));
            (if nail { 0.35 } else { tone * 1.08 }, ((0.13 - edge(u).min(edge(v))) / 0.012).clamp(0.25, 1.0))
        } else {
            let shade = ((edge(u).min(edge(v)) - 0.13) / 0.05).clamp(0.0, 1.0);
            (grain(u, v, 6) * (0.62 + 0.2 * shade), joint(v * 6.0, 0.03, 0.03))
        };
        srgb(gap).lerp(srgb(color) * tone, seam)
    })
}

fn grain(u: f64, v: f64, boards: u32) -> f64 {
    let board = (v * f64::from(boards)) as u32;
    let offset = hash(board, 0, 17);
    let fibre = noise(u + offset, v, [3, 64], 19) + 0.6 * noise(u + offset, v, [6, 128], 23) - 0.8;
    1.0 + 0.3 * (hash(board, 1, 29) - 0.5) + 0.28 * fibre
}

/// Grass, or anything that grows.
pub(super) fn grass(name: &str, color: u32, dry: u32) -> Image {
    image(name, |u, v| {
        let patch = (0.5 + 0.9 * clouds(u, v, [4, 4], 31)).clamp(0.0, 1.0);
        srgb(color).lerp(srgb(dry), patch) * (0.8 + 0.4 * noise(u, v, [90, 90], 37))
    })
}

/// A pointed window of coloured panes, black around it: a picture to be projected.
pub(super) fn window(name: &str) -> Image {
    const GLASS: [u32; 6] = [0xffe9b8, 0xd8412f, 0x2f62c8, 0xf2b233, 0x3f9a58, 0xfff6e0];
    image(name, |u, v| {
        let (x, y) = ((u - 0.5) / 0.28, (v - 0.5) / 0.4);
        // Two arcs that meet at the top.
        let top = -0.1 - 0.9 * ((4.0 - (x.abs() + 1.0).powi(2)) / 3.0).max(0.0).sqrt();
        if x.abs() > 1.0 || y > 1.0 || y < top {
            return DVec3::ZERO;
        }
        let (column, row) = (2.0 * (x + 1.0), 3.0 * (y + 1.0));
        let lead = joint(column, 0.05, 0.02) * joint(row, 0.05, 0.02);
        let rim = ((1.0 - x.abs()).min(1.0 - y).min(y - top) / 0.05 - 0.6).clamp(0.0, 1.0);
        let pane = (hash(column as u32, row as u32, 41) * GLASS.len() as f64) as usize;
        srgb(GLASS[pane.min(GLASS.len() - 1)]) * (lead * rim)
    })
}

/// Two wires that cross, as in a chain-link fence: one mesh across, and a mask.
pub(super) fn wire(name: &str, thickness: f64, color: u32) -> Image {
    let radius = 0.5 * thickness;
    masked(name, |u, v| {
        let distance = |t: f64| (t - t.round()).abs() * 0.5_f64.sqrt();
        let [rising, falling] = [distance(u + v), distance(u - v)];
        let across = rising.min(falling) / radius;
        // Each lies above the other in turns, and is round.
        let above = if u < 0.5 { rising } else { falling };
        let shade = if above < radius { 1.0 } else { 0.75 };
        (srgb(color) * (shade * (1.1 - 0.5 * across * across).max(0.4)), radius - rising.min(falling))
    })
}

/// A twig with leaves on both sides that grows from the bottom to the top, and a mask.
pub(super) fn twig(name: &str, leaves: u32, color: u32) -> Image {
    masked(name, |u, v| {
        let point = DVec2::new(u - 0.5, 1.0 - v);
        let bend = |y: f64| 0.05 * (3.0 * y).sin();
        let mut best = (0.006 - (point.x - bend(point.y)).abs().max(point.y - 0.86), srgb(color) * 0.6);
        for k in 0..leaves {
            let height = 0.1 + 0.74 * f64::from(k) / f64::from(leaves);
            let side = if k + 1 == leaves { 0.0 } else { f64::from(k % 2) * 2.0 - 1.0 };
            let angle = side * (0.75 + 0.35 * hash(k, 0, 43));
            let length = 0.3 * (1.15 - 0.5 * height) * (0.85 + 0.3 * hash(k, 1, 43));
            let axis = DVec2::new(angle.sin(), angle.cos());
            let from_base = point - DVec2::new(bend(height), height);
            let (along, across) = (from_base.dot(axis) / length, from_base.perp_dot(axis));
            // Widest before the middle, pointed at the end.
            let width = 0.3 * length * (along.clamp(0.0, 1.0).powf(0.7) * std::f64::consts::PI).sin();
            let depth = (width - across.abs()).min(along * length).min((1.0 - along) * length);
            if depth > best.0 {
                let vein = joint(along * 6.0 - 14.0 * across.abs() / length, 0.04, 0.1) * joint(across, 0.003, 0.006);
                best = (depth, srgb(color) * (0.8 + 0.35 * hash(k, 2, 43)) * (0.8 + 0.2 * vein));
            }
        }
        (best.1, best.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_tile_without_a_seam() {
        // Across the border neighbouring pixels differ as little as inside.
        let step = |image: &Image, x: [u32; 2]| -> u32 {
            (0..SIZE)
                .map(|y| {
                    let at = |x: u32| u32::from(image.rgba[((y * SIZE + x) * 4) as usize]);
                    at(x[0]).abs_diff(at(x[1]))
                })
                .sum()
        };
        for image in [stone("", 0x888888, 0.5), grass("", 0x336622, 0x887733)] {
            let inside: u32 = (0..SIZE - 1).map(|x| step(&image, [x, x + 1])).max().unwrap_or(0);
            assert!(step(&image, [SIZE - 1, 0]) <= inside);
            assert!(step(&image, [SIZE / 2, 0]) > inside, "the measure sees a seam where there is one");
        }
    }

    #[test]
    fn noise_is_within_its_range() {
        for k in 0..1000 {
            let t = f64::from(k) * 0.013 - 5.0;
            assert!((0.0..=1.0).contains(&noise(t, 3.0 * t, [5, 9], k)));
        }
    }
}
