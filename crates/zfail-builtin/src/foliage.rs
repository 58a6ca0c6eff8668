//! Masked surfaces: a tree of leaf cards and a chain-link fence, with light through both.

use glam::{DAffine3, DQuat, DVec2, DVec3};
use zfail_plan::light::LightKind;
use zfail_scene::{AlphaMode, Image, Material, Mesh, Scene, TextureRef};

use super::builder::{SceneBuilder, at};
use super::pattern;
use super::props::{Pose, block, figure};
use super::shapes::{Facets, capsule, merged, painted};

pub(super) fn scene() -> Scene {
    let mut b = SceneBuilder::new("foliage", [0.14, 0.17, 0.23], [0.45, 0.6, 0.85]);
    let direction = DVec3::new(0.8, -0.42, -0.16).normalize();
    b.light("sun", LightKind::Directional { direction }, 0xffd9a4, 2.6);
    let lawn = b.textured(pattern::grass("lawn", 0x6b8548, 0x97905c), 3.0, 0.95);
    b.block("lawn", [-40.0, -1.0, -40.0], [40.0, 0.0, 40.0], lawn);
    let paving = b.textured(pattern::bricks("path", [3, 6], 0xc9bda6, 0x8f8573), 1.5, 0.8);
    b.block("path", [-0.4, -0.5, -8.0], [3.4, 0.03, 8.0], paving);
    let plaster = b.textured(pattern::stone("plaster", 0xd9cdb8, 0.08), 2.0, 0.9);
    b.block("wall", [3.9, -0.5, -7.0], [4.2, 2.6, 4.0], plaster);
    tree(&mut b);
    fence(&mut b);
    let wood = b.matte("wood", 0xc79a6b, 0.5);
    b.add("walker", figure(&Pose::WALK), wood, at(1.9, 0.03, 1.3, 160.0));
    b.bulb("lamp", DVec3::new(-2.3, 0.5, 4.4), 0.07, 0xffb46a, 22.0);
    b.camera("garden", DVec3::new(-0.6, 2.3, 8.2), DVec3::new(0.7, 1.35, -0.6), 50.0);
    b.camera("at the wall", DVec3::new(-0.7, 1.7, 1.3), DVec3::new(2.6, 1.0, -2.4), 58.0);
    b.finish()
}

/// A double-sided dielectric that is there where its texture's alpha is at least one half.
fn cutout(b: &mut SceneBuilder, name: &str, image: Image, metallic: f32) -> usize {
    let texture = b.texture(image);
    b.material(Material {
        name: name.to_owned(),
        base_color_texture: Some(TextureRef::new(texture)),
        metallic,
        roughness: 0.7,
        alpha: AlphaMode::Mask(0.5),
        double_sided: true,
        ..Material::default()
    })
}

/// A trunk, branches, and a card with a twig's picture at many places of the crown.
fn tree(b: &mut SceneBuilder) {
    const TWIGS: u32 = 84;
    let bark = b.matte("bark", 0x6d5138, 0.9);
    let leaves = cutout(b, "leaves", pattern::twig("twig", 11, 0x7da045), 0.0);
    let crown = DVec3::new(0.0, 2.9, 0.0);
    let mut wood = vec![capsule(DVec3::Y * -0.1, 0.16, DVec3::Y * 2.5, 0.07, 12)];
    let mut cards = Facets::default();
    for k in 0..TWIGS {
        let share = (f64::from(k) + 0.5) / f64::from(TWIGS);
        let turn = DQuat::from_rotation_y(2.399_963 * f64::from(k));
        let slope = 1.0 - 1.75 * share;
        let outward = turn * DVec3::new((1.0 - slope * slope).sqrt(), slope, 0.0);
        let depth = 0.55 + 0.45 * f64::from(k * 7 % 11) / 10.0;
        let place = crown + outward * DVec3::new(1.55, 1.35, 1.55) * depth;
        if k % 7 == 0 {
            wood.push(capsule(DVec3::Y * (1.4 + 0.9 * (1.0 - share)), 0.045, place, 0.012, 8));
        }
        // Leaves hang outwards and turn their faces every way.
        let up = (outward - DVec3::Y * 0.35).normalize();
        let spin = DQuat::from_axis_angle(up, f64::from(k * 5 % 13));
        let right = spin * up.any_orthonormal_vector();
        card(&mut cards, place, right, up, 0.42 + 0.12 * f64::from(k * 3 % 7) / 6.0);
    }
    let parts = wood.into_iter().map(|part| painted(part, bark)).chain([painted(cards.mesh("cards", 0.1), leaves)]);
    let mesh = b.mesh("tree", merged("tree", parts));
    b.place("tree", mesh, at(-1.3, 0.0, -2.2, 0.0));
}

/// A square with the whole texture, upright along `up`.
fn card(cards: &mut Facets, center: DVec3, right: DVec3, up: DVec3, half: f64) {
    let corner = |x: f64, y: f64| (center + (right * x + up * y) * half, DVec2::new(0.5 + 0.5 * x, 0.5 - 0.5 * y));
    cards.textured_quad([corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]);
}

/// Wire mesh between posts, along two sides of the lawn.
fn fence(b: &mut SceneBuilder) {
    const HEIGHT: f64 = 1.5;
    const LENGTH: f64 = 2.0;
    let steel = b.matte("post", 0x8d9499, 0.5);
    let wire = cutout(b, "wire", pattern::wire("wire", 0.14, 0xb4bcc0), 0.3);
    let corners = [DVec3::new(-5.2, 0.0, 2.0), DVec3::new(-0.9, 0.0, 2.0), DVec3::new(-0.9, 0.0, 6.5)];
    let mut posts: Vec<Mesh> = Vec::new();
    let mut mesh = Facets::default();
    for ends in corners.windows(2) {
        let [from, to] = [ends[0], ends[1]];
        let panels = (from.distance(to) / LENGTH).round();
        for k in 0..panels as u32 {
            let [a, b] = [0.0, 1.0].map(|step| from.lerp(to, (f64::from(k) + step) / panels));
            // Meshes of 0.15 m.
            let uv = |along: f64, height: f64| DVec2::new(along, HEIGHT - height) / 0.15;
            let length = a.distance(b);
            let low = DVec3::Y * 0.05;
            let high = DVec3::Y * HEIGHT;
            mesh.textured_quad([
                (a + low, uv(0.0, 0.05)),
                (b + low, uv(length, 0.05)),
                (b + high, uv(length, HEIGHT)),
                (a + high, uv(0.0, HEIGHT)),
            ]);
            posts.push(post(a));
        }
    }
    posts.push(post(corners[2]));
    b.add("wire", mesh.mesh("wire", 0.1), wire, DAffine3::IDENTITY);
    b.add("posts", merged("posts", posts), steel, DAffine3::IDENTITY);
    let stone = b.matte("step", 0xa39a8b, 0.9);
    b.add("step", block(DVec3::new(0.7, 0.3, 0.7)), stone, at(-3.3, 0.0, 0.7, 20.0));
}

fn post(foot: DVec3) -> Mesh {
    capsule(foot - DVec3::Y * 0.1, 0.03, foot + DVec3::Y * 1.55, 0.03, 10)
}
