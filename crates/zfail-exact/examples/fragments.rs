//! Which faces of shadow volumes pass at a pixel: `fragments FILE WxH X,Y [LIGHT]`, or `builtin:NAME` or `KIND:SEED` instead of a
//! file.
//! `ZFAIL_TECHNIQUE` names the technique.
//!
//! Prints, per face that covers the pixel's centre or comes within a sixteenth of a pixel of it, the caster, the part of its
//! volume, the side that the eye sees, how far inside its outline the centre lies (pixels), and its depth beyond the visible
//! surface. Everything is computed in f64 from the plan that is drawn: what a rasteriser without rounding would find.

use std::{env, error::Error};
use zfail_exact::kinds::Kind;
use zfail_plan::glam::{DMat4, DVec2, DVec3, DVec4};
use zfail_plan::plan::{Caster, Counting, Draw, FramePlan, Input, Planner, ShadowLight, Technique};
use zfail_plan::view::View;
use zfail_scene::{Instance, Scene};

/// Faces as close as this count as being at the pixel.
const NEAR: f64 = 1.0 / 16.0;

fn main() -> Result<(), Box<dyn Error>> {
    let usage = "usage: fragments FILE|builtin:NAME|KIND:SEED WxH X,Y [LIGHT]";
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [subject, size, pixel, rest @ ..] = &arguments[..] else { return Err(usage.into()) };
    let size = pair(size, 'x').ok_or(usage)?;
    let [x, y] = pair(pixel, ',').ok_or(usage)?;
    let (scene, view) = scene(subject, size)?;
    let only: Option<usize> = rest.first().map(|light| light.parse()).transpose()?;
    let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
    for light in (0..scene.lights.len()).filter(|&l| only.is_none_or(|only| l == only)) {
        println!("light {light}: {:?}", scene.lights[light].kind);
        list(&scene, &view, centre, light)?;
    }
    Ok(())
}

fn pair(text: &str, separator: char) -> Option<[u32; 2]> {
    let (a, b) = text.split_once(separator)?;
    Some([a.parse().ok()?, b.parse().ok()?])
}

fn scene(subject: &str, size: [u32; 2]) -> Result<(Scene, View), Box<dyn Error>> {
    if let Some(name) = subject.strip_prefix("builtin:") {
        let scene = zfail_builtin::scene(name).ok_or("no such scene")?;
        let view = scene.cameras[0].view(size, &scene.bounds());
        return Ok((scene, view));
    }
    if let Some((kind, seed)) = subject.split_once(':') {
        let kind = Kind::ALL.into_iter().find(|k| format!("{k:?}") == kind).ok_or("no such kind")?;
        let recipe = kind.recipe(seed.parse()?, size);
        return Ok((recipe.scene(), recipe.view));
    }
    let mut scene = zfail_files::load(subject.as_ref())?;
    zfail_scene::complete(&mut scene);
    let view = scene.cameras[0].view(size, &scene.bounds());
    Ok((scene, view))
}

