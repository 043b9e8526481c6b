//! Size of a picture and of its letters, as a user asks for them.

use crate::picture::PictureError;
use crate::style::MM;

/// Size of labels unless another is asked for, pt.
const LABEL_PT: f64 = 8.0;
/// Least width of a picture, and least height below its legend, in units of letters of the usual size: less
/// leaves no room for a curve.
const MIN_WIDTH: f64 = 500.0;
const MIN_HEIGHT: f64 = 330.0;

/// Size of a picture and of its letters; what is not given is as usual. Lines, marks and numbers grow and
/// shrink with the letters.
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

    /// Refuses a width in which letters leave no room for curves.
    ///
    /// # Errors
    /// [`PictureError::TooSmall`], with the least width for these letters.
    pub(crate) fn check_width(self, usual: f64) -> Result<(), PictureError> {
        self.expect("width", self.width(usual), MIN_WIDTH)
    }

    /// Refuses a height in which a legend of height `above` leaves no room for curves.
    ///
    /// # Errors
    /// [`PictureError::TooSmall`], with the least height for these letters.
    pub(crate) fn check_height(self, above: f64) -> Result<(), PictureError> {
        let height = self.height().unwrap_or(f64::INFINITY);
        self.expect("height", height, above + MIN_HEIGHT)
    }

    fn expect(self, side: &'static str, found: f64, least: f64) -> Result<(), PictureError> {
        if found >= least {
            return Ok(());
        }
        Err(PictureError::TooSmall {
            side,
            mm: (found * self.scale() / MM).round(),
            least_mm: (least * self.scale() / MM).ceil(),
            font_pt: self.font_pt.unwrap_or(LABEL_PT),
        })
    }
}
