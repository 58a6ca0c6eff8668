//! z-pass from the number of volumes in which the eye is: Moller & Haines, "Real-Time Rendering", 1999.
//!
//! "This method counts the number of shadow volumes enclosing the center of projection by casting a ray ... This is
//! effectively a full-screen cap. This method produces incorrect results because it approximates the viewport rectangle
//! with a single point" (McG section 3). As McG tells it, all stencil values are incremented "by one" if the count is not
//! zero. Here they start from the count itself, which is right wherever all of the near rectangle is in as many volumes as
//! the eye. Where a volume cuts partway through the rectangle, no single number is.
//!
//! The ray goes to the light: the eye is in as many layers of shadow as the ray crosses casting triangles.

use crate::geometry::{Geometry, object_eye};
use crate::procedure::Procedure;
use crate::volumes::weigh;
use crate::{Error, Method, Unavailable, heidmann};
use zfail_plan::glam::{DVec3, DVec4};
use zfail_plan::topology::Topology;
use zfail_plan::view::{Projection, View};
use zfail_scene::Light;

/// Heidmann's sides, counted from the eye's own shadow on.
pub fn procedure(geometry: &Geometry, view: &View, light: &Light) -> Result<Procedure, Error> {
    let start = layers_over_eye(Method::EyeCount, geometry, view, light)?;
    Ok(Procedure { start, ..heidmann::two_sided(geometry, view, light)? })
}

/// How many layers of shadow the eye is in, for a method that wants to know.
pub fn layers_over_eye(method: Method, geometry: &Geometry, view: &View, light: &Light) -> Result<u32, Error> {
    if matches!(view.projection, Projection::Orthographic { .. }) {
        let reason = "an orthographic view has no eye that could be in a shadow".to_owned();
        return Err(Unavailable { method, reason }.into());
    }
    let mut start = 0;
    for (number, instance, mesh) in geometry.casters(light) {
        let (at, weights) = weigh(number, instance, mesh, light)?;
        start += layers(&mesh.topology, &weights, object_eye(instance, view).truncate(), at.as_dvec4());
    }
    Ok(start)
}

/// How many layers lie between `eye` and the homogeneous `light`.
fn layers(topology: &Topology, weights: &[i8], eye: DVec3, light: DVec4) -> u32 {
    let along = light.truncate() - eye * light.w;
    // On which side of the line an edge passes, asked in one direction, so that neighbours never both claim or both deny a
    // line between them.
    let passes = |from: u32, to: u32| {
        let (lo, hi) = (topology.position(from.min(to)), topology.position(from.max(to)));
        (along.dot((lo - eye).cross(hi - eye)) >= 0.0) == (from < to)
    };
    let crossed = |t: usize| {
        let [a, b, c] = topology.triangles()[t];
        let side = passes(a, b);
        let [p, q, r] = topology.corners(t);
        let normal = (q - p).cross(r - p);
        let light_in_front = normal.dot(light.truncate() - p * light.w) > 0.0;
        passes(b, c) == side && passes(c, a) == side && light_in_front != (normal.dot(eye - p) > 0.0)
    };
    let counted = |(t, weight): (usize, &i8)| if *weight != 0 && crossed(t) { weight.unsigned_abs().into() } else { 0 };
    weights.iter().enumerate().map(counted).sum()
}
