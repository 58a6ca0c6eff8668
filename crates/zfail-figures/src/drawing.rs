//! A figure as a display list: what a canvas draws.
//!
//! In: geometry relative to some origin and a matrix to clip space. Nothing here knows a GPU.

use crate::legend::{Legend, Sticker};
use crate::palette::Color;
use bytemuck::{Pod, Zeroable};
use std::ops::Range;
use zfail_plan::glam::{DMat4, DVec4};
use zfail_plan::scissor::Rectangle;

/// A vertex of a surface or of a volume.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Vertex {
    /// Homogeneous; w = 0 at infinity.
    pub position: [f32; 4],
    pub color: Color,
    /// Of surfaces: 0 if both sides are visible, +1 if the counter-clockwise one, -1 if the clockwise one.
    /// Of volumes: +1 if the outside is counter-clockwise, -1 if clockwise.
    pub side: f32,
}

/// A line, as wide everywhere.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Line {
    /// Homogeneous; w = 0 at infinity.
    pub ends: [[f32; 4]; 2],
    pub color: Color,
    /// Pixels.
    pub width: f32,
    /// Opacity, relative to that in front, where a surface hides it.
    pub hidden: f32,
    /// Length of a dash and of a gap in pixels; 0 for a solid line.
    pub dash: f32,
    /// 0 if its ends are relative to the origin, 1 if in clip space.
    pub screen: f32,
}

/// Everything in one figure.
#[derive(Clone, Debug)]
pub struct Drawing {
    pub clip_from_origin: DMat4,
    /// Points at infinity lie beyond the far plane.
    pub finite: bool,
    /// What hides, and what is seen where the figure is a picture of its own.
    pub surfaces: Surfaces,
    /// Surfaces once more, in another colour.
    pub tints: Vec<Vertex>,
    /// Translucent triangles in any order.
    pub glass: Vec<Vertex>,
    /// The pixels in which runs of `glass` are drawn, in order; empty if all of it is drawn everywhere.
    pub windows: Vec<(Rectangle, Range<u32>)>,
    pub lines: Vec<Line>,
    /// Volumes that are counted: sides and dark caps, then light caps; `None` without a heat map.
    pub counted: Option<[Vec<Vertex>; 2]>,
    pub stickers: Vec<Sticker>,
    pub legend: Legend,
}

/// The scene in a figure.
#[derive(Clone, Debug)]
pub enum Surfaces {
    /// As it is, hidden behind the picture of it.
    Scene,
    /// Opaque triangles on paper.
    Paper(Vec<Vertex>),
}

impl Drawing {
    /// An empty figure.
    pub fn new(clip_from_origin: DMat4, finite: bool, surfaces: Surfaces) -> Self {
        Self {
            clip_from_origin,
            finite,
            surfaces,
            tints: Vec::new(),
            glass: Vec::new(),
            windows: Vec::new(),
            lines: Vec::new(),
            counted: None,
            stickers: Vec::new(),
            legend: Legend::default(),
        }
    }

    /// Adds a translucent triangle, drawn in the pixels of `window`. Of a drawing, all have one, or none.
    pub fn glass_within(&mut self, window: Rectangle, triangle: [Vertex; 3]) {
        let start = self.glass.len() as u32;
        self.glass.extend(triangle);
        let end = self.glass.len() as u32;
        match self.windows.last_mut() {
            Some((last, range)) if *last == window => range.end = end,
            _ => self.windows.push((window, start..end)),
        }
    }

    /// Adds a line between homogeneous points.
    pub fn line(&mut self, ends: [DVec4; 2], style: Line) {
        self.lines.push(Line { ends: ends.map(|p| p.as_vec4().to_array()), ..style });
    }
}

/// A triangle of one colour.
pub fn flat(corners: [DVec4; 3], color: Color, side: f32) -> [Vertex; 3] {
    corners.map(|p| Vertex { position: p.as_vec4().to_array(), color, side })
}

/// A solid line, visible in front of surfaces only, to be placed.
pub fn stroke(color: Color, width: f32) -> Line {
    Line { ends: [[0.0; 4]; 2], color, width, hidden: 0.0, dash: 0.0, screen: 0.0 }
}
