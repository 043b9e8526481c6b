//! The options that a model uses, known before it is made.

use crate::friction::Friction;
use crate::slider::SliderOptions;

/// The options of a model that decide which kernel computes it and which arrays of blocks it needs. They are known before
/// any of these arrays is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelOptions {
    /// The law of friction.
    pub friction: Friction,
    /// Arrays of a heterogeneous slider, and dampers.
    pub slider: SliderOptions,
    /// Whether every block has a pressure of its own.
    pub has_pressures: bool,
    /// Whether the drive rotates.
    pub rotates: bool,
}
