//! Every shadow method that the papers tell of, runnable side by side.
//!
//! In: a [`Scene`](zfail_plan::scene::Scene), a [`View`](zfail_plan::view::View) and one of its lights. Out: a
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
mod heidmann;

mod eye_count;

mod carmack_preload;

mod zfail_finite;

mod near_caps;

mod everitt_kilgard;

mod lengyel;

mod mcguire;

mod ours;

mod shadow_map;

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
