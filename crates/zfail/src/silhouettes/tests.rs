//! The device's lists hold what the planner's would, and are closed.

use super::*;
use crate::shadows::volume_layout;
use bytemuck::Zeroable;
use glam::{DVec4, Vec4};
use std::collections::BTreeMap;
use wgpu::{BufferDescriptor, MapMode, PollType};
use zfail_plan::casting;
use zfail_plan::topology::{NONE, Topology};
use zfail_plan::volume::{self, Volume};
use zfail_testing::Random;

/// Triangles of the three lists, in ascending order.
type Triangles = [Vec<[u32; 3]>; 3];

fn device() -> Option<(Device, Queue)> {
    // With the least that WebGPU promises.
    let raw = zfail_testing::gpu(zfail_testing::device(|_| wgpu::DeviceDescriptor::default()))?;
    Some((raw.device, raw.queue))
}

/// A closed ring around y, with a fin on one of its edges and a sheet beside it.
fn ring() -> Topology {
    let (n, m) = (40, 24);
    let angle = |i: u32, n: u32| f64::from(i % n) / f64::from(n) * std::f64::consts::TAU;
    let at = |i: u32, j: u32| (i % n) * m + j % m;
    let grid = || (0..n).flat_map(|i| (0..m).map(move |j| (i, j)));
    let vertex = |(i, j)| {
        let (u, v) = (angle(i, n), angle(j, m));
        let r = 1.0 + 0.4 * v.cos();
        DVec3::new(r * u.cos(), 0.4 * v.sin(), r * u.sin()).as_vec3().to_array()
    };
    let quad = |(i, j)| [[at(i, j), at(i, j + 1), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i + 1, j)]];
    let mut positions: Vec<[f32; 3]> = grid().map(vertex).collect();
    let mut triangles: Vec<[u32; 3]> = grid().flat_map(quad).collect();
    let fin = positions.len() as u32;
    positions.extend([[2.0, 0.9, 0.1], [3.0, 0.1, 0.2], [4.0, 0.3, 0.1], [3.5, 1.0, 0.9], [3.4, -1.0, 0.4]]);
    // Wound alike, so that their common edge counts twice.
    triangles.extend([[at(0, 0), at(0, 1), fin], [fin + 1, fin + 2, fin + 3], [fin + 1, fin + 2, fin + 4]]);
    Topology::new(&positions, &triangles, |t| t != 7).expect("mesh")
}

/// Triangles over few vertices: edges with many triangles, in all orders.
fn soup(seed: u64) -> Topology {
    let mut random = Random(seed);
    let positions: Vec<[f32; 3]> = (0..14).map(|_| random.vector(0.5).as_vec3().to_array()).collect();
    let triangles: Vec<[u32; 3]> = (0..300).map(|_| [(); 3].map(|()| random.below(14) as u32)).collect();
    Topology::new(&positions, &triangles, |_| true).expect("mesh")
}

fn castings(topology: &Topology, light: Vec4) -> Vec<Casting> {
    let mut castings = Vec::new();
    casting::castings(topology, light, &mut castings);
    castings
}

/// What the planner would list, if `dark_cap` is not a fan.
fn expected(topology: &Topology, light: Vec4, castings: &[Casting]) -> Triangles {
    let (mut weights, mut indices) = (Vec::new(), Vec::new());
    casting::weights(topology, castings, light, &mut weights);
    let volume = volume::build(topology, &weights, &weights, light.w == 0.0, &mut indices);
    [volume.sides.start..volume.dark_cap.end, volume.light_cap, volume.light_cap_reversed].map(|range| {
        let list = &indices[range.start as usize..range.end as usize];
        sorted(list)
    })
}

fn sorted(list: &[u32]) -> Vec<[u32; 3]> {
    let mut triangles: Vec<[u32; 3]> = list.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
    triangles.sort_unstable();
    triangles
}

fn read(device: &Device, queue: &Queue, buffer: &Buffer) -> Vec<u32> {
    let usage = BufferUsages::MAP_READ | BufferUsages::COPY_DST;
    let copy =
        device.create_buffer(&BufferDescriptor { label: None, size: buffer.size(), usage, mapped_at_creation: false });
    let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor::default());
    encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, buffer.size());
    queue.submit([encoder.finish()]);
    copy.slice(..).map_async(MapMode::Read, |result| result.expect("map"));
    device.poll(PollType::wait_indefinitely()).expect("poll");
    let mapped = copy.slice(..).get_mapped_range().expect("mapped");
    bytemuck::pod_collect_to_vec(&mapped)
}

