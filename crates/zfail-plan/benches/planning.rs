//! What the CPU does: topology at registration, then facing, silhouette and a whole plan per frame.
//!
//! Tori of 10^3 to 10^6 triangles: closed, embedded, with a silhouette that grows as the square root.

#[path = "../tests/all/shapes/mod.rs"]
mod shapes;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::{DAffine3, DVec3, Vec4};
use std::hint::black_box;
use zfail_plan::casting::{self, Casting};
use zfail_plan::light::LightKind;
use zfail_plan::plan::{Caster, Counting, Input, Planner, ShadowLight, Technique};
use zfail_plan::topology::Topology;
use zfail_plan::view::{Projection, View};
use zfail_plan::volume;

/// Rings and segments of the tori.
const SIZES: [(u32, u32); 4] = [(32, 16), (100, 50), (320, 160), (1000, 500)];

fn meshes() -> impl Iterator<Item = (shapes::Soup, u64)> {
    SIZES.into_iter().map(|(n, m)| (shapes::torus(n, m, 0.4), u64::from(n * m * 2)))
}

fn topology(c: &mut Criterion) {
    let mut group = c.benchmark_group("topology");
    group.sample_size(10);
    for ((positions, triangles), count) in meshes() {
        group.throughput(Throughput::Elements(count));
        group.bench_function(BenchmarkId::from_parameter(count), |b| {
            b.iter(|| Topology::new(black_box(&positions), &triangles, |_| true));
        });
    }
}

fn silhouette(c: &mut Criterion) {
    let mut group = c.benchmark_group("silhouette");
    group.sample_size(20);
    let light = Vec4::new(3.0, 4.0, 1.0, 1.0);
    for ((positions, triangles), count) in meshes() {
        let topology = Topology::new(&positions, &triangles, |_| true).expect("valid mesh");
        let (mut weights, mut indices) = (Vec::new(), Vec::new());
        group.throughput(Throughput::Elements(count));
        group.bench_function(BenchmarkId::from_parameter(count), |b| {
            b.iter(|| {
                casting::weights(&topology, &[Casting::Front], black_box(light), &mut weights);
                indices.clear();
                volume::build(&topology, &weights, &weights, false, &mut indices)
            });
        });
    }
}

fn plan(c: &mut Criterion) {
    let mut group = c.benchmark_group("plan");
    group.sample_size(20);
    let projection = Projection::Perspective { yfov: 1.0, near: 0.1, far: None };
    let view = View::new(DAffine3::IDENTITY, projection, [1280, 720]);
    let (positions, triangles) = shapes::torus(100, 50, 0.4);
    let topology = Topology::new(&positions, &triangles, |_| true).expect("valid mesh");
    for (name, moving) in [("still", false), ("moving light", true)] {
        let casters: Vec<Caster<'_>> = (0..64)
            .map(|i| {
                let at = DVec3::new(f64::from(i % 8), 0.0, f64::from(i / 8)) * 4.0;
                Caster { topology: &topology, mesh: 1, world_from_object: DAffine3::from_translation(at) }
            })
            .collect();
        let mut planner = Planner::new();
        let mut time = 0.0;
        group.bench_function(BenchmarkId::new("64 tori of 10k triangles", name), |b| {
            b.iter(|| {
                time += if moving { 0.01 } else { 0.0 };
                let kind = LightKind::Point { position: DVec3::new(14.0 + time, 9.0, 14.0), range: f64::INFINITY };
                let lights = [ShadowLight::new(kind)];
                let frame = Input {
                    view: &view,
                    casters: &casters,
                    lights: &lights,
                    receivers: &[],
                    steps: Technique::Auto.into(),
                    counting: Counting::Verdict,
                };
                planner.plan(&frame).map(|plan| plan.draws.len()).expect("plan")
            });
        });
    }
}

criterion_group!(benches, topology, silhouette, plan);
criterion_main!(benches);
