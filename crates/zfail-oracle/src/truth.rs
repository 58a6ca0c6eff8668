//! The oracle's answer for every pixel.

use crate::{
    guard::{Doubt, Guards},
    shade::{Shade, Shader},
    sight::{Looker, Sight},
};

/// What is right for an image and a light.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// Width and height.
    pub size: [u32; 2],
    /// The guards under which it was judged.
    pub guards: Guards,
    /// Row by row from the top.
    pub pixels: Vec<Pixel>,
}

/// What is right for one pixel. With a doubt, the values are those at the pixel's centre, as far as known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pixel {
    /// Whether a surface is visible.
    pub surface: bool,
    /// Whether the surface is within the light's range and cone.
    pub reached: bool,
    /// Whether nothing blocks the light.
    pub lit: bool,
    /// Weighted count of casters between the light and the surface.
    pub count: i32,
    /// Why [`Pixel::mask`] is not to be relied upon.
    pub mask_doubt: Option<Doubt>,
    /// Why `count` is not to be relied upon.
    pub count_doubt: Option<Doubt>,
}

impl Pixel {
    const BACKGROUND: Self =
        Self { surface: false, reached: false, lit: false, count: 0, mask_doubt: None, count_doubt: None };

    fn doubtful(doubt: Doubt) -> Self {
        Self { mask_doubt: Some(doubt), count_doubt: Some(doubt), ..Self::BACKGROUND }
    }

    /// The value of a shadow mask: 255 where a surface is lit, 0 elsewhere.
    #[must_use]
    pub fn mask(&self) -> u8 {
        if self.surface && self.reached && self.lit { 255 } else { 0 }
    }
}

impl Truth {
    /// The right shadow mask: 255 lit, 0 shadowed, not reached or background. Doubtful pixels hold the likeliest value.
    #[must_use]
    pub fn mask(&self) -> Vec<u8> {
        self.pixels.iter().map(Pixel::mask).collect()
    }

    /// The right stencil counts modulo 256; 0 where there is nothing to count.
    #[must_use]
    pub fn counts(&self) -> Vec<u8> {
        self.pixels.iter().map(|p| p.count.rem_euclid(256) as u8).collect()
    }
}

/// Judges the pixel whose centre is `(x, y)`.
pub(crate) fn judge(looker: &Looker<'_>, shader: &Shader<'_>, x: f64, y: f64) -> Pixel {
    let faces = match looker.look(x, y) {
        Sight::Nothing => return Pixel::BACKGROUND,
        Sight::Doubtful => return Pixel::doubtful(Doubt::Surface),
        Sight::Faces(faces) => faces,
    };
    let masked = faces.iter().any(|f| looker.soup.triangle(f.triangle).masked);
    let shades: Vec<_> = faces.iter().map(|&face| shader.shade(x, y, face)).collect();
    let centre = faces.iter().position(|f| f.probes & 1 == 1).unwrap_or(0);
    let nominal = shades[centre];
    let first = |doubt: fn(&Shade) -> Option<Doubt>| shades.iter().find_map(doubt);
    let differ = |same: fn(&Shade, &Shade) -> bool| {
        let differs = shades.iter().any(|s| !same(s, &nominal));
        differs.then_some(Doubt::Surface)
    };
    let alpha = masked.then_some(Doubt::Alpha);
    let reach_doubt = alpha.or(first(|s| s.reach_doubt)).or(differ(|a, b| a.reached == b.reached));
    let lit_doubt = first(|s| s.lit_doubt).or(differ(|a, b| a.lit == b.lit));
    let count_doubt = first(|s| s.count_doubt).or(differ(|a, b| a.count == b.count));
    // Where nothing is lit either way, it does not matter which reason holds.
    let dark = |known: Option<Doubt>, value: bool| known.is_none() && !value;
    let is_unreached = alpha.is_none() && dark(reach_doubt, nominal.reached);
    let is_dark = alpha.is_none() && (is_unreached || dark(lit_doubt, nominal.lit));
    Pixel {
        surface: true,
        reached: nominal.reached,
        lit: nominal.lit,
        count: nominal.count,
        mask_doubt: if is_dark { None } else { reach_doubt.or(lit_doubt) },
        count_doubt: if is_unreached { None } else { reach_doubt.or(count_doubt) },
    }
}
