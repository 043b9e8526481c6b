//! The dimensionless groups of a case.

use slipfront::Scales;

use crate::case_file;
use crate::case_file::{CaseError, CaseFile};

/// The dimensionless groups on which the model depends (Eq. 11).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Groups {
    /// V*, the speed of the drive.
    pub v_star: f64,
    /// R*, the mean kinetic over the mean static coefficient.
    pub r_star: f64,
    /// Omega*, the damping.
    pub omega_star: f64,
    /// sigma_s*, the spread of the static coefficients.
    pub sigma_static_star: f64,
    /// sigma_k*, the spread of the kinetic coefficients.
    pub sigma_kinetic_star: f64,
    /// eps = P mu_s/E, the strain of the load.
    pub epsilon: f64,
}

/// Largest strain of the load; the model assumes small deformations.
const MAX_EPSILON: f64 = 0.5;
const MIN_V_STAR: f64 = 1e-9;
const MAX_V_STAR: f64 = 10.0;
const MAX_OMEGA_STAR: f64 = 1000.0;

impl Groups {
    /// The groups of a case file.
    ///
    /// # Errors
    /// When a group is out of the range in which the model is valid.
    pub(super) fn of(file: &CaseFile, scales: &Scales) -> Result<Self, CaseError> {
        let epsilon = scales.epsilon();
        if epsilon > MAX_EPSILON {
            let sentence = format!(
                "the load strains the slider by P mu_s/E = {epsilon:.3}, more than {MAX_EPSILON}: lower `pressure` or raise \
                 `young_modulus`"
            );
            return Err(file.source.error("load.pressure", sentence));
        }
        let v_star = match &file.drive.speed {
            case_file::DriveSpeed::VStar(v_star) => *v_star,
            case_file::DriveSpeed::Speed(speed) => speed.si() / scales.speed(),
        };
        let key = if file.source.has("drive.speed") {
            "drive.speed"
        } else {
            "drive.v_star"
        };
        within(file, key, "V*", v_star, MIN_V_STAR, MAX_V_STAR)?;
        let r_star = match file.friction.kinetic {
            case_file::KineticFriction::RStar(r_star) => r_star,
            case_file::KineticFriction::MuKinetic(mu) => mu / scales.mu_static_mean,
        };
        let omega_star = match &file.slider.damping {
            case_file::Damping::OmegaStar(omega_star) => *omega_star,
            case_file::Damping::Rate(rate) => scales.omega_star(rate.si()),
        };
        let key = if file.source.has("slider.damping_rate") {
            "slider.damping_rate"
        } else {
            "slider.omega_star"
        };
        within(file, key, "Omega*", omega_star, 0.0, MAX_OMEGA_STAR)?;
        Ok(Groups {
            v_star,
            r_star,
            omega_star,
            sigma_static_star: file.friction.sigma_static_star,
            sigma_kinetic_star: file.friction.sigma_kinetic_star,
            epsilon,
        })
    }
}

fn within(
    file: &CaseFile,
    key: &str,
    symbol: &str,
    value: f64,
    low: f64,
    high: f64,
) -> Result<(), CaseError> {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    Err(file.source.error(
        key,
        format!("this makes {symbol} = {value:?}, which must lie between {low:?} and {high:?}"),
    ))
}
