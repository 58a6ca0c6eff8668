//! How the primitives of a mesh are masked, and along what they are cut.
//!
//! In: materials, textures and the alpha of vertices. Out: a pattern per primitive, and its shape at some fineness.

use super::field::AlphaField;
use super::limits::{Limits, Step};
use super::outline::Outline;
use crate::{AlphaMode, Filter, Image, Material, Mesh, Primitive, Texture, TextureRef};
use glam::DVec2;
use rustc_hash::FxHashMap;

/// How a primitive is masked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Pattern {
    /// Its alpha is the same everywhere: it is there, or it is not.
    Even(bool),
    /// Along the contour of a texture at a level of 0 to 255.
    Texture(TextureRef, f64),
    /// Where the alpha of the vertices times that of a texture, or 255 without one, reaches a level.
    Product(Option<TextureRef>, f64),
}

impl Pattern {
    /// Whose texture coordinates count.
    pub fn reference(&self) -> Option<&TextureRef> {
        match self {
            Self::Even(_) => None,
            Self::Texture(reference, _) => Some(reference),
            Self::Product(reference, _) => reference.as_ref(),
        }
    }

    /// Where a vertex lies on the texture, which is as long and as high as 1.
    pub fn place(&self, mesh: &Mesh, vertex: u32) -> DVec2 {
        let Some(reference) = self.reference() else { return DVec2::ZERO };
        let uv = if reference.uv_set == 0 { &mesh.uv0 } else { &mesh.uv1 };
        let [u, v] = uv.get(vertex as usize).copied().unwrap_or_default().map(f64::from);
        let [x, y] = reference.uv_from_mesh.map(|[a, b, c]| f64::from(a) * u + f64::from(b) * v + f64::from(c));
        DVec2::new(x, y)
    }
}

/// What masks are made of.
pub(super) struct Masks<'a> {
    pub textures: &'a [Texture],
    pub images: &'a [Image],
}

/// What a texture is at some fineness.
#[derive(Debug)]
pub(super) enum Shape<'a> {
    /// Its contour at a level.
    Outline(Outline<'a>),
    /// Its alpha.
    Field(AlphaField<'a>),
}

impl Shape<'_> {
    /// Width and height of the image, texels.
    pub fn size(&self) -> DVec2 {
        match self {
            Self::Outline(outline) => outline.size(),
            Self::Field(field) => field.size(),
        }
    }
}

/// Shapes that were made; `None` for those with too many points.
pub(super) type Shapes<'a> = FxHashMap<ShapeKey, Option<Shape<'a>>>;

/// Texture, bits of the level for an outline, halvings and bits of the tolerance.
type ShapeKey = (usize, Option<u64>, u32, u64);

impl<'a> Masks<'a> {
    /// The pattern of each primitive of `mesh`, `None` for those that are not masked.
    pub fn of(&self, mesh: &Mesh, materials: &[Material]) -> Vec<Option<Pattern>> {
        let of_primitive = |primitive: &Primitive| {
            let material = materials.get(primitive.material?)?;
            let AlphaMode::Mask(cutoff) = material.alpha else { return None };
            // Primitives of one material may share edges, where they have to agree.
            let alike = mesh.primitives.iter().filter(|other| other.material == primitive.material);
            Some(self.pattern(material, even_alpha(mesh, alike), cutoff))
        };
        mesh.primitives.iter().map(of_primitive).collect()
    }

    /// The pattern of a material on vertices whose alpha is `alpha`, unless it differs.
    fn pattern(&self, material: &Material, alpha: Option<f32>, cutoff: f32) -> Pattern {
        let factor = material.base_color[3] * alpha.unwrap_or(1.0);
        let reference = material.base_color_texture.filter(|r| self.field(r.texture, 0).is_some());
        let level = f64::from(cutoff) / f64::from(factor) * 255.0;
        let crosses = cutoff > 0.0 && factor > 0.0 && level.is_finite();
        match (alpha, reference) {
            (Some(_), Some(reference)) if crosses && level <= 255.0 => Pattern::Texture(reference, level),
            (Some(_), _) => Pattern::Even(factor >= cutoff),
            (None, reference) if crosses => Pattern::Product(reference, level),
            (None, _) => Pattern::Even(cutoff <= 0.0),
        }
    }

    /// Width and height of a texture's image, pixels.
    pub fn size(&self, reference: &TextureRef) -> Option<DVec2> {
        let image = self.images.get(self.textures.get(reference.texture)?.image)?;
        Some(DVec2::new(image.width.into(), image.height.into()))
    }

    fn field(&self, texture: usize, halvings: u32) -> Option<AlphaField<'a>> {
        let texture = self.textures.get(texture)?;
        Some(AlphaField::new(self.images.get(texture.image)?, texture, halvings))
    }

    /// Sees to it that `made` has the shapes of all `patterns`, and takes the points of new ones off `limits`; `None` if one
    /// has too many.
    pub fn shapes<'m>(
        &self,
        patterns: &[Option<Pattern>],
        step: Step,
        limits: &mut Limits,
        made: &'m mut Shapes<'a>,
    ) -> Option<Vec<Option<&'m Shape<'a>>>> {
        let key = |pattern: &Option<Pattern>| match pattern.as_ref()? {
            Pattern::Even(_) | Pattern::Product(None, _) => None,
            Pattern::Texture(reference, level) => {
                Some((reference.texture, Some(level.to_bits()), step.halvings, step.tolerance.to_bits()))
            }
            Pattern::Product(Some(reference), _) => Some((reference.texture, None, step.halvings, 0)),
        };
        for key in patterns.iter().filter_map(key) {
            let make = || {
                let mut field = self.field(key.0, step.halvings)?;
                let Some(level) = key.1 else {
                    field.filter = Filter::Linear;
                    return Some(Shape::Field(field));
                };
                let outline = Outline::new(field, f64::from_bits(level), step.tolerance, limits.of_contour())?;
                limits.points = limits.points.saturating_sub(outline.traced() as u64);
                Some(Shape::Outline(outline))
            };
            made.entry(key).or_insert_with(make).as_ref()?;
        }
        let made = &*made;
        Some(patterns.iter().map(|pattern| made.get(&key(pattern)?)?.as_ref()).collect())
    }
}

/// The alpha of the vertices of some primitives if it is the same for all.
fn even_alpha<'m>(mesh: &'m Mesh, primitives: impl Iterator<Item = &'m Primitive>) -> Option<f32> {
    let mut vertices = primitives.flat_map(|primitive| triangles_of(mesh, primitive)).flatten();
    let first = vertices.next().map_or(1.0, |&v| alpha(mesh, v));
    vertices.all(|&v| alpha(mesh, v) == first).then_some(first)
}

/// The alpha of a vertex.
pub(super) fn alpha(mesh: &Mesh, vertex: u32) -> f32 {
    mesh.colors.get(vertex as usize).map_or(1.0, |color| color[3])
}

pub(super) fn triangles_of<'m>(mesh: &'m Mesh, primitive: &Primitive) -> &'m [[u32; 3]] {
    let range = primitive.triangles.start as usize..primitive.triangles.end as usize;
    mesh.triangles.get(range).unwrap_or(&[])
}
