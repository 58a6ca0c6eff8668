//! .ply files: ASCII and binary of both byte orders, with polygons or strips, normals, colours and texture coordinates.
//!
//! In: bytes, and the folder of the texture. Out: one part.

mod body;
mod faces;
mod header;
mod vertices;

use crate::plain::folder::Folder;
use crate::plain::losses::{Flaw, counted, flaw};
use crate::plain::text::{decode, shown};
use crate::plain::{Part, Picture, Plain, Texture, Up, grey, not_of_format, points, texture};
use crate::polygon::Triangulator;
use crate::shared::error::{Fault, Result, malformed};
use crate::shared::limits::Budget;
use body::Body;
use faces::{Faces, MISSING, Shape};
use header::{Element, Encoding, Header, Scalar};
use std::path::Path;
use vertices::Vertices;

const FORMAT: &str = "PLY";

/// Reads the vertices and faces of a file in `folder`, where its texture lies.
pub(crate) fn read(bytes: &[u8], folder: &Path, budget: &Budget) -> Result<Plain> {
    let bytes = decode(bytes, budget)?;
    let not_ply =
        || malformed("line 1", "is not `ply`", "export the file again as PLY, or give it the name of its format");
    let header = Header::read(&bytes, budget)?.ok_or_else(|| not_of_format(FORMAT, &bytes, not_ply))?;
    let mut notices = header.notices.clone();
    let (vertices, faces) = elements(&header, budget)?;
    let (origin, part) = assemble(vertices, faces, &mut notices)?;
    let has = |element: &[u8], names: &[&str]| {
        let elements = header.elements.iter().filter(|e| e.name == element);
        elements.flat_map(|e| &e.properties).any(|p| p.is(names))
    };
    if has(b"face", &["texcoord"]) {
        notices.push("texture coordinates of faces are left out; those of vertices are used".into());
    }
    if has(b"face", &["red", "r", "diffuse_red"]) {
        notices.push("colours of faces are left out; those of vertices are used".into());
    }
    let pictures: Vec<Picture> = picture(&header, folder, budget, &mut notices)?.into_iter().collect();
    let mut material = grey(FORMAT.into());
    material.pbr_metallic_roughness.base_color_texture = pictures.first().map(|_| texture(0));
    if part.colors.is_some() || !pictures.is_empty() {
        material.pbr_metallic_roughness.base_color_factor = [1.0; 4];
    }
    notices.push("PLY has neither axes nor units: z is taken as up, and one unit as one metre".into());
    Ok(Plain {
        format: FORMAT,
        parts: vec![part],
        materials: vec![material],
        textures: pictures.iter().map(|_| Texture { picture: 0, clamped: false }).collect(),
        pictures,
        up: Up::Z,
        origin,
        notices,
    })
}

/// What is known of an element by its name.
fn shape(element: &Element<'_>) -> Option<Shape> {
    match element.name {
        b"face" => Some(Shape::Polygons),
        b"tristrips" => Some(Shape::Strips),
        _ => None,
    }
}

fn elements(header: &Header<'_>, budget: &Budget) -> Result<(Vertices, Faces)> {
    let mut body = Body::new(header);
    let (mut vertices, mut faces) = (Vertices::default(), Faces::default());
    let needed = |element: &Element<'_>| element.name == b"vertex" || shape(element).is_some();
    let last = header.elements.iter().rposition(needed).map_or(0, |last| last + 1);
    for element in header.elements[..last].iter().filter(|element| !element.properties.is_empty()) {
        let unknown =
            element.properties.iter().find(|p| p.scalar == Scalar::Unknown || p.list == Some(Scalar::Unknown));
        if let (Some(property), true) = (unknown, header.encoding != Encoding::Ascii) {
            let problem = format!("property {} has a type of unknown size", shown(property.name));
            let remedy = "export the file again as ASCII PLY";
            return Err(malformed(format!("element {}", shown(element.name)), problem, remedy));
        }
        match shape(element) {
            Some(shape) => faces.read(shape, &mut body, element, budget)?,
            None if element.name == b"vertex" => vertices = vertices::read(&mut body, element, budget)?,
            None => skip(&mut body, element)?,
        }
    }
    Ok((vertices, faces))
}

