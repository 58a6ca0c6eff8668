//! z-fail at infinity: Everitt & Kilgard 2002, section 3.
//!
//! The far plane goes to infinity (3.2.1), and so do the volumes' far ends, with w = 0 (3.2.2): nothing can lie beyond,
//! nothing is cut off, and no distance has to be chosen. "The shadow depth count can always start from zero for every
//! pixel", wherever the near plane is. With depth reversed, points at infinity have depth 0 without any rounding.
//!
//! The paper asks for closed 2-manifolds and throws the faces turned away from the light; here the faces that cast are
//! thrown, which closes the volume of any mesh (corrections to the cap with the light inside a caster included). What
//! remains of its requirements (3.1) are a perspective view, and a stencil that holds "the maximum shadow depth count":
//! with 8 bits, 256 layers look like none ("in practice ... quite unlikely", 4.1).

use crate::geometry::Geometry;
use crate::procedure::{Pass, Procedure, behind};
use crate::volumes::{Extrusion, Faces, Volumes};
use crate::{Error, Method, Unavailable};
use wgpu::{Face, StencilOperation};
use zfail_plan::view::{Projection, View};
use zfail_scene::Light;

/// As section 3.3, step 6, prints it: back faces in one pass, front faces in the next, by `INCR` and `DECR`, which stop at 255 and
/// at 0. Every back face comes first, so nothing is cut at 0; what 255 cuts off never comes back, and where more layers overlap, the
/// count ends at 0 or below what it should be. "Using the wrapping operations" (4.1) is the correction, as far as 8 bits go.
pub fn two_pass(geometry: &Geometry, view: &View, light: &Light) -> Result<Procedure, Error> {
    let wrapping = from_behind(Method::EverittKilgardTwoPass, geometry, view, light)?;
    let (leave, enter) = (behind(StencilOperation::IncrementClamp), behind(StencilOperation::DecrementClamp));
    let backs = Pass { cull: Some(Face::Front), ..Pass::two_sided(leave, leave) };
    let fronts = Pass { cull: Some(Face::Back), ..Pass::two_sided(enter, enter) };
    Ok(Procedure { passes: vec![backs, fronts], ..wrapping })
}

/// All faces of all volumes, from behind.
pub fn procedure(geometry: &Geometry, view: &View, light: &Light) -> Result<Procedure, Error> {
    from_behind(Method::EverittKilgard, geometry, view, light)
}

fn from_behind(method: Method, geometry: &Geometry, view: &View, light: &Light) -> Result<Procedure, Error> {
    let Projection::Perspective { yfov, near, .. } = view.projection else {
        let reason =
            "\"the projection matrix must be perspective, not orthographic\" (Everitt & Kilgard 2002, section 3.1)";
        return Err(Unavailable { method, reason: reason.to_owned() }.into());
    };
    let view = View { projection: Projection::Perspective { yfov, near, far: None }, ..*view };
    let volumes = Volumes::new(geometry, &view, light, Extrusion::Infinite, Faces::All)?;
    Ok(Procedure { view, start: 0, lists: vec![volumes], passes: vec![Pass::Z_FAIL], ledge: false, inverted: false })
}
