//! The pictures of a comparison: the truth, each method's, and where each is wrong.

use super::composite::Studio;
use super::measure::{Entry, Outcome};
use zfail_methods::Method;
use zfail_oracle::Truth;

/// Lit, and should be in shadow.
pub const LIGHT_LEAKS: [u8; 3] = [255, 90, 0];
/// In shadow, and should be lit.
pub const FALSE_SHADOW: [u8; 3] = [0, 130, 255];

/// All pictures, 8-bit sRGB, three bytes per pixel.
pub struct Pictures {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The oracle's.
    pub truth: Vec<u8>,
    /// Of the methods that run.
    pub methods: Vec<MethodPictures>,
}

/// The pictures of one method.
pub struct MethodPictures {
    /// Which.
    pub method: Method,
    /// As it shadows the scene.
    pub picture: Vec<u8>,
    /// The truth in grey, pixels with a wrong verdict of any light marked.
    pub difference: Vec<u8>,
}

impl Pictures {
    /// Composes all of them.
    ///
    /// # Errors
    /// If a mask has not the size of the truth.
    pub fn new(studio: &Studio, truths: &[Truth], entries: &[Entry]) -> Result<Self, crate::error::Error> {
        let truth = studio.picture(&truths.iter().map(Truth::mask).collect::<Vec<_>>());
        let mut methods = Vec::new();
        for entry in entries {
            if let Outcome::Drawn(drawn) = &entry.outcome {
                let mut difference = faint(&truth);
                for (truth, mask) in truths.iter().zip(&drawn.masks) {
                    mark(&mut difference, truth, mask)?;
                }
                methods.push(MethodPictures {
                    method: entry.method,
                    picture: studio.picture(&drawn.masks),
                    difference,
                });
            }
        }
        Ok(Self { size: studio.size, truth, methods })
    }
}

/// `rgb` in grey and darkened, so that marks stand out.
fn faint(rgb: &[u8]) -> Vec<u8> {
    let grey = |p: &[u8]| {
        let luma = 2 * u32::from(p[0]) + 5 * u32::from(p[1]) + u32::from(p[2]);
        [(luma / 12) as u8; 3]
    };
    rgb.chunks_exact(3).flat_map(grey).collect()
}

/// Paints the pixels of `rgb` at which `mask` is wrong.
fn mark(rgb: &mut [u8], truth: &Truth, mask: &[u8]) -> Result<(), crate::error::Error> {
    let report = truth.compare_mask(mask)?;
    for wrong in report.wrong {
        let at = 3 * (wrong.y as usize * truth.size[0] as usize + wrong.x as usize);
        let color = if wrong.expected == 0 { LIGHT_LEAKS } else { FALSE_SHADOW };
        if let Some(pixel) = rgb.get_mut(at..at + 3) {
            pixel.copy_from_slice(&color);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::judged::tests::truth;

    #[test]
    fn wrong_pixels_are_marked_by_the_kind_of_error() {
        let truth = truth();
        let mut mask = truth.mask();
        let picture: Vec<u8> = (0..24).map(|i| 10 * i as u8).collect();
        let mut marked = faint(&picture);
        mark(&mut marked, &truth, &mask).unwrap();
        assert_eq!(marked, faint(&picture), "a right mask leaves no mark");
        // Lit pixels 1 to 4 and dark ones 5 and 6; the last one is left out.
        mask[2] = 0;
        mask[6] = 255;
        mask[7] = 255;
        mark(&mut marked, &truth, &mask).unwrap();
        let marks: Vec<usize> =
            (0..8).filter(|i| marked[3 * i..3 * i + 3] != faint(&picture)[3 * i..3 * i + 3]).collect();
        assert_eq!(marks, [2, 6]);
        assert_eq!((&marked[6..9], &marked[18..21]), (&FALSE_SHADOW[..], &LIGHT_LEAKS[..]));
        assert!(mark(&mut marked, &truth, &mask[1..]).is_err());
    }
}
