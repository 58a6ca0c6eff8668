//! KHR_draco_mesh_compression: compressed primitives become ordinary ones.
//!
//! In: a validated document and its bytes. Out: the same document, in which accessors of its own replace whatever a
//! primitive's Draco stream holds, and every primitive is a list of triangles.
//!
//! A stream of a kilobyte can honestly hold millions of triangles, so what bounds it are the counts of the accessors
//! it fills: they are charged first, and the stream may not hold more.

use super::buffers::Buffers;
use super::schema::{Accessor, BufferView, BufferViewExtensions, Component, Draco, Mode, Primitive, Root, Shape};
use super::validate::moves_vertices;
use crate::shared::error::{Result, invalid};
use crate::shared::fence::fenced;
use crate::shared::limits::Budget;
use draco_core::geometry_attribute::PointAttribute;
use draco_core::{DataType, DecodeLimits, DecoderBuffer, Mesh, MeshDecoder, PointIndex};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Bytes that the decoder may need for a triangle: its corners, their opposites, and the marks of the traversal.
const TRIANGLE_COST: u64 = 256;
/// Bytes of all attributes of a vertex, several times over.
const VERTEX_COST: u64 = 512;

/// One attribute or the indices of a primitive, decoded.
struct Column {
    bytes: Vec<u8>,
    component: Component,
    shape: Shape,
    count: u64,
}

struct Decoded {
    indices: Column,
    attributes: BTreeMap<String, Column>,
    /// Attributes that are spared, and why.
    lost: Vec<(String, String)>,
}

/// Decodes every compressed primitive of `root` and replaces its accessors.
pub(super) fn expand(
    root: &mut Root,
    buffers: &mut Buffers<'_>,
    budget: &Budget,
    notices: &mut Vec<String>,
) -> Result<()> {
    let meshes = root.meshes.iter().enumerate();
    let compressed: Vec<(usize, usize, &Draco)> = meshes
        .flat_map(|(m, mesh)| mesh.primitives.iter().enumerate().map(move |(p, primitive)| (m, p, primitive)))
        .filter(|(.., primitive)| matches!(primitive.mode, Mode::Triangles | Mode::TriangleStrip))
        .filter_map(|(m, p, primitive)| Some((m, p, primitive.extensions.draco.as_ref()?)))
        .collect();
    let decode = |&(m, p, draco): &(usize, usize, &Draco)| {
        let path = format!("meshes[{m}].primitives[{p}].extensions.KHR_draco_mesh_compression");
        let primitive = &root.meshes[m].primitives[p];
        decode(root, buffers, primitive, draco, budget, &path).map(|decoded| (m, p, decoded))
    };
    let decoded: Vec<(usize, usize, Decoded)> = compressed.par_iter().map(decode).collect::<Result<_>>()?;
    for (m, p, decoded) in decoded {
        for (name, problem) in decoded.lost {
            root.meshes[m].primitives[p].attributes.remove(&name);
            notices.push(format!("meshes[{m}].primitives[{p}].attributes.{name} is left out: {problem}"));
        }
        let old = &root.meshes[m].primitives[p].attributes;
        let normalized = |name: &String| old.get(name).is_some_and(|&a| root.accessors[a].normalized);
        let columns: Vec<(String, bool, Column)> =
            decoded.attributes.into_iter().map(|(name, column)| (name.clone(), normalized(&name), column)).collect();
        for (name, normalized, column) in columns {
            let accessor = push(root, buffers, column, normalized);
            root.meshes[m].primitives[p].attributes.insert(name, accessor);
        }
        let indices = push(root, buffers, decoded.indices, false);
        let primitive = &mut root.meshes[m].primitives[p];
        primitive.indices = Some(indices);
        primitive.mode = Mode::Triangles;
    }
    Ok(())
}

/// Adds an accessor that holds `column`; returns its index.
fn push(root: &mut Root, buffers: &mut Buffers<'_>, column: Column, normalized: bool) -> usize {
    let byte_length = column.bytes.len() as u64;
    let extensions = BufferViewExtensions::default();
    root.buffer_views.push(BufferView {
        buffer: 0,
        byte_offset: 0,
        byte_length,
        byte_stride: None,
        extensions,
        fault: None,
    });
    buffers.push(column.bytes);
    root.accessors.push(Accessor {
        buffer_view: Some(root.buffer_views.len() - 1),
        byte_offset: 0,
        component_type: column.component,
        normalized,
        count: column.count,
        shape: column.shape,
        sparse: None,
        fault: None,
    });
    root.accessors.len() - 1
}

