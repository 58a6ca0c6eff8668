//! What figures depend on beside scene and view.

use zfail_plan::plan::Technique;

/// What is shown of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Which lights, by index; all of them if `None`. Figures of a single light show the first.
    pub lights: Option<Vec<usize>>,
    /// Who plans the volumes of [`crate::Overlay::Volumes`], cases and scissors.
    pub technique: Technique,
    /// From where figures that replace the picture are seen.
    pub from: Option<ThirdPerson>,
}

/// A place from which eye, light and scene are seen together: an orbit around them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThirdPerson {
    /// Radians by which the view direction is turned from the eye's, counter-clockwise seen from above.
    pub yaw: f64,
    /// Radians above the horizontal, less than a right angle.
    pub pitch: f64,
    /// 1 where everything just fits the image; 2 shows it twice as large.
    pub zoom: f64,
}

impl Default for ThirdPerson {
    /// From the right, behind and above.
    fn default() -> Self {
        Self { yaw: 0.95, pitch: 0.42, zoom: 1.0 }
    }
}

impl ThirdPerson {
    /// With every number in its range, whatever was given.
    pub(crate) fn sane(self) -> Self {
        let or = |value: f64, default: f64| if value.is_finite() { value } else { default };
        let Self { yaw, pitch, zoom } = Self::default();
        Self {
            yaw: or(self.yaw, yaw),
            pitch: or(self.pitch, pitch).clamp(-1.55, 1.55),
            zoom: or(self.zoom, zoom).clamp(0.01, 100.0),
        }
    }
}
