//! Small deep inputs, their plans, and what the stencil would say. Fuzzing makes more of them from bytes.
#![allow(dead_code, missing_docs, reason = "tests and the fuzz target use a part of this each")]

use std::f64::consts::TAU;
use zfail_plan::glam::{DAffine3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::plan::{Caster, Counting, FramePlan, Input, Planner, ShadowLight, Technique};
use zfail_plan::topology::Topology;
use zfail_plan::view::{Projection, View};

type Soup = (Vec<[f32; 3]>, Vec<[u32; 3]>);

/// A disc of so many triangles around its middle, its rim as high as `height` says of the angle.
pub fn disc(segments: u32, height: impl Fn(f64) -> f64) -> Soup {
    let rim = |i: u32| {
        let angle = TAU * f64::from(i) / f64::from(segments);
        DVec3::new(angle.cos(), height(angle), angle.sin()).as_vec3().to_array()
    };
    let positions = std::iter::once([0.0; 3]).chain((0..segments).map(rim)).collect();
    (positions, (0..segments).map(|i| [0, 1 + (i + 1) % segments, 1 + i]).collect())
}

/// Pages of a book that is bound in one point.
pub fn pages(count: u32) -> Soup {
    let mut positions = vec![[-1.0, 0.0, 0.0]];
    for i in 0..count {
        let y = 0.5 * i as f32 / count as f32;
        positions.extend([[1.0, y, 1.0], [1.0, y, -1.0]]);
    }
    (positions, (0..count).map(|i| [0, 2 * i + 1, 2 * i + 2]).collect())
}

pub fn lamp() -> LightKind {
    LightKind::Point { position: DVec3::new(0.2, 9.0, 0.1), range: f64::INFINITY }
}

pub fn sun() -> LightKind {
    LightKind::Directional { direction: DVec3::new(0.1, -1.0, 0.2).normalize() }
}

/// A tower of as many copies of a mesh, or a single one.
pub struct Tower {
    topology: Topology,
    places: Vec<DAffine3>,
    light: LightKind,
}

impl Tower {
    pub fn new(soup: &Soup, copies: u32, light: LightKind) -> Self {
        let place = |i| DAffine3::from_translation(DVec3::Y * f64::from(i) * 0.01);
        let topology = Topology::new(&soup.0, &soup.1, |_| true).unwrap();
        Self { topology, places: (0..copies).map(place).collect(), light }
    }

    pub fn triangles(&self) -> usize {
        self.topology.triangles().len() * self.places.len()
    }

    /// Everything is drawn, so that light caps tell what is in which batch.
    pub fn plan(&self) -> FramePlan {
        let casters: Vec<Caster<'_>> = self
            .places
            .iter()
            .map(|&world_from_object| Caster { topology: &self.topology, mesh: 1, world_from_object })
            .collect();
        let projection = Projection::Perspective { yfov: 1.0, near: 0.1, far: None };
        let view = View::new(DAffine3::from_translation(DVec3::Z * 20.0), projection, [320, 200]);
        let lights = [ShadowLight::new(self.light)];
        let (steps, counting) = (Technique::EverittKilgard.into(), Counting::Verdict);
        let frame = Input { view: &view, casters: &casters, lights: &lights, receivers: &[], steps, counting };
        let mut planner = Planner::new();
        planner.plan(&frame).unwrap();
        planner.last().clone()
    }

    /// How many layers of each batch are between the light and a point.
    pub fn counts(&self, plan: &FramePlan, point: DVec3) -> Vec<usize> {
        let light = self.light.homogeneous();
        let to_light = light.truncate() - point * light.w;
        let crossed = |corners: [DVec3; 3]| {
            let p = corners.map(|corner| corner - point);
            let [a, b, c] = [0, 1, 2].map(|i| to_light.dot(p[i].cross(p[(i + 1) % 3])));
            let normal = (p[1] - p[0]).cross(p[2] - p[0]);
            let distance = normal.dot(p[0]) / normal.dot(to_light);
            (a > 0.0) == (b > 0.0) && (b > 0.0) == (c > 0.0) && distance > 0.0 && (light.w == 0.0 || distance < 1.0)
        };
        let batch = |draws: &std::ops::Range<u32>| {
            let mut layers = 0;
            for draw in &plan.draws[draws.start as usize..draws.end as usize] {
                let place = self.places[draw.caster as usize];
                for cap in [&draw.volume.light_cap, &draw.volume.light_cap_reversed] {
                    let indices = &plan.indices[cap.start as usize..cap.end as usize];
                    let corner = |i: u32| place.transform_point3(self.topology.position(i >> 1));
                    let triangles = indices.chunks_exact(3).map(|t| [corner(t[0]), corner(t[1]), corner(t[2])]);
                    layers += triangles.filter(|corners| crossed(*corners)).count();
                }
            }
            layers
        };
        plan.lights[0].batches.iter().map(batch).collect()
    }
}

/// What the stencil says after these batches: 8 bits, or where there are several 7 and a sticky one.
pub fn is_dark(counts: &[usize]) -> bool {
    let bits = if counts.len() > 1 { 7 } else { 8 };
    counts.iter().any(|count| count % (1 << bits) != 0)
}

/// Points below everything.
pub fn below() -> impl Iterator<Item = DVec3> {
    (0..10).map(|i| {
        let (sin, cos) = (f64::from(i) * 2.4).sin_cos();
        DVec3::new(cos, 0.0, sin) * (f64::from(i) / 7.0) - DVec3::Y
    })
}

/// Triangles over a few points, as bytes say: most of them share vertices and edges, many coincide.
fn soup(bytes: &[u8], points: usize) -> Soup {
    let point = |i: usize| {
        let at = |k: usize| f32::from(bytes[(3 * i + k) % bytes.len()] as i8) / 32.0;
        [at(0), at(1), at(2)]
    };
    let corner = |i: usize| u32::from(bytes[i % bytes.len()]) % points as u32;
    let triangle = |i: usize| [corner(3 * i), corner(3 * i + 1), corner(3 * i + 2)];
    ((0..points).map(point).collect(), (0..bytes.len() / 3).map(triangle).collect())
}

/// Plans what `bytes` describe. Panics where the search does not end soon, or counts wrap to "lit".
pub fn check(bytes: &[u8]) {
    let [kind, size, copies, light, rest @ ..] = bytes else { return };
    if rest.is_empty() {
        return;
    }
    let light = match light % 3 {
        0 => lamp(),
        1 => sun(),
        _ => LightKind::Point { position: DVec3::new(0.013, f64::from(*light) / 128.0, -0.021), range: f64::INFINITY },
    };
    let segments = 3 + 16 * u32::from(*size);
    let pleats = f64::from(rest[0]);
    let mesh = match kind % 4 {
        0 => soup(rest, 4 + usize::from(*size) % 60),
        1 => disc(segments, |_| 0.0),
        2 => disc(segments, |angle| 0.2 * (pleats * angle).sin()),
        _ => pages(segments),
    };
    let tower = Tower::new(&mesh, 1 + u32::from(*copies) % 32, light);
    let plan = tower.plan();
    let searched = plan.lights[0].stats.searched;
    assert!(searched <= 1 << 25, "{searched} looked at");
    assert!(plan.lights[0].batches.len() <= 1 + tower.triangles() / 60, "{} batches", plan.lights[0].batches.len());
    for point in below() {
        let counts = tower.counts(&plan, point);
        assert_eq!(is_dark(&counts), counts.iter().any(|count| *count > 0), "{point}: {counts:?}");
    }
}
