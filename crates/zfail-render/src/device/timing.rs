//! GPU time per pass, where the device has timestamps.

use crate::{Gpu, RenderError, device::read_back};

/// The most timestamps a query set holds (WebGPU).
const MOST: u32 = 4096;

/// Times passes, and draws within passes where the device can; its queries are kept while their number stays.
#[derive(Debug, Default)]
pub struct Timer {
    queries: Option<Queries>,
}

#[derive(Debug)]
struct Queries {
    set: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    staging: wgpu::Buffer,
}

impl Timer {
    /// Gets ready for a frame of `spans` spans of time; does nothing where the device cannot, or where there are too many.
    pub fn begin(&mut self, gpu: &Gpu, spans: usize) {
        let count = u32::try_from(2 * spans).unwrap_or(u32::MAX);
        if !gpu.timestamps || count == 0 || count > MOST {
            self.queries = None;
        } else if self.queries.as_ref().is_none_or(|q| q.set.count() != count) {
            let buffer = |usage| {
                gpu.device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("times"),
                    size: u64::from(count) * 8,
                    usage,
                    mapped_at_creation: false,
                })
            };
            self.queries = Some(Queries {
                set: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                    label: Some("times"),
                    ty: wgpu::QueryType::Timestamp,
                    count,
                }),
                resolved: buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
                staging: buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
            });
        }
    }

    /// What the pass of span `span` writes.
    pub fn pass(&self, span: usize) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
        let queries = self.queries.as_ref()?;
        Some(wgpu::RenderPassTimestampWrites {
            query_set: &queries.set,
            beginning_of_pass_write_index: Some(2 * span as u32),
            end_of_pass_write_index: Some(2 * span as u32 + 1),
        })
    }

    /// Begins, or ends, span `span` within a pass; only where [`Gpu::timestamps_inside`] holds.
    pub fn stamp(&self, pass: &mut wgpu::RenderPass<'_>, span: usize, end: bool) {
        if let Some(queries) = &self.queries {
            pass.write_timestamp(&queries.set, 2 * span as u32 + u32::from(end));
        }
    }

    /// Collects the timestamps after the last pass.
    pub fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        if let Some(Queries { set, resolved, staging }) = &self.queries {
            encoder.resolve_query_set(set, 0..set.count(), resolved, 0);
            encoder.copy_buffer_to_buffer(resolved, 0, staging, 0, resolved.size());
        }
    }

    /// Waits for the device, and returns the times of all spans.
    pub fn read(&self, gpu: &Gpu) -> Result<PassTimes, RenderError> {
        let Some(Queries { staging, .. }) = &self.queries else {
            gpu.wait()?;
            return Ok(PassTimes::default());
        };
        let mut ticks = Vec::new();
        read_back::map(gpu, staging, |bytes| ticks = bytemuck::pod_collect_to_vec(bytes))?;
        Ok(PassTimes { ticks, ms_per_tick: f64::from(gpu.queue.get_timestamp_period()) * 1e-6 })
    }
}

/// When passes began and ended.
#[derive(Clone, Debug, Default)]
pub struct PassTimes {
    /// Two per pass.
    ticks: Vec<u64>,
    ms_per_tick: f64,
}

impl PassTimes {
    /// Milliseconds that span number `pass` took.
    pub fn pass_ms(&self, pass: usize) -> Option<f64> {
        self.ms(*self.ticks.get(2 * pass)?, *self.ticks.get(2 * pass + 1)?)
    }

    /// Milliseconds from the first beginning to the last end.
    pub fn total_ms(&self) -> Option<f64> {
        self.ms(*self.ticks.iter().min()?, *self.ticks.iter().max()?)
    }

    fn ms(&self, begin: u64, end: u64) -> Option<f64> {
        Some(end.checked_sub(begin)? as f64 * self.ms_per_tick)
    }
}