/// Passes over an element that is of no use here.
fn skip(body: &mut Body<'_>, element: &Element<'_>) -> Result<()> {
    for i in 0..element.count {
        body.begin();
        for property in &element.properties {
            let count = match property.list {
                None => Ok(Some(1)),
                Some(length) => body.length(length, property.scalar),
            };
            let passed = count.and_then(|count| body.skip(property.scalar, count.ok_or(body::End)? as u64));
            match passed {
                Ok(()) => {}
                Err(_) if body.goes_on() => break,
                Err(_) => return Err(cut_off(element, i)),
            }
        }
        body.end();
    }
    Ok(())
}

/// The fault of a file that ends within row `row` of `element`, or of which nobody can tell where the next one begins.
fn cut_off(element: &Element<'_>, row: u64) -> Fault {
    let problem =
        format!("says that there are {}, but the file ends after {row}, or is not what its header says", element.count);
    let remedy = "its end may be missing: copy or download it again";
    malformed(format!("element {}", shown(element.name)), problem, remedy)
}

/// The texture that a comment names.
fn picture(header: &Header<'_>, folder: &Path, budget: &Budget, notices: &mut Vec<String>) -> Result<Option<Picture>> {
    let Some(name) = header.texture else { return Ok(None) };
    let folder = Folder::new(folder, budget);
    let read = match folder.find(name, Path::new("")) {
        Ok(path) => folder.read(&path)?,
        Err(problem) => Err(problem.into()),
    };
    Ok(match read {
        Ok(bytes) => Some(Picture { name: shown(name).into_owned(), bytes }),
        Err(problem) => {
            notices.push(format!("texture `{}` {problem}: shown without it", shown(name)));
            None
        }
    })
}

fn assemble(vertices: Vertices, faces: Faces, notices: &mut Vec<String>) -> Result<([f64; 3], Part)> {
    let Vertices { positions: points, normals, uv, colors, short } = vertices;
    let Faces { corners, ends, odd, mut losses } = faces;
    let starts = [0].into_iter().chain(ends.iter().copied());
    let faces = starts.zip(&ends).map(|(start, &end)| &corners[start as usize..end as usize]);
    let mut drawn = Vec::with_capacity(ends.len());
    for (i, face) in faces.enumerate() {
        match flaw(face.iter().copied(), &points) {
            None => drawn.push(face),
            Some(flaw) => {
                let triangles = if flaw == Flaw::Nowhere { face.len() - 2 } else { 1 };
                losses.add(flaw, triangles, || match flaw {
                    Flaw::Missing(corner) => {
                        let index = odd.filter(|_| corner == MISSING).unwrap_or(corner.into());
                        format!("face {i}: refers to vertex {index}, but there are {}", points.len())
                    }
                    _ => format!("face {i}"),
                });
            }
        }
    }
    if drawn.is_empty() {
        return Err(losses.fault(|| {
            let problem = "is a point cloud: it has no faces that could cast or receive a shadow";
            malformed("the file", problem, "make a surface of it first, as MeshLab's surface reconstruction does")
        }));
    }
    notices.extend(losses.notices());
    if short > 0 {
        notices.push(format!("{} of vertices with fewer values than the header says", counted(short, "line")));
    }
    let origin = points::origin(drawn.iter().copied().flatten().map(|v| points[*v as usize]));
    let near = |p: &[f64; 3]| if points::is_usable(p) { points::relative(p, &origin) } else { [0.0; 3] };
    let positions: Vec<[f32; 3]> = points.iter().map(near).collect();
    let (mut triangles, mut triangulator) = (Vec::with_capacity(drawn.len()), Triangulator::default());
    for face in drawn {
        match face {
            [a, b, c] => triangles.push([*a, *b, *c]),
            polygon => triangulator.cut(polygon, |v| positions[v as usize], &mut triangles),
        }
    }
    notices.extend(triangulator.notice());
    let uv = uv.map(|uv| uv.into_iter().map(|[u, v]| [u, 1.0 - v]).collect());
    Ok((origin, Part { positions, normals, uv, colors, triangles, material: 0 }))
}
