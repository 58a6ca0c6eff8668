//! z-pass or z-fail by caster: McGuire, Hughes, Egan, Kilgard & Everitt, "Fast, Practical and Robust Shadows", 2003.
//!
//! Of every caster by itself it is asked whether it comes between the light and the near rectangle (section 6, the
//! occlusion pyramid); where it does not, its sides alone are counted by z-pass (section 7, case 1). Of those that need
//! z-fail, parts out of view are left out: the light cap (case 2 instead of 3), the dark cap. And a dark cap at infinity
//! has no shape, only a border, so a fan over the silhouette does: O(s) triangles instead of O(f) (section 6,
//! DrawDarkCap). That is closed only where the light is outside of the caster's hull, which the planner asks first. Bounds of depth
//! (SetDepthBounds) are not to be had here; in their place, pixels are left out in which no surface lies deep enough or near
//! enough to be in a caster's shadow.

use crate::lengyel;
use zfail_plan::plan::{Steps, ZPass};

/// The steps that make the method.
pub const MEASURES: Steps =
    Steps { z_pass: ZPass::ByCaster, off_screen: true, fan: true, receivers: true, ..lengyel::MEASURES };
