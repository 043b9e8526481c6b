//! Static friction coefficient of a whole slider without texture, which is below that of its blocks.

use slipfront::{FrictionLaw, Slider};

use super::dimensionless_groups::Groups;
use super::runnable::Case;
use crate::case_file::{Attached, AttachedEdge, AutoOrStiffness, DriveStiffness, Motion};

/// Estimate of the static friction of a whole heterogeneous slider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WholeSlider {
    /// mu_s of the whole slider.
    pub mu_static: f64,
    /// Half the width of the range around the estimate in which the result of a run is expected.
    pub half_width: f64,
    /// Value of `friction.mu_static` of the blocks for which the whole slider would have the given
    /// coefficient, at the same V*.
    pub for_given: f64,
}

/// R* of the tables of [`MEASURED`].
const R_STAR: [f64; 4] = [0.25, 0.5, 0.75, 0.9];
/// V* of the rows of the tables.
const V_STAR: [f64; 4] = [0.003, 0.01, 0.03, 0.1];
/// sigma_s* of the columns of the tables.
const SIGMA_STAR: [f64; 5] = [0.0, 0.02, 0.05, 0.1, 0.2];

/// mu_s* of 50 x 50 blocks, the mean of eight surfaces, measured by `cases/studies/whole_slider.toml`.
const MEASURED: [[[f64; 5]; 4]; 4] = [
    [
        [1.000, 0.933, 0.831, 0.701, 0.605],
        [1.000, 0.938, 0.841, 0.719, 0.622],
        [1.000, 0.951, 0.867, 0.758, 0.654],
        [1.002, 0.976, 0.919, 0.830, 0.723],
    ],
    [
        [1.000, 0.933, 0.835, 0.761, 0.709],
        [1.000, 0.940, 0.850, 0.778, 0.723],
        [1.000, 0.956, 0.882, 0.810, 0.748],
        [1.003, 0.981, 0.933, 0.868, 0.804],
    ],
    [
        [1.000, 0.936, 0.882, 0.857, 0.847],
        [1.000, 0.947, 0.897, 0.867, 0.855],
        [1.000, 0.965, 0.919, 0.887, 0.872],
        [1.007, 0.992, 0.962, 0.932, 0.918],
    ],
    [
        [1.000, 0.954, 0.939, 0.938, 0.948],
        [1.000, 0.965, 0.947, 0.945, 0.954],
        [1.001, 0.979, 0.962, 0.960, 0.969],
        [1.017, 1.011, 1.003, 1.002, 1.010],
    ],
];

/// Largest expected difference of a run from the estimate, in units of `mu_static`: between the entries of
/// the table, the mean of surfaces differs by up to 0.020, and a single surface scatters about the mean by up
/// to 0.015.
const ACCURACY: f64 = 0.03;

/// Smallest and largest number of blocks along an axis for which the table was tested.
const BLOCKS: [usize; 2] = [25, 200];
/// Largest spread of kinetic coefficients and largest damping for which the table was tested.
const MAX_SIGMA_KINETIC: f64 = 0.1;
const MAX_OMEGA_STAR: f64 = 0.5;

impl Case {
    /// Estimate of the static friction of the whole slider. None where there is no basis for an estimate:
    /// with a texture, a slider that is heterogeneous by design, another law of friction or drive, or groups
    /// outside the measured range.
    pub fn whole_slider(&self) -> Option<WholeSlider> {
        let share = self.has_measured_kind().then(|| interpolated(&self.groups))??;
        let mu_static = self.scales.mu_static_mean;
        Some(WholeSlider {
            mu_static: share * mu_static,
            half_width: ACCURACY * mu_static,
            for_given: mu_static / share,
        })
    }

    /// Whether the case is like the measured ones, apart from its dimensionless groups.
    fn has_measured_kind(&self) -> bool {
        let (file, model) = (&self.file, &self.model);
        let (drive, load, friction) = (&file.drive, &file.load, &file.friction);
        let has_adhesion = friction.adhesion.si() > 0.0 || friction.adhesion_kinetic.si() > 0.0;
        let has_fields = friction.mu_static_field.is_some() || friction.mu_kinetic_field.is_some();
        model.friction == FrictionLaw::Projection.into()
            && !has_adhesion
            && !has_fields
            && friction.correlation_length.is_none()
            && file.texture.is_empty()
            && load.profile.is_none()
            && load.pressure_field.is_none()
            && !model.dead_load().acts()
            && self.initial.is_none()
            && *model.slider() == Slider::default()
            && model.body().is_none()
            && model.drive.program.is_none()
            && !model.drive.is_held()
            && drive.motion == Motion::Translation
            && matches!(drive.attached, Attached::At(AttachedEdge::All))
            && drive.stiffness == DriveStiffness::Each(AutoOrStiffness::Auto)
            && [model.lattice.nx, model.lattice.ny]
                .iter()
                .all(|blocks| (BLOCKS[0]..=BLOCKS[1]).contains(blocks))
    }
}

