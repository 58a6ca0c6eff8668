//! z-pass or z-fail by light: Lengyel, "The Mechanics of Robust Stencil Shadows", Gamasutra, 2002; McG section 2.
//!
//! "A hybrid algorithm ... that uses faster z-pass rendering when the viewport is not shadowed and reverts to robust
//! z-fail rendering when the viewport is shadowed", with "a rectangular clipping region ... computed [from] the projected
//! image plane bounding box of a 3D sphere of this radius" around a light that ends somewhere (McG). The test is Everitt
//! & Kilgard's (3.4): does anything come between the light and the near rectangle?

use zfail_plan::plan::{Measures, Silhouettes, Tiles, ZPass};

/// The steps that make the method.
pub const MEASURES: Measures = Measures {
    reach: true,
    z_pass: ZPass::ByLight,
    off_screen: false,
    near_count: false,
    fan: false,
    receivers: false,
    occluders: 0,
    tiles: Tiles::Never,
    silhouettes: Silhouettes::Cpu,
};
