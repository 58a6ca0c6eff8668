//! Verdicts as a texture say what the stencil says, light by light, and a host's own matrices give the same.

use crate::stage::{self, Setup, Soup};
use zfail::glam::{DAffine3, DVec3, Mat4, Vec3};
use zfail::{Caster, Error, Frame, LightKind, MeshDescriptor, Projection, ShadowLight, Shadows, VerdictBits, View};
use zfail::{Target, wgpu};
use zfail_testing::assert_alike;

const SIZE: [u32; 2] = [96, 64];

/// A floor, and sheets above it.
fn meshes() -> Vec<(Soup, DAffine3)> {
    let square = |half: f32| {
        let corners = [[-half, 0.0, -half], [-half, 0.0, half], [half, 0.0, half], [half, 0.0, -half]];
        (corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]])
    };
    let at = |x: f64, y: f64| DAffine3::from_translation(DVec3::new(x, y, 0.2 * x));
    vec![(square(6.0), DAffine3::IDENTITY), (square(0.5), at(-1.0, 1.0)), (square(0.3), at(1.2, 1.6))]
}

fn view() -> View {
    let projection = Projection::Perspective { yfov: 0.9, near: 0.1, far: None };
    View::looking_at(DVec3::new(1.0, 5.0, 6.0), DVec3::ZERO, DVec3::Y, projection, SIZE)
}

/// More lights than fit a texture of bits, most of them with a shadow somewhere else.
fn lights() -> Vec<LightKind> {
    let lamp = |i: u32| {
        let turn = f64::from(i) * 0.7;
        LightKind::Point { position: DVec3::new(2.0 * turn.cos(), 3.0, 2.0 * turn.sin()), range: f64::INFINITY }
    };
    (0..36).map(lamp).collect()
}

/// What is drawn of a frame.
struct Drawn {
    /// By light, from the stencil.
    stencils: Vec<Vec<bool>>,
    /// By light, as a shader looks it up.
    looked_up: Vec<Vec<bool>>,
}

fn draw(own_matrices: bool) -> Drawn {
    let setup = Setup::default();
    let (device, queue) = stage::device(&setup);
    let (meshes, view) = (meshes(), view());
    let mut shadows = Shadows::new(&device, &queue);
    let casters: Vec<Caster> = meshes
        .iter()
        .map(|((positions, triangles), place)| {
            let mesh = MeshDescriptor { positions, triangles, ..MeshDescriptor::default() };
            let caster = Caster::new(shadows.add_mesh(&mesh).expect("mesh"), *place);
            if own_matrices { caster.drawn_with(view.clip_from_object(place)) } else { caster }
        })
        .collect();
    let lights: Vec<_> = lights().into_iter().map(ShadowLight::new).collect();
    let pipelines = shadows.pipelines(&Target { colors: &[], depth_stencil: setup.depth_stencil, samples: 1 });
    let bits = VerdictBits::new(&shadows, setup.depth_stencil, 1);
    let prepared = shadows.prepare(&Frame::new(&view, &casters, &lights)).expect("plan");

    let texture = |format, usage| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING | usage,
            view_formats: &[],
        })
    };
    let depth_stencil = texture(setup.depth_stencil, wgpu::TextureUsages::empty());
    let attachment = depth_stencil.create_view(&wgpu::TextureViewDescriptor::default());
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = stage::begin(&mut encoder, &attachment, wgpu::LoadOp::Clear(0.0));
        stage::draw_depth(&device, &mut pass, &setup, &view, &meshes);
    }
    let verdicts: Vec<wgpu::Texture> = (0..lights.len())
        .step_by(VerdictBits::LIGHTS)
        .map(|first| {
            let verdicts = texture(VerdictBits::FORMAT, wgpu::TextureUsages::empty());
            let target = verdicts.create_view(&wgpu::TextureViewDescriptor::default());
            bits.encode(&mut encoder, &prepared, first, &target, &attachment);
            verdicts
        })
        .collect();
    queue.submit([encoder.finish()]);
    let looked_up = (0..lights.len())
        .map(|light| look_up(&device, &queue, &verdicts[light / VerdictBits::LIGHTS], light % VerdictBits::LIGHTS));
    let stencils = (0..lights.len()).map(|light| {
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        prepared.draw(&mut stage::begin(&mut encoder, &attachment, wgpu::LoadOp::Load), &pipelines, light);
        let counts = stage::read_stencil(&device, &queue, encoder, &depth_stencil);
        counts.into_iter().map(|count| count == 0).collect()
    });
    Drawn { looked_up: looked_up.collect(), stencils: stencils.collect() }
}

/// Which pixels `zfail_is_lit` calls lit.
fn look_up(device: &wgpu::Device, queue: &wgpu::Queue, verdicts: &wgpu::Texture, bit: usize) -> Vec<bool> {
    let encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let value = format!("u32(zfail_is_lit(textureLoad(image, id.xy, 0), {bit}u))");
    let image = (verdicts, wgpu::TextureAspect::All);
    let lit = stage::read(device, queue, encoder, image, "texture_2d<f32>", VerdictBits::LOOKUP, &value);
    lit.into_iter().map(|word| word != 0).collect()
}

#[test]
fn bits_say_what_the_stencil_says() {
    if !stage::has_device() {
        return;
    }
    let drawn = draw(false);
    let shadowed = |mask: &[bool]| mask.iter().filter(|&&lit| !lit).count();
    for (light, (bits, stencil)) in drawn.looked_up.iter().zip(&drawn.stencils).enumerate() {
        assert!(shadowed(stencil) > 20 && shadowed(stencil) < 4000, "light {light}: {}", shadowed(stencil));
        let shown = |mask: &[bool]| mask.iter().map(|&lit| if lit { 255 } else { 0 }).collect::<Vec<u8>>();
        assert_alike(&format!("bits of light {light}"), SIZE, &shown(bits), &shown(stencil), 0);
        // Another light's bits are others.
        assert!(*bits != drawn.stencils[(light + 1) % drawn.stencils.len()], "light {light}");
    }
}

#[test]
fn a_hosts_own_matrices_give_the_same() {
    if !stage::has_device() {
        return;
    }
    let (own, given) = (draw(true), draw(false));
    assert!(own.stencils == given.stencils && own.looked_up == given.looked_up);
}

#[test]
fn matrices_that_show_something_else_are_refused() {
    if !stage::has_device() {
        return;
    }
    let (device, queue) = stage::device(&Setup::default());
    let mut shadows = Shadows::new(&device, &queue);
    let ((positions, triangles), place) = &meshes()[1];
    let mesh = MeshDescriptor { positions, triangles, ..MeshDescriptor::default() };
    let caster = Caster::new(shadows.add_mesh(&mesh).expect("mesh"), *place);
    let view = view();
    let right = view.clip_from_object(place);
    let mut prepare = |clip_from_object: Mat4| {
        let casters = [caster.drawn_with(clip_from_object)];
        let outcome = shadows.prepare(&Frame::new(&view, &casters, &[])).map(|_| ());
        assert_eq!(outcome.is_ok(), shadows.prepared().is_some(), "after a failure there is nothing to draw with");
        outcome
    };
    assert_eq!(prepare(right), Ok(()));
    let moved = right * Mat4::from_translation(Vec3::new(0.0, 0.1, 0.0));
    assert_eq!(prepare(moved), Err(Error::ClipMatrix { caster: 0 }));
    let mut infinite = right;
    infinite.x_axis.z = 1e-7;
    assert_eq!(prepare(infinite), Err(Error::ClipDepth { caster: 0 }));
}
