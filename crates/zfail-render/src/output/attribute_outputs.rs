//! Outputs that describe the visible surface, decoded from the attribute pass on the CPU.

use crate::output::aov::{AovKind, Aovs};
use crate::passes::targets::{Attributes, NO_SURFACE};
use crate::{Gpu, RenderError, device::read_back, srgb};
use half::f16;
use zfail_plan::glam::{DVec3, Vec2, Vec3};
use zfail_plan::view::{Projection, View};

/// Fills depth, position, normal and albedo of `out`, as far as `kinds` ask for them.
pub fn fill(
    out: &mut Aovs,
    gpu: &Gpu,
    targets: &Attributes,
    view: &View,
    kinds: &[AovKind],
) -> Result<(), RenderError> {
    let wants = |kind| kinds.contains(&kind);
    if !AovKind::ALL[2..].iter().any(|&kind| wants(kind)) {
        return Ok(());
    }
    let mut depth: Vec<f32> = bytemuck::pod_collect_to_vec(&read_back::texture(gpu, &targets.depth)?);
    if wants(AovKind::Position) {
        out.position = positions(&depth, view);
    }
    if wants(AovKind::Normal) {
        let texels: Vec<[u16; 2]> = bytemuck::pod_collect_to_vec(&read_back::texture(gpu, &targets.normal)?);
        let world_from_view = view.world_from_view.matrix3.as_mat3();
        out.normal = per_surface(&depth, &texels, |&[x, y]| {
            world_from_view * from_octahedral(Vec2::new(f16::from_bits(x).to_f32(), f16::from_bits(y).to_f32()))
        });
    }
    if wants(AovKind::Albedo) {
        let bytes = read_back::texture(gpu, &targets.albedo)?;
        let texels: Vec<[u8; 4]> = bytemuck::pod_collect_to_vec(&bytes);
        let linear: [f32; 256] = std::array::from_fn(|code| srgb::linear(code as f32 / 255.0));
        out.albedo = per_surface(&depth, &texels, |t| Vec3::from_array([t[0], t[1], t[2]].map(|c| linear[c as usize])));
    }
    if wants(AovKind::Depth) {
        for d in depth.iter_mut().filter(|d| **d == NO_SURFACE) {
            *d = 0.0;
        }
        out.depth = depth;
    }
    Ok(())
}

/// `of` every texel that shows a surface, else 0.
fn per_surface<T>(depth: &[f32], texels: &[T], of: impl Fn(&T) -> Vec3) -> Vec<[f32; 3]> {
    depth
        .iter()
        .zip(texels)
        .map(|(&depth, texel)| if depth == NO_SURFACE { [0.0; 3] } else { of(texel).to_array() })
        .collect()
}

fn positions(depth: &[f32], view: &View) -> Vec<[f32; 3]> {
    let clip_from_view = view.clip_from_view();
    let per_ndc = [clip_from_view.x_axis.x.recip(), clip_from_view.y_axis.y.recip()];
    let size = view.size.map(f64::from);
    depth
        .iter()
        .enumerate()
        .map(|(i, &depth)| {
            if depth == NO_SURFACE {
                return [0.0; 3];
            }
            let depth = f64::from(depth);
            let x = (i % view.size[0] as usize) as f64 + 0.5;
            let y = (i / view.size[0] as usize) as f64 + 0.5;
            let spread = if matches!(view.projection, Projection::Perspective { .. }) { depth } else { 1.0 };
            let on_plane = DVec3::new(
                (2.0 * x / size[0] - 1.0 - view.window.offset.x) * per_ndc[0] * spread,
                (1.0 - 2.0 * y / size[1] - view.window.offset.y) * per_ndc[1] * spread,
                -depth,
            );
            view.world_from_view.transform_point3(on_plane).as_vec3().to_array()
        })
        .collect()
}

/// As in `octahedral.wgsl`.
fn from_octahedral(p: Vec2) -> Vec3 {
    let z = 1.0 - p.x.abs() - p.y.abs();
    let folded = Vec2::new((1.0 - p.y.abs()).copysign(p.x), (1.0 - p.x.abs()).copysign(p.y));
    (if z >= 0.0 { p } else { folded }).extend(z).normalize_or_zero()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_octahedron_unfolds() {
        assert_eq!(from_octahedral(Vec2::ZERO), Vec3::Z);
        assert_eq!(from_octahedral(Vec2::X), Vec3::X);
        assert_eq!(from_octahedral(Vec2::new(-1.0, -1.0)), Vec3::NEG_Z);
        let n = from_octahedral(Vec2::new(-0.75, 0.75));
        assert!(n.abs_diff_eq(Vec3::new(-0.25, 0.25, -0.5).normalize(), 1e-6), "{n}");
    }
}
