//! What a scene stands in, on the device: sky, background, and the ground that catches its shadows.

use crate::scene::geometry::{MeshBuffers, Vertices};
use crate::{Gpu, RenderError, scene::check};
use zfail_plan::view::View;
use zfail_scene::{Ground, Scene, Sky};

/// Light from everywhere, and what is seen where no surface is.
#[derive(Debug)]
pub struct Surroundings {
    pub ambient: [f32; 3],
    pub background: [f32; 3],
    pub sky: Option<Sky>,
    ground: Option<Ground>,
    /// [`Ground::disc`], once there is a ground.
    disc: Option<MeshBuffers>,
}

/// A ground that a view shows.
#[derive(Clone, Copy, Debug)]
pub struct VisibleGround<'s> {
    pub ground: &'s Ground,
    pub disc: &'s MeshBuffers,
}

impl Surroundings {
    pub fn new(gpu: &Gpu, scene: &Scene) -> Result<Self, RenderError> {
        check::surroundings(scene)?;
        let &Scene { ambient, background, sky, ground, .. } = scene;
        let disc = ground.map(|_| MeshBuffers::new(gpu, &Ground::disc())).transpose()?;
        Ok(Self { ambient, background, sky, ground, disc })
    }

    /// The ground as it is seen from above; from below it is not there.
    pub fn ground(&self, view: &View) -> Option<VisibleGround<'_>> {
        let (ground, disc) = self.ground.as_ref().zip(self.disc.as_ref())?;
        ground.faces(view).then_some(VisibleGround { ground, disc })
    }
}

impl VisibleGround<'_> {
    /// Draws it with the pipeline that is set, placed by record `slot` of `instances`.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, vertices: Vertices, instances: &wgpu::Buffer, slot: u32) {
        self.disc.bind(pass, vertices, instances);
        pass.draw_indexed(0..self.disc.index_count(), 0, slot..slot + 1);
    }
}
