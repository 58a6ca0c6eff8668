//! z-pass from a count without depth test: Carmack's letter of May 2000, "preload".
//!
//! "I first drew the shadow volumes with depth test disabled, incrementing for back sides and decrementing for front
//! sides. This finishes with a positive value in the stencil buffer for each plane that is clipped away at the view
//! plane. The normal depth tested shadow volume is drawn next, with the change polarity reversed" (C). A closed volume
//! has as many fronts as backs along any ray; where the near plane cuts it open, a front is missing, and the preload
//! finds that at every pixel by itself.
//!
//! It draws everything twice, caps included, and needs both of every volume's ends: "making sure that none of the shadow
//! volumes get clipped off by your far clipping plane (which would unbalance the count)" (C). So volumes end, and the far
//! plane lies behind their ends; see [`crate::zfail_finite`], which the letter derives from this by cancelling passes.

use crate::geometry::Geometry;
use crate::procedure::{Pass, Procedure, in_front};
use crate::{Error, FiniteOptions, zfail_finite};
use wgpu::{CompareFunction, StencilOperation};
use zfail_plan::view::View;
use zfail_scene::Light;

/// Closed volumes twice: against the polarity wherever they are, with it in front of the visible surface.
pub fn procedure(geometry: &Geometry, view: &View, light: &Light, options: &FiniteOptions) -> Result<Procedure, Error> {
    let finite = zfail_finite::procedure(geometry, view, light, options)?;
    let (fronts, backs) = (in_front(StencilOperation::DecrementWrap), in_front(StencilOperation::IncrementWrap));
    let preload = Pass { depth: CompareFunction::Always, ..Pass::two_sided(fronts, backs) };
    Ok(Procedure { passes: vec![preload, Pass::Z_PASS], ..finite })
}
