//! z-pass: Heidmann, "Real Shadows, Real Time", IRIS Universe 18, 1991; E&K section 2.2.1.
//!
//! Every face of a volume in front of the visible surface is entered (front faces, +1) or left (back faces, -1) on the
//! way from the eye; what remains is the number of volumes around the surface. It needs the sides alone: the caps hide
//! behind the caster and beyond everything. The sides reach to infinity, and what the far plane cuts of them is behind
//! all that is visible, so the view's own projection does.
//!
//! Counting starts at the near plane, as if nothing there were in shadow. "Heidmann fails to mention in his article a
//! problem that seriously undermines the robustness of his approach" (E&K 2.2.2): wherever the near rectangle lies in a
//! volume, as much is missing from the count.

use crate::Error;
use crate::geometry::Geometry;
use crate::procedure::{Pass, Procedure, in_front};
use crate::volumes::{Extrusion, Faces, Volumes};
use wgpu::{Face, StencilOperation};
use zfail_plan::view::View;
use zfail_scene::Light;

/// As the hardware of the day had it: front faces in one pass, back faces in the next, and counts that stop at 0 and at
/// 255 (`GL_INCR`, `GL_DECR`). All front faces have to come first, or counts would be cut at 0 on the way.
pub fn two_pass(geometry: &Geometry, view: &View, light: &Light) -> Result<Procedure, Error> {
    let (enter, leave) = (in_front(StencilOperation::IncrementClamp), in_front(StencilOperation::DecrementClamp));
    let fronts = Pass { cull: Some(Face::Back), ..Pass::two_sided(enter, enter) };
    let backs = Pass { cull: Some(Face::Front), ..Pass::two_sided(leave, leave) };
    sides(geometry, view, light, vec![fronts, backs])
}

/// In one pass, since two-sided stencil testing (E&K 4.3). It draws faces in any order, so counts have to wrap (E&K 4.1).
pub fn two_sided(geometry: &Geometry, view: &View, light: &Light) -> Result<Procedure, Error> {
    sides(geometry, view, light, vec![Pass::Z_PASS])
}

/// Endless sides, counted from the near plane on.
fn sides(geometry: &Geometry, view: &View, light: &Light, passes: Vec<Pass>) -> Result<Procedure, Error> {
    let volumes = Volumes::new(geometry, view, light, Extrusion::Infinite, Faces::Sides)?;
    Ok(Procedure { view: *view, start: 0, lists: vec![volumes], passes, ledge: false, inverted: false })
}
