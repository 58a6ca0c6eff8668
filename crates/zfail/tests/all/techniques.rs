//! Every step beyond z-fail gives the count of z-fail, bit for bit, on every pixel; and every step, taken wrongly, does
//! not.

use crate::stage::{self, Random, Setup, Soup, draw};
use zfail::glam::{DAffine3, DMat3, DQuat, DVec3};
use zfail::low_level::FramePlan;
use zfail::{Counting, LightKind, Projection, Silhouettes, Steps, Technique, Tiles, View, ZPass};
use zfail_plan::plan::{DarkCap, Extraction, LightCap};

/// A closed ring around y: not convex, with a hole.
fn ring(segments: u32, sides: u32) -> Soup {
    let at = |i: u32, n: u32| f64::from(i) / f64::from(n) * std::f64::consts::TAU;
    let positions = (0..segments * sides)
        .map(|v| {
            let (u, w) = (at(v / sides, segments), at(v % sides, sides));
            let r = 1.0 + 0.35 * w.cos();
            DVec3::new(r * u.cos(), 0.35 * w.sin(), r * u.sin()).as_vec3().to_array()
        })
        .collect();
    let id = |i: u32, j: u32| i % segments * sides + j % sides;
    let quads = (0..segments).flat_map(|i| (0..sides).map(move |j| (i, j)));
    let triangles = quads
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
            [[a, c, b], [a, d, c]]
        })
        .collect();
    (positions, triangles)
}

