//! Shadow methods that the papers tell of, runnable side by side. They are those of [`Method::ALL`].
//!
//! In: a [`Scene`](zfail_scene::Scene), a [`View`](zfail_plan::view::View) and one of its lights. Out: a
//! [`Shadow`]: a mask of what the light reaches, as [`zfail_render::Aovs::shadow`] has it, and what it cost.
//!
//! The modules stand in the order of history, and each says in its head which section of which paper it follows. All
//! volumes are the same closed ones, made by [`zfail_plan::volume`] for any mesh, open or not; so what differs in the
//! masks is the method alone. The `stage` is what they share: a depth pass and passes that count in the stencil.
//!
//! Papers: *C* is Carmack's letter of May 2000; *E&K* Everitt & Kilgard, "Practical and Robust Stenciled Shadow Volumes
//! for Hardware-Accelerated Rendering", 2002; *McG* McGuire, Hughes, Egan, Kilgard & Everitt, "Fast, Practical and
//! Robust Shadows", 2003.

// The methods, in the order of history.

// Counting in front of the visible surface.
mod heidmann;

// The other way round where the eye is in shadow.
mod inverted_test;

// From the eye's own shadow on.
mod eye_count;

// From what the near plane cuts off.
mod carmack_preload;

// Behind the visible surface.
mod zfail_finite;

// With the cut closed.
mod near_caps;

// To infinity.
mod everitt_kilgard;

// In front or behind, by light.
mod lengyel;

// By caster.
mod mcguire;

// And with less to draw.
mod ours;

// Without volumes: what the light sees.
mod shadow_map;

// Without volumes: what a ray meets.
mod ray_query;

// What they share.
mod error;
mod geometry;
mod method;
mod methods;
mod options;
mod planned;
mod procedure;
mod shadow;
mod stage;
mod volumes;

pub use error::{Error, Unavailable};
pub use method::{Method, UnknownMethod};
pub use methods::Methods;
pub use options::{FiniteOptions, Options, ShadowMapOptions};
pub use shadow::{Figures, Shadow};
