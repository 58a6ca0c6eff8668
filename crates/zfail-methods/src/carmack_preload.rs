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

//!
//! [`near_view_plane`] is the same with a preload of fewer casters, "which I would only apply on surfaces that were likely to
//! intersect the view plane" (C): a volume that keeps clear of the near plane is well formed, and adds nothing to it.

use crate::geometry::Geometry;
use crate::procedure::{Pass, Procedure, in_front};
use crate::{Error, FiniteOptions, zfail_finite};
use wgpu::{CompareFunction, StencilOperation};
use zfail_plan::bounds::Bounds;
use zfail_plan::glam::DVec3;
use zfail_plan::view::{Projection, View};
use zfail_scene::Light;

/// Closed volumes twice: against the polarity wherever they are, with it in front of the visible surface.
pub fn procedure(geometry: &Geometry, view: &View, light: &Light, options: &FiniteOptions) -> Result<Procedure, Error> {
    let finite = zfail_finite::procedure(geometry, view, light, options)?;
    Ok(Procedure { passes: vec![preload(0), Pass::Z_PASS], ..finite })
}

/// The same, with a preload of those casters alone whose volumes may meet the near plane within the image.
pub fn near_view_plane(
    geometry: &Geometry,
    view: &View,
    light: &Light,
    options: &FiniteOptions,
) -> Result<Procedure, Error> {
    let mut finite = zfail_finite::procedure(geometry, view, light, options)?;
    let mut near = finite.lists[0].clone();
    let reach = finite.view;
    near.draws.retain(|draw| {
        let vertices = &finite.lists[0].vertices;
        let all = draw.outward.clone().chain(draw.inward.clone()).map(|i| finite.lists[0].indices[i as usize]);
        let instance = &geometry.instances[draw.placement as usize];
        let around = Bounds::of(all.map(|i| {
            let [x, y, z, _] = vertices[draw.first_vertex as usize + i as usize].map(f64::from);
            instance.world_from_object.transform_point3(DVec3::new(x, y, z))
        }));
        meets_near_rectangle(&around, &reach)
    });
    finite.lists.push(near);
    Ok(Procedure { passes: vec![preload(1), Pass::Z_PASS], ..finite })
}

/// Without a depth test, against the polarity.
fn preload(list: usize) -> Pass {
    let (fronts, backs) = (in_front(StencilOperation::DecrementWrap), in_front(StencilOperation::IncrementWrap));
    Pass { list, depth: CompareFunction::Always, ..Pass::two_sided(fronts, backs) }
}

/// Whether a box around a volume has any of the near rectangle, or of what is between it and the eye.
fn meets_near_rectangle(around: &Bounds, view: &View) -> bool {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]].map(|ndc| {
        let at = view.on_image_plane(ndc.into());
        let depth = view.near();
        let across = if matches!(view.projection, Projection::Perspective { .. }) { at * depth } else { at };
        view.world_from_view.transform_point3(across.extend(-depth))
    });
    let rectangle = Bounds::of(corners.into_iter().chain([view.eye()]));
    let margin = 1e-3 * (rectangle.half().max_element() + 1e-6);
    around.min.cmple(rectangle.max + margin).all() && around.max.cmpge(rectangle.min - margin).all()
}
