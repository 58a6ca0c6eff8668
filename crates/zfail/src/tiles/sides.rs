//! Side quads as linear functions of the pixel.
//!
//! In: silhouette edges in object space. Out: for each, the functions by which a pixel decides on its own whether the
//! quad between the edge and infinity lies before the visible surface, and a footprint that holds all such pixels.
//!
//! A point at a pixel is a direction `d = (x, y, 1)` in clip space without z, and a quad `b a X(a) X(b)` is the cone that
//! its corners span there, whatever the signs of their w (Olano & Greer 1997). `d` is inside when it is on the inner side
//! of the planes through the eye and each edge. The plane of `a X(a)` depends on `a` alone, so neighbouring quads share it
//! bit for bit; that of `X(a) X(b)` is the horizon, beyond which the quad's depth is not positive and no test is needed.

use bytemuck::{Pod, Zeroable};
use glam::{DAffine3, DMat4, DVec2, DVec3, DVec4, Mat4, Vec4};
use zfail_plan::scene::Bounds;

/// `Quad` of `count.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct Quad {
    dx: [f32; 4],
    dy: [f32; 4],
    origin: [f32; 4],
    weight: [i32; 4],
}

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
    /// Index list of the sides, as [`zfail_plan::volume`] builds it.
    pub indices: &'a [u32],
    /// Whether the transform mirrors, so that outside is clockwise.
    pub mirrored: bool,
}

/// What a quad needs of one end of its edge.
struct Corner {
    clip: DVec4,
    /// Point at infinity.
    far: DVec4,
    /// When the ray from here passes the planes of the bounds: -x, -y, -z, +x, +y, +z.
    exits: [f64; 6],
}

/// Turns sides into quads, for an image of `size` pixels.
pub(super) struct Setup<'a> {
    sides: Sides<'a>,
    clip_from_object: DMat4,
    /// World-space bounds of everything visible.
    bounds: Bounds,
    size: DVec2,
}

impl<'a> Setup<'a> {
    pub fn new(sides: Sides<'a>, bounds: Bounds, size: [u32; 2]) -> Self {
        let clip_from_object = sides.clip_from_object.as_dmat4();
        Self { sides, clip_from_object, bounds, size: DVec2::new(size[0].into(), size[1].into()) }
    }

    /// Emits every quad that can be seen, with its footprint; an empty footprint stands for the whole image.
    pub fn quads(&self, mut emit: impl FnMut(Quad, &[DVec2])) {
        let step = if self.sides.light.w == 0.0 { 3 } else { 6 };
        for side in self.sides.indices.chunks_exact(step) {
            let [b, a] = [side[0] >> 1, side[1] >> 1];
            let ends = [self.corner(b), self.corner(a)];
            let Some(quad) = self.quad(&ends) else { continue };
            let mut footprint = Footprint::default();
            if self.footprint(&ends, &mut footprint) {
                emit(quad, &footprint.points[..footprint.len]);
            }
        }
    }

    fn corner(&self, v: u32) -> Corner {
        let p = DVec3::from(self.sides.positions[v as usize].map(f64::from));
        let light = self.sides.light.as_dvec4();
        let away = p * light.w - light.truncate();
        let start = self.sides.world_from_object.transform_point3(p);
        let way = self.sides.world_from_object.transform_vector3(away);
        let mut exits = [f64::INFINITY; 6];
        for i in 0..3 {
            if way[i] < 0.0 {
                exits[i] = (self.bounds.min[i] - start[i]) / way[i];
            } else if way[i] > 0.0 {
                exits[i + 3] = (self.bounds.max[i] - start[i]) / way[i];
            }
        }
        Corner {
            clip: self.clip_from_object * p.extend(1.0),
            far: self.clip_from_object * away.extend(0.0),
            exits,
        }
    }

    fn quad(&self, [b, a]: &[Corner; 2]) -> Option<Quad> {
        let xyw = |c: DVec4| DVec3::new(c.x, c.y, c.w);
        let (pa, pb, xa, xb) = (xyw(a.clip), xyw(b.clip), xyw(a.far), xyw(b.far));
        let normals = [pb.cross(xa), xa.cross(pa), pa.cross(pb)];
        let det = pa.dot(normals[0]);
        if det == 0.0 {
            return None;
        }
        // det(b, a, X) = -det(a, b, X).
        let clockwise = det > 0.0;
        let ba = if clockwise { pa.cross(pb) } else { pb.cross(pa) };
        // z is linear in x, y, w on the quad's plane.
        let depth = (normals[0] * a.clip.z + normals[1] * b.clip.z + normals[2] * a.far.z) / det;
        let lines = [unit(ba, self.size), unit(pa.cross(xa), self.size), unit(pb.cross(xb), self.size)];
        let [p, m] = if clockwise { [lines[2], lines[1]] } else { [lines[1], lines[2]] };
        let functions = [lines[0], p, m, to_pixels(depth, self.size)];
        let quad = Quad {
            dx: functions.map(|f| f.x as f32),
            dy: functions.map(|f| f.y as f32),
            origin: functions.map(|f| f.z as f32),
            weight: [if clockwise == self.sides.mirrored { 1 } else { -1 }, 0, 0, 0],
        };
        functions.iter().all(|f| f.is_finite()).then_some(quad)
    }

    /// The part of the quad on the inner side of one plane of the bounds and of the near plane; false if there is none.
    fn footprint(&self, [b, a]: &[Corner; 2], out: &mut Footprint) -> bool {
        let exit = |i: &usize| a.exits[*i].max(b.exits[*i]);
        let (mut best, mut at) = (f64::INFINITY, 0);
        for i in 0..6 {
            if exit(&i) < best {
                best = exit(&i);
                at = i;
            }
        }
        if best <= 0.0 {
            return false;
        }
        if best == f64::INFINITY {
            return true;
        }
        let end = |c: &Corner| c.clip + c.far * c.exits[at].max(0.0) * (1.0 + 1e-6);
        let corners = [a.clip, b.clip, end(b), end(a)];
        // Reversed depth: z <= w is beyond the near plane.
        let inside = |c: &DVec4| c.w - c.z;
        let mut previous = corners[3];
        for c in corners {
            let (i, j) = (inside(&previous), inside(&c));
            if (i < 0.0) != (j < 0.0) {
                out.push(previous + (c - previous) * (i / (i - j)), self.size);
            }
            if j >= 0.0 {
                out.push(c, self.size);
            }
            previous = c;
        }
        out.len > 0
    }
}

/// A convex polygon in pixels.
#[derive(Default)]
struct Footprint {
    points: [DVec2; 8],
    len: usize,
}

impl Footprint {
    fn push(&mut self, c: DVec4, size: DVec2) {
        let ndc = DVec2::new(c.x, -c.y) / c.w;
        self.points[self.len] = (ndc * 0.5 + 0.5) * size;
        self.len += 1;
    }
}

/// A function of `(x, y, 1)` in normalised device coordinates as one of pixels from the middle of the image, y down.
fn to_pixels(f: DVec3, size: DVec2) -> DVec3 {
    DVec3::new(f.x * 2.0 / size.x, f.y * -2.0 / size.y, f.z)
}

/// The same for an edge, of which only the sign matters: with unit gradient.
fn unit(f: DVec3, size: DVec2) -> DVec3 {
    let f = to_pixels(f, size);
    f / f.x.hypot(f.y).max(f.z.abs() * 1e-30)
}
impl Quad {
    pub fn eval(&self, u: f32, v: f32) -> [f32; 4] {
        std::array::from_fn(|i| self.dx[i] * u + (self.dy[i] * v + self.origin[i]))
    }
}
