//! z-pass or z-fail by light: Lengyel, "The Mechanics of Robust Stencil Shadows", Gamasutra, 2002; McG section 3.
//!
//! It "uses faster z-pass rendering when the viewport is not shadowed and reverts to robust z-fail rendering when the
//! viewport is shadowed", and for a light that ends somewhere "computes the projected image plane bounding box of a 3D
//! sphere of this radius and sets the OpenGL scissor region to that bounding box" (McG). Whether the viewport is shadowed is
//! asked of each light once: does any of its casters come between it and the near rectangle? (E&K 3.4 suggests that.)

use zfail_plan::plan::{Silhouettes, Steps, Tiles, ZPass};

/// The steps that make the method.
pub const MEASURES: Steps = Steps {
    reach: true,
    z_pass: ZPass::ByLight,
    off_screen: false,
    near_count: false,
    fan: false,
    by_section: false,
    receivers: false,
    occluders: 0,
    tiles: Tiles::Never,
    silhouettes: Silhouettes::Cpu,
};
