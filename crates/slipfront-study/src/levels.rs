//! Combinations of levels of several axes, and the axis of directions.

use crate::axis::{Axis, Spacing};

/// The key of the axis of directions.
const DIRECTION: &str = "drive.direction";

/// The axis over directions of the drive, if a study has one.
pub(crate) fn direction_axis(axes: &[Axis]) -> Option<usize> {
    let is_direction = |axis: &Axis| axis.title() == DIRECTION && axis.spacing != Spacing::Named;
    axes.iter().position(is_direction)
}

/// Levels of some axes: pairs of axis and level.
pub(crate) type Levels = Vec<(usize, usize)>;

/// Every combination of levels of these axes, the last fastest.
pub(crate) fn combinations(axes: &[Axis], chosen: &[usize]) -> Vec<Levels> {
    let mut all = vec![Levels::new()];
    for &axis in chosen {
        let levels = 0..axes[axis].levels.len();
        let with_each = |earlier: Levels| {
            let with = move |level| [earlier.as_slice(), &[(axis, level)]].concat();
            levels.clone().map(with)
        };
        all = all.into_iter().flat_map(with_each).collect();
    }
    all
}
