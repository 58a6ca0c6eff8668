//! `zfail adapters`: what there is to render with, in the order in which it is tried.

use crate::console;
use crate::error::Error;
use crate::groups::Device;
use serde::Serialize;
use std::fmt::Write;
use zfail_render::wgpu::{Backend, DeviceType, Features};
use zfail_render::{Adapter, Gpu, RenderError};

/// `zfail adapters`
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Print JSON instead of text.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    device: Device,
}

/// One adapter, as far as it matters here.
#[derive(Debug, PartialEq, Serialize)]
pub struct Entry {
    name: String,
    backend: String,
    driver: String,
    #[serde(rename = "type")]
    kind: &'static str,
    /// Depth can be clamped, for cameras with a finite far plane.
    depth_clip_control: bool,
    /// Depth has 32 bits of floating point beside the stencil.
    depth32float_stencil8: bool,
    timestamps: bool,
    ray_queries: bool,
    /// What a command without --adapter and --backend tries first.
    default: bool,
}

/// Prints the list.
///
/// # Errors
/// If there is no adapter, or standard output cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    let found = Gpu::adapters(&args.device.options());
    if found.is_empty() {
        return Err(RenderError::NoAdapter { detail: String::new() }.into());
    }
    let all_tried = args.device.adapter.is_none() && args.device.backend.is_none();
    let entries: Vec<Entry> = found.iter().enumerate().map(|(i, a)| Entry::new(a, all_tried && i == 0)).collect();
    console::print(&if args.json { console::json(&entries)? } else { text(&entries) })
}

impl Entry {
    fn new(adapter: &Adapter, default: bool) -> Self {
        let (info, has) = (&adapter.info, |feature| adapter.features.contains(feature));
        Self {
            name: info.name.clone(),
            backend: info.backend.to_string(),
            driver: driver(adapter),
            kind: match info.device_type {
                DeviceType::DiscreteGpu => "discrete",
                DeviceType::IntegratedGpu => "integrated",
                DeviceType::VirtualGpu => "virtual",
                DeviceType::Cpu => "software",
                DeviceType::Other => "other",
            },
            depth_clip_control: has(Features::DEPTH_CLIP_CONTROL),
            depth32float_stencil8: has(Features::DEPTH32FLOAT_STENCIL8),
            // Those of GL are not times on all drivers, and so are not used.
            timestamps: has(Features::TIMESTAMP_QUERY) && info.backend != Backend::Gl,
            ray_queries: has(Features::EXPERIMENTAL_RAY_QUERY),
            default,
        }
    }
}

/// Name and version of the driver, as far as it says.
fn driver(adapter: &Adapter) -> String {
    let words = [adapter.info.driver.as_str(), adapter.info.driver_info.as_str()];
    words.into_iter().filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
}

fn text(entries: &[Entry]) -> String {
    let mut text = String::new();
    for entry in entries {
        let mark = if entry.default { "  (default)" } else { "" };
        let yes = |has: bool| if has { "yes" } else { "no" };
        let driver = if entry.driver.is_empty() { "unknown" } else { &entry.driver };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}{mark}\n  {}, {}, driver {driver}", entry.name, entry.backend, entry.kind);
        let _ = writeln!(
            text,
            "  depth clip control {}, 32-bit float depth {}, timestamps {}, ray queries {}",
            yes(entry.depth_clip_control),
            yes(entry.depth32float_stencil8),
            yes(entry.timestamps),
            yes(entry.ray_queries)
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_says_which_is_the_default_and_what_it_can_do() {
        let first = Entry {
            name: "Swift".to_owned(),
            backend: "vulkan".to_owned(),
            driver: "mesa 22".to_owned(),
            kind: "software",
            depth_clip_control: true,
            depth32float_stencil8: false,
            timestamps: true,
            ray_queries: false,
            default: true,
        };
        let second = Entry { default: false, driver: String::new(), depth32float_stencil8: true, ..entry(&first) };
        assert_eq!(
            text(&[first, second]),
            "Swift  (default)\n  vulkan, software, driver mesa 22\n  depth clip control yes, 32-bit float depth no, \
             timestamps yes, ray queries no\nSwift\n  vulkan, software, driver unknown\n  depth clip control yes, \
             32-bit float depth yes, timestamps yes, ray queries no\n"
        );
    }

    fn entry(like: &Entry) -> Entry {
        Entry { name: like.name.clone(), driver: like.driver.clone(), backend: like.backend.clone(), ..*like }
    }
}
