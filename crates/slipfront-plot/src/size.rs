//! Size of a picture and of its letters, as requested by a user.

use crate::picture_error::PictureError;
use crate::style::{DPI, MM, SIZE_TEXT};

/// Default size of all text, pt.
const TEXT_PT: f64 = SIZE_TEXT as f64 / DPI * 72.0;
/// Least width of a picture, and least heights of one panel and of two panels with everything below them, in
/// pixels for letters of the usual size: smaller sizes leave no room for a curve.
const MIN_WIDTH: f64 = 500.0;
const MIN_PANEL: f64 = 160.0;
const MIN_PANELS: f64 = 330.0;

/// Size of a picture and of its letters; values that are not given have their defaults. Lines and marks grow
/// and shrink with the letters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PictureSize {
    /// Width, mm.
    pub width_mm: Option<f64>,
    /// Height, mm.
    pub height_mm: Option<f64>,
    /// Size of all text, pt. Titles and numbers in cells that do not fit in this size have seven eighths of
    /// it; subscripts have 0.72 of it.
    pub font_pt: Option<f64>,
}

impl PictureSize {
    /// Largest width and height, mm.
    pub const MAX_MM: f64 = 400.0;

    /// Factor of letters, lines and marks.
    pub(crate) fn scale(self) -> f64 {
        self.font_pt.map_or(1.0, |pt| pt / TEXT_PT)
    }

    /// Width of the canvas, before it is scaled, of a picture that is usually this wide.
    pub(crate) fn width(self, usual: f64) -> f64 {
        self.width_mm.map_or(usual, |mm| mm * MM) / self.scale()
    }

    /// Height of the canvas before it is scaled, if one is given.
    pub(crate) fn height(self) -> Option<f64> {
        Some(self.height_mm? * MM / self.scale())
    }

    /// Width of a picture that is usually this wide, before it is scaled.
    ///
    /// # Errors
    /// [`PictureError::TooSmall`] for a width in which letters leave no room for curves, with the least width
    /// for these letters.
    pub(crate) fn roomy_width(self, usual: f64) -> Result<f64, PictureError> {
        self.wide_enough(usual, MIN_WIDTH)
    }

    /// Width of a picture that is usually `usual` wide and must be at least `least` wide, before it is
    /// scaled.
    ///
    /// # Errors
    /// [`PictureError::TooSmall`], with the least width for these letters.
    pub(crate) fn wide_enough(self, usual: f64, least: f64) -> Result<f64, PictureError> {
        let width = self.width(usual);
        self.expect("width", width, least)?;
        Ok(width)
    }

    /// Height of each of `panels` panels that are usually this high; everything else takes `others` of the
    /// height.
    ///
    /// # Errors
    /// [`PictureError::TooSmall`] for a height that leaves no room for curves, with the least height for
    /// these letters.
    pub(crate) fn panel(self, usual: f64, others: f64, panels: usize) -> Result<f64, PictureError> {
        let Some(height) = self.height() else {
            return Ok(usual);
        };
        let panels = panels as f64;
        self.expect("height", height, others + panels * MIN_PANEL)?;
        Ok((height - others) / panels)
    }

    /// Refuses a height in which a legend of height `above` leaves no room for curves in two panels.
    ///
    /// # Errors
    /// [`PictureError::TooSmall`], with the least height for these letters.
    pub(crate) fn check_height(self, above: f64) -> Result<(), PictureError> {
        let height = self.height().unwrap_or(f64::INFINITY);
        self.expect("height", height, above + MIN_PANELS)
    }

    /// Refuses a height of a picture of maps, which have the shape of the slider.
    ///
    /// # Errors
    /// [`PictureError::HeightOfMaps`] if a height is given.
    pub(crate) fn expect_no_height(self) -> Result<(), PictureError> {
        match self.height_mm {
            None => Ok(()),
            Some(_) => Err(PictureError::HeightOfMaps),
        }
    }

    fn expect(self, side: &'static str, found: f64, least: f64) -> Result<(), PictureError> {
        // Tolerance for the rounding of a height that is just enough.
        if found >= least - 1e-6 {
            return Ok(());
        }
        let mm = |pixels: f64| pixels * self.scale() / MM;
        Err(PictureError::TooSmall {
            side,
            mm: mm(found).round(),
            least_mm: mm(least).ceil(),
            font_pt: self.font_pt.unwrap_or(TEXT_PT.round()),
        })
    }
}
