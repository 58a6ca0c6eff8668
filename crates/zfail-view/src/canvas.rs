//! The window's surface: configuring it, and putting picture and panels onto it.

use crate::ViewError;
use crate::present::Present;
use egui_wgpu::{RendererOptions, ScreenDescriptor};
use std::mem;
use std::sync::Arc;
use wgpu::CurrentSurfaceTexture as Acquired;
use winit::window::Window;
use zfail_render::Gpu;

/// A surface with what draws onto it.
pub struct Canvas {
    instance: wgpu::Instance,
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    present: Present,
    panels: egui_wgpu::Renderer,
    /// Whether the surface has a size and is configured for it.
    ready: bool,
}

/// What becomes of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// It is on the screen.
    Yes,
    /// It is not, and should be drawn again.
    Again,
    /// It is not, because nobody would see it.
    Hidden,
}

impl Canvas {
    /// A surface that presents as `capabilities` say.
    ///
    /// # Errors
    /// If it supports no format.
    pub fn new(
        gpu: &Gpu,
        instance: wgpu::Instance,
        window: Arc<Window>,
        surface: wgpu::Surface<'static>,
        capabilities: &wgpu::SurfaceCapabilities,
    ) -> Result<Self, ViewError> {
        // Panels are blended as they were designed where the surface does not encode.
        let formats = &capabilities.formats;
        let plain = [wgpu::TextureFormat::Bgra8Unorm, wgpu::TextureFormat::Rgba8Unorm];
        let format = formats.iter().find(|format| plain.contains(format)).or(formats.first());
        let format = *format.ok_or_else(|| ViewError::Surface("it has no format".to_owned()))?;
        let config = wgpu::SurfaceConfiguration {
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            format,
            color_space: wgpu::SurfaceColorSpace::Auto,
            width: 0,
            height: 0,
            present_mode: wgpu::PresentMode::AutoVsync,
            desired_maximum_frame_latency: 1,
            alpha_mode: wgpu::CompositeAlphaMode::Auto,
            view_formats: Vec::new(),
        };
        let panels = egui_wgpu::Renderer::new(&gpu.device, format, RendererOptions::default());
        let present = Present::new(gpu, format);
        let mut canvas = Self { instance, window, surface, config, present, panels, ready: false };
        canvas.resize(gpu);
        Ok(canvas)
    }

    /// Takes the window's size.
    pub fn resize(&mut self, gpu: &Gpu) {
        let size = self.window.inner_size();
        let most = gpu.device.limits().max_texture_dimension_2d;
        (self.config.width, self.config.height) = (size.width.min(most), size.height.min(most));
        self.ready = size.width > 0 && size.height > 0;
        if self.ready {
            self.surface.configure(&gpu.device, &self.config);
        }
    }

    /// Draws `picture` into `area` (points) and the panels over it.
    ///
    /// # Errors
    /// If the surface is lost for good.
    pub fn show(
        &mut self,
        gpu: &Gpu,
        context: &egui::Context,
        mut output: egui::FullOutput,
        picture: Option<(&wgpu::Texture, egui::Rect)>,
    ) -> Result<Shown, ViewError> {
        let mut textures = mem::take(&mut output.textures_delta);
        for (id, deltas) in textures.set.drain() {
            for delta in deltas {
                self.panels.update_texture(&gpu.device, &gpu.queue, id, &delta);
            }
        }
        let unused = mem::take(&mut textures.free);
        let shown = match self.acquire(gpu)? {
            Ok(frame) => {
                let jobs = context.tessellate(output.shapes, output.pixels_per_point);
                self.paint(gpu, &frame, &jobs, output.pixels_per_point, picture);
                self.window.pre_present_notify();
                gpu.queue.present(frame);
                Shown::Yes
            }
            Err(shown) => shown,
        };
        for id in &unused {
            self.panels.free_texture(id);
        }
        Ok(shown)
    }

    /// The texture to draw onto.
    fn acquire(&mut self, gpu: &Gpu) -> Result<Result<wgpu::SurfaceTexture, Shown>, ViewError> {
        if !self.ready {
            return Ok(Err(Shown::Hidden));
        }
        Ok(match self.surface.get_current_texture() {
            Acquired::Success(frame) | Acquired::Suboptimal(frame) => Ok(frame),
            Acquired::Timeout => Err(Shown::Again),
            Acquired::Occluded => Err(Shown::Hidden),
            Acquired::Outdated => {
                self.resize(gpu);
                Err(Shown::Again)
            }
            Acquired::Lost => {
                let surface = self.instance.create_surface(Arc::clone(&self.window));
                self.surface = surface.map_err(|e| ViewError::Surface(e.to_string()))?;
                self.resize(gpu);
                Err(Shown::Again)
            }
            Acquired::Validation => {
                gpu.check()?;
                Err(Shown::Hidden)
            }
        })
    }

    fn paint(
        &mut self,
        gpu: &Gpu,
        frame: &wgpu::SurfaceTexture,
        jobs: &[egui::ClippedPrimitive],
        pixels_per_point: f32,
        picture: Option<(&wgpu::Texture, egui::Rect)>,
    ) {
        let size = [frame.texture.width(), frame.texture.height()];
        let screen = ScreenDescriptor { size_in_pixels: size, pixels_per_point };
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let callbacks = self.panels.update_buffers(&gpu.device, &gpu.queue, &mut encoder, jobs, &screen);
        let view = frame.texture.create_view(&wgpu::TextureViewDescriptor::default());
        let mut pass = encoder
            .begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("window"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..Default::default()
            })
            .forget_lifetime();
        if let Some((texture, area)) = picture {
            let pixels = |at: f32, most: u32| ((at * pixels_per_point).round().max(0.0) as u32).min(most);
            let [x, y] = [pixels(area.min.x, size[0]), pixels(area.min.y, size[1])];
            let [right, bottom] = [pixels(area.max.x, size[0]), pixels(area.max.y, size[1])];
            let area = [x, y, right.saturating_sub(x), bottom.saturating_sub(y)];
            self.present.draw(gpu, &mut pass, texture, area);
        }
        self.panels.render(&mut pass, jobs, &screen);
        drop(pass);
        gpu.queue.submit(callbacks.into_iter().chain([encoder.finish()]));
    }
}
