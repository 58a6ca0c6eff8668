//! Accessors, buffer views and buffers.

use serde::Deserialize;

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Accessor {
    pub buffer_view: Option<usize>,
    #[serde(default)]
    pub byte_offset: u64,
    pub component_type: Component,
    #[serde(default)]
    pub normalized: bool,
    pub count: u64,
    #[serde(rename = "type")]
    pub shape: Shape,
    pub sparse: Option<Sparse>,
    /// Where and why this is none: it stands in for one that could not be understood.
    pub fault: Option<String>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Sparse {
    pub count: u64,
    pub indices: SparseIndices,
    pub values: SparseValues,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct SparseIndices {
    pub buffer_view: usize,
    #[serde(default)]
    pub byte_offset: u64,
    pub component_type: Component,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct SparseValues {
    pub buffer_view: usize,
    #[serde(default)]
    pub byte_offset: u64,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(try_from = "u32")]
pub(crate) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl TryFrom<u32> for Component {
    type Error = String;
    fn try_from(code: u32) -> Result<Self, String> {
        Ok(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return Err(format!("{code} is not a component type (5120 to 5123, 5125, 5126)")),
        })
    }
}

impl Component {
    /// Bytes.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "UPPERCASE")]
pub(crate) enum Shape {
    Scalar,
    Vec2,
    Vec3,
    Vec4,
    Mat2,
    Mat3,
    Mat4,
}

impl Shape {
    /// Number of components.
    pub fn components(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Vec2 => 2,
            Self::Vec3 => 3,
            Self::Vec4 | Self::Mat2 => 4,
            Self::Mat3 => 9,
            Self::Mat4 => 16,
        }
    }

    /// Bytes of one element; the columns of small-component matrices are padded to four bytes.
    pub fn element_size(self, component: Component) -> usize {
        let column = |rows: usize| (rows * component.size()).next_multiple_of(4);
        match self {
            Self::Mat2 => 2 * column(2),
            Self::Mat3 => 3 * column(3),
            _ => self.components() * component.size(),
        }
    }
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct BufferView {
    pub buffer: usize,
    #[serde(default)]
    pub byte_offset: u64,
    pub byte_length: u64,
    pub byte_stride: Option<u64>,
    #[serde(default)]
    pub extensions: BufferViewExtensions,
    /// Where and why this is none: it stands in for one that could not be understood.
    pub fault: Option<String>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct BufferViewExtensions {
    #[serde(rename = "EXT_meshopt_compression")]
    ext: Option<Meshopt>,
    #[serde(rename = "KHR_meshopt_compression")]
    khr: Option<Meshopt>,
}

impl BufferViewExtensions {
    /// The compressed form of the view with the name of the extension that says so.
    pub fn meshopt(&self) -> Option<(&'static str, &Meshopt)> {
        let khr = self.khr.as_ref().map(|m| ("KHR_meshopt_compression", m));
        khr.or(self.ext.as_ref().map(|m| ("EXT_meshopt_compression", m)))
    }
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Meshopt {
    pub buffer: usize,
    #[serde(default)]
    pub byte_offset: u64,
    pub byte_length: u64,
    pub byte_stride: u64,
    pub count: u64,
    pub mode: MeshoptMode,
    #[serde(default)]
    pub filter: MeshoptFilter,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "UPPERCASE")]
pub(crate) enum MeshoptMode {
    Attributes,
    Triangles,
    Indices,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "UPPERCASE")]
pub(crate) enum MeshoptFilter {
    #[default]
    None,
    Octahedral,
    Quaternion,
    Exponential,
    /// KHR_meshopt_compression only.
    Color,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Buffer {
    pub uri: Option<String>,
    pub byte_length: u64,
    #[serde(default)]
    pub extensions: BufferExtensions,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct BufferExtensions {
    #[serde(rename = "EXT_meshopt_compression")]
    ext: Fallback,
    #[serde(rename = "KHR_meshopt_compression")]
    khr: Fallback,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Fallback {
    fallback: bool,
}

impl Buffer {
    /// Whether the buffer serves only readers without meshopt; it may then have no bytes at all.
    pub fn is_fallback(&self) -> bool {
        self.extensions.ext.fallback || self.extensions.khr.fallback
    }
}
