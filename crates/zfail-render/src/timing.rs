//! GPU time per pass, where the device has timestamps.

use crate::{Gpu, RenderError, read_back};

/// The most timestamps a query set holds (WebGPU).
const MOST: u32 = 4096;

/// Times a fixed number of passes; does nothing where the device cannot, or where there are too many.
#[derive(Debug)]
pub struct Timer {
    queries: Option<(wgpu::QuerySet, wgpu::Buffer)>,
}

impl Timer {
    pub fn new(gpu: &Gpu, passes: usize) -> Self {
        let count = u32::try_from(2 * passes).unwrap_or(u32::MAX);
        let queries = (gpu.timestamps && count <= MOST).then(|| {
            let set = gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("pass times"),
                ty: wgpu::QueryType::Timestamp,
                count,
            });
            let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("pass times"),
                size: u64::from(count) * 8,
                usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            });
            (set, buffer)
        });
        Self { queries }
    }

    /// What pass number `pass` writes.
    pub fn pass(&self, pass: usize) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
        let (query_set, _) = self.queries.as_ref()?;
        Some(wgpu::RenderPassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(2 * pass as u32),
            end_of_pass_write_index: Some(2 * pass as u32 + 1),
        })
    }

    /// Collects the timestamps after the last pass.
    pub fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        if let Some((set, buffer)) = &self.queries {
            encoder.resolve_query_set(set, 0..set.count(), buffer, 0);
        }
    }

    /// The times of all passes, after submission.
    pub fn read(&self, gpu: &Gpu) -> Result<PassTimes, RenderError> {
        let Some((_, buffer)) = &self.queries else { return Ok(PassTimes::default()) };
        let ticks = bytemuck::pod_collect_to_vec(&read_back::buffer(gpu, buffer)?);
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
    /// Milliseconds that pass number `pass` took.
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
