//! Figures of a plan, for reports.

use crate::scissor::Rectangle;

/// Why a caster is left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Culled {
    /// The light ignores it.
    Excluded,
    /// It has no casting triangle.
    Empty,
    /// The light reaches nothing in view.
    LightOffScreen,
    /// It lies beyond the light's range, cone or box.
    OutOfReach,
    /// No part of its volume comes into view.
    OffScreen,
    /// Nothing that is in view and in the light's reach can lie in its shadow.
    NoReceiver,
    /// It lies in the shadow of another caster.
    Occluded,
}

impl Culled {
    /// Every reason, in the order of the checks.
    pub const ALL: [Self; 7] = [
        Self::Excluded,
        Self::Empty,
        Self::LightOffScreen,
        Self::OutOfReach,
        Self::OffScreen,
        Self::NoReceiver,
        Self::Occluded,
    ];

    /// Its name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Excluded => "excluded",
            Self::Empty => "nothing to cast",
            Self::LightOffScreen => "light off screen",
            Self::OutOfReach => "out of range",
            Self::OffScreen => "off screen",
            Self::NoReceiver => "shadows nothing in view",
            Self::Occluded => "in another's shadow",
        }
    }
}

/// Figures of one light's plan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LightStats {
    /// Casters considered.
    pub casters: u32,
    /// Casters left out, in the order of [`Culled::ALL`].
    pub culled: [u32; Culled::ALL.len()],
    /// Casters drawn in case 1 (z-pass), 2 (z-fail without light cap) and 3 (z-fail) of McGuire et al., section 7.
    pub cases: [u32; 3],
    /// The same by section, where meshes of several parts are decided on in sections.
    pub sections: Sections,
    /// Layers over the whole near rectangle, of casters in case 1.
    pub near_count: u32,
    /// Casters whose silhouettes the device finds. Only it knows how many triangles and vertices they have.
    pub extracted: u32,
    /// Triangles submitted.
    pub triangles: Triangles,
    /// Vertex indices submitted.
    pub vertices: u32,
    /// Pixels the light may reach: x, y, width, height; all zero where it reaches none.
    pub scissor: Rectangle,
    /// What the search for batches looked at in this frame ([`crate::stack::Work`]): nothing where few layers are in sight.
    pub searched: u64,
}

impl LightStats {
    /// How many casters were left out for each reason that occurred.
    pub fn reasons(&self) -> impl Iterator<Item = (Culled, u32)> {
        Culled::ALL.into_iter().zip(self.culled).filter(|&(_, count)| count > 0)
    }

    /// Whether anything may be in the light's shadow.
    #[must_use]
    pub fn has_shadow(&self) -> bool {
        self.vertices > 0 || self.near_count > 0 || self.extracted > 0
    }
}

/// What became of sections ([`crate::topology::Topology::sections`]); a caster without any is one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sections {
    /// All of them.
    pub considered: u32,
    /// Those that draw anything, by case.
    pub cases: [u32; 3],
}

/// Triangles of shadow volumes by part.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Triangles {
    /// Extruded silhouette edges.
    pub sides: u32,
    /// What closes volumes at infinity or at a plane.
    pub dark_cap: u32,
    /// Casting triangles in place.
    pub light_cap: u32,
}

impl Triangles {
    /// Of all parts.
    #[must_use]
    pub fn total(&self) -> u32 {
        self.sides + self.dark_cap + self.light_cap
    }
}
