//! What bends a primitive: its morph targets and its joints.
//!
//! In: a primitive of a validated document. Out: the parts of a [`Section`](zfail_scene::deform::Section) that displace vertices,
//! checked, so that posing cannot fail but by leaving all measure; and which vertices have no place because of them.

use super::document::Document;
use super::schema::Primitive;
use crate::shared::error::{Result, invalid};
use std::collections::BTreeMap;
use zfail_scene::deform::{Influences, Target};

/// The morph targets of `primitive`, at `path`; those that are not `wanted` are empty. Marks vertices `broken` that a target
/// takes to no place.
pub(super) fn targets(
    document: &Document<'_>,
    primitive: &Primitive,
    path: &str,
    broken: &mut [bool],
    wanted: impl Fn(usize) -> bool,
) -> Result<Vec<Target>> {
    let last = (0..primitive.targets.len()).rev().find(|&t| wanted(t));
    let mut target = |(t, attributes): (usize, &BTreeMap<String, usize>)| {
        let displacement = |name: &str| match attributes.get(name).filter(|_| wanted(t)) {
            Some(&accessor) if document.count(accessor) == broken.len() as u64 => document.floats::<3>(accessor),
            Some(&accessor) if name == "POSITION" => {
                let problem = format!("has {} elements, but POSITION has {}", document.count(accessor), broken.len());
                Err(invalid(format!("{path}.targets[{t}].{name}"), problem))
            }
            // Without its own displacement, a normal stays as it is.
            _ => Ok(Vec::new()),
        };
        let (positions, normals, tangents) =
            (displacement("POSITION")?, displacement("NORMAL")?, displacement("TANGENT")?);
        for (broken, displacement) in broken.iter_mut().zip(&positions) {
            *broken |= !displacement.iter().all(|x| x.is_finite());
        }
        Ok(Target { positions, normals, tangents })
    };
    primitive.targets.iter().enumerate().take(last.map_or(0, |last| last + 1)).map(&mut target).collect()
}

/// The joints of `primitive`, at `path`, out of `joint_count`; `None` if it names none. Marks vertices `broken` whose joints
/// are not there or whose weights are not finite. Weights below 0 count as 0.
pub(super) fn influences(
    document: &Document<'_>,
    primitive: &Primitive,
    joint_count: usize,
    path: &str,
    broken: &mut [bool],
) -> Result<Option<Influences>> {
    let mut sets = Vec::new();
    for set in 0.. {
        let names = [format!("JOINTS_{set}"), format!("WEIGHTS_{set}")];
        let (Some(&j), Some(&w)) = (primitive.attributes.get(&names[0]), primitive.attributes.get(&names[1])) else {
            break;
        };
        for (name, accessor) in names.into_iter().zip([j, w]) {
            if document.count(accessor) != broken.len() as u64 {
                let problem = format!("has {} elements, but POSITION has {}", document.count(accessor), broken.len());
                return Err(invalid(format!("{path}.attributes.{name}"), problem));
            }
        }
        sets.push((document.integers::<4>(j)?, document.floats::<4>(w)?));
    }
    if sets.is_empty() {
        return Ok(None);
    }
    let (count, width) = (broken.len(), sets.len() * 4);
    document.budget.charge(count as u64, width as u64 * 8, || path.into())?;
    let mut all = Influences { width, joints: Vec::with_capacity(count * width), weights: Vec::new() };
    all.weights.reserve(count * width);
    for (v, broken) in broken.iter_mut().enumerate() {
        let first = all.weights.len();
        for (joints, weights) in &sets {
            for (&joint, &weight) in joints[v].iter().zip(&weights[v]) {
                let counts = weight > 0.0 || weight.is_nan();
                let is_sound = !counts || (weight.is_finite() && (joint as usize) < joint_count);
                *broken |= !is_sound;
                all.joints.push(if is_sound { joint } else { 0 });
                all.weights.push(if is_sound && counts { weight } else { 0.0 });
            }
        }
        // Without any weight, the first joint counts.
        if all.weights[first..].iter().all(|&weight| weight == 0.0) {
            *broken |= all.joints[first] as usize >= joint_count;
            all.joints[first] = all.joints[first].min(joint_count.saturating_sub(1) as u32);
            all.weights[first] = 1.0;
        }
    }
    Ok(Some(all))
}
