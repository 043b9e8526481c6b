//! Columns that the tables of every study have.

/// Columns of `runs.csv` before those of the axes, and after them, before the quantities.
pub(super) const BEFORE_AXES: [&str; 3] = ["point", "replicate", "role"];
pub(super) const AFTER_AXES: [&str; 4] = ["seed", "run", "status", "reason"];

/// Columns of `points.csv` after those of the axes.
pub(super) const STATISTICS: [&str; 9] = [
    "quantity",
    "n",
    "mean",
    "deviation",
    "low",
    "high",
    "min",
    "max",
    "narrow_enough",
];

/// Whether the tables have a column of this name beside those of axes and quantities. An axis cannot have such a name.
pub(super) fn is_column(name: &str) -> bool {
    [&BEFORE_AXES[..], &AFTER_AXES, &STATISTICS]
        .concat()
        .contains(&name)
}
