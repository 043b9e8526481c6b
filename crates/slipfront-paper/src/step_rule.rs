//! The two rules for the time step of the paper's cases.

/// Rule for the time step of cases that do not set it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepRule {
    /// The step `dt* = 0.1`.
    Auto,
    /// The paper's step, `dt* = (2/3) V*` (Eq. 13).
    Paper,
}

impl StepRule {
    /// The time step as a formula.
    pub fn formula(self) -> &'static str {
        match self {
            Self::Auto => "dt* = 0.1",
            Self::Paper => "dt* = (2/3) V*",
        }
    }
}
