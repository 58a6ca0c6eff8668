//! The division of casting triangles that one batch cannot hold.
//!
//! In: weights of every pair of one light. Out: a batch number per triangle, so that no ray crosses more layers of a batch
//! than seven bits can count.

use super::pair::Pair;
use super::sheets::sheets;
use super::stage::Stage;
use crate::light::LightKind;
use crate::stack::{self, Caster, Outline, Work};
use crate::topology::Topology;
use std::ops::Range;

/// Layers that a stencil of 7 bits can tell from zero, when the eighth is the sticky one; less a few as in
/// [`super::batches::SINGLE`].
const FOLDED: usize = 120;

/// A casting triangle.
#[derive(Clone, Copy, Debug)]
struct Item {
    pair: u32,
    triangle: u32,
    /// With which others it hangs together.
    sheet: u32,
    /// Of the sheet's nearest triangle.
    distance: f64,
}

/// Distributes casting triangles over batches.
pub(super) fn spread(stage: &Stage<'_>, kind: &LightKind, pairs: &mut [Pair], shape: &stack::Chart, work: &mut Work) {
    let items = items(stage, kind, pairs);
    let mut batches = Vec::new();
    halve(&items, |run, work| is_within(stage, pairs, shape, run, work), work, &mut batches);
    for pair in pairs.iter_mut().filter(|pair| pair.is_active()) {
        let triangles = pair.weights().len();
        pair.divide(|batch_of| {
            batch_of.clear();
            batch_of.resize(triangles, 0);
        });
    }
    for (batch, range) in batches.into_iter().enumerate() {
        for item in &items[range] {
            // More batches than 16 bits would need 8 million stacked layers; the last one takes the rest.
            pairs[item.pair as usize].batch_of[item.triangle as usize] = batch.min(usize::from(u16::MAX)) as u16;
        }
    }
}

/// All casting triangles of one light, nearest caster first, nearest sheet first.
fn items(stage: &Stage<'_>, kind: &LightKind, pairs: &[Pair]) -> Vec<Item> {
    let light = kind.homogeneous();
    let mut items = Vec::new();
    let mut nearest = vec![f64::INFINITY; pairs.len()];
    for (p, (pair, caster)) in pairs.iter().zip(stage.placed).enumerate().filter(|(_, (pair, _))| pair.is_active()) {
        let sheets = sheets(stage.topology(p), pair.weights());
        let first = items.len();
        for triangle in (0..pair.weights().len()).filter(|&t| pair.weights()[t] != 0) {
            let corners = stage.topology(p).corners(triangle);
            let center = caster.world_from_object.transform_point3((corners[0] + corners[1] + corners[2]) / 3.0);
            let distance =
                if light.w == 0.0 { -light.truncate().dot(center) } else { light.truncate().distance(center) };
            nearest[p] = nearest[p].min(distance);
            items.push(Item { pair: p as u32, triangle: triangle as u32, sheet: sheets[triangle], distance });
        }
        let mut of_sheet = vec![f64::INFINITY; sheets.len()];
        for item in &items[first..] {
            let nearest = &mut of_sheet[item.sheet as usize];
            *nearest = nearest.min(item.distance);
        }
        items[first..].iter_mut().for_each(|item| item.distance = of_sheet[item.sheet as usize]);
    }
    items.sort_by(|a, b| {
        let [p, q] = [a, b].map(|item| nearest[item.pair as usize]);
        let casters = p.total_cmp(&q).then(a.pair.cmp(&b.pair));
        casters.then(a.distance.total_cmp(&b.distance)).then(a.sheet.cmp(&b.sheet))
    });
    items
}

/// Halves the sequence of items until all runs are proved to be within, between casters where possible, or else between
/// sheets.
fn halve(items: &[Item], is_within: impl Fn(&[Item], &mut Work) -> bool, work: &mut Work, out: &mut Vec<Range<usize>>) {
    let mut rest = Vec::new();
    let mut next = Some(0..items.len());
    while let Some(range) = next.take().or_else(|| rest.pop()) {
        if range.len() <= FOLDED || !work.is_over() && is_within(&items[range.clone()], work) {
            out.push(range);
            continue;
        }
        let middle = usize::midpoint(range.start, range.end);
        let casters = |i: usize| items[i - 1].pair != items[i].pair;
        let sheets = |i: usize| casters(i) || items[i - 1].sheet != items[i].sheet;
        let cut = border(&range, middle, casters).or_else(|| border(&range, middle, sheets)).unwrap_or(middle);
        rest.push(cut..range.end);
        next = Some(range.start..cut);
    }
}

/// The border within `range` that is nearest to its middle.
fn border(range: &Range<usize>, middle: usize, is_border: impl Fn(usize) -> bool) -> Option<usize> {
    let before = (range.start + 1..=middle).rev().find(|&i| is_border(i));
    let after = (middle..range.end).find(|&i| i > range.start && is_border(i));
    match (before, after) {
        (Some(b), Some(a)) if middle - b <= a - middle => Some(b),
        (_, Some(i)) | (Some(i), None) => Some(i),
        (None, None) => None,
    }
}

/// Whether no ray crosses more than [`FOLDED`] layers of a run.
fn is_within(stage: &Stage<'_>, pairs: &[Pair], shape: &stack::Chart, run: &[Item], work: &mut Work) -> bool {
    let mut outline = Outline::new(shape.clone());
    let mut edges = Vec::new();
    for run in run.chunk_by(|a, b| a.pair == b.pair) {
        let p = run[0].pair as usize;
        let (pair, topology) = (&pairs[p], stage.topology(p));
        if run.len() == pair.casting() && pair.is_united() {
            pair.outline(topology, &stage.placed[p], &mut outline);
            continue;
        }
        silhouette(topology, pair.weights(), run, &mut edges);
        let silhouette = edges.iter().flat_map(|&(edge, times)| std::iter::repeat_n(edge, times as usize));
        let caster = Caster {
            topology,
            weights: pair.weights(),
            world_from_object: &stage.placed[p].world_from_object,
            light: pair.light,
        };
        outline.add(&caster, silhouette, run.iter().map(|item| item.triangle as usize));
    }
    outline.is_within(FOLDED, work)
}

/// The edges at which a run of one caster's triangles ends, along the way of those with weight 1, and how often.
fn silhouette(topology: &Topology, weights: &[i8], run: &[Item], out: &mut Vec<([u32; 2], i32)>) {
    out.clear();
    for item in run {
        let t = item.triangle as usize;
        let ([a, b, c], weight) = (topology.triangles[t], i32::from(weights[t]));
        out.extend([(a, b), (b, c), (c, a)].map(
            |(from, to)| {
                if from < to { ([from, to], weight) } else { ([to, from], -weight) }
            },
        ));
    }
    out.sort_unstable();
    let mut kept = 0;
    let mut start = 0;
    while start < out.len() {
        let [lo, hi] = out[start].0;
        let count = out[start..].iter().take_while(|edge| edge.0 == [lo, hi]).count();
        let sum: i32 = out[start..start + count].iter().map(|edge| edge.1).sum();
        if sum != 0 {
            out[kept] = (if sum > 0 { [lo, hi] } else { [hi, lo] }, sum.abs());
            kept += 1;
        }
        start += count;
    }
    out.truncate(kept);
}