fn cuboid(half: DVec3) -> Soup {
    let positions = (0..8)
        .map(|i| {
            let sign = |bit: u32| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
            (half * DVec3::new(sign(0), sign(1), sign(2))).as_vec3().to_array()
        })
        .collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    (positions, quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
}

fn sheet(half: f32) -> Soup {
    let p = |x: f32, z: f32| [x * half, 0.0, z * half];
    (vec![p(-1.0, -1.0), p(1.0, -1.0), p(1.0, 1.0), p(-1.0, 1.0)], vec![[0, 2, 1], [0, 3, 2]])
}

/// A room seen from within, some things in it, an eye and a light anywhere: behind things, beside them, on the near plane.
fn scene(seed: u64) -> (View, Vec<(Soup, DAffine3)>, LightKind) {
    let mut random = Random(seed);
    let mut things = Vec::new();
    // Seen from within, its back faces face out: only they block, from behind.
    let (positions, triangles) = cuboid(DVec3::splat(9.0));
    things.push(((positions, triangles.into_iter().map(|[a, b, c]| [a, c, b]).collect()), DAffine3::IDENTITY));
    for i in 0..6 {
        let soup = match (seed + i) % 4 {
            0 => ring(12, 6),
            1 | 2 => cuboid(random.vector(0.9).abs() + 0.1),
            _ => sheet(random.real(0.5, 3.0) as f32),
        };
        let mirror = DMat3::from_diagonal(DVec3::new(if i % 3 == 0 { -1.0 } else { 1.0 }, 1.0, random.real(0.5, 1.5)));
        let matrix3 = DMat3::from_quat(DQuat::from_scaled_axis(random.vector(3.0))) * mirror;
        things.push((soup, DAffine3 { matrix3, translation: random.vector(4.0) }));
    }
    let eye = random.vector(5.0);
    let back = (eye - random.vector(2.0)).normalize();
    let right = back.any_orthonormal_vector();
    let place = DAffine3 { matrix3: DMat3::from_cols(right, back.cross(right), back), translation: eye };
    if seed.is_multiple_of(5) {
        // Something large right over the eye.
        let above = DAffine3::from_translation(eye + DVec3::Y * 0.4) * DAffine3::from_rotation_x(0.1);
        things.push((cuboid(DVec3::new(6.0, 0.05, 6.0)), above));
    }
    let light = match seed % 3 {
        0 => LightKind::Directional { direction: random.vector(1.0).normalize() },
        1 => LightKind::Point { position: random.vector(6.0), range: f64::INFINITY },
        // In the near plane, and often close to the near rectangle.
        _ => {
            let near = place.transform_point3(DVec3::new(random.real(-1.0, 1.0), random.real(-1.0, 1.0), -0.1));
            LightKind::Point { position: near, range: f64::INFINITY }
        }
    };
    let projection = Projection::Perspective { yfov: 1.2, near: 0.1, far: None };
    (View::new(place, projection, SIZE), things, light)
}

struct Device(wgpu::Device, wgpu::Queue);

impl Device {
    fn draw(
        &self,
        seed: u64,
        steps: Steps,
        counting: Counting,
        edit: impl FnOnce(&mut FramePlan),
    ) -> (Vec<u8>, FramePlan) {
        let (view, things, light) = scene(seed);
        draw(&self.0, &self.1, &Setup { steps, counting, ..Setup::default() }, &view, &things, light, edit)
    }

    fn truth(&self, seed: u64) -> Vec<u8> {
        self.draw(seed, Technique::EverittKilgard.into(), Counting::Raw, |_| {}).0
    }
}

fn device() -> Device {
    let (device, queue) = stage::device(&Setup::default());
    Device(device, queue)
}

const SEEDS: u64 = 40;
const SIZE: [u32; 2] = [96, 64];

#[test]
fn every_technique_counts_alike() {
    if !stage::has_device() {
        return;
    }
    let device = device();
    let all = Technique::Auto.steps();
    let plain = Technique::EverittKilgard.steps();
    let steps = [
        Technique::Auto.steps(),
        Technique::Lengyel.steps(),
        Technique::Mcguire.steps(),
        Steps { off_screen: true, ..plain },
        Steps { fan: true, ..plain },
        Steps { receivers: true, ..plain },
        Steps { z_pass: ZPass::ByCaster, near_count: true, ..plain },
        Steps { near_count: false, ..all },
        Steps { receivers: false, ..all },
    ];
    let (mut cases, mut cleared, mut fans, mut scissored) = ([0; 3], 0, 0, 0);
    for seed in 0..SEEDS {
        let truth = device.truth(seed);
        for (i, steps) in steps.into_iter().enumerate() {
            let (image, plan) = device.draw(seed, steps, Counting::Raw, |_| {});
            zfail_testing::compare(&format!("technique scene {seed}"), SIZE, &image, &truth, 0)
                .unwrap_or_else(|difference| panic!("{difference}, with {steps:?}"));
            let light = &plan.lights[0];
            (0..3).for_each(|case| cases[case] += light.stats.cases[case]);
            if i == 0 {
                cleared += u32::from(light.stats.near_count > 0);
                scissored += plan.draws.iter().filter(|d| Some(d.scissor) != light.scissor).count();
            }
            fans += u32::from(steps.fan && light.stats.triangles.dark_cap > 0);
        }
    }
    println!("cases {cases:?}, {cleared} near counts above zero, {fans} plans with fans, {scissored} scissored draws");
    assert!(cases[0] > 500 && cases[1] > 5 && cases[2] > 500, "{cases:?}");
    assert!(cleared > 3 && fans > 10 && scissored > 50, "{cleared} near counts, {fans} fans, {scissored} scissors");
}

#[test]
fn skipping_casters_changes_no_verdict() {
    if !stage::has_device() {
        return;
    }
    let device = device();
    let (mut culled, mut dark) = (0, 0);
    for seed in 0..SEEDS {
        let all = device.draw(seed, Technique::EverittKilgard.into(), Counting::Verdict, |_| {}).0;
        let (some, plan) = device.draw(seed, Technique::Auto.into(), Counting::Verdict, |_| {});
        culled += plan.lights[0].stats.culled.iter().sum::<u32>();
        let wrong = all.iter().zip(&some).filter(|&(&a, &b)| (a == 0) != (b == 0)).count();
        assert_eq!(wrong, 0, "seed {seed}: {wrong} verdicts differ");
        dark += all.iter().filter(|&&s| s > 0).count();
    }
    assert!(culled > 30 && dark > 10_000, "{culled} casters culled, {dark} pixels in shadow");
}

/// Counting by tiles, a pixel may differ where its centre lies within the rasteriser's rounding of an edge, and nowhere else.
#[test]
fn tiles_give_the_verdicts_of_the_rasteriser() {
    if !stage::has_device() {
        return;
    }
    let device = device();
    let (mut wrong, mut dark, mut all) = (0, 0, 0);
    for seed in 0..SEEDS {
        let truth = device.draw(seed, Technique::EverittKilgard.into(), Counting::Verdict, |_| {}).0;
        let steps = Steps { tiles: Tiles::Always, ..Technique::Auto.steps() };
        let image = device.draw(seed, steps, Counting::Verdict, |_| {}).0;
        let differing = truth.iter().zip(&image).filter(|&(&a, &b)| (a == 0) != (b == 0)).count();
        assert!(differing <= 4, "seed {seed}: {differing} verdicts differ");
        wrong += differing;
        all += image.len();
        // Marks, not counts: the tile pass has been there.
        dark += image.iter().filter(|&&s| s == 0x80).count();
    }
    println!("{wrong} of {all} verdicts differ, {dark} pixels darkened by tiles");
    assert!(wrong * 20_000 < all && dark > 10_000, "{wrong} differ of {all}, {dark} pixels darkened by tiles");
}

/// What is wrongly done without, and how.
type Mistake = (&'static str, fn(&mut Extraction));

/// Silhouettes from the device give the counts of those from the CPU, bit for bit on every pixel; without the device's
/// sides or caps they do not.
#[test]
fn silhouettes_of_the_device_count_alike() {
    if !stage::has_device() {
        return;
    }
    let device = device();
    let gpu = |technique: Technique| Steps { silhouettes: Silhouettes::Gpu, ..technique.steps() };
    let steps = [
        gpu(Technique::Auto),
        gpu(Technique::EverittKilgard),
        gpu(Technique::Mcguire),
        Steps { fan: true, ..gpu(Technique::EverittKilgard) },
    ];
    let (mut extracted, mut fans, mut caps, mut exposed) = (0, 0, 0, 0);
    for seed in 0..SEEDS / 2 {
        let truth = device.truth(seed);
        for steps in steps {
            let (image, plan) = device.draw(seed, steps, Counting::Raw, |_| {});
            zfail_testing::compare(&format!("technique scene {seed}"), SIZE, &image, &truth, 0)
                .unwrap_or_else(|difference| panic!("{difference}, with {steps:?}"));
            let extractions = || plan.draws.iter().filter_map(|draw| draw.extraction.as_ref());
            extracted += extractions().count();
            fans += extractions().filter(|e| e.dark_cap == DarkCap::Fan).count();
            caps += extractions().filter(|e| e.dark_cap == DarkCap::Triangles).count();
            exposed += extractions().filter(|e| e.light_cap == LightCap::Exposed).count();
            assert_eq!(extractions().count(), plan.draws.len(), "seed {seed}: a caster stayed on the CPU");
        }
        let lit = |steps| {
            let image = device.draw(seed, steps, Counting::Verdict, |_| {}).0;
            image.iter().map(|&count| count == 0).collect::<Vec<_>>()
        };
        assert_eq!(lit(Technique::EverittKilgard.into()), lit(gpu(Technique::Auto)), "seed {seed}: verdicts differ");
    }
    println!("{extracted} extracted, {fans} fans, {caps} dark caps, {exposed} exposed light caps");
    assert!(extracted > 250 && fans > 30 && caps > 60 && exposed > 50, "{extracted} {fans} {caps} {exposed}");

    let faults: [Mistake; 3] = [
        ("light caps", |extraction| extraction.light_cap = LightCap::None),
        ("sides and dark caps", |extraction| {
            (extraction.sides, extraction.dark_cap) = (false, DarkCap::None);
        }),
        ("another caster's lists", |extraction| extraction.light += 1),
    ];
    for (name, fault) in faults {
        let edit = |plan: &mut FramePlan| plan.draws.iter_mut().filter_map(|d| d.extraction.as_mut()).for_each(fault);
        let drawn = |seed| device.draw(seed, gpu(Technique::Mcguire), Counting::Raw, edit).0;
        let noticed = (0..SEEDS / 8).filter(|&seed| drawn(seed) != device.truth(seed)).count();
        println!("without {name}: noticed in {noticed} of {} scenes", SEEDS / 8);
        assert!(noticed >= 2, "without {name}: noticed in {noticed} scenes only");
    }
}

/// Edits that must not go unnoticed, each with a name and the technique whose plan is edited.
type Fault = (&'static str, Technique, fn(&mut FramePlan));

#[test]
fn every_step_taken_wrongly_is_noticed() {
    if !stage::has_device() {
        return;
    }
    let device = device();
    let faults: [Fault; 7] = [
        ("z-pass where the near rectangle is in shadow", Technique::Mcguire, |plan| {
            plan.draws.iter_mut().for_each(|draw| draw.z_pass = true);
        }),
        ("a near count forgotten", Technique::Auto, |plan| plan.lights[0].stats.near_count = 0),
        ("a scissor too tight", Technique::Auto, |plan| {
            for draw in &mut plan.draws {
                let [x, y, width, height] = draw.scissor;
                draw.scissor = [x + width / 8, y, (width - width / 8).max(1), height];
            }
        }),
        ("a caster culled", Technique::Auto, |plan| {
            if let Some(draw) = plan.draws.last_mut() {
                draw.volume = zfail_plan::volume::Volume::default();
            }
        }),
        ("sides culled", Technique::Auto, |plan| {
            plan.draws.iter_mut().for_each(|draw| draw.volume.sides.end = draw.volume.sides.start);
        }),
        ("dark caps culled", Technique::Mcguire, |plan| {
            plan.draws.iter_mut().for_each(|draw| draw.volume.dark_cap.end = draw.volume.dark_cap.start);
        }),
        ("light caps culled", Technique::Mcguire, |plan| {
            for draw in &mut plan.draws {
                draw.volume.light_cap.end = draw.volume.light_cap.start;
                draw.volume.light_cap_reversed.end = draw.volume.light_cap_reversed.start;
            }
        }),
    ];
    for (name, technique, fault) in faults {
        let noticed = (0..SEEDS / 2)
            .filter(|&seed| device.draw(seed, technique.into(), Counting::Raw, fault).0 != device.truth(seed))
            .count();
        println!("{name}: noticed in {noticed} of {} scenes", SEEDS / 2);
        assert!(noticed >= 2, "{name}: noticed in {noticed} scenes only");
    }
}
