//! Progress of a calibration: the purpose of its runs, and how many have ended.

/// Purpose of runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CalibrationStage {
    /// Runs of the case over the ranges.
    Training,
    /// Runs on blocks of half the size.
    FinerBlocks,
    /// Runs of experiments that may be made next.
    Further,
    /// Runs of the calibrated model.
    Prediction,
    /// Search for the closest curve; its number of runs is not known in advance.
    Closest,
    /// Runs of the calibrated model at another time step.
    OtherStep,
    /// Runs of a planned experiment.
    Planning,
}

impl CalibrationStage {
    /// Whether the runs of this stage are valid for all records at the same sample points, whatever their
    /// friction.
    pub(crate) fn is_for_any_records(self) -> bool {
        match self {
            Self::Training | Self::FinerBlocks | Self::Further | Self::Planning => true,
            Self::Prediction | Self::Closest | Self::OtherStep => false,
        }
    }
}

/// Progress of a calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CalibrationProgress {
    /// Present stage.
    pub stage: CalibrationStage,
    /// Number of runs of this call that have ended.
    pub runs: usize,
    /// Number of all runs of this call, as far as it is known.
    pub total: usize,
}
