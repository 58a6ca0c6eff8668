//! Side quads as linear functions of the pixel.
//!
//! In: silhouette edges in object space. Out: for each, the functions by which a pixel decides on its own whether the
//! quad between the edge and infinity covers it and how deep it is there, and a footprint that holds all pixels for which
//! that can matter.
//!
//! A pixel is a direction `d = (x, y, 1)` in clip space without z, and the quad `b a X(a) X(b)` is the cone that its corners
//! span there, whatever the signs of their w: `d` is inside if it is on the inner side of the planes through the eye and
//! each edge (Olano & Greer 1997). The plane through `a X(a)` depends on `a` alone, so that neighbouring quads share it bit
//! for bit. The plane through `X(a) X(b)` is the horizon of the quad's plane, beyond which its depth is negative, so that
//! the comparison with the surface's depth stands in for the fourth edge.

use bytemuck::{Pod, Zeroable};
use glam::{DAffine3, DMat4, DVec2, DVec3, DVec4, Mat4, Vec4};
use zfail_plan::bounds::Bounds;
use zfail_plan::scissor::Rectangle;

/// The sides of one volume.
#[derive(Clone, Copy, Debug)]
pub struct Sides<'a> {
    /// Welded positions, object space.
    pub positions: &'a [[f32; 3]],
    /// The matrix of the depth pass.
    pub clip_from_object: Mat4,
    /// Object to world.
    pub world_from_object: DAffine3,
    /// Light in object space: `(position, 1)` or `(towards the light, 0)`.
    pub light: Vec4,
    /// The range [`zfail_plan::volume::Volume::sides`] of the index list.
    pub indices: &'a [u32],
    /// Whether the sides converge, as they were built by [`zfail_plan::volume::build`].
    pub converging: bool,
    /// Whether `world_from_object` mirrors, so that the outside is clockwise.
    pub mirrored: bool,
    /// The only pixels that the caster may darken: the whole image if its count at the near plane is not zero.
    pub scissor: Rectangle,
}

/// The texels of `quads` in `count.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(super) struct Quad {
    pub across: [f32; 4],
    pub down: [f32; 4],
    pub middle: [f32; 4],
    pub weight: [i32; 4],
}

/// One end of a silhouette edge.
struct Corner {
    clip: DVec4,
    /// Where the ray through it goes, a point at infinity.
    far: DVec4,
    /// When the ray leaves the visible space, in steps of `far`: through -x, -y, -z, +x, +y, +z.
    exits: [f64; 6],
}

/// A convex polygon in pixels, y down.
#[derive(Default)]
struct Footprint {
    points: [DVec2; 8],
    len: usize,
}

/// Where quads are looked at from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sight {
    /// World-space bounds of the eye and all that it sees.
    pub bounds: Bounds,
    /// Pixels across and down.
    pub size: DVec2,
}

impl Sight {
    /// Emits every quad of `sides` that is in sight, and its footprint.
    pub fn quads(&self, sides: &Sides<'_>, mut emit: impl FnMut(Quad, &[DVec2])) {
        let clip_from_object = sides.clip_from_object.as_dmat4();
        let mut rest = sides.indices.chunks_exact(if sides.converging { 3 } else { 6 }).peekable();
        while let Some(side) = rest.next() {
            // Edges of many triangles are repeated.
            let mut copies = 1;
            while rest.next_if_eq(&side).is_some() {
                copies += 1;
            }
            let [b, a] = [side[0], side[1]].map(|index| self.corner(sides, &clip_from_object, index >> 1));
            let Some(footprint) = self.footprint(&a, &b) else { continue };
            if let Some(quad) = self.quad(&a, &b, if sides.mirrored { -copies } else { copies }) {
                emit(quad, &footprint.points[..footprint.len]);
            }
        }
    }

    fn corner(&self, sides: &Sides<'_>, clip_from_object: &DMat4, vertex: u32) -> Corner {
        let position = DVec3::from(sides.positions[vertex as usize].map(f64::from));
        let light = sides.light.as_dvec4();
        let away = position * light.w - light.truncate();
        let start = sides.world_from_object.transform_point3(position);
        let way = sides.world_from_object.transform_vector3(away);
        let below = (self.bounds.min - start) / way;
        let above = (self.bounds.max - start) / way;
        let exit = |i: usize, towards: bool, t: DVec3| if towards { t[i] } else { f64::INFINITY };
        Corner {
            clip: clip_from_object * position.extend(1.0),
            far: clip_from_object * away.extend(0.0),
            exits: std::array::from_fn(|i| match i {
                0..3 => exit(i, way[i] < 0.0, below),
                _ => exit(i - 3, way[i - 3] > 0.0, above),
            }),
        }
    }

