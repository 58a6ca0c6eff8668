//! A frame whose volumes are on the device: all that can be drawn.

use crate::pipelines::{Pipelines, STICKY, Variant};
use crate::shadows::Shadows;
use crate::silhouettes::{List, Place};
use crate::tiled::can_tile;
use std::ops::Range;
use wgpu::{CommandEncoder, IndexFormat, RenderPass, RenderPipeline, TextureView};
use zfail_plan::plan::{DarkCap, Draw, Extraction, LightCap, LightStats};
use zfail_plan::scissor::Rectangle;

/// A prepared frame, by [`Shadows::prepare`]: what it draws is on the device until the next one is prepared. Submit its passes
/// before that.
#[derive(Clone, Copy, Debug)]
pub struct Prepared<'a> {
    pub(crate) shadows: &'a Shadows,
    /// Whether the tile pass has been encoded.
    counted: bool,
}

impl<'a> Prepared<'a> {
    pub(crate) fn new(shadows: &'a Shadows) -> Self {
        Self { shadows, counted: false }
    }

    /// Number of lights of the frame.
    #[must_use]
    pub fn lights(&self) -> usize {
        self.shadows.planner.last().lights.len()
    }

    /// Figures of one light: casters, what was left out and why, triangles.
    #[must_use]
    pub fn stats(&self, light: usize) -> LightStats {
        self.shadows.planner.last().lights.get(light).map(|light| light.stats).unwrap_or_default()
    }

    /// The pixels in which something may be in a light's shadow (x, y, width, height), `None` if in none: everywhere else
    /// nothing stands between the light and what it reaches.
    #[must_use]
    pub fn shadowed(&self, light: usize) -> Option<Rectangle> {
        Some(self.stats(light)).filter(LightStats::has_shadow).map(|stats| stats.scissor)
    }

    /// Whether [`Self::count_tiles`] has anything to encode: only for frames with [`Frame::tile_pass`](crate::Frame::tile_pass),
    /// and where it is cheaper.
    #[must_use]
    pub fn has_tiles(&self) -> bool {
        self.shadows.tiles_chosen()
    }

    /// Encodes the compute pass that counts sides by tiles, if there is anything for it: after the pass that finishes the depth
    /// of the view. `depth` is a view of the depth aspect alone, of a texture with one sample and the usage `TEXTURE_BINDING`.
    /// What is returned draws in passes that come after it, and leaves out what has been counted; what was there before draws
    /// everything, as it does without tiles.
    #[must_use = "what is returned draws with the counts"]
    pub fn count_tiles(self, encoder: &mut CommandEncoder, depth: &TextureView) -> Self {
        match self.shadows.tiled.as_ref().filter(|_| self.has_tiles()) {
            None => self,
            Some(tiled) => {
                tiled.pass.encode(&self.shadows.device, encoder, depth);
                Self { counted: true, ..self }
            }
        }
    }

    /// Encodes the volumes of one light. The pass holds the finished depth of the view and a stencil of 0; afterwards the
    /// stencil is 0 exactly where the light arrives ([`Counting::Verdict`](crate::Counting::Verdict)). Nothing is encoded for a
    /// light that the frame has not.
    ///
    /// Sets pipeline, bind group 0, index buffer, stencil reference and scissor; the scissor is left at the whole image.
    pub fn draw(&self, pass: &mut RenderPass<'_>, pipelines: &Pipelines, light: usize) {
        let shadows = self.shadows;
        let plan = shadows.planner.last();
        // Samples of multisampled targets are not told apart by tiles.
        let tiled = Some(light).filter(|_| self.counted).and_then(|light| shadows.tiled_light(light));
        let tiled = tiled.and_then(|tiled| Some((tiled, pipelines.tiles.as_ref()?)));
        let Some(light) = plan.lights.get(light) else { return };
        let Some(scissor) = light.scissor.filter(|_| light.stats.has_shadow()) else { return };
        self.bind_planned(pass);
        let last = light.batches.len().saturating_sub(1);
        let mut state = PassState { scissor: None, pipeline: None, extracted: None };
        let draws = || light.batches.iter().flat_map(|batch| &plan.draws[batch.start as usize..batch.end as usize]);
        let rasterised = |draw: &Draw| tiled.is_none() || !can_tile(draw);
        // Modulo 256, as all counting is. What the tile pass counts it starts itself.
        let near_count = match tiled {
            Some(_) => draws().filter(|draw| rasterised(draw)).map(|draw| draw.near_layers).sum(),
            None => light.stats.near_count,
        } % 256;
        if near_count > 0 {
            state.set_scissor(pass, scissor);
            state.set_pipeline(pass, &pipelines.start);
            pass.set_stencil_reference(near_count);
            pass.draw(0..3, 0..1);
        }
        for (i, batch) in light.batches.iter().enumerate() {
            for d in batch.clone().filter(|&d| rasterised(&plan.draws[d as usize])) {
                self.draw_volume(pass, &mut state, pipelines, d, &plan.draws[d as usize], last > 0);
            }
            if i < last {
                state.set_scissor(pass, scissor);
                state.set_pipeline(pass, &pipelines.fold);
                pass.set_stencil_reference(STICKY);
                pass.draw(0..3, 0..1);
            }
        }
        if let Some((light, pipeline)) = tiled
            && let Some(tiled) = &shadows.tiled
        {
            tiled.pass.draw(pass, pipeline, light.index, scissor);
        }
        let [x, y, width, height] = shadows.image;
        pass.set_scissor_rect(x, y, width, height);
    }

