//! Casters that stand wholly in another's shadow.
//!
//! In: a light's casters. Out: which of them block no light that a kept convex caster does not block already. Leaving
//! those out lowers counts where they stay above zero, and nowhere else.
//!
//! Occluders are visited in the order of their distance from the light, and only kept ones hide others, so that casters
//! that coincide cannot hide each other.

use super::Culled;
use super::pair::{Pair, Role};
use super::placed::Placed;
use super::stage::Stage;
use crate::topology::{ConvexPart, Topology};
use glam::{DAffine3, DVec3, DVec4};

/// A convex caster's shadow as half spaces, `dot(xyz, p) + w >= 0`, relative to the eye.
#[derive(Clone, Debug, Default)]
struct Shadow {
    planes: Vec<DVec4>,
    faces: Vec<DVec4>,
}

impl Shadow {
    /// The shadow that `part` of a caster throws; empty where the light is inside of it.
    fn set(&mut self, topology: &Topology, part: &ConvexPart, relative_from_object: &DAffine3, light: DVec4) {
        self.planes.clear();
        self.faces.clear();
        let at = |v: u32| relative_from_object.transform_point3(topology.position(v));
        let mirrored = relative_from_object.matrix3.determinant() < 0.0;
        let mut middle = DVec3::ZERO;
        for face in &part.faces {
            let [a, b, c] = face.map(at);
            middle += a / part.faces.len() as f64;
            let normal = (b - a).cross(c - a);
            let outward = if mirrored { -normal } else { normal };
            self.faces.push(outward.extend(-outward.dot(a)));
        }
        let lit = |plane: &DVec4| plane.dot(light) > 0.0;
        // Silhouette first: those planes turn most casters away.
        for &(edge, [f, g]) in &part.edges {
            if lit(&self.faces[usize::from(f)]) != lit(&self.faces[usize::from(g)]) {
                let [a, b] = edge.map(at);
                let normal = (b - a).cross(light.truncate() - a * light.w);
                let inward = if normal.dot(middle - a) >= 0.0 { normal } else { -normal };
                self.planes.push(inward.extend(-inward.dot(a)));
            }
        }
        // Behind the lit faces.
        self.planes.extend(self.faces.iter().filter(|plane| lit(plane)).map(|plane| -*plane));
        for plane in &mut self.planes {
            *plane /= plane.truncate().length().max(f64::MIN_POSITIVE);
        }
    }

    /// Whether all of `corners` (relative to the eye) lie in the shadow, up to rounding.
    fn holds(&self, corners: &[DVec3; 8]) -> bool {
        /// Corners this much out of the shadow, relative to their distance from the eye, are in it for all that the f32
        /// arithmetic of a GPU can tell: flush surfaces must not fail for the rounding of their coordinates.
        const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;
        let reach = corners.iter().map(|c| c.abs().max_element()).fold(0.0, f64::max);
        let tolerance = -ROUNDING * reach;
        !self.planes.is_empty()
            && self.planes.iter().all(|plane| corners.iter().all(|c| plane.truncate().dot(*c) + plane.w >= tolerance))
    }
}

/// Memory for looking for casters that stand in shadow.
#[derive(Debug, Default)]
pub(super) struct Occlusion {
    /// Distance from the light, and caster.
    occluders: Vec<(f64, usize)>,
    shadows: Vec<Shadow>,
}