/// mu_s* from the table, linear in R*, log V* and sigma_s*; none outside of the table.
fn interpolated(groups: &Groups) -> Option<f64> {
    if groups.sigma_kinetic_star > MAX_SIGMA_KINETIC || groups.omega_star > MAX_OMEGA_STAR {
        return None;
    }
    let (table, at_r) = place(&R_STAR, groups.r_star)?;
    let (row, at_v) = place(&V_STAR.map(libm::log), libm::log(groups.v_star))?;
    let (column, at_sigma) = place(&SIGMA_STAR, groups.sigma_static_star)?;
    let between = |[from, to]: [f64; 2], at: f64| from + at * (to - from);
    let along_sigma = |table: usize, row: usize| {
        let values = MEASURED[table][row];
        between([values[column], values[column + 1]], at_sigma)
    };
    let along_v = |table: usize| between([along_sigma(table, row), along_sigma(table, row + 1)], at_v);
    Some(between([along_v(table), along_v(table + 1)], at_r))
}

/// Interval between neighbours of a rising grid that contains a number, and the relative position of the
/// number in it; none outside the grid.
fn place(grid: &[f64], number: f64) -> Option<(usize, f64)> {
    let within = |pair: &[f64]| (pair[0]..=pair[1]).contains(&number);
    let first = grid.windows(2).position(within)?;
    Some((first, (number - grid[first]) / (grid[first + 1] - grid[first])))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn share(changes: &[&str]) -> Option<f64> {
        let changes: Vec<String> = changes.iter().map(ToString::to_string).collect();
        let case = Case::parse("", "case", "", &changes).unwrap();
        let whole = case.whole_slider()?;
        assert!((whole.for_given * whole.mu_static - case.scales.mu_static_mean.powi(2)).abs() < 1e-12);
        Some(whole.mu_static / case.scales.mu_static_mean)
    }

    #[test]
    fn entries_of_the_table_are_given_as_they_are() {
        let found = share(&["friction.r_star=0.5", "drive.v_star=0.03"]).unwrap();
        assert!((found - 0.882).abs() < 1e-12);
        let last = [
            "friction.r_star=0.9",
            "drive.v_star=0.1",
            "friction.sigma_static_star=0.2",
        ];
        assert!((share(&last).unwrap() - 1.010).abs() < 1e-12);
        // Half-way in all three: the mean of eight entries.
        let [r, v, sigma] = [0.625, libm::sqrt(0.03 * 0.1), 0.075];
        let changes = [
            format!("friction.r_star={r}"),
            format!("drive.v_star={v:?}"),
            format!("friction.sigma_static_star={sigma}"),
        ];
        let mean = (0.882 + 0.810 + 0.933 + 0.868 + 0.919 + 0.887 + 0.962 + 0.932) / 8.0;
        let found = share(&changes.each_ref().map(String::as_str)).unwrap();
        assert!((found - mean).abs() < 1e-12, "{found} {mean}");
    }

    #[test]
    fn there_is_none_without_ground() {
        assert!(share(&[]).is_some());
        for change in [
            "friction.r_star=0.2",
            "drive.v_star=0.2",
            "drive.v_star=0.001",
            "friction.sigma_static_star=0.3",
            "friction.correlation_length='5 um'",
            "friction.sigma_kinetic_star=0.2",
            "friction.law='reversal'",
            "friction.adhesion='10 kPa'",
            "friction.velocity={ law = 'weakening', v_c_star = 0.1, ratio = 0.5 }",
            "friction.ageing={ law = 'logarithmic', beta = 0.1, time_star = 10 }",
            "slider.omega_star=1",
            "slider.blocks=[24, 50]",
            "slider.blocks=[50, 201]",
            "slider.outline='disc'",
            "slider.viscosity_time_star=0.1",
            "slider.stiffness_grade={ along = 'x', from = 0.5, to = 1.5 }",
            "load.profile={ along = 'x', relative_slope = 0.5 }",
            "load.shear_star=0.1",
            "drive.attach='left'",
            "drive.motion='rotation'",
            "drive.loading='held'",
            "drive.stiffness_star=0.1",
            "texture=[{ shape = 'cavity', coverage = 10 }]",
        ] {
            assert_eq!(share(&[change]), None, "{change}");
        }
    }
}
