//! What bends a primitive: its morph targets and its joints.
//!
//! In: a primitive of a validated document. Out: the parts of a [`Section`](crate::deform::Section) that displace vertices,
//! checked, so that posing cannot fail but by leaving all measure.

use super::document::Document;
use super::error::{Result, invalid};
use super::schema::Primitive;
use crate::deform::{Influences, Target};

/// The morph targets of `primitive`; those that are not `wanted` are empty.
pub(super) fn targets(
    document: &Document<'_>,
    primitive: &Primitive,
    wanted: impl Fn(usize) -> bool,
) -> Result<Vec<Target>> {
    let last = (0..primitive.targets.len()).rev().find(|&t| wanted(t));
    let target = |(t, attributes): (usize, &std::collections::BTreeMap<String, usize>)| {
        let displacement = |name: &str| match attributes.get(name).filter(|_| wanted(t)) {
            Some(&accessor) => document.floats::<3>(accessor),
            None => Ok(Vec::new()),
        };
        Ok(Target {
            positions: displacement("POSITION")?,
            normals: displacement("NORMAL")?,
            tangents: displacement("TANGENT")?,
        })
    };
    primitive.targets.iter().enumerate().take(last.map_or(0, |last| last + 1)).map(target).collect()
}

/// The joints of `primitive`, at `path`, out of `joint_count`; `None` if it names none.
pub(super) fn influences(
    document: &Document<'_>,
    primitive: &Primitive,
    joint_count: usize,
    path: &str,
) -> Result<Option<Influences>> {
    let mut sets = Vec::new();
    for set in 0.. {
        let names = [format!("JOINTS_{set}"), format!("WEIGHTS_{set}")];
        let (Some(&j), Some(&w)) = (primitive.attributes.get(&names[0]), primitive.attributes.get(&names[1])) else {
            break;
        };
        sets.push((document.integers::<4>(j)?, document.floats::<4>(w)?));
    }
    let Some(count) = sets.iter().map(|(j, w)| j.len().min(w.len())).min() else { return Ok(None) };
    let width = sets.len() * 4;
    document.budget.charge(count as u64, width as u64 * 8, || path.into())?;
    let mut all = Influences { width, joints: Vec::with_capacity(count * width), weights: Vec::new() };
    all.weights.reserve(count * width);
    for v in 0..count {
        let pairs = sets.iter().flat_map(|(j, w)| (0..4).map(move |k| (j[v][k], w[v][k])));
        let first = all.weights.len();
        for (joint, weight) in pairs {
            let fail = |problem: String| Err(invalid(path, format!("vertex {v}: {problem}")));
            if !(weight.is_finite() && weight >= 0.0) {
                return fail(format!("the weight {weight} of joint {joint} is negative or not finite"));
            }
            if weight > 0.0 && joint as usize >= joint_count {
                return fail(format!("joint {joint} of {joint_count} does not exist"));
            }
            all.joints.push(joint);
            all.weights.push(weight);
        }
        // Without any weight, the first joint counts.
        if all.weights[first..].iter().all(|&weight| weight == 0.0) {
            if all.joints[first] as usize >= joint_count {
                return Err(invalid(
                    path,
                    format!("vertex {v}: joint {} of {joint_count} does not exist", all.joints[first]),
                ));
            }
            all.weights[first] = 1.0;
        }
    }
    Ok(Some(all))
}
