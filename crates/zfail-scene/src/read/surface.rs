//! One primitive's triangles with their vertex attributes.
//!
//! In: a primitive of a validated document. Out: positions, the attributes it has, and triangles in glTF's winding.

use super::document::Document;
use super::error::{Result, invalid};
use super::schema::{Component, Mode, Primitive, Shape};
use glam::{DVec3, DVec4};

/// The vertices of one primitive. Attributes have the length of `positions`, or are absent.
#[derive(Default)]
pub(super) struct Surface {
    /// In f64 so that posing does not round; finite.
    pub positions: Vec<DVec3>,
    /// As in the file, perhaps not unit, perhaps not finite.
    pub normals: Option<Vec<DVec3>>,
    pub tangents: Option<Vec<DVec4>>,
    pub uv: [Option<Vec<[f32; 2]>>; 2],
    pub colors: Option<Vec<[f32; 4]>>,
    pub triangles: Vec<[u32; 3]>,
}

impl Surface {
    /// Decodes `primitive`, found at `path`, which must have positions.
    pub fn read(document: &Document<'_>, primitive: &Primitive, positions: usize, path: &str) -> Result<Self> {
        let attribute = |name: &str| primitive.attributes.get(name).copied();
        let uv = |name: &str| attribute(name).map(|a| document.floats::<2>(a)).transpose();
        Ok(Self {
            positions: read_positions(document, positions, &format!("{path}.attributes.POSITION"))?,
            normals: attribute("NORMAL").map(|a| vectors(document, a)).transpose()?,
            tangents: attribute("TANGENT").map(|a| read_tangents(document, a)).transpose()?,
            uv: [uv("TEXCOORD_0")?, uv("TEXCOORD_1")?],
            colors: attribute("COLOR_0").map(|a| read_colors(document, a)).transpose()?,
            triangles: read_triangles(document, primitive, positions, path)?,
        })
    }

    /// Gives every triangle three vertices of its own; returns which vertices they were.
    pub fn unshare(&mut self) -> Vec<u32> {
        let corners: Vec<u32> = self.triangles.iter().flatten().copied().collect();
        gather(&mut self.positions, &corners);
        let Self { normals, tangents, uv, colors, .. } = self;
        normals.iter_mut().for_each(|v| gather(v, &corners));
        tangents.iter_mut().for_each(|v| gather(v, &corners));
        uv.iter_mut().flatten().for_each(|v| gather(v, &corners));
        colors.iter_mut().for_each(|v| gather(v, &corners));
        for (i, triangle) in (0u32..).zip(&mut self.triangles) {
            *triangle = [3 * i, 3 * i + 1, 3 * i + 2];
        }
        corners
    }
}

fn gather<T: Copy>(values: &mut Vec<T>, indices: &[u32]) {
    *values = indices.iter().map(|&i| values[i as usize]).collect();
}

/// A VEC3 accessor in f64.
pub(super) fn vectors(document: &Document<'_>, accessor: usize) -> Result<Vec<DVec3>> {
    Ok(document.floats::<3>(accessor)?.into_iter().map(|v| DVec3::from(v.map(f64::from))).collect())
}

fn read_positions(document: &Document<'_>, accessor: usize, path: &str) -> Result<Vec<DVec3>> {
    let positions = vectors(document, accessor)?;
    match positions.iter().position(|p| !p.is_finite()) {
        None => Ok(positions),
        Some(i) => Err(invalid(path, format!("vertex {i} (accessors[{accessor}]) is not finite"))),
    }
}

fn read_tangents(document: &Document<'_>, accessor: usize) -> Result<Vec<DVec4>> {
    Ok(document.floats::<4>(accessor)?.into_iter().map(|v| DVec4::from(v.map(f64::from))).collect())
}

fn read_colors(document: &Document<'_>, accessor: usize) -> Result<Vec<[f32; 4]>> {
    Ok(match document.root.accessors[accessor].shape {
        Shape::Vec3 => document.floats::<3>(accessor)?.into_iter().map(|[r, g, b]| [r, g, b, 1.0]).collect(),
        _ => document.floats::<4>(accessor)?,
    })
}