    fn draw_volume<'p>(
        &self,
        pass: &mut RenderPass<'_>,
        state: &mut PassState<'p>,
        pipelines: &'p Pipelines,
        d: u32,
        draw: &Draw,
        batched: bool,
    ) {
        // Indices are doubled to make room for the extruded bit, and so is the base.
        let base = (self.shadows.first_positions[d as usize] * 2).cast_signed();
        let volume = &draw.volume;
        let far_plane = self.shadows.far_plane;
        let variant = Variant { z_pass: draw.z_pass, far_plane, batched, clockwise: draw.mirrored };
        let reversed = Variant { clockwise: !variant.clockwise, ..variant };
        state.set_scissor(pass, draw.scissor);
        if let Some(extraction) = &draw.extraction {
            let caps = [pipelines.light_cap(variant), pipelines.light_cap(reversed)];
            self.draw_extracted(pass, state, extraction, draw.caster, pipelines.extruded(variant), caps);
            return;
        }
        if state.extracted.take().is_some() {
            self.bind_planned(pass);
        }
        // Neighbouring ranges under one pipeline are one draw.
        let mut pending: Option<(&RenderPipeline, Range<u32>)> = None;
        for (pipeline, range) in [
            (pipelines.extruded(variant), &volume.sides),
            (pipelines.extruded(variant), &volume.dark_cap),
            (pipelines.light_cap(variant), &volume.light_cap),
            (pipelines.light_cap(reversed), &volume.light_cap_reversed),
        ] {
            if range.is_empty() {
                continue;
            }
            pending = Some(match pending {
                Some((same, before)) if same == pipeline && before.end == range.start => {
                    (same, before.start..range.end)
                }
                Some((other, before)) => {
                    state.set_pipeline(pass, other);
                    pass.draw_indexed(before, base, d..d + 1);
                    (pipeline, range.clone())
                }
                None => (pipeline, range.clone()),
            });
        }
        if let Some((pipeline, range)) = pending {
            state.set_pipeline(pass, pipeline);
            pass.draw_indexed(range, base, d..d + 1);
        }
    }

    /// Draws from the index lists of the plan.
    fn bind_planned(&self, pass: &mut RenderPass<'_>) {
        pass.set_bind_group(0, &self.shadows.bindings, &[]);
        pass.set_index_buffer(self.shadows.buffers.indices.slice(..), IndexFormat::Uint32);
    }

    /// Draws the lists that the device has made for one caster, whose lengths only it knows.
    fn draw_extracted<'p>(
        &self,
        pass: &mut RenderPass<'_>,
        state: &mut PassState<'p>,
        extraction: &Extraction,
        caster: u32,
        extruded: &'p RenderPipeline,
        [light_cap, reversed]: [&'p RenderPipeline; 2],
    ) {
        let Some(silhouettes) = &self.shadows.silhouettes else { return };
        let place = (extraction.light, caster);
        if state.extracted.replace(place) != Some(place) {
            silhouettes.bind(pass, place);
        }
        if extraction.sides || extraction.dark_cap != DarkCap::None {
            state.set_pipeline(pass, extruded);
            silhouettes.draw(pass, place, List::Extruded);
        }
        if extraction.light_cap != LightCap::None {
            state.set_pipeline(pass, light_cap);
            silhouettes.draw(pass, place, List::LightCap);
            state.set_pipeline(pass, reversed);
            silhouettes.draw(pass, place, List::LightCapReversed);
        }
    }
}

/// What a pass has been told, so that it is told only once.
struct PassState<'p> {
    scissor: Option<Rectangle>,
    pipeline: Option<&'p RenderPipeline>,
    /// Whose extracted lists are bound; none for those of the plan.
    extracted: Option<Place>,
}

impl<'p> PassState<'p> {
    fn set_scissor(&mut self, pass: &mut RenderPass<'_>, scissor: Rectangle) {
        if self.scissor != Some(scissor) {
            self.scissor = Some(scissor);
            let [x, y, width, height] = scissor;
            pass.set_scissor_rect(x, y, width, height);
        }
    }

    fn set_pipeline(&mut self, pass: &mut RenderPass<'_>, pipeline: &'p RenderPipeline) {
        if self.pipeline != Some(pipeline) {
            self.pipeline = Some(pipeline);
            pass.set_pipeline(pipeline);
        }
    }
}
