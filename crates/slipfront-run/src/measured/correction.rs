//! Corrections of a measured record.

/// Corrections of a record, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correction {
    /// Factor of friction: -1 turns its sign.
    pub y_factor: f64,
    /// Number that is added to friction after that.
    pub y_offset: f64,
    /// Time or displacement that is added to those of the record.
    pub shift: f64,
    /// First and last time or displacement that count, after the shift.
    pub part: [f64; 2],
}

impl Default for Correction {
    fn default() -> Self {
        Self {
            y_factor: 1.0,
            y_offset: 0.0,
            shift: 0.0,
            part: [f64::NEG_INFINITY, f64::INFINITY],
        }
    }
}
