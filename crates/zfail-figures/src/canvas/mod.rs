//! Drawings onto textures.
//!
//! In: a display list. Out: a picture with the figure on it. One pass draws two layers against one depth buffer: glass,
//! whose optical depths add up so that no order matters, and ink; they are then laid over the picture. Edges are smooth
//! whatever the picture's own samples are. Counts have a pass of their own at pixel centres.

mod buffers;
mod pipelines;
mod stickers;
mod targets;

use crate::Error;
use crate::drawing::{Drawing, Surfaces, Vertex};
use crate::palette;
use buffers::Stream;
use bytemuck::{Pod, Zeroable, cast_slice};
use pipelines::Pipelines;
use stickers::Stickers;
use targets::Targets;
use zfail_render::{Gpu, wgpu};

/// Pipelines, textures and buffers of one device.
#[derive(Debug)]
pub struct Canvas<'g> {
    gpu: &'g Gpu,
    samples: u32,
    pipelines: Pipelines,
    targets: Option<Targets>,
    frame: wgpu::Buffer,
    frame_binding: wgpu::BindGroup,
    heat: wgpu::Buffer,
    scene: Stream,
    paper: Stream,
    tints: Stream,
    glass: Stream,
    lines: Stream,
    counted: [Stream; 2],
    stickers: Stickers,
}

/// `Frame` of `figure.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct FrameRecord {
    clip_from_origin: [[f32; 4]; 4],
    size: [f32; 2],
    padding: [f32; 2],
}

impl<'g> Canvas<'g> {
    pub fn new(gpu: &'g Gpu) -> Self {
        // wgpu cannot read back what it has drawn with several samples on GL.
        let samples = if gpu.info.backend == wgpu::Backend::Gl { 1 } else { 4 };
        let pipelines = Pipelines::new(&gpu.device, samples);
        let uniform = |label, size| buffers::create(gpu, label, size, wgpu::BufferUsages::UNIFORM);
        let frame = uniform("figure frame", size_of::<FrameRecord>() as u64);
        let heat = uniform("heat", 16 * palette::COUNTS.len() as u64);
        let colors = palette::COUNTS.map(|([r, g, b], _)| [r, g, b, 255].map(|c| f32::from(c) / 255.0));
        gpu.queue.write_buffer(&heat, 0, cast_slice(&colors));
        let stream = |label| Stream::new(gpu, label);
        Self {
            gpu,
            samples,
            frame_binding: bind(gpu, &pipelines.frame, &[(0, frame.as_entire_binding())]),
            frame,
            heat,
            targets: None,
            scene: stream("figure scene"),
            paper: stream("figure paper"),
            tints: stream("figure tints"),
            glass: stream("figure glass"),
            lines: stream("figure lines"),
            counted: [stream("figure counts"), stream("figure cap counts")],
            stickers: Stickers::new(gpu),
            pipelines,
        }
    }

    /// Replaces the scene's surfaces.
    pub fn set_scene(&mut self, surfaces: &[Vertex]) -> Result<(), Error> {
        self.scene.set(self.gpu, surfaces)
    }

    /// Uploads a drawing, to be drawn from now on.
    pub fn set_drawing(&mut self, drawing: &Drawing, size: [u32; 2]) -> Result<(), Error> {
        let gpu = self.gpu;
        let record = FrameRecord {
            clip_from_origin: drawing.clip_from_origin.as_mat4().to_cols_array_2d(),
            size: size.map(|side| side as f32),
            padding: [0.0; 2],
        };
        gpu.queue.write_buffer(&self.frame, 0, bytemuck::bytes_of(&record));
        if let Surfaces::Paper(triangles) = &drawing.surfaces {
            self.paper.set(gpu, triangles)?;
        }
        self.tints.set(gpu, &drawing.tints)?;
        self.glass.set(gpu, &drawing.glass)?;
        self.lines.set(gpu, &drawing.lines)?;
        let none = [Vec::new(), Vec::new()];
        for (stream, counted) in self.counted.iter_mut().zip(drawing.counted.as_ref().unwrap_or(&none)) {
            stream.set(gpu, counted)?;
        }
        let stickers: Vec<_> = drawing.stickers.iter().cloned().chain(drawing.legend.panel(size)).collect();
        self.stickers.set(gpu, &self.pipelines.sheets, &stickers, size)
    }

    /// Draws `drawing`, which was uploaded, onto `target`.
    pub fn draw(&mut self, drawing: &Drawing, target: &wgpu::TextureView, size: [u32; 2]) {
        let (gpu, samples) = (self.gpu, self.samples);
        if self.targets.as_ref().is_none_or(|targets| targets.size != size) {
            self.targets = None;
        }
        let mut targets = self.targets.take().unwrap_or_else(|| Targets::new(gpu, size, samples));
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        if drawing.counted.is_some() {
            self.count(&mut encoder, drawing.finite, &mut targets, target);
        }
        self.surfaces(&mut encoder, &drawing.surfaces, &targets, target);
        self.layers(&mut encoder, drawing, &targets);
        self.composite(&mut encoder, &targets, target);
        gpu.queue.submit([encoder.finish()]);
        self.targets = Some(targets);
    }