    /// `None` for a quad that is seen exactly edge-on, and where numbers overflow.
    fn quad(&self, a: &Corner, b: &Corner, weight: i32) -> Option<Quad> {
        let xyw = |c: DVec4| DVec3::new(c.x, c.y, c.w);
        let [pa, pb, xa, xb] = [a.clip, b.clip, a.far, b.far].map(xyw);
        let across = pb.cross(xa);
        let det = pa.dot(across);
        // The quad is wound b, a, X(a): det(b, a, X(a)) is the negative of this.
        let front = det < 0.0;
        // Where the quad begins, a rasteriser rounds the triangle that it continues to parts of a pixel. Following it there
        // would tear the quad from its neighbours, whose common edges have to begin in the same point.
        let edge = if front { pb.cross(pa) } else { pa.cross(pb) };
        let [to_a, to_b] = [pa.cross(xa), pb.cross(xb)].map(|f| self.unit(f));
        let [first, second] = if front { [to_a, to_b] } else { [to_b, to_a] };
        // On the quad's plane z is linear in x, y and w, so z/w is linear in x/w and y/w.
        let depth = (across * a.clip.z + xa.cross(pa) * b.clip.z + pa.cross(pb) * a.far.z) / det;
        let functions = [self.unit(edge), first, second, self.in_pixels(depth)].map(DVec3::as_vec3);
        functions.iter().all(|f| f.is_finite()).then(|| Quad {
            across: functions.map(|f| f.x),
            down: functions.map(|f| f.y),
            middle: functions.map(|f| f.z),
            weight: [if front { weight } else { -weight }, 0, 0, 0],
        })
    }

    /// A function of `(x, y, 1)` in normalised device coordinates as one of pixels from the middle of the image, y down.
    fn in_pixels(&self, f: DVec3) -> DVec3 {
        DVec3::new(f.x * 2.0 / self.size.x, f.y * -2.0 / self.size.y, f.z)
    }

    /// The same for a function of which only the sign matters: a distance in pixels.
    fn unit(&self, f: DVec3) -> DVec3 {
        let f = self.in_pixels(f);
        // Far off the image the gradient may vanish beside the constant.
        f / f.x.hypot(f.y).max(1e-12 * f.z.abs())
    }

    /// The part of the quad beyond the near plane and on the inner side of one plane of the bounds, the one that leaves
    /// least: what lies beyond that plane is never before something visible. `None` if there is nothing left.
    fn footprint(&self, a: &Corner, b: &Corner) -> Option<Footprint> {
        let both = |i: usize| a.exits[i].max(b.exits[i]);
        let exit = (0..6).min_by(|&i, &j| both(i).total_cmp(&both(j)))?;
        if both(exit) < 0.0 {
            return None;
        }
        let mut out = Footprint::default();
        if both(exit) == f64::INFINITY {
            // No plane ends both rays: the whole image.
            out.points[1..4].copy_from_slice(&[DVec2::new(self.size.x, 0.0), self.size, DVec2::new(0.0, self.size.y)]);
            out.len = 4;
            return Some(out);
        }
        // A little more, for what rounding takes away.
        let end = |c: &Corner| c.clip + c.far * (c.exits[exit].max(0.0) * (1.0 + 1e-6));
        let corners = [a.clip, b.clip, end(b), end(a)];
        // Depth is reversed: beyond the near plane z is less than w.
        let beyond = |c: &DVec4| c.w - c.z;
        let mut previous = corners[3];
        for corner in corners {
            let (s, t) = (beyond(&previous), beyond(&corner));
            if (s < 0.0) != (t < 0.0) {
                out.push(previous + (corner - previous) * (s / (s - t)), self.size);
            }
            if t >= 0.0 {
                out.push(corner, self.size);
            }
            previous = corner;
        }
        (out.len > 0).then_some(out)
    }
}

impl Footprint {
    fn push(&mut self, clip: DVec4, size: DVec2) {
        let ndc = DVec2::new(clip.x, -clip.y) / clip.w;
        self.points[self.len] = (ndc * 0.5 + 0.5) * size;
        self.len += 1;
    }
}

#[cfg(test)]
mod tests;
