//! Springs between the blocks and the substrate.

/// Every block in contact is held by a spring that breaks at its static threshold and forms again without stress.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSprings {
    /// Stiffness `k_t` per block, in units of `E l`.
    pub stiffness: f64,
    /// Whether a spring that forms again has a new threshold, drawn from `seed`, block and number of breaks.
    pub redraw: bool,
    /// Seed of the thresholds.
    pub seed: u64,
}
