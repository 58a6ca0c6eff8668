//! Finite dark caps for orthographic views.
//!
//! All rays of an orthographic view meet in one point at infinity, so a dark cap there has no area on the image and
//! cannot count. Planes beyond everything in view take its place, for directional lights too, whose point of convergence
//! not every rasteriser can place. A planar cap needs all its casting triangles in the
//! open half space before the light; where the light is among them, they are divided into clusters with a plane each,
//! which any subset of triangles allows, since its volume is closed by itself.
//!
//! In: the weights of one pair. Out: a cluster per casting triangle with the normal of its plane, and the planes.

use crate::casting::ObjectLight;
use crate::scene::Bounds;
use crate::topology::Topology;
use crate::view::{Projection, View};
use glam::{DAffine3, DVec3, Vec4};

/// Least cosine between a plane's normal and the directions to its cluster.
const SPREAD: f64 = 0.05;
/// Triangles seen more edge-on than this by the light cast nothing: f32 could not extrude them, and their shadow is a
/// hundred thousand times thinner than long.
const EDGE_ON: f64 = 1e-5;

/// Casting triangles by the plane that caps them.
#[derive(Debug, Default)]
pub(super) struct Clusters {
    /// Cluster of each triangle; empty while there are none.
    pub of: Vec<u16>,
    /// Normal of each cluster's plane, object space, pointing away from the light.
    pub normals: Vec<DVec3>,
}

impl Clusters {
    /// No clusters: caps at infinity.
    pub fn clear(&mut self) {
        self.of.clear();
        self.normals.clear();
    }

    /// Divides the triangles with a weight; takes the weight of those that no plane can cap.
    pub fn fill(&mut self, topology: &Topology, weights: &mut [i8], light: ObjectLight) {
        self.of.resize(weights.len(), 0);
        if light.w == 0.0 {
            self.normals.push(-light.truncate().as_dvec3().normalize_or_zero());
            return;
        }
        let origin = light.truncate().as_dvec3();
        let directions = |t: usize| topology.corners(t).map(|p| (p - origin).normalize_or_zero());
        let spread = |u: DVec3, d: [DVec3; 3]| d.iter().map(|v| u.dot(*v)).fold(f64::INFINITY, f64::min);

        // One plane for all, if the light is outside of the caster.
        let middle = (topology.bounds().center() - origin).normalize_or_zero();
        if (0..weights.len()).all(|t| weights[t] == 0 || spread(middle, directions(t)) > SPREAD) {
            self.normals.push(middle);
            return;
        }
        let compass: Vec<DVec3> = compass();
        let mut cluster_of_compass = [None; 26];
        for (t, weight) in weights.iter_mut().enumerate().filter(|(_, weight)| **weight != 0) {
            let d = directions(t);
            let best = (0..compass.len()).max_by(|&i, &j| spread(compass[i], d).total_cmp(&spread(compass[j], d)));
            let best = best.filter(|&i| spread(compass[i], d) > SPREAD);
            let cluster = match best.map(|i| (i, cluster_of_compass[i])) {
                Some((_, Some(known))) => known,
                Some((i, None)) => {
                    let new = self.push(compass[i]);
                    cluster_of_compass[i] = Some(new);
                    new
                }
                // Wide as seen from the light: parallel to its own plane.
                None => {
                    let [a, b, c] = topology.corners(t);
                    let normal = (b - a).cross(c - a).normalize_or_zero();
                    let normal = normal * normal.dot(a - origin).signum();
                    if spread(normal, d) < EDGE_ON || self.normals.len() == usize::from(u16::MAX) {
                        *weight = 0;
                        continue;
                    }
                    self.push(normal)
                }
            };
            self.of[t] = cluster;
        }
    }

    fn push(&mut self, normal: DVec3) -> u16 {
        self.normals.push(normal);
        (self.normals.len() - 1) as u16
    }
}

/// The 26 directions to the faces, edges and corners of a cube.
fn compass() -> Vec<DVec3> {
    let steps = [-1.0, 0.0, 1.0];
    let all = steps.iter().flat_map(|&x| steps.iter().flat_map(move |&y| steps.map(|z| DVec3::new(x, y, z))));
    all.filter(|d| *d != DVec3::ZERO).map(DVec3::normalize).collect()
}

/// The plane with normal `u` beyond everything in view, object space.
pub(super) fn plane(u: DVec3, light: ObjectLight, view: &View, object_from_relative: &DAffine3) -> Vec4 {
    let Projection::Orthographic { ymag, near, far } = view.projection else { return Vec4::ZERO };
    let xmag = ymag * view.aspect();
    let mut corners = Bounds::EMPTY;
    // A point light itself has to lie before its plane.
    let mut reach = if light.w == 0.0 { f64::NEG_INFINITY } else { u.dot(light.truncate().as_dvec3()) };
    for x in [-xmag, xmag] {
        for y in [-ymag, ymag] {
            for z in [-near, -far] {
                let corner = view.world_from_view.matrix3 * DVec3::new(x, y, z);
                let corner = object_from_relative.transform_point3(corner);
                corners.add(corner);
                reach = reach.max(u.dot(corner));
            }
        }
    }
    // Clear of the farthest corner.
    u.extend(reach + 0.01 * corners.half().length()).as_vec4()
}
