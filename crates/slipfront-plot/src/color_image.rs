//! Images made of levels of the colour ramp: maps and colour bars.

use crate::geometry::Area;
use crate::style::{BLANK, Rgb, ramp};

/// An image with a level of the colour ramp for every pixel.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Image {
    pub(crate) area: Area,
    pub(crate) columns: usize,
    /// Levels row by row, the uppermost first; see [`level`].
    pub(crate) levels: Vec<u8>,
}

impl Image {
    pub(crate) fn rows(&self) -> usize {
        self.levels.len() / self.columns
    }

    /// Columns, rows and levels of the image with every pixel repeated, often enough that smoothing by a
    /// viewer blurs only the edges of the original pixels.
    pub(crate) fn repeated(&self) -> (usize, usize, Vec<u8>) {
        let rows = self.rows();
        let repeat = (400 / self.columns.max(rows)).max(1);
        let mut levels = Vec::with_capacity(self.levels.len() * repeat * repeat);
        for row in self.levels.chunks_exact(self.columns) {
            let start = levels.len();
            levels.extend(row.iter().flat_map(|&level| std::iter::repeat_n(level, repeat)));
            for _ in 1..repeat {
                levels.extend_from_within(start..start + self.columns * repeat);
            }
        }
        (self.columns * repeat, rows * repeat, levels)
    }
}

/// The level of a blank pixel.
const LEVEL_BLANK: u8 = 255;

/// The level of a value, clamped to this range; NaN is blank.
pub(crate) fn level(value: f64, [lo, hi]: [f64; 2]) -> u8 {
    let share = ((value - lo) / (hi - lo)) as f32;
    if share.is_nan() {
        LEVEL_BLANK
    } else {
        (share.clamp(0.0, 1.0) * f32::from(LEVEL_BLANK - 1)).round() as u8
    }
}

pub(crate) fn level_colour(level: u8) -> Rgb {
    match level {
        LEVEL_BLANK => BLANK,
        _ => ramp(f64::from(level) / f64::from(LEVEL_BLANK - 1)),
    }
}

/// The colours of all levels.
pub(crate) fn palette() -> Vec<Rgb> {
    (0..=u8::MAX).map(level_colour).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_span_the_ramp_and_leave_one_for_blank() {
        assert_eq!(
            [0.0, 1.0, 2.0, -1.0, f64::NAN, f64::INFINITY].map(|value| level(value, [0.0, 1.0])),
            [0, 254, 254, 0, 255, 254]
        );
        assert_eq!(level_colour(0), [0x44, 0x01, 0x54]);
        assert_eq!(level_colour(254), [0xfd, 0xe7, 0x25]);
        assert_eq!(level_colour(255), BLANK);
    }
}
