//! z-fail with a far plane: Bilodeau & Songy 1999, Carmack's letter of May 2000; E&K section 2.2.3.
//!
//! "Draw back sides, doing nothing with depth pass and incrementing with depth fail. Draw front sides, doing nothing with
//! depth pass and decrementing with depth fail" (C). Counting comes from behind the visible surface, so the near plane no
//! longer matters; the volume's far end does. It is thrown "some large but finite distance (importantly, still within the
//! far clip plane)" (E&K 2.2.3).
//!
//! Two things go wrong. "When a light source is arbitrarily close to a single occluder polygon, any finite distance ...
//! may not extend far enough" (E&K 2.2.3): both ends of a side go the same distance in directions far apart, and the cap
//! between them sags towards the light. And reversing the count "only moved the problem to the far clipping plane" (McG
//! section 3): what that cuts off of a volume is missing from the count.

use crate::geometry::Geometry;
use crate::procedure::{Pass, Procedure};
use crate::volumes::{Extrusion, Faces, Volumes};
use crate::{Error, FiniteOptions};
use zfail_plan::bounds::Bounds;
use zfail_plan::view::{Projection, View};
use zfail_scene::Light;

/// Volumes that end, before a far plane.
pub fn procedure(geometry: &Geometry, view: &View, light: &Light, options: &FiniteOptions) -> Result<Procedure, Error> {
    let [extrusion, far] = ends(&geometry.bounds, view, options)?;
    let view = View { projection: with_far(view.projection, far), ..*view };
    let volumes = Volumes::new(geometry, &view, light, Extrusion::By(extrusion), Faces::All)?;
    Ok(Procedure { view, start: 0, lists: vec![volumes], passes: vec![Pass::Z_FAIL], ledge: false, inverted: false })
}

/// How far vertices are thrown, and where the far plane is. Without a choice, as a careful engine of the day has it: as
/// far as any two points of the scene can be apart, and behind whatever that can reach.
fn ends(bounds: &Bounds, view: &View, options: &FiniteOptions) -> Result<[f64; 2], Error> {
    let near = view.near();
    let diagonal = if bounds.is_empty() { 1.0 } else { 2.0 * bounds.half().length() };
    let extrusion = options.extrusion.unwrap_or(diagonal);
    if !(extrusion.is_finite() && extrusion > 0.0) {
        let remedy = "it has to be finite and greater than 0";
        return Err(Error::BadOption { option: "finite.extrusion", value: extrusion, remedy });
    }
    let forward = -view.world_from_view.matrix3.z_axis;
    let depth = if bounds.is_empty() {
        near
    } else {
        bounds.corners().map(|corner| forward.dot(corner - view.eye())).into_iter().fold(near, f64::max)
    };
    let far = options.far.unwrap_or(depth + 1.01 * extrusion + 1e-3 * near.abs());
    if !(far.is_finite() && far > near) {
        let remedy = "it has to be finite and greater than the near plane's distance";
        return Err(Error::BadOption { option: "finite.far", value: far, remedy });
    }
    Ok([extrusion, far])
}

fn with_far(projection: Projection, far: f64) -> Projection {
    match projection {
        Projection::Perspective { yfov, near, .. } => Projection::Perspective { yfov, near, far: Some(far) },
        Projection::Orthographic { ymag, near, .. } => Projection::Orthographic { ymag, near, far },
    }
}
