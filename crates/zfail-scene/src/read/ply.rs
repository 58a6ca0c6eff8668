//! .ply files: ASCII and binary of both byte orders, with polygons, normals, colours and texture coordinates.
//!
//! In: bytes, and the folder of the texture. Out: one part.

use super::error::{Result, malformed};
use super::fence::fenced;
use super::limits::Budget;
use super::plain::{Part, Plain, Z_UP, check_finite, grey, linear, nothing_to_draw, texture};
use super::polygon::Triangulator;
use super::uri;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult, PropertyType, ScalarType,
};
use std::io::ErrorKind;
use std::path::Path;

const FORMAT: &str = "PLY";

/// Reads the vertices and faces of a file in `folder`, where its texture lies.
pub(super) fn read(bytes: &[u8], folder: &Path, budget: &Budget) -> Result<Plain> {
    // The words of a line are taken apart, and lists are copied.
    budget.charge(bytes.len() as u64, 16, || "the file".into())?;
    let mut reader = Reader::new(bytes);
    let header = decoded(fenced(|| Parser::<Ignored>::new().read_header(&mut reader)))?;
    let mut notices = vec!["PLY has neither axes nor units: z is taken as up, and one unit as one metre".into()];
    let (mut vertices, mut faces): (Vec<Vertex>, Vec<Face>) = Default::default();
    for (name, element) in &header.elements {
        check_count(element, header.encoding, reader.get_ref().len())?;
        let charge = |size| budget.charge(element.count as u64, size, || format!("element {name}"));
        match name.as_str() {
            "vertex" => {
                charge(2 * size_of::<Vertex>() as u64)?;
                vertices = elements(&mut reader, element, &header)?;
            }
            "face" => {
                charge(128)?;
                faces = elements(&mut reader, element, &header)?;
                break;
            }
            _ => drop(elements::<Ignored>(&mut reader, element, &header)?),
        }
    }
    if let Some(strips) = header.elements.get("tristrips") {
        let problem = format!("has {} triangle strips, which cannot be read; store triangles instead", strips.count);
        return Err(malformed(FORMAT, "element tristrips", problem));
    }
    if faces.is_empty() {
        return Err(nothing_to_draw(FORMAT, "is a point cloud: it has no faces that could cast or receive a shadow"));
    }
    if faces.iter().any(|face| face.textured) {
        notices.push("texture coordinates of faces are left out; those of vertices are used".into());
    }
    let images: Vec<String> = texture_file(&header, folder, &mut notices).into_iter().collect();
    let mut material = grey("PLY".into());
    material.pbr_metallic_roughness.base_color_texture = images.first().map(|_| texture(0));
    let origin = origin(&vertices);
    let part = assemble(&header, &vertices, origin, &faces)?;
    if part.colors.is_some() || !images.is_empty() {
        material.pbr_metallic_roughness.base_color_factor = [1.0; 4];
    }
    let mut world_from_file = Z_UP;
    world_from_file[12..15].copy_from_slice(&[origin[0], origin[2], -origin[1]]);
    Ok(Plain { format: FORMAT, parts: vec![part], materials: vec![material], images, world_from_file, notices })
}

/// No element takes less than its properties, so that a count is bounded by the bytes that are left.
fn check_count(element: &ElementDef, encoding: Encoding, left: usize) -> Result<()> {
    let scalar = |kind: &ScalarType| match kind {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    };
    let size: usize = match encoding {
        Encoding::Ascii => 1,
        _ => element
            .properties
            .iter()
            .map(|(_, property)| match &property.data_type {
                PropertyType::Scalar(kind) | PropertyType::List(kind, _) => scalar(kind),
            })
            .sum(),
    };
    let most = (left + 1).checked_div(size).unwrap_or(0);
    if element.count <= most {
        return Ok(());
    }
    let problem = format!("says {} elements, but the {left} bytes that follow hold at most {most}", element.count);
    Err(malformed(FORMAT, format!("element {}", element.name), problem))
}

fn elements<E: PropertyAccess>(reader: &mut Reader<&[u8]>, element: &ElementDef, header: &Header) -> Result<Vec<E>> {
    decoded(fenced(|| Parser::<E>::new().read_payload_for_element(reader, element, header)))
}

fn decoded<T>(result: std::result::Result<std::result::Result<T, ParseError>, String>) -> Result<T> {
    let fault = |e: ParseError| {
        let element = e.line().map_or_else(|| "the file".into(), |line| format!("line {line}"));
        // The parser quotes the line around the reason, which comes last.
        let message = e.to_string();
        let reason = match e.kind() {
            ErrorKind::UnexpectedEof => "the end of file comes too early",
            _ => message.rsplit("Error: ").next().unwrap_or_default(),
        };
        malformed(FORMAT, element, format!("cannot be read: {}", reason.trim()))
    };
    match result {
        Ok(result) => result.map_err(fault),
        Err(panic) => Err(malformed(FORMAT, "the file", panic)),
    }
}

/// The texture that MeshLab and its kin name in a comment.
fn texture_file(header: &Header, folder: &Path, notices: &mut Vec<String>) -> Option<String> {
    let name = header.comments.iter().find_map(|comment| comment.trim().strip_prefix("TextureFile"))?.trim();
    let found = uri::of_file(name, folder);
    if found.is_none() {
        notices.push(format!("texture `{name}` is not below the file's folder: shown without it"));
    }
    found
}

