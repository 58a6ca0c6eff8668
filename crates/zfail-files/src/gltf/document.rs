//! The document with the bytes behind it, and how accessors are read from them.
//!
//! In: the schema and its buffers, decompressed here. Out: attribute values as `f32` or `u32`, in checked arithmetic throughout, so that
//! no offset, stride or count can reach outside a buffer. Misaligned data are read as they are.

use super::buffers::{Buffers, slice};
use super::draco;
use super::schema::{Component, Root};
use crate::shared::error::{Result, invalid, misunderstood};
use crate::shared::limits::Budget;
use std::borrow::Cow;
use std::path::Path;

pub(super) struct Document<'a> {
    pub root: Root,
    pub budget: Budget,
    buffers: Buffers<'a>,
}

/// Elements at a fixed distance, all inside `bytes`.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
}

/// Indices, values, and the type of the indices.
type SparsePart<'a> = (Elements<'a>, Elements<'a>, Component);

impl<'a> Elements<'a> {
    fn get(&self, i: usize) -> &'a [u8] {
        &self.bytes[i * self.stride..][..self.size]
    }
}

impl<'a> Document<'a> {
    /// Decompresses what is compressed. Buffer views and accessors are checked when something needs them.
    pub fn open(
        mut root: Root,
        bin: Option<Cow<'a, [u8]>>,
        folder: &Path,
        budget: Budget,
        notices: &mut Vec<String>,
    ) -> Result<Self> {
        let mut buffers = Buffers::open(&root, bin, folder, &budget, notices)?;
        draco::expand(&mut root, &mut buffers, &budget, notices)?;
        Ok(Self { root, budget, buffers })
    }

    /// The bytes of a buffer view.
    pub fn view(&self, index: usize) -> Result<&[u8]> {
        self.buffers.view(&self.root, index)
    }