fn decode(
    root: &Root,
    buffers: &Buffers<'_>,
    primitive: &Primitive,
    draco: &Draco,
    budget: &Budget,
    path: &str,
) -> Result<Decoded> {
    let (vertices, triangles) = declared(root, primitive, draco, path)?;
    budget.charge(vertices, VERTEX_COST, || path.into())?;
    budget.charge(triangles, TRIANGLE_COST, || path.into())?;
    let source = buffers.view(root, draco.buffer_view)?;
    let mesh = decode_stream(source, vertices, triangles).map_err(|why| invalid(path, why))?;
    check_counts(root, primitive, draco, mesh.num_points() as u64, vertices, path)?;
    let indices = indices(&mesh).map_err(|why| invalid(path, why))?;
    let (mut attributes, mut lost) = (BTreeMap::new(), Vec::new());
    for (name, &id) in &draco.attributes {
        let attribute = mesh.attribute_by_unique_id(id);
        let attribute = attribute.ok_or_else(|| format!("the stream has no attribute with the id {id}"));
        match attribute.and_then(|attribute| column(attribute, mesh.num_points())) {
            Ok(column) => drop(attributes.insert(name.clone(), column)),
            Err(why) if moves_vertices(name) => return Err(invalid(format!("{path}.attributes.{name}"), why)),
            Err(why) => lost.push((name.clone(), why)),
        }
    }
    Ok(Decoded { indices, attributes, lost })
}

/// How many vertices and triangles the accessors let the stream have.
fn declared(root: &Root, primitive: &Primitive, draco: &Draco, path: &str) -> Result<(u64, u64)> {
    let counts = draco.attributes.keys().map(|name| {
        let accessor = primitive.attributes.get(name).ok_or_else(|| {
            invalid(format!("{path}.attributes.{name}"), "is not among the attributes of the primitive itself")
        })?;
        Ok(root.accessors[*accessor].count)
    });
    let vertices = counts.collect::<Result<Vec<u64>>>()?.into_iter().max().unwrap_or(0);
    let indices = primitive.indices.map(|indices| root.accessors[indices].count);
    let triangles = match (indices, primitive.mode) {
        (Some(count), Mode::Triangles) => count / 3,
        (Some(count), _) => count,
        (None, _) => vertices.saturating_mul(2),
    };
    Ok((vertices, triangles))
}

fn decode_stream(source: &[u8], vertices: u64, triangles: u64) -> std::result::Result<Mesh, String> {
    let limits = DecodeLimits::default()
        .with_max_points(vertices)
        .with_max_faces(triangles)
        .with_max_decoded_bytes(vertices.saturating_mul(VERTEX_COST));
    fenced(|| {
        let mut mesh = Mesh::new();
        let status = MeshDecoder::new().decode(&mut DecoderBuffer::new(source).with_limits(limits), &mut mesh);
        status.map(|()| mesh).map_err(|e| e.to_string())
    })
    .and_then(|decoded| decoded)
    .map_err(|why| format!("cannot be decompressed: {why}"))
}

/// The stream may leave out vertices, but then nothing outside of it may be addressed by them.
fn check_counts(
    root: &Root,
    primitive: &Primitive,
    draco: &Draco,
    found: u64,
    declared: u64,
    path: &str,
) -> Result<()> {
    if found > declared {
        let problem = format!("holds {found} vertices, but its accessors say {declared}");
        return Err(invalid(path, problem));
    }
    let beside = primitive.attributes.iter().filter(|(name, _)| !draco.attributes.contains_key(*name));
    let morphs = primitive.targets.iter().flatten();
    let mut needed = beside.chain(morphs).filter(|(name, _)| moves_vertices(name));
    match needed.find(|(_, accessor)| root.accessors[**accessor].count != found) {
        None => Ok(()),
        Some((name, accessor)) => {
            let count = root.accessors[*accessor].count;
            let problem = format!("holds {found} vertices, but {name} (accessors[{accessor}]) has {count}");
            Err(invalid(path, problem))
        }
    }
}

fn column(attribute: &PointAttribute, points: usize) -> std::result::Result<Column, String> {
    let component = match attribute.data_type() {
        DataType::Int8 => Component::I8,
        DataType::Uint8 => Component::U8,
        DataType::Int16 => Component::I16,
        DataType::Uint16 => Component::U16,
        DataType::Uint32 => Component::U32,
        DataType::Float32 => Component::F32,
        other => return Err(format!("its type in the stream, {other:?}, does not exist in glTF")),
    };
    let shape = match attribute.num_components() {
        1 => Shape::Scalar,
        2 => Shape::Vec2,
        3 => Shape::Vec3,
        4 => Shape::Vec4,
        n => return Err(format!("it has {n} components in the stream")),
    };
    let size = shape.element_size(component);
    let stride = usize::try_from(attribute.byte_stride()).unwrap_or(0).max(size);
    let values = attribute.buffer().data();
    let mut bytes = Vec::with_capacity(points * size);
    for point in 0..points {
        let value = attribute.mapped_index(PointIndex(point as u32)).0 as usize;
        let start = value.checked_mul(stride);
        let element = start.and_then(|start| values.get(start..start.checked_add(size)?));
        bytes.extend_from_slice(element.ok_or_else(|| format!("vertex {point} has no value in the stream"))?);
    }
    Ok(Column { bytes, component, shape, count: points as u64 })
}

fn indices(mesh: &Mesh) -> std::result::Result<Column, String> {
    let points = mesh.num_points();
    let corners = mesh.faces().iter().flatten().map(|corner| corner.0);
    if let Some(beyond) = corners.clone().find(|&corner| corner as usize >= points) {
        return Err(format!("a triangle of the stream refers to vertex {beyond}, but there are {points}"));
    }
    let bytes = corners.flat_map(u32::to_le_bytes).collect();
    Ok(Column { bytes, component: Component::U32, shape: Shape::Scalar, count: 3 * mesh.num_faces() as u64 })
}