/// A device with one mesh of interest, not the first in its buffer.
struct Bench<'a> {
    device: &'a Device,
    queue: &'a Queue,
    arena: Arena,
    slot: usize,
    serial: u64,
    silhouettes: Silhouettes,
    volume: BindGroupLayout,
}

impl<'a> Bench<'a> {
    fn new((device, queue): &'a (Device, Queue), topology: &Topology) -> Self {
        let mut arena = Arena::new(device);
        arena.add(device, queue, soup(1)).expect("room");
        let (slot, serial, _) = arena.add(device, queue, topology.clone()).expect("room");
        let volume = volume_layout(device);
        Self { device, queue, arena, slot, serial, silhouettes: Silhouettes::new(device), volume }
    }

    fn mesh(&self) -> &Mesh {
        self.arena.get(self.slot, self.serial).expect("mesh")
    }

    /// Changes what the device knows of the mesh.
    fn tamper(&mut self, tamper: impl FnOnce(&mut Incidence)) {
        let mut incidence = Incidence::new(&self.mesh().topology);
        tamper(&mut incidence);
        self.silhouettes.meshes.insert(self.serial, MeshBuffers::of(self.device, incidence));
    }

    /// What the device lists.
    fn listed(&mut self, light: Vec4, castings: &[Casting], dark_cap: DarkCap) -> Triangles {
        let extraction = Extraction {
            light: 3,
            mesh: self.mesh().version,
            castings: 0..castings.len() as u32,
            sides: true,
            dark_cap,
            light_cap: LightCap::Whole,
        };
        let draw = Draw {
            caster: 5,
            light,
            reach: 0.0,
            z_pass: false,
            near_layers: 0,
            scissor: [0; 4],
            volume: Volume::default(),
            extraction: Some(extraction),
            mirrored: false,
        };
        let plan = FramePlan { castings: castings.to_vec(), draws: vec![draw], ..FramePlan::default() };
        let (arena, slot, serial) = (&self.arena, self.slot, self.serial);
        let caster = |_: &Draw| Some((arena.get(slot, serial)?, DrawRecord::zeroed()));
        self.silhouettes.extract(self.device, self.queue, &self.volume, arena, &plan, caster);
        let lists = &self.silhouettes.lists[&(3, 5)];
        let [indices, draws] = [&lists.indices, &lists.draws].map(|buffer| read(self.device, self.queue, buffer));
        [0, 1, 2].map(|list| {
            let &[count, instances, first, base, first_instance] = &draws[5 * list..5 * list + 5] else {
                unreachable!()
            };
            assert_eq!([instances, base, first_instance], [1, 2 * self.mesh().first, 0]);
            sorted(&indices[first as usize..(first + count) as usize])
        })
    }
}

/// Edges of a volume that are not traversed as often one way as the other.
fn open_edges([extruded, lit, reversed]: &Triangles, converging: bool) -> usize {
    let mut edges = BTreeMap::<[u32; 2], i32>::new();
    // Where sides converge, all extruded vertices are one.
    let point = |v: u32| if converging && v & 1 == 1 { 1 } else { v };
    let outward = extruded.iter().chain(lit).copied();
    for [a, b, c] in outward.chain(reversed.iter().map(|&[a, b, c]| [a, c, b])) {
        for [from, to] in [[a, b], [b, c], [c, a]].map(|edge| edge.map(point)) {
            *edges.entry([from.min(to), from.max(to)]).or_default() += if from < to { 1 } else { -1 };
        }
    }
    edges.iter().filter(|([a, b], sum)| a != b && **sum != 0).count()
}

const LIGHTS: [Vec4; 3] =
    [Vec4::new(1.3, 5.1, 2.7, 1.0), Vec4::new(0.31, 0.83, 0.47, 0.0), Vec4::new(0.93, 0.17, -0.21, 1.0)];

#[test]
fn the_device_lists_what_the_planner_lists() {
    let Some(device) = device() else { return };
    for (m, topology) in [ring(), soup(2), soup(3)].iter().enumerate() {
        for light in LIGHTS {
            let dark_cap = if light.w == 0.0 { DarkCap::None } else { DarkCap::Triangles };
            let mut castings = castings(topology, light);
            for round in 0..3 {
                let expected = expected(topology, light, &castings);
                let found = Bench::new(&device, topology).listed(light, &castings, dark_cap);
                assert!(!expected[0].is_empty() && expected[1].len() + expected[2].len() > 50);
                assert_eq!(found, expected, "mesh {m}, {light}, round {round}");
                // Any casting will do, be it from the back.
                castings.fill([Casting::Back, Casting::Double][round.min(1)]);
            }
        }
    }
}

