//! What a method gives.

/// What one light reaches in one view, according to one method.
#[derive(Clone, Debug, PartialEq)]
pub struct Shadow {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Rows from top to bottom: 255 where the method says lit, 0 in shadow, where there is no surface, and outside the
    /// light's range, cone or box, as in [`zfail_render::Aovs::shadow`].
    pub mask: Vec<u8>,
    /// What it cost.
    pub figures: Figures,
}

/// What a method cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Figures {
    /// Triangles submitted to find the shadow: of volumes in all their passes, or of the scene into a shadow map. The
    /// scene as the eye sees it is not counted: all methods draw that alike.
    pub triangles: u64,
    /// Vertex indices submitted for these.
    pub vertices: u64,
    /// Fragments that these rasterise to, whatever tests they fail or pass; for ray queries, rays. Counted in a run of
    /// its own.
    pub fragments: u64,
    /// Times that geometry or the image is drawn over: the depth pass, each pass over the volumes or each face of a
    /// shadow map, and what reads the verdict.
    pub passes: u32,
    /// Wall time until the device has its lists: silhouettes, caps, culling and upload; for ray queries, the tree over all
    /// instances. Milliseconds. Nothing is kept from one call to the next.
    pub planning_ms: f64,
    /// Wall time of a plain run, from a device that is idle to one that is idle again, milliseconds; the median of three.
    pub render_ms: f64,
}
