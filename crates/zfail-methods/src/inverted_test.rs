//! z-pass with the test exchanged where the eye is in shadow: what "the classic shadow volume works" suggest, as Carmack's letter
//! of May 2000 quotes them: "inverting the test when the view is inside a shadow volume".
//!
//! With the eye in one volume, what is still in it has a count of 0, and what is out of it a count of -1, so lit is what is *not*
//! 0. "That is not a robust solution" (C): one bit stands for the number of volumes, so that a second volume, around the eye or
//! before it, turns dark into light; and it stands for the whole near rectangle, as in [`crate::eye_count`], which only puts the
//! number in the bit's place.

use crate::geometry::Geometry;
use crate::procedure::Procedure;
use crate::{Error, Method, eye_count, heidmann};
use zfail_plan::view::View;
use zfail_scene::Light;

/// Heidmann's sides; lit is what is 0, or with the eye in shadow what is not.
pub fn procedure(geometry: &Geometry, view: &View, light: &Light) -> Result<Procedure, Error> {
    let inverted = eye_count::layers_over_eye(Method::InvertedTest, geometry, view, light)? > 0;
    Ok(Procedure { inverted, ..heidmann::two_sided(geometry, view, light)? })
}