#[test]
fn volumes_of_the_device_are_closed() {
    let Some(device) = device() else { return };
    for topology in [ring(), soup(2)] {
        for light in LIGHTS {
            for dark_cap in if light.w == 0.0 { &[DarkCap::None][..] } else { &[DarkCap::Triangles, DarkCap::Fan] } {
                let castings = castings(&topology, light);
                let open = |tamper: fn(&mut Incidence)| {
                    let mut bench = Bench::new(&device, &topology);
                    bench.tamper(tamper);
                    open_edges(&bench.listed(light, &castings, *dark_cap), light.w == 0.0)
                };
                assert_eq!(open(|_| {}), 0, "{light}, {dark_cap:?}");
                // The negative controls: one edge forgotten, edges turned round, triangles taken for others.
                let lost: [fn(&mut Incidence); 3] = [
                    |incidence| {
                        // A border is a silhouette edge under any light.
                        let border = incidence.edges.iter_mut().find(|edge| edge[3] == NONE).expect("an open mesh");
                        border[3] = border[2] ^ HIGH_BIT;
                    },
                    |incidence| incidence.edges[..incidence.pairs].iter_mut().for_each(|edge| edge[2] ^= HIGH_BIT),
                    |incidence| incidence.edges[..incidence.pairs].iter_mut().for_each(|edge| edge[2] ^= 2),
                ];
                for (i, lost) in lost.into_iter().enumerate().filter(|_| topology.edge_counts()[1] > 100) {
                    assert!(open(lost) > 0, "{light}, {dark_cap:?}: fault {i} goes unnoticed");
                }
            }
        }
    }
}

/// Incidence stays, silhouettes follow the positions; and what does not change is not listed again.
#[test]
fn lists_follow_vertices_that_move() {
    let Some(device) = device() else { return };
    let rigid = ring();
    let alike: Vec<u32> = (0..rigid.positions().len() as u32).collect();
    let topology = Topology::bending(rigid.positions(), rigid.triangles(), &alike, |_| true).expect("mesh");
    let (mut bench, light) = (Bench::new(&device, &topology), LIGHTS[0]);
    let castings = castings(&topology, light);
    let mut before = bench.listed(light, &castings, DarkCap::Triangles);
    for turn in 1..4 {
        assert_eq!(bench.listed(light, &castings, DarkCap::Triangles), before);
        assert!(bench.silhouettes.stale.is_empty(), "nothing has moved");
        let bent: Vec<[f32; 3]> =
            rigid.positions().iter().map(|&[x, y, z]| [x, y + 0.3 * turn as f32 * x * x, z]).collect();
        bench.arena.move_vertices(&device.1, bench.slot, bench.serial, &bent).expect("as many positions");
        let now = bench.listed(light, &castings, DarkCap::Triangles);
        assert_eq!(now, expected(&bench.mesh().topology, light, &castings), "turn {turn}");
        assert_ne!(now, before, "another pose has another silhouette");
        before = now;
    }
}

const HIGH_BIT: u32 = 1 << 31;

#[test]
fn there_is_room_for_any_volume() {
    for topology in [ring(), soup(2)] {
        let incidence = Incidence::new(&topology);
        for light in LIGHTS {
            for casting in [Casting::Front, Casting::Back, Casting::Double] {
                let castings = vec![casting; topology.parts().len()];
                let (lists, room) = (expected(&topology, light, &castings), incidence.room(&castings));
                for (list, room) in lists.iter().zip(room.0) {
                    assert!(3 * list.len() as u64 <= room, "{casting:?}: {} triangles, {room} indices", list.len());
                }
                let most = Room::most(topology.by_part().len() as u64);
                assert!(room.0.iter().zip(most.0).all(|(room, most)| *room <= most), "{room:?} {most:?}");
            }
        }
    }
}

#[test]
fn scales_are_powers_of_two() {
    for (extent, expected) in
        [(1.0, 1.0), (0.75, 1.0), (3.0, 0.25), (1e-30, 2.0_f32.powi(99)), (0.0, 2.0_f32.powi(126))]
    {
        assert_eq!(unit_scale(DVec4::splat(extent).truncate()), expected, "{extent}");
    }
}

#[test]
fn parameters_lie_as_their_shader_reads_them() {
    use zfail_testing::naga::valid::Capabilities;
    let module = zfail_testing::wgsl::validate(include_str!("extract.wgsl"), Capabilities::empty()).expect("WGSL");
    let fields = zfail_testing::layout!(
        &module,
        "Params",
        Params,
        [light, edge_scale, light_scale, first, triangles, edges, fans, apex, steps, starts]
    );
    fields.expect("agreement");
}
