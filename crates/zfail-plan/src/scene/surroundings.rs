//! What a scene stands in: a sky that lights it from all sides, and a ground that catches its shadows.

/// A sky without features, lit from nowhere in particular: its radiance depends on the height of a direction alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sky {
    /// Radiance straight above (+y), linear RGB.
    pub zenith: [f32; 3],
    /// Radiance of horizontal directions, linear RGB.
    pub horizon: [f32; 3],
    /// Radiance straight below, as a ground reflects it, linear RGB.
    pub nadir: [f32; 3],
}

/// A horizontal plane that receives shadows, casts none, and fades out at its rim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// World-space y, in metres.
    pub height: f64,
    /// World-space x and z of its middle, in metres.
    pub center: [f64; 2],
    /// Where it has faded out entirely, in metres from the middle.
    pub radius: f64,
    /// Whether it is a surface of the scene, as one that somebody asked for by its height is: AOVs hold it then.
    pub is_surface: bool,
}
