//! This library: McGuire et al.'s method with what has been found since.
//!
//! - *Sections*: of a mesh of several parts, those that lie together are decided on by themselves.
//! - *Occluders*: casters in the shadow of others change no verdict, and are left out.
//! - *Near count*: z-pass also for casters that cover the near rectangle whole, from a number known beforehand; that is
//!   [`crate::eye_count`] made right, for it asks of the whole rectangle and not of the eye.
//!
//! Beside the steps, which can all be left, stand what makes it exact on any mesh: integer weights that close every
//! volume, finite caps under orthographic views, and batches that are folded before 8 bits wrap. The tile pass and
//! silhouettes found on the device belong to it too, but depend on the device's measured times and are not taken here.

use crate::mcguire;
use zfail_plan::plan::Steps;

/// The steps that make the method.
pub const MEASURES: Steps = Steps { by_section: true, occluders: 8, near_count: true, ..mcguire::MEASURES };

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{lengyel, mcguire};
    use zfail_plan::plan::{Silhouettes, Technique, Tiles};

    #[test]
    fn the_steps_are_those_of_the_techniques() {
        let cpu =
            |technique: Technique| Steps { tiles: Tiles::Never, silhouettes: Silhouettes::Cpu, ..technique.steps() };
        assert_eq!(lengyel::MEASURES, cpu(Technique::Lengyel));
        assert_eq!(mcguire::MEASURES, cpu(Technique::Mcguire));
        assert_eq!(MEASURES, cpu(Technique::Auto));
        assert_ne!(MEASURES, mcguire::MEASURES);
    }
}