impl Occlusion {
    /// Leaves out the casters of a light (homogeneous, relative to the eye) that stand in the shadow of convex ones.
    pub fn leave_out(&mut self, stage: &Stage<'_>, light: DVec4, pairs: &mut [Pair]) {
        let most = usize::from(stage.steps.occluders);
        if most == 0 || pairs.iter().filter(|pair| pair.is_active()).count() < 2 {
            return;
        }
        self.list(stage, light, pairs, most);
        let mut kept = 0;
        for &(_, c) in &self.occluders {
            let caster = &stage.placed[c];
            if self.shadows[..kept].iter().any(|shadow| shadow.holds(&caster.exact_corners)) {
                pairs[c].role = Role::Culled(Culled::Occluded);
                continue;
            }
            if kept == self.shadows.len() {
                self.shadows.push(Shadow::default());
            }
            let topology = stage.topology(c);
            if let Some(part) = &topology.convex {
                self.shadows[kept].set(topology, part, &caster.relative_from_object, light);
                kept += 1;
            }
        }
        for (c, (pair, caster)) in pairs.iter_mut().zip(stage.placed).enumerate() {
            let itself = self.occluders.iter().any(|entry| entry.1 == c);
            let occluded = |shadow: &Shadow| shadow.holds(&caster.exact_corners);
            if pair.is_active() && !itself && self.shadows[..kept].iter().any(occluded) {
                pair.role = Role::Culled(Culled::Occluded);
            }
        }
    }

    /// Lists the convex casters that look largest from the light, nearest first.
    fn list(&mut self, stage: &Stage<'_>, light: DVec4, pairs: &[Pair], most: usize) {
        let distance = |caster: &Placed| {
            let way = |p: DVec3| if light.w == 0.0 { -light.truncate().dot(p) } else { light.truncate().distance(p) };
            caster.corners.iter().map(|c| way(*c)).fold(f64::INFINITY, f64::min)
        };
        self.occluders.clear();
        let active = pairs.iter().zip(stage.placed).enumerate().filter(|(_, (pair, _))| pair.is_active());
        for (c, (_, caster)) in active {
            if stage.topology(c).convex.is_some() {
                let size = caster.axes.iter().map(|axis| axis.length_squared()).sum::<f64>();
                let away = if light.w == 0.0 { 1.0 } else { light.truncate().distance_squared(caster.center) };
                self.occluders.push((-size / away.max(f64::MIN_POSITIVE), c));
            }
        }
        let by_first = |a: &(f64, usize), b: &(f64, usize)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        self.occluders.sort_unstable_by(by_first);
        self.occluders.truncate(most);
        for entry in &mut self.occluders {
            entry.0 = distance(&stage.placed[entry.1]);
        }
        self.occluders.sort_unstable_by(by_first);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::Bounds;

    fn cube() -> Topology {
        let positions: Vec<[f32; 3]> =
            (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2 & 1].map(|bit| 2.0 * bit as f32 - 1.0)).collect();
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles: Vec<[u32; 3]> = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        Topology::new(&positions, &triangles, |_| true).expect("valid")
    }

    fn holds(light: DVec4, mirrored: bool, center: DVec3, half: f64) -> bool {
        let topology = cube();
        let part = topology.convex.clone().expect("convex");
        let mut shadow = Shadow::default();
        let place = DAffine3::from_scale(if mirrored { DVec3::new(-1.0, 1.0, 1.0) } else { DVec3::ONE });
        shadow.set(&topology, &part, &place, light);
        shadow.holds(&Bounds { min: center - half, max: center + half }.corners())
    }

    #[test]
    fn what_is_behind_a_cube_is_in_its_shadow() {
        for mirrored in [false, true] {
            let light = DVec4::new(0.0, 5.0, 0.0, 1.0);
            assert!(holds(light, mirrored, DVec3::new(0.0, -3.0, 0.0), 1.5));
            assert!(!holds(light, mirrored, DVec3::new(0.0, -3.0, 0.0), 2.5), "wider than the shadow");
            assert!(!holds(light, mirrored, DVec3::new(0.0, 3.0, 0.0), 0.1), "before the cube");
            assert!(!holds(DVec4::new(0.1, 0.2, 0.3, 1.0), mirrored, DVec3::new(0.0, -3.0, 0.0), 0.1), "light inside");
            let sun = DVec4::new(0.0, 1.0, 0.0, 0.0);
            assert!(holds(sun, mirrored, DVec3::new(0.0, -3.0, 0.0), 1.0), "exactly as wide");
            assert!(!holds(sun, mirrored, DVec3::new(0.0, -3.0, 0.0), 1.001));
        }
    }
}
