//! EXT_meshopt_compression and KHR_meshopt_compression: the bytes of one compressed buffer view.
//!
//! In: the extension's description, checked here against its buffer view, and the compressed bytes. Out: `count`
//! elements at a distance of `byteStride`, filter undone, exactly the view's bytes.

use super::schema::{BufferView, Meshopt, MeshoptFilter as Filter, MeshoptMode as Mode};
use crate::shared::error::{Fault, Result, invalid};
use crate::shared::limits::Budget;
use meshoptimizer_rs::codec::{
    decode_filter_color, decode_filter_exp, decode_filter_oct, decode_filter_quat, decode_index_buffer,
    decode_index_sequence, decode_vertex_buffer,
};
use meshoptimizer_rs::{Limits, Workspace};

/// Decodes `source`, which `view`, found at JSON path `path`, describes with `meshopt`.
pub(super) fn decode(
    meshopt: &Meshopt,
    view: &BufferView,
    source: &[u8],
    budget: &Budget,
    path: &str,
) -> Result<Vec<u8>> {
    let size = checked_size(meshopt, view, path)?;
    budget.charge(size, 1, || path.into())?;
    let (Ok(count), Ok(stride), Ok(size)) =
        (usize::try_from(meshopt.count), usize::try_from(meshopt.byte_stride), usize::try_from(size))
    else {
        return Err(budget.exceeded(path.into()));
    };
    let workspace = &mut Workspace::new(Limits { max_bytes: size.saturating_mul(2).max(4096), max_work: u64::MAX });
    let mut bytes = match meshopt.mode {
        Mode::Attributes => decode_vertex_buffer(count, stride, source, workspace),
        Mode::Triangles => decode_index_buffer(count, stride, source, workspace),
        Mode::Indices => decode_index_sequence(count, stride, source, workspace),
    }
    .map_err(|e| damaged(path, e))?;
    match meshopt.filter {
        Filter::None => Ok(()),
        Filter::Octahedral => decode_filter_oct(&mut bytes, count, stride, workspace),
        Filter::Quaternion => decode_filter_quat(&mut bytes, count, stride, workspace),
        Filter::Exponential => decode_filter_exp(&mut bytes, count, stride, workspace),
        Filter::Color => decode_filter_color(&mut bytes, count, stride, workspace),
    }
    .map_err(|e| damaged(path, e))?;
    if bytes.len() != size {
        return Err(damaged(path, format!("{} bytes came out instead of {size}", bytes.len())));
    }
    Ok(bytes)
}

fn damaged(path: &str, why: impl std::fmt::Display) -> Fault {
    invalid(path, format!("cannot be decompressed: {why}"))
}

/// Bytes of the decoded view, by the rules that tie the extension to its buffer view.
fn checked_size(meshopt: &Meshopt, view: &BufferView, path: &str) -> Result<u64> {
    let require = |holds: bool, property: &str, problem: &str| {
        if holds { Ok(()) } else { Err(invalid(format!("{path}.{property}"), problem)) }
    };
    let stride = meshopt.byte_stride;
    match meshopt.mode {
        Mode::Attributes => {
            let fits = stride.is_multiple_of(4) && (4..=256).contains(&stride);
            require(fits, "byteStride", "must be a multiple of 4 from 4 to 256 for ATTRIBUTES")?;
        }
        Mode::Triangles | Mode::Indices => {
            require(matches!(stride, 2 | 4), "byteStride", "must be 2 or 4 for indices")?;
            require(meshopt.filter == Filter::None, "filter", "must be NONE for indices")?;
        }
    }
    let triangles = meshopt.mode != Mode::Triangles || meshopt.count.is_multiple_of(3);
    require(triangles, "count", "must be a multiple of 3 for TRIANGLES")?;
    let filterable = match meshopt.filter {
        Filter::None | Filter::Exponential => true,
        Filter::Octahedral | Filter::Color => matches!(stride, 4 | 8),
        Filter::Quaternion => stride == 8,
    };
    require(filterable, "byteStride", "does not fit the filter")?;
    let same = view.byte_stride.is_none_or(|outer| outer == stride);
    require(same, "byteStride", "is not the byteStride of the buffer view itself")?;
    match meshopt.count.checked_mul(stride) {
        Some(size) if size == view.byte_length => Ok(size),
        _ => {
            let problem = format!(
                "{} times the byteStride of {stride} is not the {} bytes of the buffer view",
                meshopt.count, view.byte_length
            );
            Err(invalid(format!("{path}.count"), problem))
        }
    }
}
