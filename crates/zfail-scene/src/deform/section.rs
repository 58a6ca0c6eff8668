//! The vertices of one primitive and what moves them: morph targets first, then joints.
//!
//! In: morph weights, and joints as transforms from the mesh's space. Out: positions, normals and tangents.

use crate::placement::{cofactor, unit_vector};
use glam::{DAffine3, DMat3, DVec3};
use rayon::prelude::*;

/// Vertices before any deformation. All lists that are not empty have the length of `positions`.
#[derive(Clone, Debug, Default)]
pub struct Section {
    /// The mesh's own space, metres.
    pub positions: Vec<[f32; 3]>,
    /// Unit vectors.
    pub normals: Vec<[f32; 3]>,
    /// With the sign of the bitangent in w; zero where there is none.
    pub tangents: Vec<[f32; 4]>,
    /// Whether every three vertices are a triangle, whose normal they have in every pose.
    pub flat: bool,
    /// By morph weight.
    pub targets: Vec<Target>,
    /// Of a mesh with a skin.
    pub influences: Option<Influences>,
}

/// Displacements for a morph weight of 1; an empty list displaces nothing.
#[derive(Clone, Debug, Default)]
pub struct Target {
    /// Of [`Section::positions`].
    pub positions: Vec<[f32; 3]>,
    /// Of [`Section::normals`].
    pub normals: Vec<[f32; 3]>,
    /// Of [`Section::tangents`], without their signs.
    pub tangents: Vec<[f32; 3]>,
}

/// Which joints move each vertex: the same number for all, unused ones with weight 0. Some weight of each is above 0.
#[derive(Clone, Debug, Default)]
pub struct Influences {
    /// How many joints a vertex has.
    pub width: usize,
    /// `width` per vertex; all exist.
    pub joints: Vec<u32>,
    /// Parallel to `joints`; finite and not negative.
    pub weights: Vec<f32>,
}

/// A posed vertex.
struct Vertex {
    position: DVec3,
    normal: DVec3,
    tangent: DVec3,
}

impl Section {
    /// Makes a vertex of its own of every one of `corners`, for triangles that share none.
    pub fn gather(&mut self, corners: &[u32]) {
        fn pick<T: Copy>(values: &mut Vec<T>, corners: &[u32]) {
            if !values.is_empty() {
                *values = corners.iter().map(|&v| values[v as usize]).collect();
            }
        }
        pick(&mut self.positions, corners);
        pick(&mut self.normals, corners);
        pick(&mut self.tangents, corners);
        for target in &mut self.targets {
            pick(&mut target.positions, corners);
            pick(&mut target.normals, corners);
            pick(&mut target.tangents, corners);
        }
        if let Some(Influences { width, joints, weights }) = &mut self.influences {
            *joints = corners.iter().flat_map(|&v| &joints[v as usize * *width..][..*width]).copied().collect();
            *weights = corners.iter().flat_map(|&v| &weights[v as usize * *width..][..*width]).copied().collect();
        }
    }

    /// The joints that move vertex `v`, with their weights, in the order in which they are added.
    pub fn influences_of(&self, v: usize) -> impl Iterator<Item = (u32, f32)> {
        self.influences.iter().flat_map(move |Influences { width, joints, weights }| {
            let range = v * width..(v + 1) * width;
            let pairs = joints[range.clone()].iter().zip(&weights[range]);
            pairs.map(|(&joint, &weight)| (joint, weight)).filter(|&(_, weight)| weight != 0.0)
        })
    }

    /// Poses all vertices into slices of their number. Morph weights that are missing are 0. What the weights or joints
    /// take to infinity is not finite; normals are unit vectors all the same.
    pub fn pose(
        &self,
        weights: &[f64],
        joints: &[DAffine3],
        positions: &mut [DVec3],
        normals: &mut [[f32; 3]],
        tangents: &mut [[f32; 4]],
    ) {
        /// Vertices per parallel task.
        const TASK: usize = 1024;
        let targets: Vec<(&Target, f64)> =
            self.targets.iter().zip(weights.iter().copied()).filter(|&(_, weight)| weight != 0.0).collect();
        let outputs = positions.par_iter_mut().zip(normals.par_iter_mut()).zip(tangents.par_iter_mut());
        outputs.enumerate().with_min_len(TASK).for_each(|(v, ((position, normal), tangent))| {
            let posed = self.vertex(v, &targets, joints);
            *position = posed.position;
            *normal = unit_vector(posed.normal).unwrap_or(DVec3::Y).as_vec3().to_array();
            let sign = self.tangents[v][3];
            *tangent = unit_vector(posed.tangent).map_or([0.0; 4], |t| t.as_vec3().extend(sign).to_array());
        });
        if self.flat {
            for (corners, normals) in positions.as_chunks::<3>().0.iter().zip(normals.as_chunks_mut::<3>().0) {
                let [a, b, c] = *corners;
                let normal = (b - a).cross(c - a).try_normalize().unwrap_or(DVec3::Y);
                *normals = [normal.as_vec3().to_array(); 3];
            }
        }
    }

