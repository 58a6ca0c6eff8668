//! What the light really reaches: ray-cast truth in f64 for shadow masks and stencil counts.
//!
//! In: a scene, a camera, a light. Out: for every pixel whether an unobstructed ray reaches the visible surface, and
//! how many casting triangles it crosses; pixels that geometry alone shows to be ambiguous for a rasteriser are left
//! out with a reason ([`Doubt`]). [`Truth`] then compares masks and counts and says whether it left out too much.
//!
//! It shares nothing with the renderer but the scene's data and the camera's parameters: it computes rays, facings and
//! crossings on its own, with exact predicates where f64 cannot decide.
//!
//! Rules: blended materials are neither visible nor casters. Back faces of single-sided materials are not visible.
//! Every other triangle that casts blocks light from both sides. The lit point lies just on the eye's side of the
//! surface. A triangle whose plane contains the light exactly blocks nothing.

mod bvh;
mod cast;
mod cone;
mod guard;
mod lens;
mod report;
mod shade;
mod sight;
mod soup;
mod truth;

pub use cast::{Cast, CastTable};
pub use guard::{Doubt, Guards};
pub use report::{OverBudget, Report, SizeMismatch, Wrong};
pub use truth::{Pixel, Truth};

use bvh::Bvh;
use cone::Apex;
use lens::Lens;
use rayon::prelude::*;
use shade::{Shader, Source};
use sight::{Looker, Sight};
use soup::Soup;
use zfail_plan::light::LightKind;
use zfail_plan::view::View;
use zfail_scene::{Light, Scene};

/// A scene prepared for ray casting.
pub struct Oracle {
    soup: Soup,
    bvh: Bvh,
    guards: Guards,
}

impl Oracle {
    /// Prepares `scene` with the default guards.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        Self::with_guards(scene, Guards::default())
    }

    /// Prepares `scene`.
    #[must_use]
    pub fn with_guards(scene: &Scene, guards: Guards) -> Self {
        let soup = Soup::new(scene);
        let bvh = Bvh::new(&soup);
        Self { soup, bvh, guards }
    }

    /// Judges every pixel of `view` for one light; `casts` weighs the count, not the verdict.
    #[must_use]
    pub fn judge(&self, view: &View, light: &Light, casts: &CastTable) -> Truth {
        let Self { soup, bvh, guards } = self;
        let lens = &Lens::new(view, soup.origin);
        let source = &self.source(light);
        let looker = Looker { soup, bvh, lens, guards };
        let shader = Shader { soup, bvh, lens, guards, source, casts };
        let [width, height] = view.size;
        let pixels = (0..height).into_par_iter().flat_map_iter(|y| {
            let (looker, shader) = (&looker, &shader);
            (0..width).map(move |x| truth::judge(looker, shader, f64::from(x) + 0.5, f64::from(y) + 0.5))
        });
        Truth { size: view.size, guards: self.guards, pixels: pixels.collect() }
    }

    /// How far away, along the view axis, the surface is that `view` shows at `(x, y)`, in pixels from the upper left corner;
    /// `None` where there is none, or it cannot be told.
    #[must_use]
    pub fn depth(&self, view: &View, x: f64, y: f64) -> Option<f64> {
        let Self { soup, bvh, guards } = self;
        let lens = &Lens::new(view, soup.origin);
        let Sight::Faces(faces) = (Looker { soup, bvh, lens, guards }).look(x, y) else { return None };
        let face = soup.triangle(faces.first()?.triangle);
        Some(Lens::meet(&lens.ray(x, y), face.v[0], face.normal)).filter(|depth| depth.is_finite())
    }

    fn source(&self, light: &Light) -> Source {
        let mut light = light.clone();
        let apex = match &mut light.kind {
            LightKind::Point { position, .. } | LightKind::Spot { position, .. } => {
                *position -= self.soup.origin;
                Apex::Point(*position)
            }
            LightKind::Directional { direction } => Apex::Direction(*direction),
        };
        let excluded = (0..self.soup.placements.len()).map(|i| light.excluded.contains(&i)).collect();
        Source { apex, light, excluded }
    }
}
