//! How many triangles a ray from the light can cross: a bound that keeps 8-bit stencil counts from wrapping to "lit".
//!
//! In: the casting triangles of a light's casters. Out: batches of them such that no ray crosses more than a given
//! number in any batch. Since weights may be restricted to any subset of triangles and still give a closed volume,
//! batches are drawn one after the other, each folded into a sticky stencil bit before the next.
//!
//! E&K section 3.1 and McGuire et al. section 4 ask for enough stencil bits instead.
//!
//! The bound is a quadtree over directions: a cell that at most `limit` triangles overlap is done, others are divided. Whole
//! bodies whose layers are known can stand for their triangles, where they are many.
//! Overlap is decided conservatively, so the bound can only be too high, which costs time and never a pixel.

use glam::{DVec3, DVec4};

/// Triangles as cones of directions seen from the light: the rays from it that cross a triangle are exactly the
/// non-negative combinations of its three vectors.
pub type Cone = [DVec3; 3];

/// Relative error of a direction, far above that of f64.
const MARGIN: f64 = 1e-9;

/// Divisions after which a cell counts as indivisible: about 10^-6 of a cube face.
const DEPTH: u32 = 20;

/// The cone of a triangle (`corners` relative to any origin shared by all) for a homogeneous light in the same space.
///
/// A directional light sees triangles in parallel projection; `frame` maps its plane to a bounded square.
#[must_use]
pub fn cone(corners: [DVec3; 3], light: DVec4, frame: &Frame) -> Cone {
    corners.map(|p| frame.direction(p, light))
}

/// A body as seen from the light.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    directions: [DVec3; 8],
    /// How many of its layers a ray from the light can cross.
    layers: usize,
}

impl Body {
    /// A body within the hull of `corners`, of which no ray crosses more than so many layers.
    #[must_use]
    pub fn new(corners: [DVec3; 8], layers: usize, light: DVec4, frame: &Frame) -> Self {
        Self { directions: corners.map(|p| frame.direction(p, light)), layers }
    }
}

/// What rays from the light may cross.
pub trait Obstacle {
    /// With all directions turned from cube face `face` towards +z.
    #[must_use]
    fn turned(&self, face: usize) -> Self;
    /// Whether it may share a direction with a cell.
    fn overlaps(&self, cell: &Cell) -> bool;
    /// How often one ray can cross it.
    fn layers(&self) -> usize;
}

impl Obstacle for Cone {
    fn turned(&self, face: usize) -> Self {
        self.map(|h| turn(h, face))
    }

    fn overlaps(&self, cell: &Cell) -> bool {
        cell.overlaps(self)
    }

    fn layers(&self) -> usize {
        1
    }
}

impl Obstacle for Body {
    fn turned(&self, face: usize) -> Self {
        Self { directions: self.directions.map(|h| turn(h, face)), layers: self.layers }
    }

    fn overlaps(&self, cell: &Cell) -> bool {
        !cell.is_beside(&self.directions)
    }

    fn layers(&self) -> usize {
        self.layers
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

    /// Where a ray from the light through `p` goes, in homogeneous coordinates of the frame.
    fn direction(&self, p: DVec3, light: DVec4) -> DVec3 {
        match self {
            Self::Sphere => p * light.w - light.truncate(),
            Self::Plane { u, v, center, scale } => {
                DVec3::new((p.dot(*u) - center.0) * scale, (p.dot(*v) - center.1) * scale, 1.0)
            }
        }
    }

    fn faces(&self) -> usize {
        match self {
            Self::Sphere => 6,
            Self::Plane { .. } => 1,
        }
    }
}

/// Whether no ray crosses more than `limit` layers of `obstacles` (a "no" may be mistaken, a "yes" never is).
#[must_use]
pub fn is_within<O: Obstacle>(obstacles: &[O], frame: &Frame, limit: usize) -> bool {
    if obstacles.iter().map(O::layers).sum::<usize>() <= limit {
        return true;
    }
    let mut stack = Vec::new();
    (0..frame.faces()).all(|face| {
        let turned: Vec<O> = obstacles.iter().map(|obstacle| obstacle.turned(face)).collect();
        let root = Cell { x: [-1.0, 1.0], y: [-1.0, 1.0] };
        stack.clear();
        stack.extend((0..turned.len() as u32).filter(|&i| turned[i as usize].overlaps(&root)));
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
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    x: [f64; 2],
    y: [f64; 2],
}

impl Cell {
    /// `members` of `stack` overlap this cell; children's members are pushed above them and popped again.
    fn is_within<O: Obstacle>(
        &self,
        obstacles: &[O],
        stack: &mut Vec<u32>,
        members: std::ops::Range<usize>,
        limit: usize,
        depth: u32,
    ) -> bool {
        if stack[members.clone()].iter().map(|&i| obstacles[i as usize].layers()).sum::<usize>() <= limit {
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
                    if obstacles[stack[i] as usize].overlaps(&child) {
                        stack.push(stack[i]);
                    }
                }
                let end = stack.len();
                let within = child.is_within(obstacles, stack, start..end, limit, depth - 1);
                stack.truncate(start);
                within
            })
        })
    }

    /// Whether all `directions` lie beside the cell, on one side.
    fn is_beside(&self, directions: &[DVec3]) -> bool {
        let planes = [
            DVec3::new(1.0, 0.0, -self.x[0]),
            DVec3::new(-1.0, 0.0, self.x[1]),
            DVec3::new(0.0, 1.0, -self.y[0]),
            DVec3::new(0.0, -1.0, self.y[1]),
            DVec3::Z,
        ];
        let size = directions.iter().map(|h| h.abs().max_element()).fold(0.0, f64::max);
        planes.iter().any(|plane| directions.iter().all(|h| plane.dot(*h) < -MARGIN * size))
    }

    /// Whether a cone and this cell may share a direction: separating planes through the apex, with a margin.
    fn overlaps(&self, cone: &Cone) -> bool {
        if self.is_beside(cone) {
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
