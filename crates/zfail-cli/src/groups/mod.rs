//! Arguments that several commands have: what may be asked, with its help text and the checks that need no scene.

mod device;
mod loading;
mod moment;
mod scene;
mod surroundings;
mod values;
mod verbosity;

pub use device::Device;
pub use loading::{AlphaShadows, Loading};
pub use moment::Moment;
pub use scene::{SceneArg, Subject};
pub use surroundings::{Sunlight, Surroundings};
pub use values::{Size, parse_exposure, parse_fps, parse_light, parse_samples, parse_terminator, technique_parser};
pub use verbosity::Verbosity;
