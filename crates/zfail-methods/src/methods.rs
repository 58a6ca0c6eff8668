//! A scene on the device, to be shadowed by any method.

use crate::geometry::Geometry;
use crate::procedure::Procedure;
use crate::ray_query::RayTracer;
use crate::stage::Stage;
use crate::{Error, Figures, Method, Options, Shadow, Unavailable};
use crate::{
    carmack_preload, everitt_kilgard, eye_count, heidmann, inverted_test, lengyel, mcguire, near_caps, ours, planned,
    shadow_map, zfail_finite,
};
use std::cell::OnceCell;
use std::time::Instant;
use zfail_plan::view::View;
use zfail_render::{AovKind, Gpu, RenderError, Renderer, Settings};
use zfail_scene::{Light, Scene};

/// A scene on the device, ready to be shadowed by any method.
#[derive(Debug)]
pub struct Methods<'g> {
    gpu: &'g Gpu,
    renderer: Renderer<'g>,
    geometry: Geometry,
    stage: Stage,
    /// What the light reaches if nothing casts, for the last view and light.
    reach: Option<(View, usize, Vec<u8>)>,
    /// Opened when it is first asked for, or why it cannot be.
    rays: OnceCell<Result<RayTracer, String>>,
}

impl<'g> Methods<'g> {
    /// Uploads `scene`. Masked materials should have been cut to shape; they are drawn whole.
    ///
    /// # Errors
    /// If the scene is inconsistent or the device runs out of memory.
    pub fn new(gpu: &'g Gpu, scene: &Scene) -> Result<Self, Error> {
        // Checks the scene's indices, too.
        let renderer = Renderer::new(gpu, scene)?;
        let geometry = Geometry::new(&gpu.device, scene)?;
        gpu.check()?;
        Ok(Self { gpu, renderer, geometry, stage: Stage::new(gpu), reach: None, rays: OnceCell::new() })
    }

    /// What light number `light` reaches in `view`, according to `method`.
    ///
    /// # Errors
    /// If the method is not available, on this device or under this view; if there is no such light; if an option makes
    /// no sense; if the device fails.
    pub fn shadow(&mut self, method: Method, view: &View, light: usize, options: &Options) -> Result<Shadow, Error> {
        self.availability(method)?;
        self.ask_reach(view, light)?;
        let (mut mask, figures) = self.verdict(method, view, light, options)?;
        if let Some((.., reach)) = &self.reach {
            mask.iter_mut().zip(reach).for_each(|(verdict, reach)| *verdict &= reach);
        }
        Ok(Shadow { size: view.size, mask, figures })
    }

    /// Whether the device can run `method`.
    ///
    /// # Errors
    /// What it lacks.
    pub fn availability(&self, method: Method) -> Result<(), Unavailable> {
        let unavailable = |reason: &str| Err(Unavailable { method, reason: reason.to_owned() });
        match method {
            // Depth textures are incomplete there without a sampler of their own.
            Method::ShadowMap if self.gpu.info.backend == wgpu::Backend::Gl => {
                unavailable("wgpu's GL backend reads nothing from depth textures")
            }
            Method::RayQuery => {
                let rays = self.rays.get_or_init(|| RayTracer::new(&self.gpu.info, &self.geometry));
                rays.as_ref().map_or_else(|reason| unavailable(reason), |_| Ok(()))
            }
            _ => Ok(()),
        }
    }

    fn verdict(
        &mut self,
        method: Method,
        view: &View,
        light: usize,
        options: &Options,
    ) -> Result<(Vec<u8>, Figures), Error> {
        let Self { gpu, geometry, stage, rays, .. } = self;
        if let (Method::RayQuery, Some(Ok(rays))) = (method, rays.get_mut()) {
            return rays.shadow(view, light);
        }
        let light = &geometry.lights[light];
        if method == Method::ShadowMap {
            return shadow_map::shadow(gpu, stage, geometry, view, light, &options.shadow_map);
        }
        let mut planned = |steps| planned::shadow(gpu, stage, geometry, view, light, steps);
        match method {
            Method::Lengyel => return planned(lengyel::MEASURES),
            Method::Mcguire => return planned(mcguire::MEASURES),
            Method::Zfail => return planned(ours::MEASURES),
            _ => {}
        }
        let start = Instant::now();
        let procedure = procedure(method, geometry, view, light, options)?;
        stage.carry_out(gpu, geometry, &procedure, start)
    }

    /// Fills `reach`; fails if there is no such light.
    fn ask_reach(&mut self, view: &View, light: usize) -> Result<(), RenderError> {
        if self.reach.as_ref().is_some_and(|(v, l, _)| v == view && *l == light) {
            return Ok(());
        }
        let settings = Settings { shadows: false, lights: Some(vec![light]), ..Settings::default() };
        let mask = self.renderer.aovs(view, &settings, &[AovKind::Shadow])?.shadow.swap_remove(0);
        self.reach = Some((*view, light, mask));
        Ok(())
    }
}

/// What the older methods do with the stencil.
fn procedure(
    method: Method,
    geometry: &Geometry,
    view: &View,
    light: &Light,
    options: &Options,
) -> Result<Procedure, Error> {
    match method {
        Method::HeidmannTwoPass => heidmann::two_pass(geometry, view, light),
        Method::HeidmannTwoSided => heidmann::two_sided(geometry, view, light),
        Method::InvertedTest => inverted_test::procedure(geometry, view, light),
        Method::EyeCount => eye_count::procedure(geometry, view, light),
        Method::CarmackPreload => carmack_preload::procedure(geometry, view, light, &options.finite),
        Method::CarmackPreloadNear => carmack_preload::near_view_plane(geometry, view, light, &options.finite),
        Method::FiniteZFail => zfail_finite::procedure(geometry, view, light, &options.finite),
        Method::NearCaps => near_caps::procedure(geometry, view, light),
        Method::EverittKilgardTwoPass => everitt_kilgard::two_pass(geometry, view, light),
        _ => everitt_kilgard::procedure(geometry, view, light),
    }
}
