//! Needs of a law of friction, which kernels, checkpoints and series provide.

/// Needs of a law of friction, or of an option of a law, in addition to the thresholds of the blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Needs {
    /// Whether the fused kernel computes the law; the general kernel computes every law.
    pub is_fused: bool,
    /// Whether the law changes thresholds in the fused kernel, which then sweeps the blocks as for a
    /// heterogeneous slider.
    pub varies: bool,
    /// Number of columns that the law adds to a checkpoint: numbers per block that it remembers in addition
    /// to the velocity.
    pub columns: usize,
    /// Whether contacts store energy, which is lost when they break.
    pub stores_energy: bool,
    /// Whether contacts have a state; its mean is a result.
    pub has_state: bool,
    /// Whether strength falls with slip, so that a part of the friction loss is weakening energy.
    pub weakens_with_slip: bool,
}

impl Needs {
    /// Needs of a law that remembers nothing and that every kernel computes.
    pub(super) const NONE: Self = Self {
        is_fused: true,
        varies: false,
        columns: 0,
        stores_energy: false,
        has_state: false,
        weakens_with_slip: false,
    };

    /// Combined needs of a law and an option of it.
    pub(super) fn and(self, option: Option<Self>) -> Self {
        option.map_or(self, |more| Self {
            is_fused: self.is_fused && more.is_fused,
            varies: self.varies || more.varies,
            columns: self.columns + more.columns,
            stores_energy: self.stores_energy || more.stores_energy,
            has_state: self.has_state || more.has_state,
            weakens_with_slip: self.weakens_with_slip || more.weakens_with_slip,
        })
    }
}