/// The triangles of `primitive`; every index is less than the number of positions. Empty for points and lines.
pub(super) fn read_triangles(
    document: &Document<'_>,
    primitive: &Primitive,
    positions: usize,
    path: &str,
) -> Result<Vec<[u32; 3]>> {
    let count = document.root.accessors[positions].count;
    let indices = match primitive.indices {
        Some(accessor) => read_indices(document, accessor, count, &format!("{path}.indices"))?,
        None => {
            document.budget.charge(count, 4, || format!("accessors[{positions}].count"))?;
            (0..u32::try_from(count).map_err(|_| document.budget.exceeded(path.into()))?).collect()
        }
    };
    Ok(assemble(&indices, primitive.mode))
}

fn read_indices(document: &Document<'_>, accessor: usize, vertices: u64, path: &str) -> Result<Vec<u32>> {
    let restart = match document.root.accessors[accessor].component_type {
        Component::U8 => u32::from(u8::MAX),
        Component::U16 => u32::from(u16::MAX),
        _ => u32::MAX,
    };
    let indices: Vec<u32> = document.integers::<1>(accessor)?.into_iter().map(|[i]| i).collect();
    match indices.iter().position(|&i| i == restart || u64::from(i) >= vertices) {
        None => Ok(indices),
        Some(at) if indices[at] == restart && u64::from(restart) < vertices => {
            let problem = format!("element {at} of accessors[{accessor}] is {restart}, the forbidden restart value");
            Err(invalid(path, problem))
        }
        Some(at) => {
            let problem =
                format!("element {at} of accessors[{accessor}] is {}, but there are {vertices} vertices", indices[at]);
            Err(invalid(path, problem))
        }
    }
}

/// Triangles in the vertex order of the glTF specification, section 3.7.2.1: every second one of a strip is turned,
/// so that all face the same way.
fn assemble(indices: &[u32], mode: Mode) -> Vec<[u32; 3]> {
    let strip = || indices.windows(3).enumerate();
    match mode {
        Mode::Triangles => indices.as_chunks().0.to_vec(),
        Mode::TriangleStrip => {
            strip().map(|(i, w)| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] }).collect()
        }
        Mode::TriangleFan => match indices {
            [hub, rim @ ..] => rim.windows(2).map(|w| [w[0], w[1], *hub]).collect(),
            [] => Vec::new(),
        },
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn winding_of_strips_and_fans() {
        let indices = [0, 1, 2, 3, 4];
        assert_eq!(assemble(&indices, Mode::Triangles), [[0, 1, 2]]);
        assert_eq!(assemble(&indices, Mode::TriangleStrip), [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
        assert_eq!(assemble(&indices, Mode::TriangleFan), [[1, 2, 0], [2, 3, 0], [3, 4, 0]]);
        for mode in [Mode::Triangles, Mode::TriangleStrip, Mode::TriangleFan] {
            assert!(assemble(&indices[..2], mode).is_empty());
            assert!(assemble(&[], mode).is_empty());
        }
    }

    #[test]
    fn strips_and_fans_face_one_way() {
        // A zigzag strip and a fan in the plane z = 0, both counter-clockwise.
        let at = |i: u32| DVec3::new(f64::from(i), f64::from(i % 2), 0.0);
        let around =
            |i: u32| if i == 0 { DVec3::ZERO } else { DVec3::new(f64::from(i).cos(), f64::from(i).sin(), 0.0) };
        let area = |t: [DVec3; 3]| (t[1] - t[0]).cross(t[2] - t[0]).z;
        let strip = assemble(&[0, 2, 1, 3], Mode::TriangleStrip);
        assert!(strip.iter().all(|t| area(t.map(at)) * area(strip[0].map(at)) > 0.0 || area(t.map(at)) == 0.0));
        let fan = assemble(&[0, 1, 2, 3], Mode::TriangleFan);
        assert!(fan.iter().all(|t| area(t.map(around)) > 0.0), "{fan:?}");
    }
}
