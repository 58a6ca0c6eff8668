//! Which way every triangle casts: one integer weight per triangle and light.
//!
//! In: a topology and the light in object space. Out: `c_t` in {-1, 0, +1} relative to the stored winding. Facing is
//! decided here, once; silhouette and caps follow from the weights by integer arithmetic, so that a doubtful facing
//! can never open a volume.
//!
//! With `s_t` the side of the triangle that faces the light (+1 front, -1 back, 0 edge-on), the count at a point is
//! - front-facing triangles crossed for `c = [s > 0]`, the casting of E&K and McGuire et al.,
//! - back-facing triangles crossed for `c = -[s < 0]`,
//! - all triangles crossed for `c = s` (Kim, Kim & Turk 2008).
//!
//! The last is always exact. On a solid the three agree on what is dark as long as the one layer counted is never
//! outnumbered: crossings of front minus back faces between light and point are the difference of their winding
//! numbers, so front faces suffice where the light's winding number is the least there is, back faces where it is the
//! greatest.

use crate::light::LightKind;
use crate::parallel;
use crate::topology::{NONE, Shape, Topology};
use glam::{DMat3, DVec3, DVec4, Vec4};

/// A light in a caster's object space, rounded to the f32 with which the GPU extrudes: `(position, 1)` or
/// `(direction towards the light, 0)`.
pub type ObjectLight = Vec4;

/// The light in the object space of a caster at `origin` (world space) whose directions `object_from_world` turns; computed
/// in f64 and rounded once. `None` if it is not finite, as for a transform that cannot be inverted.
#[must_use]
pub fn object_light(kind: &LightKind, object_from_world: &DMat3, origin: DVec3) -> Option<ObjectLight> {
    let light = kind.homogeneous();
    let to_object = *object_from_world * (light.truncate() - origin * light.w);
    // Only the direction of a directional light matters; its length must not overflow f32.
    let to_object = if light.w == 0.0 { to_object.try_normalize()? } else { to_object };
    let rounded = to_object.extend(light.w).as_vec4();
    rounded.is_finite().then_some(rounded)
}

/// Which faces of a part cast.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Casting {
    /// The faces whose front the light sees: a single layer.
    Front,
    /// The faces whose back the light sees: a single layer.
    Back,
    /// Every face.
    Double,
}

impl Casting {
    /// The casting of a part around which the light has the given winding number (`None`: undecided).
    #[must_use]
    pub fn of(shape: Shape, light_winding: Option<i32>) -> Self {
        match (shape, light_winding) {
            (Shape::Solid { inside }, Some(winding)) => match i32::from(inside) {
                1 if winding == 0 => Self::Front,
                1 if winding == 1 => Self::Back,
                -1 if winding == -1 => Self::Front,
                -1 if winding == 0 => Self::Back,
                _ => Self::Double,
            },
            _ => Self::Double,
        }
    }

    /// Weight of a triangle with facing `s`.
    #[must_use]
    pub fn weight(self, s: i8) -> i8 {
        match self {
            Self::Front => i8::from(s > 0),
            Self::Back => -i8::from(s < 0),
            Self::Double => s,
        }
    }
}

/// The casting of every part of `topology` for `light`.
pub fn castings(topology: &Topology, light: ObjectLight, out: &mut Vec<Casting>) {
    out.clear();
    out.extend((0..topology.parts.len()).map(|part| {
        let shape = topology.parts[part].shape;
        // A directional light is infinitely far, outside of everything.
        let winding = match shape {
            Shape::Solid { .. } if light.w == 0.0 => Some(0),
            Shape::Solid { .. } => topology.winding_number(part, light.truncate().as_dvec3()),
            _ => None,
        };
        Casting::of(shape, winding)
    }));
}

/// Weights of all triangles, in parallel for large meshes.
pub fn weights(topology: &Topology, castings: &[Casting], light: ObjectLight, out: &mut Vec<i8>) {
    /// Triangles per parallel task: large enough that scheduling does not show.
    const TASK: usize = 4096;
    out.clear();
    out.resize(topology.triangles.len(), 0);
    let light = light.as_dvec4();
    let fill = |first: usize, weights: &mut [i8]| {
        for (t, weight) in (first..).zip(weights) {
            let part = topology.part_of[t];
            if part != NONE {
                *weight = castings[part as usize].weight(facing(topology.corners(t), light));
            }
        }
    };
    parallel::for_each_piece(out, TASK, fill);
}

/// Which side of a counter-clockwise triangle faces the homogeneous `light`: +1 front, -1 back, 0 edge-on within
/// rounding (McGuire et al. let zero face away; here it casts nothing at all, which is safe for the same reason).
#[must_use]
pub fn facing([a, b, c]: [DVec3; 3], light: DVec4) -> i8 {
    /// Far above the rounding of f64, far below anything that f32 positions can express.
    const DEAD_ZONE: f64 = 1.0 / (1_u64 << 44) as f64;
    let normal = (b - a).cross(c - a);
    let to_light = light.truncate() - a * light.w;
    let g = normal.dot(to_light);
    if g * g <= DEAD_ZONE * DEAD_ZONE * normal.length_squared() * to_light.length_squared() {
        0
    } else if g > 0.0 {
        1
    } else {
        -1
    }
}
