//! What counting costs on a device, by rasterisation and by tiles, and what silhouettes cost there and on the CPU.
//!
//! In: a device. Out: constants, by two measurements: of volumes, and of silhouettes.

#[cfg(not(target_family = "wasm"))]
mod silhouettes;
#[cfg(not(target_family = "wasm"))]
mod volumes;

use wgpu::{Device, Queue};

/// Times of one device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CostModel {
    /// Nanoseconds to rasterise a thin side within one 8x8 tile that it crosses.
    pub raster_pair_ns: f64,
    /// Nanoseconds to list and count such a pair in the tile pass.
    pub tile_pair_ns: f64,
    /// Nanoseconds per pixel of the light that the tile pass costs in any case.
    pub tile_pixel_ns: f64,
    /// Nanoseconds to find silhouette and caps on the CPU and to upload them, per triangle of the caster.
    pub cpu_triangle_ns: f64,
    /// Nanoseconds to find them on the device, per triangle.
    pub gpu_triangle_ns: f64,
    /// Nanoseconds for a caster that the device costs in any case.
    pub gpu_caster_ns: f64,
}

impl CostModel {
    /// Of a device that rasterises all volumes and finds no silhouettes.
    pub const RASTERISE: Self = Self {
        raster_pair_ns: 0.0,
        tile_pair_ns: 1.0,
        tile_pixel_ns: 0.0,
        cpu_triangle_ns: 0.0,
        gpu_triangle_ns: 1.0,
        gpu_caster_ns: 0.0,
    };

    /// Whether the device finds the silhouette of so many triangles in less time.
    #[must_use]
    pub(crate) fn may_extract(&self, triangles: usize) -> bool {
        triangles as f64 * (self.cpu_triangle_ns - self.gpu_triangle_ns) > self.gpu_caster_ns
    }

    /// Whether so many pairs of a side and a tile cost less by tiles, over so many pixels.
    #[must_use]
    pub(crate) fn may_tile(&self, pairs: f64, pixels: u32) -> bool {
        pairs * (self.raster_pair_ns - self.tile_pair_ns) > f64::from(pixels) * self.tile_pixel_ns
    }

    /// Measures `device`: a few frames of 512x512 pixels and a few silhouettes, a tenth of a second or two on a software
    /// device. Keep the result as long as the device.
    #[must_use]
    #[cfg(not(target_family = "wasm"))]
    pub fn calibrate(device: &Device, queue: &Queue) -> Self {
        let model = volumes::measure(device, queue).unwrap_or(Self::RASTERISE);
        silhouettes::measure(device, queue, model).unwrap_or(model)
    }

    /// In a browser nobody may wait for the device, so nothing can be measured.
    #[must_use]
    #[cfg(target_family = "wasm")]
    pub fn calibrate(_device: &Device, _queue: &Queue) -> Self {
        Self::RASTERISE
    }
}