/// Prints everything at one pixel, nearest first.
fn list(scene: &Scene, view: &View, centre: DVec2, light: usize) -> Result<(), Box<dyn Error>> {
    let topologies = scene.topologies()?;
    let casting = |i: &&Instance| i.casts_shadow;
    let casters: Vec<Caster<'_>> = (0..)
        .zip(scene.instances.iter().filter(casting))
        .filter_map(|(mesh, instance)| {
            let topology = topologies[instance.mesh].as_ref()?;
            Some(Caster { topology, mesh, world_from_object: instance.world_from_object })
        })
        .collect();
    let technique: Technique = env::var("ZFAIL_TECHNIQUE").map_or(Ok(Technique::EverittKilgard), |t| t.parse())?;
    let lights = [ShadowLight::new(scene.lights[light].kind)];
    let (steps, counting) = (technique.steps(), Counting::Raw);
    let frame = Input { view, casters: &casters, lights: &lights, receivers: &[], steps, counting };
    let mut planner = Planner::new();
    let plan = planner.plan(&frame)?;

    let mut faces = Vec::new();
    for (i, instance) in scene.instances.iter().enumerate() {
        let clip = view.clip_from_object(&instance.world_from_object).as_dmat4();
        let mesh = &scene.meshes[instance.mesh];
        for (t, corners) in mesh.triangles.iter().enumerate() {
            let corners = corners.map(|c| clip * mesh.position(c).extend(1.0));
            faces.extend(Face::new(view, centre, corners, format!("SURFACE {i} triangle {t}")));
        }
    }
    let covering = faces.iter().filter(|f| f.inside >= 0.0);
    let surface = covering.map(|f| f.depth).fold(f64::NEG_INFINITY, f64::max);
    for draw in &plan.draws {
        let topology = casters[draw.caster as usize].topology;
        let clip = view.clip_from_object(&casters[draw.caster as usize].world_from_object).as_dmat4();
        let place = |index: u32| place(draw, clip, topology.position(index >> 1), index & 1 == 1);
        for (part, range) in parts(draw) {
            for t in plan_triangles(plan, range) {
                let name = format!("caster {} {part} {:?}", draw.caster, t.map(|i| (i >> 1, i & 1)));
                let face = Face::new(view, centre, t.map(place), name);
                faces.extend(face.map(|f| Face { front: f.front != draw.mirrored, ..f }));
            }
        }
    }
    faces.sort_by(|a, b| b.depth.total_cmp(&a.depth));
    println!("surface at {surface}");
    for face in faces {
        let side = if face.front { "front" } else { "back" };
        let covers = if face.inside >= 0.0 { "covers" } else { "misses" };
        let (inside, beyond) = (face.inside, surface - face.depth);
        println!("{beyond:+14.6e} {side:5} {covers} by {inside:+.6} px, slope {:.3e}: {}", face.slope, face.name);
    }
    Ok(())
}

fn parts(draw: &Draw) -> [(&'static str, std::ops::Range<u32>); 4] {
    let volume = draw.volume.clone();
    [
        ("side", volume.sides),
        ("dark cap", volume.dark_cap),
        ("light cap", volume.light_cap),
        ("light cap, reversed,", volume.light_cap_reversed),
    ]
}

fn plan_triangles(plan: &FramePlan, range: std::ops::Range<u32>) -> impl Iterator<Item = [u32; 3]> {
    plan.indices[range.start as usize..range.end as usize].chunks_exact(3).map(|t| [t[0], t[1], t[2]])
}

/// Where a vertex goes, as `volume.wgsl` has it.
fn place(draw: &Draw, clip: DMat4, p: DVec3, extruded: bool) -> DVec4 {
    clip * if extruded { draw.extruded(p) } else { p.extend(1.0) }
}

/// A triangle near the pixel.
struct Face {
    name: String,
    /// Counter-clockwise.
    front: bool,
    /// Pixels from the centre to the outline; negative outside.
    inside: f64,
    /// Depth of its plane at the centre: 1 at the near plane.
    depth: f64,
    /// Change of depth per pixel.
    slope: f64,
}

impl Face {
    /// `None` if the triangle is elsewhere, or behind the eye.
    fn new(view: &View, centre: DVec2, corners: [DVec4; 3], name: String) -> Option<Self> {
        // In units of w: homogeneous pixels relative to the centre.
        let [width, height] = view.size.map(f64::from);
        let v = corners.map(|c| {
            let (x, y) = (0.5 * width * (c.w + c.x) - centre.x * c.w, 0.5 * height * (c.w - c.y) - centre.y * c.w);
            DVec3::new(x, y, c.w)
        });
        let normals: [_; 3] = std::array::from_fn(|i| v[(i + 1) % 3].cross(v[(i + 2) % 3]));
        let whole = v[0].dot(normals[0]);
        if whole == 0.0 {
            return None;
        }
        // Distances from the edges at w = 1, positive inside.
        let inside = normals.map(|n| n.z * whole.signum() / n.truncate().length());
        let inside = inside.into_iter().fold(f64::INFINITY, f64::min);
        if inside < -NEAR {
            return None;
        }
        // z is linear in (x, y, w): z = g . (x, y, w), and at the centre x = y = 0, w = 1.
        let gradient = (0..3).map(|i| normals[i] * corners[i].z).sum::<DVec3>() / whole;
        // Pixels count downwards.
        Some(Self { name, front: whole < 0.0, inside, depth: gradient.z, slope: gradient.truncate().length() })
    }
}
