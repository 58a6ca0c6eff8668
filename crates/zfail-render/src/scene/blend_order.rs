//! The triangles of blended surfaces from back to front, for one view.
//!
//! In: the scene's blended parts and the draws of a frame. Out: an index list in which a draw finds its triangles sorted by
//! the distance of their centroids along the view axis, equals in the order of the mesh.

use crate::scene::draw_list::{Draw, Part};
use std::collections::HashMap;
use zfail_plan::glam::{DVec3, Vec3};
use zfail_plan::view::View;
use zfail_scene::{Instance, Mesh};

/// Triangles that a frame sorts at most, those of the nearest surfaces first: more would cost more than drawing them.
/// Surfaces beyond are drawn as their mesh has them, inner sides first.
const SORTED: usize = 1 << 17;

/// Sorts triangles; its memory is kept from frame to frame.
#[derive(Clone, Debug, Default)]
pub struct BlendOrder {
    /// By mesh, object space; those with blended parts.
    positions: HashMap<usize, Vec<[f32; 3]>>,
    /// By part.
    triangles: HashMap<usize, Vec<[u32; 3]>>,
    keyed: Vec<(f32, u32)>,
    /// Of the frame, for the device.
    pub indices: Vec<[u32; 3]>,
}

impl BlendOrder {
    /// Keeps what it needs of `meshes`; `blended` are the blended ones of all parts, with their indices.
    pub fn new<'p>(meshes: &[Mesh], blended: impl Iterator<Item = (usize, &'p Part)>) -> Self {
        let mut order = Self::default();
        for (index, part) in blended {
            let mesh = &meshes[part.mesh];
            let range = part.indices.start as usize / 3..part.indices.end as usize / 3;
            if range.len() <= SORTED {
                order.positions.entry(part.mesh).or_insert_with(|| mesh.positions.clone());
                order.triangles.insert(index, mesh.triangles[range].to_vec());
            }
        }
        order
    }

    /// Fills [`Self::indices`] for `draws`, which go from the farthest to the nearest, and tells each where its triangles are.
    pub fn arrange(
        &mut self,
        view: &View,
        instances: &[Instance],
        order: &[usize],
        parts: &[Part],
        draws: &mut [Draw],
    ) {
        self.indices.clear();
        for draw in draws.iter_mut().rev() {
            draw.sorted = None;
            let Some(triangles) = self.triangles.get(&draw.part) else { continue };
            let Some(positions) = self.positions.get(&parts[draw.part].mesh) else { continue };
            if self.indices.len() + triangles.len() > SORTED {
                continue;
            }
            let back = view.world_from_view.matrix3.z_axis;
            let object = &instances[order[draw.slots.start as usize]].world_from_object.matrix3;
            let axis = DVec3::new(object.x_axis.dot(back), object.y_axis.dot(back), object.z_axis.dot(back)).as_vec3();
            self.keyed.clear();
            self.keyed.extend((0..).zip(triangles).map(|(t, corners)| {
                let sum: Vec3 = corners.iter().map(|&v| Vec3::from(positions[v as usize])).sum();
                (sum.dot(axis), t)
            }));
            self.keyed.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let start = 3 * self.indices.len() as u32;
            self.indices.extend(self.keyed.iter().map(|&(_, t)| triangles[t as usize]));
            draw.sorted = Some(start..3 * self.indices.len() as u32);
        }
    }
}
