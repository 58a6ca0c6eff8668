//! The rest pose: morph targets at their default weights and skins with their joints where the nodes put them.
//!
//! In: a surface in its mesh's space. Out: the same surface displaced, for skins in world space.

use super::document::Document;
use super::error::{Result, invalid};
use super::schema::Primitive;
use super::surface::{Surface, vectors};
use crate::placement::cofactor;
use glam::{DAffine3, DMat3, DVec3};

/// Adds the morph targets of `primitive` by `weights`; missing weights are 0.
pub(super) fn morph(
    document: &Document<'_>,
    primitive: &Primitive,
    weights: &[f64],
    surface: &mut Surface,
    path: &str,
) -> Result<()> {
    for (t, (target, &weight)) in primitive.targets.iter().zip(weights).enumerate() {
        if weight == 0.0 {
            continue;
        }
        let displacement = |name| target.get(name).map(|&a| vectors(document, a)).transpose();
        if let Some(displacement) = displacement("POSITION")? {
            for (i, (p, d)) in surface.positions.iter_mut().zip(displacement).enumerate() {
                *p += weight * d;
                if !p.is_finite() {
                    let element = format!("{path}.targets[{t}].POSITION");
                    return Err(invalid(element, format!("takes vertex {i} to infinity")));
                }
            }
        }
        if let (Some(normals), Some(displacement)) = (&mut surface.normals, displacement("NORMAL")?) {
            normals.iter_mut().zip(displacement).for_each(|(n, d)| *n += weight * d);
        }
        if let (Some(tangents), Some(displacement)) = (&mut surface.tangents, displacement("TANGENT")?) {
            tangents.iter_mut().zip(displacement).for_each(|(t, d)| *t += (weight * d).extend(0.0));
        }
    }
    Ok(())
}

/// Linear blend skinning: takes `surface` to world space by the weighted sum of `joints`, each of which takes the
/// mesh's space to the world. Returns false, leaving the surface as it is, if the primitive names no joints.
pub(super) fn skin(
    document: &Document<'_>,
    primitive: &Primitive,
    joints: &[DAffine3],
    surface: &mut Surface,
    path: &str,
) -> Result<bool> {
    let mut sets = Vec::new();
    for set in 0.. {
        let names = [format!("JOINTS_{set}"), format!("WEIGHTS_{set}")];
        let (Some(&j), Some(&w)) = (primitive.attributes.get(&names[0]), primitive.attributes.get(&names[1])) else {
            break;
        };
        sets.push((document.integers::<4>(j)?, document.floats::<4>(w)?));
    }
    if sets.is_empty() {
        return Ok(false);
    }
    for i in 0..surface.positions.len() {
        let influences = sets.iter().flat_map(|(j, w)| (0..4).map(move |k| (j[i][k], f64::from(w[i][k]))));
        let blend = blend(influences, joints).map_err(|problem| invalid(path, format!("vertex {i}: {problem}")))?;
        let p = &mut surface.positions[i];
        *p = blend.transform_point3(*p);
        if !p.is_finite() {
            return Err(invalid(path, format!("vertex {i}: its joints take it to infinity")));
        }
        if let Some(normals) = &mut surface.normals {
            let side = blend.matrix3.determinant().signum();
            normals[i] = (cofactor(&blend.matrix3) * normals[i]).normalize_or_zero() * side;
        }
        if let Some(tangents) = &mut surface.tangents {
            let t = tangents[i];
            tangents[i] = blend.transform_vector3(t.truncate()).extend(t.w);
        }
    }
    Ok(true)
}

/// The weighted mean of `joints`. Weights that do not add up to 1 are scaled; without any, the first joint counts.
fn blend(influences: impl Iterator<Item = (u32, f64)>, joints: &[DAffine3]) -> std::result::Result<DAffine3, String> {
    let mut sum = DAffine3 { matrix3: DMat3::ZERO, translation: DVec3::ZERO };
    let mut total = 0.0;
    let mut first = None;
    for (joint, weight) in influences {
        first = first.or(Some(joint));
        if weight == 0.0 {
            continue;
        }
        if !(weight.is_finite() && weight > 0.0) {
            return Err(format!("the weight {weight} of joint {joint} is negative or not finite"));
        }
        let joint =
            joints.get(joint as usize).ok_or_else(|| format!("joint {joint} of {} does not exist", joints.len()))?;
        sum.matrix3 += joint.matrix3 * weight;
        sum.translation += joint.translation * weight;
        total += weight;
    }
    if total == 0.0 {
        let joint = first.and_then(|joint| joints.get(joint as usize));
        return joint.copied().ok_or_else(|| "it has no joint".into());
    }
    Ok(DAffine3 { matrix3: sum.matrix3 * (1.0 / total), translation: sum.translation / total })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blending() {
        let joints =
            [DAffine3::IDENTITY, DAffine3::from_translation(DVec3::X), DAffine3::from_scale(DVec3::splat(3.0))];
        let at = |influences: &[(u32, f64)]| {
            blend(influences.iter().copied(), &joints).map(|m| m.transform_point3(DVec3::Y))
        };
        assert_eq!(at(&[(1, 0.5), (0, 0.5)]).unwrap(), DVec3::new(0.5, 1.0, 0.0));
        assert_eq!(at(&[(1, 2.0), (0, 2.0)]).unwrap(), DVec3::new(0.5, 1.0, 0.0), "weights are scaled");
        assert_eq!(at(&[(2, 0.0), (9, 0.0)]).unwrap(), DVec3::Y * 3.0, "no weights: the first joint");
        assert_eq!(at(&[(0, 1.0), (9, 0.0)]).unwrap(), DVec3::Y, "an unused joint may be absent");
        for bad in [(9, 1.0), (0, f64::NAN), (0, -1.0), (0, f64::INFINITY)] {
            assert!(at(&[bad]).is_err(), "{bad:?}");
        }
    }
}
