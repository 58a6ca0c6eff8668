//! z-pass with volumes capped at the near plane: Diefenbach's thesis, 1996; Kilgard 2001; E&K section 2.2.2.
//!
//! Where the near plane cuts a volume, the cut is closed by polygons on that plane, so that its front is there to be
//! counted again. Here the CPU clips every triangle of the closed volume; each that crosses the plane leaves a segment on
//! it, and all segments of a volume together run around its cut. A triangle from the image's centre to each segment,
//! counted by its winding, covers the cut exactly, whatever its shape: on a plane, any fan over a closed line does.
//!
//! Drawn on the near plane itself, "the very near plane you are attempting to cap can clip your capping polygons" (E&K).
//! Kilgard's *near plane ledge* prevents that: all else is drawn with a depth range that leaves a little free in front,
//! and the caps go there.
//!
//! What stays wrong is "the inability to guarantee identical and bit-exact CPU and GPU floating-point computations"
//! (E&K): the device clips the same triangles by its own arithmetic, and where the two outlines differ by a fraction of a
//! pixel, pixels along them are counted once too often or not at all. Diefenbach's own cheaper method, which draws the
//! volume's faces once more instead of clipping them, fails for whole areas (E&K Figure 1) and is not repeated here.

use crate::Error;
use crate::geometry::Geometry;
use crate::procedure::{Pass, Procedure};
use crate::volumes::{Draw, Extrusion, Faces, Volumes};
use zfail_plan::glam::{DMat4, DVec2, DVec4};
use zfail_plan::view::View;
use zfail_scene::Light;

/// Closed volumes, and in front of them the caps of what the near plane cuts off.
pub fn procedure(geometry: &Geometry, view: &View, light: &Light) -> Result<Procedure, Error> {
    let volumes = Volumes::new(geometry, view, light, Extrusion::Infinite, Faces::All)?;
    let mut caps = Volumes::default();
    for draw in &volumes.draws {
        let instance = &geometry.instances[draw.placement as usize];
        let view_from_object = DMat4::from(view.view_from_object(&instance.world_from_object));
        let mut cap = Cap { clip_from_view: view.clip_from_view(), near: view.near(), caps: &mut caps };
        let corner = |&index: &u32| {
            let vertex = volumes.vertices[draw.first_vertex as usize + index as usize];
            view_from_object * DVec4::from_array(vertex.map(f64::from))
        };
        for (range, outward) in [(&draw.outward, !draw.mirrored), (&draw.inward, draw.mirrored)] {
            let indices = &volumes.indices[range.start as usize..range.end as usize];
            for triangle in indices.chunks_exact(3) {
                let [a, b, c] = [0, 1, 2].map(|i| corner(&triangle[i]));
                cap.close(if outward { [a, b, c] } else { [a, c, b] });
            }
        }
    }
    let indices = caps.vertices.len() as u32;
    caps.indices = (0..indices).collect();
    caps.draws.push(Draw {
        placement: geometry.identity(),
        first_vertex: 0,
        outward: 0..indices,
        inward: 0..0,
        mirrored: false,
        scissor: None,
    });
    let on_ledge = Pass { list: 1, on_ledge: true, ..Pass::Z_PASS };
    let (lists, passes) = (vec![volumes, caps], vec![Pass::Z_PASS, on_ledge]);
    Ok(Procedure { view: *view, start: 0, lists, passes, ledge: true, inverted: false })
}

/// Collects the triangles that close volumes, in clip space.
struct Cap<'v> {
    clip_from_view: DMat4,
    near: f64,
    caps: &'v mut Volumes,
}

impl Cap<'_> {
    /// Closes what the near plane leaves open of a triangle, homogeneous in view space, that is counter-clockwise seen from
    /// outside of its volume.
    fn close(&mut self, triangle: [DVec4; 3]) {
        let height = |p: DVec4| -p.z - self.near * p.w;
        let [mut entry, mut exit] = [None; 2];
        for (p, q) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (triangle[i], triangle[j])) {
            let (from, to) = (height(p), height(q));
            // From the kept end to the cut one, whichever triangle asks: neighbours find the same point to the bit.
            match (from > 0.0, to > 0.0) {
                (false, true) => entry = Some(self.on_ledge(p * to - q * from)),
                (true, false) => exit = Some(self.on_ledge(q * from - p * to)),
                _ => {}
            }
        }
        // The clipped triangle runs from its exit to its entry, so the cap runs back.
        if let (Some(entry), Some(exit)) = (entry, exit) {
            self.caps.vertices.extend([[0.0, 0.0, 0.5, 1.0], entry, exit]);
        }
    }

    /// A point of the near plane as a vertex in the middle of the ledge's depth; it may lie at infinity.
    fn on_ledge(&self, on_plane: DVec4) -> [f32; 4] {
        let clip = self.clip_from_view * on_plane;
        let scale = DVec2::new(clip.x, clip.y).abs().max_element().max(clip.w);
        let [x, y, w] = [clip.x, clip.y, clip.w].map(|c| if scale > 0.0 { (c / scale) as f32 } else { 0.0 });
        [x, y, 0.5 * w, w]
    }
}
