//! The binary chunk with its views and accessors.

use serde_json::{Value, json};

/// What a view of vertices or indices is for, as glTF numbers it.
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;

/// Bytes, and the JSON that describes them.
#[derive(Default)]
pub(super) struct Buffer {
    pub bytes: Vec<u8>,
    pub views: Vec<Value>,
    pub accessors: Vec<Value>,
}

impl Buffer {
    /// Adds a view without a target, aligned to 4 bytes, and returns its index.
    pub fn view(&mut self, data: impl IntoIterator<Item = u8>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let start = self.bytes.len();
        self.bytes.extend(data);
        let length = self.bytes.len() - start;
        self.views.push(json!({ "buffer": 0, "byteOffset": start, "byteLength": length }));
        self.views.len() - 1
    }

    /// Adds vertex attributes of `N` floats and returns the accessor's index.
    pub fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let view = self.view(values.iter().flatten().flat_map(|x| x.to_le_bytes()));
        self.views[view]["target"] = json!(ARRAY_BUFFER);
        let shape = ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1];
        self.accessor(view, FLOAT, values.len(), shape)
    }

    /// [`Buffer::floats`] with the bounds that positions must have. `values` must not be empty.
    pub fn positions(&mut self, values: &[[f32; 3]]) -> usize {
        let accessor = self.floats(values);
        let bound = |pick: fn(f32, f32) -> f32| {
            let bound = values.iter().copied().reduce(|a, b| std::array::from_fn(|k| pick(a[k], b[k])));
            json!(bound)
        };
        self.accessors[accessor]["min"] = bound(f32::min);
        self.accessors[accessor]["max"] = bound(f32::max);
        accessor
    }

    /// Adds the vertex indices of triangles among `vertices` vertices and returns the accessor's index.
    pub fn indices(&mut self, triangles: &[[u32; 3]], vertices: usize) -> usize {
        // The greatest 16-bit value is not an index but a restart.
        let short = vertices < usize::from(u16::MAX);
        let indices = triangles.iter().flatten();
        let view = if short {
            self.view(indices.flat_map(|&i| (i as u16).to_le_bytes()))
        } else {
            self.view(indices.flat_map(|i| i.to_le_bytes()))
        };
        self.views[view]["target"] = json!(ELEMENT_ARRAY_BUFFER);
        self.accessor(view, if short { UNSIGNED_SHORT } else { UNSIGNED_INT }, 3 * triangles.len(), "SCALAR")
    }

    fn accessor(&mut self, view: usize, component: u32, count: usize, shape: &str) -> usize {
        self.accessors.push(json!({ "bufferView": view, "componentType": component, "count": count, "type": shape }));
        self.accessors.len() - 1
    }
}