/// Surveyed scans lie 10^6 m from where they are measured from, in double precision. What single precision cannot hold
/// is taken relative to the middle.
fn origin(vertices: &[Vertex]) -> [f64; 3] {
    let coordinates = |axis: usize| vertices.iter().map(move |v| v.position[axis]);
    [0, 1, 2].map(|axis| {
        let (least, most) = (coordinates(axis).fold(f64::MAX, f64::min), coordinates(axis).fold(f64::MIN, f64::max));
        let middle = least.midpoint(most);
        let exact = coordinates(axis).all(|x| f64::from(x as f32) == x);
        if exact || !middle.is_finite() || middle.abs() > f64::from(f32::MAX) { 0.0 } else { middle }
    })
}

fn assemble(header: &Header, vertices: &[Vertex], origin: [f64; 3], faces: &[Face]) -> Result<Part> {
    let near = |v: &Vertex| [0, 1, 2].map(|axis| (v.position[axis] - origin[axis]) as f32);
    let positions: Vec<[f32; 3]> = vertices.iter().map(near).collect();
    check_finite(FORMAT, "vertex", &positions)?;
    let properties = header.elements.get("vertex").map(|element| &element.properties);
    let has = |names: &[&str]| names.iter().any(|name| properties.is_some_and(|p| p.contains_key(*name)));
    if !has(&["x"]) {
        return Err(malformed(FORMAT, "element vertex", "has no property x"));
    }
    let mut triangles = Vec::new();
    let mut triangulator = Triangulator::default();
    for (i, face) in faces.iter().enumerate() {
        let beyond = face.corners.iter().find(|corner| **corner as usize >= vertices.len());
        if let Some(corner) = beyond {
            let problem = format!("refers to vertex {corner}, but there are {}", vertices.len());
            return Err(malformed(FORMAT, format!("face {i}"), problem));
        }
        triangulator.cut(&face.corners, |v| positions[v as usize], &mut triangles);
    }
    Ok(Part {
        positions,
        normals: has(&["nx"]).then(|| vertices.iter().map(|v| v.normal).collect()),
        uv: has(&["s", "u", "texture_u"]).then(|| vertices.iter().map(|v| [v.uv[0], 1.0 - v.uv[1]]).collect()),
        colors: has(&["red", "r", "diffuse_red"]).then(|| vertices.iter().map(Vertex::linear_color).collect()),
        triangles,
        material: 0,
    })
}

struct Vertex {
    position: [f64; 3],
    normal: [f32; 3],
    uv: [f32; 2],
    /// As stored, 0 to 1.
    color: [f32; 4],
}

impl Vertex {
    fn linear_color(&self) -> [f32; 4] {
        let [r, g, b, a] = self.color;
        [linear(r), linear(g), linear(b), a]
    }
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self { position: [0.0; 3], normal: [0.0; 3], uv: [0.0; 2], color: [1.0; 4] }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let Some((value, greatest)) = number(&property) else { return PropertyAccessResult::Ignored };
        let slot = match name {
            "x" | "y" | "z" => {
                let axis = usize::from(name.as_bytes()[0] - b'x');
                self.position[axis] = value;
                return PropertyAccessResult::Set;
            }
            "nx" => &mut self.normal[0],
            "ny" => &mut self.normal[1],
            "nz" => &mut self.normal[2],
            "s" | "u" | "texture_u" => &mut self.uv[0],
            "t" | "v" | "texture_v" => &mut self.uv[1],
            _ => {
                let channel = match name {
                    "red" | "r" | "diffuse_red" => 0,
                    "green" | "g" | "diffuse_green" => 1,
                    "blue" | "b" | "diffuse_blue" => 2,
                    "alpha" | "a" => 3,
                    _ => return PropertyAccessResult::Ignored,
                };
                self.color[channel] = (value / greatest).clamp(0.0, 1.0) as f32;
                return PropertyAccessResult::Set;
            }
        };
        *slot = value as f32;
        PropertyAccessResult::Set
    }
}

/// The value of a scalar, and what a colour channel of its type has where it is full.
fn number(property: &Property) -> Option<(f64, f64)> {
    Some(match *property {
        Property::Char(x) => (x.into(), 127.0),
        Property::UChar(x) => (x.into(), 255.0),
        Property::Short(x) => (x.into(), 32767.0),
        Property::UShort(x) => (x.into(), 65535.0),
        // Wider integers hold bytes all the same.
        Property::Int(x) => (x.into(), 255.0),
        Property::UInt(x) => (x.into(), 255.0),
        Property::Float(x) => (x.into(), 1.0),
        Property::Double(x) => (x, 1.0),
        _ => return None,
    })
}

struct Face {
    /// Vertices; negative ones of the file are beyond every count.
    corners: Box<[u32]>,
    textured: bool,
}

impl PropertyAccess for Face {
    fn new() -> Self {
        Self { corners: Box::default(), textured: false }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if name == "texcoord" {
            self.textured = true;
        }
        if !matches!(name, "vertex_indices" | "vertex_index") {
            return PropertyAccessResult::Ignored;
        }
        fn indices<T: TryInto<u32>>(list: Vec<T>) -> Box<[u32]> {
            list.into_iter().map(|i| i.try_into().unwrap_or(u32::MAX)).collect()
        }
        self.corners = match property {
            Property::ListChar(list) => indices(list),
            Property::ListUChar(list) => indices(list),
            Property::ListShort(list) => indices(list),
            Property::ListUShort(list) => indices(list),
            Property::ListInt(list) => indices(list),
            Property::ListUInt(list) => indices(list),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

/// An element that is of no use here.
struct Ignored;

impl PropertyAccess for Ignored {
    fn new() -> Self {
        Self
    }
}
