//! What a user can choose about methods that need choices. The exact ones need none.

/// Choices for all methods; each looks at its own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// For [`Method::ShadowMap`](crate::Method::ShadowMap).
    pub shadow_map: ShadowMapOptions,
    /// For [`Method::FiniteZFail`](crate::Method::FiniteZFail) and
    /// [`Method::CarmackPreload`](crate::Method::CarmackPreload).
    pub finite: FiniteOptions,
}

/// How a shadow map is drawn and read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowMapOptions {
    /// Texels along each side of the map, or of each face of a cube of maps; at least 1.
    pub resolution: u32,
    /// What is taken from a surface's distance to the light before it is compared, as a fraction of the light's depth
    /// range: 0.001 of a range of 20 m is 2 cm. It hides acne and lifts shadows off their casters.
    pub bias: f32,
    /// What is taken besides, per unit of the slope of the surface against the light's rays, in texels: the tangent of
    /// the angle between normal and ray, times the size of a texel at the surface.
    pub slope_bias: f32,
    /// Whether four neighbouring texels vote, and a tie or more is lit, instead of the nearest one alone.
    pub pcf: bool,
}

impl Default for ShadowMapOptions {
    /// What games have used: 1024 texels, a bias of a thousandth, a slope bias of one texel, the nearest texel.
    fn default() -> Self {
        Self { resolution: 1024, bias: 1e-3, slope_bias: 1.0, pcf: false }
    }
}

/// Where things end that the theory wants at infinity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FiniteOptions {
    /// Distance of the far plane from the eye, scene units; `None`: beyond the scene and all extruded vertices.
    pub far: Option<f64>,
    /// How far vertices are extruded away from the light, scene units; `None`: the diagonal of the scene.
    pub extrusion: Option<f64>,
}
