//! Size of a picture and of its letters, as a user asks for them.

use crate::picture::PictureError;
use crate::style::MM;

/// Size of labels unless another is asked for, pt.
const LABEL_PT: f64 = 8.0;
/// Least width and height of a picture, in units of letters of the usual size: less leaves no room for a curve.
const MIN_SIDES: [f64; 2] = [500.0, 560.0];

/// Size of a picture and of its letters; what is not given is as usual. Lines, marks and numbers grow and shrink with the letters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PictureSize {
    /// Width, mm.
    pub width_mm: Option<f64>,
    /// Height, mm.
    pub height_mm: Option<f64>,
    /// Size of the labels, pt.
    pub font_pt: Option<f64>,
}

impl PictureSize {
    /// Largest width and height, mm.
    pub const MAX_MM: f64 = 400.0;

    /// Bytes of the pixels while a picture of this size is drawn, beyond those of the usual size.
    pub fn bytes(self) -> f64 {
        let side = |mm: Option<f64>| mm.unwrap_or_default().max(100.0) * MM;
        4.0 * side(self.width_mm) * side(self.height_mm)
    }

    /// Factor of letters, lines and marks.
    pub(crate) fn scale(self) -> f64 {
        self.font_pt.map_or(1.0, |pt| pt / LABEL_PT)
    }

    /// Width of the canvas, before it is scaled, of a picture that is usually this wide.
    pub(crate) fn width(self, usual: f64) -> f64 {
        self.width_mm.map_or(usual, |mm| mm * MM) / self.scale()
    }

    /// Height of the canvas before it is scaled, if one is given.
    pub(crate) fn height(self) -> Option<f64> {
        Some(self.height_mm? * MM / self.scale())
    }

    /// Refuses a size in which letters leave no room for curves.
    ///
    /// # Errors [`PictureError::TooSmall`], with the least size for these letters.
    pub(crate) fn check(self, usual: f64) -> Result<(), PictureError> {
        let sides = [Some(self.width(usual)), self.height()];
        for ((side, least), name) in sides.into_iter().zip(MIN_SIDES).zip(["width", "height"]) {
            if let Some(side) = side.filter(|side| !(*side >= least)) {
                return Err(PictureError::TooSmall {
                    side: name,
                    mm: (side * self.scale() / MM).round(),
                    least_mm: (least * self.scale() / MM).ceil(),
                    font_pt: self.font_pt.unwrap_or(LABEL_PT),
                });
            }
        }
        Ok(())
    }
}
