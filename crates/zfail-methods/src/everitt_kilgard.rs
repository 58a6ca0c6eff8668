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
use crate::procedure::{Pass, Procedure};
use crate::volumes::{Extrusion, Faces, Volumes};
use crate::{Error, Method, Unavailable};
use zfail_plan::view::{Projection, View};
use zfail_scene::Light;

/// All faces of all volumes, from behind.
pub fn procedure(geometry: &Geometry, view: &View, light: &Light) -> Result<Procedure, Error> {
    let Projection::Perspective { yfov, near, .. } = view.projection else {
        let reason =
            "\"the projection matrix must be perspective, not orthographic\" (Everitt & Kilgard 2002, section 3.1)";
        return Err(Unavailable { method: Method::EverittKilgard, reason: reason.to_owned() }.into());
    };
    let view = View { projection: Projection::Perspective { yfov, near, far: None }, ..*view };
    let volumes = Volumes::new(geometry, &view, light, Extrusion::Infinite, Faces::All)?;
    Ok(Procedure { view, start: 0, lists: vec![volumes], passes: vec![Pass::Z_FAIL], ledge: false })
}
