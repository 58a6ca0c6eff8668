//! Inputs that are small and deep: what planning them costs, and that no count of a batch wraps to "lit".

mod shapes;

use glam::{DAffine3, DVec3};
use shapes::Soup;
use std::f64::consts::TAU;
use zfail_plan::plan::{Caster, Counting, Frame, FramePlan, Planner, ShadowLight, Technique};
use zfail_plan::scene::LightKind;
use zfail_plan::topology::Topology;
use zfail_plan::view::{Projection, View};

/// A disc of so many triangles around its middle, its rim as high as `height` says of the angle.
fn disc(segments: u32, height: impl Fn(f64) -> f64) -> Soup {
    let rim = |i: u32| {
        let angle = TAU * f64::from(i) / f64::from(segments);
        DVec3::new(angle.cos(), height(angle), angle.sin()).as_vec3().to_array()
    };
    let positions = std::iter::once([0.0; 3]).chain((0..segments).map(rim)).collect();
    (positions, (0..segments).map(|i| [0, 1 + (i + 1) % segments, 1 + i]).collect())
}

/// Pages of a book that is bound in one point.
fn pages(count: u32) -> Soup {
    let mut positions = vec![[-1.0, 0.0, 0.0]];
    for i in 0..count {
        let y = 0.5 * i as f32 / count as f32;
        positions.extend([[1.0, y, 1.0], [1.0, y, -1.0]]);
    }
    (positions, (0..count).map(|i| [0, 2 * i + 1, 2 * i + 2]).collect())
}

fn lamp() -> LightKind {
    LightKind::Point { position: DVec3::new(0.2, 9.0, 0.1), range: f64::INFINITY }
}

fn sun() -> LightKind {
    LightKind::Directional { direction: DVec3::new(0.1, -1.0, 0.2).normalize() }
}

/// A tower of as many copies of a mesh, or a single one.
struct Tower {
    topology: Topology,
    places: Vec<DAffine3>,
    light: LightKind,
}

impl Tower {
    fn new(soup: &Soup, copies: u32, light: LightKind) -> Self {
        let place = |i| DAffine3::from_translation(DVec3::Y * f64::from(i) * 0.01);
        let topology = Topology::new(&soup.0, &soup.1, |_| true).unwrap();
        Self { topology, places: (0..copies).map(place).collect(), light }
    }

    fn triangles(&self) -> usize {
        self.topology.triangles.len() * self.places.len()
    }

    /// Everything is drawn, so that light caps tell what is in which batch.
    fn plan(&self) -> FramePlan {
        let casters: Vec<Caster<'_>> = self
            .places
            .iter()
            .map(|&world_from_object| Caster { topology: &self.topology, mesh: 1, world_from_object })
            .collect();
        let projection = Projection::Perspective { yfov: 1.0, near: 0.1, far: None };
        let view = View { world_from_view: DAffine3::from_translation(DVec3::Z * 20.0), projection, size: [320, 200] };
        let lights = [ShadowLight { kind: self.light, excluded: &[] }];
        let (measures, counting) = (Technique::EverittKilgard.into(), Counting::Verdict);
        let frame = Frame { view: &view, casters: &casters, lights: &lights, receivers: &[], measures, counting };
        let mut planner = Planner::new();
        planner.plan(&frame).unwrap();
        planner.last().clone()
    }

    /// How many layers of each batch are between the light and a point.
    fn counts(&self, plan: &FramePlan, point: DVec3) -> Vec<usize> {
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
fn is_dark(counts: &[usize]) -> bool {
    let bits = if counts.len() > 1 { 7 } else { 8 };
    counts.iter().any(|count| count % (1 << bits) != 0)
}

/// Points below everything.
fn below() -> impl Iterator<Item = DVec3> {
    (0..30).map(|i| {
        let (sin, cos) = (f64::from(i) * 2.4).sin_cos();
        DVec3::new(cos, 0.0, sin) * (f64::from(i) / 20.0) - DVec3::Y
    })
}

#[test]
fn small_deep_inputs_cost_little_and_never_wrap() {
    let flat = |segments| disc(segments, |_| 0.0);
    let mut stacked = flat(1000);
    for i in 1..300 {
        stacked = shapes::joined(stacked, flat(1000), [0.0, i as f32 * 0.01, 0.0]);
    }
    let deep = [
        ("instances of a disc", flat(1000), 300, 4),
        ("discs in one mesh", stacked, 1, 6),
        ("a fan", flat(50_000), 1, 1),
        ("a pleated fan", disc(50_000, |angle| 0.2 * (2_500.0 * angle).sin()), 1, 1),
        ("a heap of fans", disc(2_000, |angle| 0.1 * (9.0 * angle).sin()), 100, 1),
        ("pages", pages(1_000), 1, 16),
    ];
    for (name, soup, copies, most) in deep {
        for light in [lamp(), sun()] {
            let tower = Tower::new(&soup, copies, light);
            let plan = tower.plan();
            let (stats, batches) = (plan.lights[0].stats, plan.lights[0].batches.len());
            let triangles = tower.triangles() as u64;
            assert!(batches <= most, "{name}, {light:?}: {batches} batches");
            assert!(stats.searched < 100 * triangles + 100_000, "{name}, {light:?}: {} looked at", stats.searched);
            assert!(u64::from(stats.triangles.total()) < 8 * triangles, "{name}, {light:?}: {:?}", stats.triangles);
            let mut deepest = 0;
            for point in below() {
                let counts = tower.counts(&plan, point);
                let layers: usize = counts.iter().sum();
                assert_eq!(is_dark(&counts), layers > 0, "{name}, {light:?}, {point}: {counts:?}");
                deepest = deepest.max(layers);
            }
            assert!(deepest > 0, "{name}, {light:?}: no shadow");
        }
    }
}

/// What a bound that is too small would do: the pages stay in one batch, and where 256 of them lie over one another the
/// count is 0.
#[test]
fn a_bound_that_is_too_small_is_noticed() {
    let tower = Tower::new(&pages(256), 1, lamp());
    let mut plan = tower.plan();
    assert!(plan.lights[0].batches.len() > 1);
    let point = DVec3::new(0.5, -1.0, 0.0);
    let right = tower.counts(&plan, point);
    assert!(right.iter().sum::<usize>() == 256 && is_dark(&right), "{right:?}");
    let all = 0..plan.draws.len() as u32;
    plan.lights[0].batches = vec![all];
    assert!(!is_dark(&tower.counts(&plan, point)), "256 layers wrap to lit");
}
