//! How many triangles a ray from the light can cross: a bound that keeps 8-bit stencil counts from wrapping to "lit".
//!
//! In: the casting triangles of a light's casters. Out: batches of them such that no ray crosses more than a given
//! number in any batch. Since weights may be restricted to any subset of triangles and still give a closed volume,
//! batches are drawn one after the other, each folded into a sticky stencil bit before the next.
//!
//! E&K section 3.1 and McGuire et al. section 4 ask for enough stencil bits instead.
//!
//! The bound is a quadtree over directions: a cell that at most `limit` triangles overlap is done, others are divided.
//! Overlap is decided conservatively, so the bound can only be too high, which costs time and never a pixel.

use glam::{DVec3, DVec4};

/// Triangles as cones of directions seen from the light: the rays from it that cross a triangle are exactly the
/// non-negative combinations of its three vectors.
pub type Cone = [DVec3; 3];

/// Divisions after which a cell counts as indivisible: about 10^-6 of a cube face.
const DEPTH: u32 = 20;

/// The cone of a triangle (`corners` relative to any origin shared by all) for a homogeneous light in the same space.
///
/// A directional light sees triangles in parallel projection; `frame` maps its plane to a bounded square.
#[must_use]
pub fn cone(corners: [DVec3; 3], light: DVec4, frame: &Frame) -> Cone {
    match frame {
        Frame::Sphere => corners.map(|p| p * light.w - light.truncate()),
        Frame::Plane { u, v, center, scale } => {
            corners.map(|p| DVec3::new((p.dot(*u) - center.0) * scale, (p.dot(*v) - center.1) * scale, 1.0))
        }
    }
}

/// How directions are parametrised.
#[derive(Clone, Debug)]
pub enum Frame {
    /// All directions from a point, on the faces of a cube.
    Sphere,
    /// Parallel rays, told apart by where they cross a plane.
    Plane {
        /// First axis of the plane.
        u: DVec3,
        /// Second axis of the plane.
        v: DVec3,
        /// Centre of the casters on the plane.
        center: (f64, f64),
        /// Scales the casters into -1..1.
        scale: f64,
    },
}

impl Frame {
    /// The frame for a homogeneous light and the bounding box of all casters.
    #[must_use]
    pub fn new(light: DVec4, bounds: &crate::scene::Bounds) -> Self {
        if light.w != 0.0 {
            return Self::Sphere;
        }
        let (u, v) = light.truncate().normalize_or(DVec3::Y).any_orthonormal_pair();
        let center = bounds.center();
        let radius = bounds.half().length();
        // Slightly inside the unit square, so that rounding pushes nothing over its border.
        let scale = if radius > 0.0 { 0.999 / radius } else { 1.0 };
        Self::Plane { u, v, center: (center.dot(u), center.dot(v)), scale }
    }

    fn faces(&self) -> usize {
        match self {
            Self::Sphere => 6,
            Self::Plane { .. } => 1,
        }
    }
}

/// Whether no ray crosses more than `limit` of `cones` (a "no" may be mistaken, a "yes" never is).
#[must_use]
pub fn is_within(cones: &[Cone], frame: &Frame, limit: usize) -> bool {
    if cones.len() <= limit {
        return true;
    }
    let mut stack = Vec::new();
    (0..frame.faces()).all(|face| {
        let turned: Vec<Cone> = cones.iter().map(|cone| cone.map(|h| turn(h, face))).collect();
        let root = Cell { x: [-1.0, 1.0], y: [-1.0, 1.0] };
        stack.clear();
        stack.extend((0..turned.len() as u32).filter(|&i| root.overlaps(&turned[i as usize])));
        let all = 0..stack.len();
        root.is_within(&turned, &mut stack, all, limit, DEPTH)
    })
}

/// Turns cube face `face` towards +z.
fn turn(h: DVec3, face: usize) -> DVec3 {
    match face {
        0 => h,
        1 => DVec3::new(-h.x, h.y, -h.z),
        2 => DVec3::new(h.y, h.z, h.x),
        3 => DVec3::new(-h.y, h.z, -h.x),
        4 => DVec3::new(h.z, h.x, h.y),
        _ => DVec3::new(-h.z, h.x, -h.y),
    }
}

/// A rectangle of the plane z = 1, standing for the pyramid of directions through it.
#[derive(Clone, Copy)]
struct Cell {
    x: [f64; 2],
    y: [f64; 2],
}

impl Cell {
    /// `members` of `stack` overlap this cell; children's members are pushed above them and popped again.
    fn is_within(
        &self,
        cones: &[Cone],
        stack: &mut Vec<u32>,
        members: std::ops::Range<usize>,
        limit: usize,
        depth: u32,
    ) -> bool {
        if members.len() <= limit {
            return true;
        }
        if depth == 0 {
            return false;
        }
        let (mx, my) = ((self.x[0] + self.x[1]) * 0.5, (self.y[0] + self.y[1]) * 0.5);
        [[self.x[0], mx], [mx, self.x[1]]].into_iter().all(|x| {
            [[self.y[0], my], [my, self.y[1]]].into_iter().all(|y| {
                let child = Self { x, y };
                let start = stack.len();
                for i in members.clone() {
                    if child.overlaps(&cones[stack[i] as usize]) {
                        stack.push(stack[i]);
                    }
                }
                let end = stack.len();
                let within = child.is_within(cones, stack, start..end, limit, depth - 1);
                stack.truncate(start);
                within
            })
        })
    }

    /// Whether a cone and this cell may share a direction: separating planes through the apex, with a margin.
    fn overlaps(&self, cone: &Cone) -> bool {
        const MARGIN: f64 = 1e-9;
        let planes = [
            DVec3::new(1.0, 0.0, -self.x[0]),
            DVec3::new(-1.0, 0.0, self.x[1]),
            DVec3::new(0.0, 1.0, -self.y[0]),
            DVec3::new(0.0, -1.0, self.y[1]),
            DVec3::Z,
        ];
        let size = cone.iter().map(|h| h.abs().max_element()).fold(0.0, f64::max);
        if planes.iter().any(|plane| cone.iter().all(|h| plane.dot(*h) < -MARGIN * size)) {
            return false;
        }
        let corners = [
            DVec3::new(self.x[0], self.y[0], 1.0),
            DVec3::new(self.x[1], self.y[0], 1.0),
            DVec3::new(self.x[0], self.y[1], 1.0),
            DVec3::new(self.x[1], self.y[1], 1.0),
        ];
        (0..3).all(|i| {
            let (a, b, c) = (cone[i], cone[(i + 1) % 3], cone[(i + 2) % 3]);
            let normal = a.cross(b);
            let normal = if normal.dot(c) < 0.0 { -normal } else { normal };
            let margin = MARGIN * normal.length();
            corners.iter().any(|corner| normal.dot(*corner) >= -margin)
        })
    }
}