    /// The dense part of an accessor; `None` if it has none and so consists of zeros.
    fn elements(&self, index: usize) -> Result<Option<Elements<'_>>> {
        let accessor = &self.root.accessors[index];
        let Some(view) = accessor.buffer_view else { return Ok(None) };
        let size = accessor.shape.element_size(accessor.component_type);
        self.locate(view, accessor.byte_offset, accessor.count, size, || format!("accessors[{index}]")).map(Some)
    }

    /// How many elements accessor `index` has, all of whose bytes are there.
    pub fn checked_count(&self, index: usize) -> Result<u64> {
        self.check(index).map(|_| self.count(index))
    }

    fn check(&self, index: usize) -> Result<(Option<Elements<'_>>, Option<SparsePart<'_>>)> {
        Ok((self.elements(index)?, self.sparse(index)?))
    }

    /// Indices and values of an accessor's sparse part.
    fn sparse(&self, index: usize) -> Result<Option<SparsePart<'_>>> {
        let accessor = &self.root.accessors[index];
        let Some(sparse) = &accessor.sparse else { return Ok(None) };
        if sparse.count > accessor.count {
            let problem = format!("is {}, more than the accessor's {}", sparse.count, accessor.count);
            return Err(invalid(format!("accessors[{index}].sparse.count"), problem));
        }
        let (indices, values) = (&sparse.indices, &sparse.values);
        let component = indices.component_type;
        if !matches!(component, Component::U8 | Component::U16 | Component::U32) {
            let element = format!("accessors[{index}].sparse.indices.componentType");
            return Err(invalid(element, "must be an unsigned integer type"));
        }
        let size = accessor.shape.element_size(accessor.component_type);
        Ok(Some((
            self.locate(indices.buffer_view, indices.byte_offset, sparse.count, component.size(), || {
                format!("accessors[{index}].sparse.indices")
            })?,
            self.locate(values.buffer_view, values.byte_offset, sparse.count, size, || {
                format!("accessors[{index}].sparse.values")
            })?,
            component,
        )))
    }

    fn locate(
        &self,
        view: usize,
        offset: u64,
        count: u64,
        size: usize,
        element: impl Fn() -> String,
    ) -> Result<Elements<'_>> {
        let bytes = self.view(view).map_err(|fault| match fault.problem() {
            Some(problem) => invalid(element(), format!("needs {problem}")),
            None => fault,
        })?;
        let stride = self.root.buffer_views[view].byte_stride.unwrap_or(size as u64);
        if stride < size as u64 {
            let problem = format!("is {stride}, less than the {size} bytes of one element of {}", element());
            return Err(invalid(format!("bufferViews[{view}].byteStride"), problem));
        }
        let length = match count.checked_sub(1) {
            None => Some(0),
            Some(gaps) => gaps.checked_mul(stride).and_then(|b| b.checked_add(size as u64)),
        };
        let bytes = length.and_then(|length| slice(bytes, offset, length)).ok_or_else(|| {
            let problem = format!(
                "{count} elements at a distance of {stride} from byteOffset {offset} reach beyond the {} bytes of \
                 bufferViews[{view}]",
                bytes.len()
            );
            invalid(element(), problem)
        })?;
        Ok(Elements { bytes, stride: stride as usize, size })
    }

    /// Accessor `index`, whose elements have `N` components, as floats: integers are divided by their greatest value
    /// if normalised, otherwise converted (KHR_mesh_quantization). The values may be infinite or NaN.
    pub fn floats<const N: usize>(&self, index: usize) -> Result<Vec<[f32; N]>> {
        let accessor = &self.root.accessors[index];
        let decode: fn(&[u8]) -> f32 = match (accessor.component_type, accessor.normalized) {
            (Component::I8, false) => |b| f32::from(b[0] as i8),
            (Component::I8, true) => |b| (f32::from(b[0] as i8) / 127.0).max(-1.0),
            (Component::U8, false) => |b| f32::from(b[0]),
            (Component::U8, true) => |b| f32::from(b[0]) / 255.0,
            (Component::I16, false) => |b| f32::from(i16::from_le_bytes([b[0], b[1]])),
            (Component::I16, true) => |b| (f32::from(i16::from_le_bytes([b[0], b[1]])) / 32767.0).max(-1.0),
            (Component::U16, false) => |b| f32::from(u16::from_le_bytes([b[0], b[1]])),
            (Component::U16, true) => |b| f32::from(u16::from_le_bytes([b[0], b[1]])) / 65535.0,
            (Component::U32, _) => |b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as f32,
            (Component::F32, _) => |b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        };
        self.decode(index, 0.0, decode)
    }

    /// How many elements accessor `index` has.
    pub fn count(&self, index: usize) -> u64 {
        self.root.accessors[index].count
    }

    /// Accessor `index`, whose elements have `N` unsigned integer components.
    pub fn integers<const N: usize>(&self, index: usize) -> Result<Vec<[u32; N]>> {
        let component = self.root.accessors[index].component_type;
        if matches!(component, Component::U8 | Component::U16 | Component::U32) {
            self.decode(index, 0, |b| unsigned(b, component))
        } else {
            Err(invalid(format!("accessors[{index}].componentType"), "must be an unsigned integer type here"))
        }
    }

    fn decode<const N: usize, T: Copy>(
        &self,
        index: usize,
        zero: T,
        decode: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<[T; N]>> {
        let accessor = &self.root.accessors[index];
        if let Some(fault) = &accessor.fault {
            return Err(misunderstood(fault));
        }
        // Padded matrices would need their columns taken apart; no attribute is one.
        let step = accessor.component_type.size();
        if accessor.shape.components() != N || accessor.shape.element_size(accessor.component_type) != N * step {
            let problem = format!("is {:?}, but {N} components are needed here", accessor.shape);
            return Err(invalid(format!("accessors[{index}].type"), problem));
        }
        let (elements, sparse) = self.check(index)?;
        self.budget.charge(accessor.count, size_of::<[T; N]>() as u64, || format!("accessors[{index}].count"))?;
        let element = |bytes: &[u8]| std::array::from_fn(|c| decode(&bytes[c * step..]));
        let count = accessor.count as usize;
        let mut values = match elements {
            None => vec![[zero; N]; count],
            Some(elements) => (0..count).map(|i| element(elements.get(i))).collect(),
        };
        if let Some((indices, replacements, component)) = sparse {
            let sparse_count = accessor.sparse.as_ref().map_or(0, |s| s.count as usize);
            for i in 0..sparse_count {
                let target = unsigned(indices.get(i), component);
                let slot = values.get_mut(target as usize).ok_or_else(|| {
                    let problem = format!("element {i} is {target}, but the accessor has {count} elements");
                    invalid(format!("accessors[{index}].sparse.indices"), problem)
                })?;
                *slot = element(replacements.get(i));
            }
        }
        Ok(values)
    }
}

fn unsigned(bytes: &[u8], component: Component) -> u32 {
    match component.size() {
        1 => bytes[0].into(),
        2 => u16::from_le_bytes([bytes[0], bytes[1]]).into(),
        _ => u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
    }
}
