//! The dimensionless groups of a case.

use std::ops::RangeInclusive;

use slipfront::Scales;

use crate::case_file::{CaseError, CaseFile, Damping, DriveSpeed};
use slipfront_base::number_format::four_digits;

/// The dimensionless groups on which the model depends (Eq. 11).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Groups {
    /// V*, the speed of the drive; the largest of a program.
    pub v_star: f64,
    /// R*, the mean kinetic over the mean static coefficient.
    pub r_star: f64,
    /// Omega*, the damping.
    pub omega_star: f64,
    /// sigma_s*, the spread of the static coefficients.
    pub sigma_static_star: f64,
    /// sigma_k*, the spread of the kinetic coefficients.
    pub sigma_kinetic_star: f64,
    /// eps = P mu_s l/(E h), the strain of the load.
    pub epsilon: f64,
}

/// Largest strain of the load, because the model assumes small deformations.
const MAX_EPSILON: f64 = 0.5;
const MIN_V_STAR: f64 = 1e-9;
pub(super) const MAX_V_STAR: f64 = 10.0;
const MAX_OMEGA_STAR: f64 = 1000.0;
/// Smallest unit of a displacement, speed or stress, in SI: fields are written in single precision, which
/// ends at 1e-38 and must resolve eight digits below the unit.
const MIN_UNIT: f64 = 1e-30;

impl Groups {
    /// The groups of a case file; an error when one is outside the range in which the model is valid.
    pub(super) fn new(file: &CaseFile, scales: &Scales) -> Result<Self, CaseError> {
        let epsilon = scales.epsilon();
        if epsilon > MAX_EPSILON && !file.slider.rigid {
            let sentence = format!(
                "the load strains the slider by P mu_s l/(E h) = {epsilon:.3}, more than {MAX_EPSILON}: reduce `pressure` or \
                 increase `young_modulus`"
            );
            return Err(file.source.error("load.pressure", sentence));
        }
        refuse_small_units(file, scales)?;
        let (key, v_star) = match &file.drive.speed {
            DriveSpeed::VStar(v_star) => ("drive.v_star", *v_star),
            DriveSpeed::Speed(speed) => ("drive.speed", speed.si() / scales.speed()),
            DriveSpeed::Program(segments) => {
                let speeds = segments.iter().map(|segment| segment.v_star.abs());
                ("drive.program", speeds.fold(0.0, f64::max))
            }
        };
        within(file, key, "V*", v_star, MIN_V_STAR..=MAX_V_STAR)?;
        let friction = &file.friction;
        let (key, omega_star) = match &file.slider.damping {
            Damping::OmegaStar(omega_star) => ("slider.omega_star", *omega_star),
            Damping::Rate(rate) => ("slider.damping_rate", scales.omega_star(rate.si())),
        };
        within(file, key, "Omega*", omega_star, 0.0..=MAX_OMEGA_STAR)?;
        Ok(Groups {
            v_star,
            r_star: friction.mean_ratio(),
            omega_star,
            sigma_static_star: if friction.has_static_coefficient() {
                friction.sigma_static_star
            } else {
                0.0
            },
            sigma_kinetic_star: if friction.has_kinetic_coefficient() {
                friction.sigma_kinetic_star
            } else {
                0.0
            },
            epsilon,
        })
    }
}

/// Refuses units of results that are too small for the precision of the files.
fn refuse_small_units(file: &CaseFile, scales: &Scales) -> Result<(), CaseError> {
    let units = [
        ("displacement, P mu_s l^2/(E h),", scales.displacement(), "m"),
        ("speed, P mu_s l/(h sqrt(E rho)),", scales.speed(), "m/s"),
        ("stress, P mu_s,", scales.stress(), "Pa"),
    ];
    let Some((what, size, unit)) = units.into_iter().find(|(_, size, _)| *size < MIN_UNIT) else {
        return Ok(());
    };
    let keys = [
        "friction.mu_static",
        "load.pressure",
        "slider.block_size",
        "slider.thickness",
        "slider.young_modulus",
        "slider.density",
    ];
    let key = keys
        .into_iter()
        .find(|key| file.source.has(key))
        .unwrap_or_default();
    let sentence = format!(
        "the unit of {what} is {} {unit}, below {MIN_UNIT:e}, so results are lost to rounding: increase `mu_static` or \
         `pressure`, and check the units of `block_size`, `young_modulus` and `density`",
        four_digits(size)
    );
    Err(file.source.error(key, sentence))
}

pub(super) fn within(
    file: &CaseFile,
    key: &str,
    symbol: &str,
    value: f64,
    bounds: RangeInclusive<f64>,
) -> Result<(), CaseError> {
    if bounds.contains(&value) {
        return Ok(());
    }
    let (low, high) = bounds.into_inner();
    let sentence = format!("this makes {symbol} = {value:?}, which must lie between {low:?} and {high:?}");
    Err(file.source.error(key, sentence))
}
