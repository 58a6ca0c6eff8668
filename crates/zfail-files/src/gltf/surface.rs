//! One primitive's triangles with their vertex attributes.
//!
//! In: a primitive of a validated document. Out: positions, the attributes it has, and triangles in glTF's winding.

use super::document::Document;
use super::schema::{Component, Mode, Primitive, Shape};
use crate::shared::error::Result;
use glam::{DVec3, DVec4};

/// The vertices of one primitive. Attributes have the length of `positions`, or are absent.
#[derive(Default)]
pub(super) struct Surface {
    /// In f64 so that posing does not round; perhaps not finite.
    pub positions: Vec<DVec3>,
    /// As in the file, perhaps not unit, perhaps not finite.
    pub normals: Option<Vec<DVec3>>,
    pub tangents: Option<Vec<DVec4>>,
    pub uv: [Option<Vec<[f32; 2]>>; 2],
    pub colors: Option<Vec<[f32; 4]>>,
    pub triangles: Vec<[u32; 3]>,
}

/// What of a primitive could not be taken as it is.
#[derive(Default)]
pub(super) struct Losses {
    /// Attributes that are left out, and why.
    pub attributes: Vec<String>,
    /// Triangles that name vertices which are not there.
    pub beyond: usize,
    /// Triangles with vertices that have no place.
    pub nowhere: usize,
    /// Indices that end a strip or fan and begin another, which glTF forbids.
    pub restarts: usize,
}

impl Surface {
    /// Decodes `primitive`, found at `path`, which must have positions.
    pub fn read(
        document: &Document<'_>,
        primitive: &Primitive,
        positions: usize,
        path: &str,
        losses: &mut Losses,
    ) -> Result<Self> {
        let positions_at = positions;
        let positions = vectors(document, positions)?;
        let mut reader = Reader { document, primitive, count: positions.len(), losses };
        let normals = reader.attribute("NORMAL", |a| vectors(document, a))?;
        let tangents = reader.attribute("TANGENT", |a| read_tangents(document, a))?;
        let uv0 = reader.attribute("TEXCOORD_0", |a| document.floats::<2>(a))?;
        let uv1 = reader.attribute("TEXCOORD_1", |a| document.floats::<2>(a))?;
        let colors = reader.attribute("COLOR_0", |a| read_colors(document, a))?;
        let triangles = read_triangles(document, primitive, positions_at, path, losses)?;
        Ok(Self { positions, normals, tangents, uv: [uv0, uv1], colors, triangles })
    }

    /// Takes out the vertices that are `broken`, with their triangles; returns which vertices stay.
    pub fn remove(&mut self, broken: &[bool], losses: &mut Losses) -> Vec<u32> {
        let count = self.triangles.len();
        self.triangles.retain(|triangle| !triangle.iter().any(|&v| broken[v as usize]));
        losses.nowhere += count - self.triangles.len();
        let kept: Vec<u32> = (0..).zip(broken).filter(|(_, broken)| !**broken).map(|(v, _)| v).collect();
        let mut place = vec![0; broken.len()];
        (0..).zip(&kept).for_each(|(new, &old)| place[old as usize] = new);
        self.triangles.iter_mut().flatten().for_each(|v| *v = place[*v as usize]);
        self.gather(&kept);
        kept
    }

    /// Gives every triangle three vertices of its own; returns which vertices they were.
    pub fn unshare(&mut self) -> Vec<u32> {
        let corners: Vec<u32> = self.triangles.iter().flatten().copied().collect();
        self.gather(&corners);
        for (i, triangle) in (0u32..).zip(&mut self.triangles) {
            *triangle = [3 * i, 3 * i + 1, 3 * i + 2];
        }
        corners
    }

    /// Makes the vertices those that `indices` name.
    fn gather(&mut self, indices: &[u32]) {
        let Self { positions, normals, tangents, uv, colors, triangles: _ } = self;
        gather(positions, indices);
        normals.iter_mut().for_each(|v| gather(v, indices));
        tangents.iter_mut().for_each(|v| gather(v, indices));
        uv.iter_mut().flatten().for_each(|v| gather(v, indices));
        colors.iter_mut().for_each(|v| gather(v, indices));
    }
}

/// Reads the attributes that a primitive can do without.
struct Reader<'a> {
    document: &'a Document<'a>,
    primitive: &'a Primitive,
    /// Vertices.
    count: usize,
    losses: &'a mut Losses,
}

impl Reader<'_> {
    fn attribute<T>(&mut self, name: &str, read: impl FnOnce(usize) -> Result<Vec<T>>) -> Result<Option<Vec<T>>> {
        let Some(&accessor) = self.primitive.attributes.get(name) else { return Ok(None) };
        let found = self.document.count(accessor);
        let problem = if found == self.count as u64 {
            match read(accessor) {
                Ok(values) => return Ok(Some(values)),
                Err(fault) => match fault.problem() {
                    Some(problem) => problem,
                    None => return Err(fault),
                },
            }
        } else {
            format!("has {found} elements, but POSITION has {}", self.count)
        };
        self.losses.attributes.push(format!("{name} is left out: {problem}"));
        Ok(None)
    }
}

fn gather<T: Copy>(values: &mut Vec<T>, indices: &[u32]) {
    *values = indices.iter().map(|&i| values[i as usize]).collect();
}

/// A VEC3 accessor in f64.
fn vectors(document: &Document<'_>, accessor: usize) -> Result<Vec<DVec3>> {
    Ok(document.floats::<3>(accessor)?.into_iter().map(|v| DVec3::from(v.map(f64::from))).collect())
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
fn read_triangles(
    document: &Document<'_>,
    primitive: &Primitive,
    positions: usize,
    path: &str,
    losses: &mut Losses,
) -> Result<Vec<[u32; 3]>> {
    let count = document.count(positions);
    let Some(accessor) = primitive.indices else {
        document.budget.charge(count, 4, || format!("accessors[{positions}].count"))?;
        let all: Vec<u32> = (0..u32::try_from(count).map_err(|_| document.budget.exceeded(path.into()))?).collect();
        return Ok(assemble(&all, primitive.mode));
    };
    let restart = match document.root.accessors[accessor].component_type {
        Component::U8 => u32::from(u8::MAX),
        Component::U16 => u32::from(u16::MAX),
        _ => u32::MAX,
    };
    let indices: Vec<u32> = document.integers::<1>(accessor)?.into_iter().map(|[i]| i).collect();
    let mut triangles = if primitive.mode == Mode::Triangles {
        // In a list, the greatest index that fits is a vertex like any other, if it is there.
        assemble(&indices, primitive.mode)
    } else {
        losses.restarts += indices.iter().filter(|i| **i == restart).count();
        indices.split(|i| *i == restart).flat_map(|part| assemble(part, primitive.mode)).collect()
    };
    let found = triangles.len();
    triangles.retain(|triangle| triangle.iter().all(|&v| u64::from(v) < count));
    losses.beyond += found - triangles.len();
    Ok(triangles)
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
