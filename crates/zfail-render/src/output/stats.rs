//! What a frame cost, in the shape of the program's `--stats` file. What the device cannot measure is null.

use serde::Serialize;
use std::collections::BTreeMap;

/// Figures of one frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FrameStats {
    /// Name of the graphics adapter.
    pub adapter: String,
    /// Graphics interface: vulkan, metal, dx12, gl.
    pub backend: String,
    /// Format of the depth-stencil target.
    pub depth_format: String,
    /// CPU time to plan and upload every light's volumes, milliseconds.
    pub planning_ms: f64,
    /// Time of the whole frame on the GPU, milliseconds.
    pub gpu_ms: Option<f64>,
    /// GPU time in which visible surfaces were shaded, all lights together, milliseconds.
    pub shading_ms: Option<f64>,
    /// One entry per rendered light, in the order of [`crate::Settings::lights`].
    pub lights: Vec<LightFigures>,
}

/// Figures of one light.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LightFigures {
    /// point, spot or directional.
    pub kind: &'static str,
    /// Casters considered.
    pub casters: u32,
    /// Casters without a volume, by reason.
    pub culled: BTreeMap<&'static str, u32>,
    /// Casters in case 1 (z-pass), 2 (z-fail without light cap) and 3 (z-fail with it) of McGuire et al. 2003.
    pub cases: [u32; 3],
    /// The same by sections of meshes that have several parts; a caster that is one piece counts as one.
    pub sections: SectionFigures,
    /// Casters whose silhouettes the device found; their triangles and vertices are not counted here.
    pub extracted: u32,
    /// Sides in sight that were counted by tiles instead of being rasterised.
    pub tiled: u64,
    /// Triangles submitted.
    pub triangles: TriangleFigures,
    /// Vertices submitted.
    pub vertices: u32,
    /// Fragments of its shadow volumes, if [`crate::Renderer::count_fragments`] was asked.
    pub fragments: Option<u64>,
    /// Pixels that the light can reach: x, y, width, height.
    pub scissor: [u32; 4],
    /// GPU time of its shadow volumes, milliseconds.
    pub shadow_ms: Option<f64>,
    /// GPU time of its illumination, milliseconds; only a frame's single light has one of its own.
    pub light_ms: Option<f64>,
}

/// Triangles submitted, by part of the volume.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct TriangleFigures {
    /// Silhouette sides.
    pub sides: u32,
    /// Far end.
    pub dark_cap: u32,
    /// Near end.
    pub light_cap: u32,
}

/// What became of sections of meshes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct SectionFigures {
    /// All that were decided on.
    pub considered: u32,
    /// Those with a volume, by case.
    pub cases: [u32; 3],
}