    fn vertex(&self, v: usize, targets: &[(&Target, f64)], joints: &[DAffine3]) -> Vertex {
        let vector = |[x, y, z]: [f32; 3]| DVec3::new(x.into(), y.into(), z.into());
        let [x, y, z, _] = self.tangents[v];
        let mut vertex =
            Vertex { position: vector(self.positions[v]), normal: vector(self.normals[v]), tangent: vector([x, y, z]) };
        for (target, weight) in targets {
            let displace = |value: &mut DVec3, by: &[[f32; 3]]| {
                if let Some(&by) = by.get(v) {
                    *value += *weight * vector(by);
                }
            };
            displace(&mut vertex.position, &target.positions);
            displace(&mut vertex.normal, &target.normals);
            displace(&mut vertex.tangent, &target.tangents);
        }
        if self.influences.is_some() {
            let blend = blend(self.influences_of(v), joints);
            vertex.position = blend.transform_point3(vertex.position);
            let side = blend.matrix3.determinant().signum();
            vertex.normal = (cofactor(&blend.matrix3) * vertex.normal).normalize_or_zero() * side;
            vertex.tangent = blend.transform_vector3(vertex.tangent);
        }
        vertex
    }
}

/// Linear blend skinning: the weighted mean of joints. Weights that do not add up to 1 are scaled.
fn blend(influences: impl Iterator<Item = (u32, f32)>, joints: &[DAffine3]) -> DAffine3 {
    let mut sum = DAffine3 { matrix3: DMat3::ZERO, translation: DVec3::ZERO };
    let mut total = 0.0;
    for (joint, weight) in influences {
        let (joint, weight) = (&joints[joint as usize], f64::from(weight));
        sum.matrix3 += joint.matrix3 * weight;
        sum.translation += joint.translation * weight;
        total += weight;
    }
    DAffine3 { matrix3: sum.matrix3 * (1.0 / total), translation: sum.translation / total }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner() -> Section {
        Section {
            positions: vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]],
            normals: vec![[0.0, 0.0, 1.0]; 3],
            tangents: vec![[1.0, 0.0, 0.0, -1.0]; 3],
            ..Section::default()
        }
    }

    fn posed(section: &Section, weights: &[f64], joints: &[DAffine3]) -> (Vec<DVec3>, Vec<[f32; 3]>, Vec<[f32; 4]>) {
        let n = section.positions.len();
        let (mut p, mut m, mut t) = (vec![DVec3::ZERO; n], vec![[0.0; 3]; n], vec![[0.0; 4]; n]);
        section.pose(weights, joints, &mut p, &mut m, &mut t);
        (p, m, t)
    }

    #[test]
    fn blending() {
        let joints =
            [DAffine3::IDENTITY, DAffine3::from_translation(DVec3::X), DAffine3::from_scale(DVec3::splat(3.0))];
        let at = |influences: &[(u32, f32)]| blend(influences.iter().copied(), &joints).transform_point3(DVec3::Y);
        assert_eq!(at(&[(1, 0.5), (0, 0.5)]), DVec3::new(0.5, 1.0, 0.0));
        assert_eq!(at(&[(1, 2.0), (0, 2.0)]), DVec3::new(0.5, 1.0, 0.0), "weights are scaled");
        assert_eq!(at(&[(2, 1.0)]), DVec3::Y * 3.0);
    }

    #[test]
    fn targets_come_before_joints() {
        let up = Target { positions: vec![[0.0, 0.0, 2.0]; 3], ..Target::default() };
        let influences = Influences { width: 2, joints: vec![0, 7, 0, 7, 0, 7], weights: [1.0, 0.0].repeat(3) };
        let section = Section { targets: vec![Target::default(), up], influences: Some(influences), ..corner() };
        // A quarter turn about x takes z to -y, and the normal with it.
        let turn = DAffine3::from_rotation_x(std::f64::consts::FRAC_PI_2);
        let (positions, normals, tangents) = posed(&section, &[5.0, 0.5], &[turn]);
        assert!(positions[2].distance(DVec3::NEG_Y) < 1e-12, "{}", positions[2]);
        assert!(normals[0][1] == -1.0 && tangents[0] == [1.0, 0.0, 0.0, -1.0]);
        let (rest, ..) = posed(&section, &[], &[DAffine3::IDENTITY]);
        assert_eq!(rest[0], DVec3::X, "missing weights are 0");
    }

    #[test]
    fn flat_normals_follow_the_pose() {
        let tip = Target { positions: vec![[0.0; 3], [0.0, -1.0, 1.0], [0.0; 3]], ..Target::default() };
        let section = Section { flat: true, targets: vec![tip], ..corner() };
        assert_eq!(posed(&section, &[0.0], &[]).1, [[0.0, 0.0, 1.0]; 3]);
        assert_eq!(posed(&section, &[1.0], &[]).1, [[0.0, -1.0, 0.0]; 3]);
        let smooth = Section { flat: false, ..section };
        assert_eq!(posed(&smooth, &[1.0], &[]).1, [[0.0, 0.0, 1.0]; 3]);
    }

    #[test]
    fn gathering_takes_everything_along() {
        let tip = Target { positions: vec![[0.0; 3], [9.0; 3], [0.0; 3]], ..Target::default() };
        let influences = Influences { width: 2, joints: vec![0, 1, 2, 3, 4, 5], weights: vec![1.0; 6] };
        let mut section = Section { targets: vec![tip], influences: Some(influences), ..corner() };
        section.gather(&[1, 1, 2]);
        assert_eq!(section.positions, [[0.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0; 3]]);
        assert_eq!(section.targets[0].positions, [[9.0; 3], [9.0; 3], [0.0; 3]]);
        assert!(section.targets[0].normals.is_empty());
        assert_eq!(section.influences_of(1).collect::<Vec<_>>(), [(2, 1.0), (3, 1.0)]);
        assert_eq!(section.influences_of(2).collect::<Vec<_>>(), [(4, 1.0), (5, 1.0)]);
    }
}