    /// Counts volumes and maps the counts over the picture.
    fn count(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        finite: bool,
        targets: &mut Targets,
        target: &wgpu::TextureView,
    ) {
        let counts = targets.counts(self.gpu);
        let mut pass = begin(encoder, &[cleared(&counts.counts, None, [0.0; 4])], Some(fresh_depth(&counts.depth)));
        pass.set_bind_group(0, &self.frame_binding, &[]);
        self.scene.draw(&mut pass, &self.pipelines.mark);
        let [extruded, caps] = &self.counted;
        extruded.draw(&mut pass, &self.pipelines.count[usize::from(finite)]);
        caps.draw(&mut pass, &self.pipelines.count[0]);
        drop(pass);
        let resources = [(2, wgpu::BindingResource::TextureView(&counts.counts)), (3, self.heat.as_entire_binding())];
        let binding = bind(self.gpu, &self.pipelines.counts, &resources);
        let mut pass = begin(encoder, &[continued(target)], None);
        pass.set_pipeline(&self.pipelines.map);
        pass.set_bind_group(0, &binding, &[]);
        pass.draw(0..3, 0..1);
    }

    /// Lays depth, and for a figure of its own what is opaque in it.
    fn surfaces(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        surfaces: &Surfaces,
        targets: &Targets,
        target: &wgpu::TextureView,
    ) {
        let depth = Some(fresh_depth(&targets.depth));
        match surfaces {
            Surfaces::Scene => {
                let mut pass = begin(encoder, &[], depth);
                pass.set_bind_group(0, &self.frame_binding, &[]);
                self.scene.draw(&mut pass, &self.pipelines.depth);
            }
            Surfaces::Paper(_) => {
                let [r, g, b] = palette::PAPER.map(|c| f64::from(c) / 255.0);
                let paper = match &targets.paper {
                    Some(samples) => cleared(samples, Some(target), [r, g, b, 1.0]),
                    None => cleared(target, None, [r, g, b, 1.0]),
                };
                let mut pass = begin(encoder, &[paper], depth);
                pass.set_bind_group(0, &self.frame_binding, &[]);
                self.paper.draw(&mut pass, &self.pipelines.opaque);
            }
        }
    }

    fn layers(&self, encoder: &mut wgpu::CommandEncoder, drawing: &Drawing, targets: &Targets) {
        let depth = wgpu::RenderPassDepthStencilAttachment {
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Discard }),
            ..fresh_depth(&targets.depth)
        };
        let mut pass = begin(encoder, &[targets.glass.attachment(), targets.ink.attachment()], Some(depth));
        pass.set_bind_group(0, &self.frame_binding, &[]);
        self.tints.draw(&mut pass, &self.pipelines.tint);
        if drawing.windows.is_empty() {
            self.glass.draw(&mut pass, &self.pipelines.glass);
        }
        for ([x, y, width, height], vertices) in &drawing.windows {
            pass.set_scissor_rect(*x, *y, *width, *height);
            self.glass.draw_part(&mut pass, &self.pipelines.glass, vertices.clone());
        }
        pass.set_scissor_rect(0, 0, targets.size[0], targets.size[1]);
        self.lines.draw_quads(&mut pass, &self.pipelines.hidden_ink);
        self.lines.draw_quads(&mut pass, &self.pipelines.ink);
    }

    fn composite(&self, encoder: &mut wgpu::CommandEncoder, targets: &Targets, target: &wgpu::TextureView) {
        let layers = [targets.glass.view(), targets.ink.view()].map(wgpu::BindingResource::TextureView);
        let [glass, ink] = layers;
        let binding = bind(self.gpu, &self.pipelines.layers, &[(0, glass), (1, ink)]);
        let mut pass = begin(encoder, &[continued(target)], None);
        pass.set_pipeline(&self.pipelines.lay);
        pass.set_bind_group(0, &binding, &[]);
        pass.draw(0..3, 0..1);
        self.stickers.draw(&mut pass, &self.pipelines.letters);
    }
}

fn begin<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    colors: &[Option<wgpu::RenderPassColorAttachment<'_>>],
    depth: Option<wgpu::RenderPassDepthStencilAttachment<'_>>,
) -> wgpu::RenderPass<'e> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("figure"),
        color_attachments: colors,
        depth_stencil_attachment: depth,
        ..wgpu::RenderPassDescriptor::default()
    })
}

fn cleared<'t>(
    view: &'t wgpu::TextureView,
    resolve_target: Option<&'t wgpu::TextureView>,
    [r, g, b, a]: [f64; 4],
) -> Option<wgpu::RenderPassColorAttachment<'t>> {
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a }), store: wgpu::StoreOp::Store };
    Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target, ops })
}

fn continued(view: &wgpu::TextureView) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    let ops = wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store };
    Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
}

/// Depth that starts infinitely far.
fn fresh_depth(view: &wgpu::TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
        stencil_ops: None,
    }
}

fn bind(gpu: &Gpu, layout: &wgpu::BindGroupLayout, resources: &[(u32, wgpu::BindingResource<'_>)]) -> wgpu::BindGroup {
    let entries: Vec<wgpu::BindGroupEntry<'_>> = resources
        .iter()
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding: *binding, resource: resource.clone() })
        .collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("figure"), layout, entries: &entries })
}

#[cfg(test)]
mod tests {
    use super::{FrameRecord, palette};
    use zfail_testing::{layout, naga::valid::Capabilities, wgsl};

    #[test]
    fn records_lie_as_their_shaders_read_them() {
        let validate = |source| wgsl::validate(source, Capabilities::MULTISAMPLED_SHADING).expect("WGSL");
        let (figure, composite) = (validate(include_str!("figure.wgsl")), validate(include_str!("composite.wgsl")));
        layout!(&figure, "Frame", FrameRecord, [clip_from_origin, size]).expect("agreement");
        let heat = |colors: usize| wgsl::compare_layout(&composite, "Heat", 16 * colors, &[("colors", 0)]);
        heat(palette::COUNTS.len()).expect("agreement");
        heat(palette::COUNTS.len() + 1).expect_err("a colour too many");
    }
}
