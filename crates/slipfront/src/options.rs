//! The options that a model uses, known before it is made.

use crate::friction::Friction;
use crate::slider::SliderOptions;

/// The options on which it depends which kernel computes a model and which arrays of blocks that takes. They are known before any of
/// these arrays is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelOptions {
    /// The law of friction.
    pub friction: Friction,
    /// What differs from block to block, and dampers.
    pub slider: SliderOptions,
    /// Whether every block has a pressure of its own.
    pub has_pressures: bool,
    /// Whether the drive rotates.
    pub rotates: bool,
}
