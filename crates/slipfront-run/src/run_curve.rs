//! Runs a [`Case`] and keeps only the curve of friction against time and displacement, which a fit needs for
//! many small cases.

use std::sync::Arc;

use slipfront::observe::{Observer, Scheduled};
use slipfront::{Execution, RunError, Simulation, Snapshot, Stop};
use slipfront_case::case::Case;

use crate::friction_unit::FrictionUnit;
use crate::measured::Measure;
use crate::run_summary::with_increments;

/// Friction of a run at every step, in the units of a measured record.
#[derive(Clone, Debug, PartialEq)]
pub struct RunCurve {
    /// Time, s.
    pub time: Vec<f64>,
    /// Displacement of the drive, m; for a rotation at its largest radius.
    pub displacement: Vec<f64>,
    /// Friction coefficient mu (Eq. 9).
    pub coefficient: Vec<f64>,
    /// Friction of a slider with mu = 1, N; none for a drive that rotates, because its friction is a torque.
    pub unit_force: Option<f64>,
}

impl RunCurve {
    /// Times or displacements, according to the abscissa of a record.
    pub fn along(&self, x: Measure) -> &[f64] {
        if x == Measure::Displacement {
            &self.displacement
        } else {
            &self.time
        }
    }
}

/// A case whose curve is wanted.
#[derive(Clone, Debug)]
pub struct CurveCase {
    /// Case of the run.
    pub case: Case,
    /// Abscissa of the curve.
    pub along: Measure,
    /// Time in s or displacement in m up to which the case is run.
    pub end: f64,
}

impl CurveCase {
    /// Runs the case as [`run_curve_unless`] does.
    ///
    /// # Errors
    /// When the run diverges.
    pub fn curve_unless(&self, ends: &dyn Fn() -> bool) -> Option<Result<RunCurve, RunError>> {
        run_curve_unless(&self.case, self.along, self.end, ends)
    }
}

/// Records friction, time and path of every step.
pub(crate) struct Tracing {
    time_star: Vec<f64>,
    path: Vec<f64>,
    mu_star: Vec<f64>,
}

impl Tracing {
    /// Room for `steps` steps and the start.
    pub(crate) fn of_steps(steps: u64) -> Self {
        let room = || Vec::with_capacity(steps as usize + 1);
        Self {
            time_star: room(),
            path: room(),
            mu_star: room(),
        }
    }
}

impl Observer for Tracing {
    fn observe(&mut self, now: &Snapshot) -> Result<(), RunError> {
        self.time_star.push(now.time_star);
        self.path.push(now.model.drive.path(now.drive_time_star));
        self.mu_star.push(now.point.mu_star);
        Ok(())
    }
}

/// Runs a case on one thread up to a time or a displacement, whatever its `time` table says, and keeps only
/// the curve; none if `ends` stopped it. If a program of speeds determines how far the drive moves, the case
/// sets the end of the run.
///
/// ```
/// use slipfront_case::case::Case;
/// use slipfront_run::measured::Measure;
/// use slipfront_run::run_curve::run_curve_unless;
/// // Blocks that are all alike stick at first, and their springs pull with k* V* t*, times mu_s.
/// let text = "slider.blocks = [4, 4]\ndrive = { v_star = 0.1, stiffness_star = 0.5 }\n\
///             friction = { mu_static = 0.6, sigma_static_star = 0 }";
/// let case = Case::parse(text, "alike", "", &[])?;
/// let curve = run_curve_unless(&case, Measure::Time, 4.0 * case.scales.time(), &|| false).unwrap()?;
/// let last = curve.time.len() - 1;
/// let time_star = curve.time[last] / case.scales.time();
/// assert!((4.0..4.3).contains(&time_star));
/// assert!((curve.coefficient[last] - 0.6 * 0.5 * 0.1 * time_star).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the run diverges.
pub fn run_curve_unless(
    case: &Case,
    along: Measure,
    end: f64,
    ends: &dyn Fn() -> bool,
) -> Option<Result<RunCurve, RunError>> {
    let case = &*match with_increments(case, ends)? {
        Ok(case) => case,
        Err(error) => return Some(Err(error)),
    };
    let steps = steps_to(case, along, end);
    let stop = Stop::at_step(steps);
    let dt_star = case.time_plan.dt_star;
    let mut simulation = Simulation::new(
        Arc::clone(&case.model),
        dt_star,
        case.state(),
        Execution::default(),
    );
    let mut tracing = Tracing::of_steps(steps);
    while !ends() {
        let mut observers = [Scheduled::always(&mut tracing)];
        match simulation.advance(stop, case.steps_per_poll(), &mut observers) {
            Ok(None) => {}
            Ok(Some(_)) => return Some(Ok(in_si_units(case, tracing))),
            Err(error) => return Some(Err(error)),
        }
    }
    None
}

/// Number of steps that [`run_curve_unless`] takes.
pub fn steps_to(case: &Case, along: Measure, end: f64) -> u64 {
    let drive = &case.model.drive;
    let end_star = match (along, &drive.program) {
        (Measure::Displacement, None) => end / (drive.v_star * case.scales.displacement()),
        (Measure::Displacement, Some(_)) => case.time_plan.end_star(),
        _ => end / case.scales.time(),
    };
    (end_star / case.time_plan.dt_star).ceil() as u64 + 1
}

/// Friction force at mu* = 1, N; none for a drive that rotates, because its friction is a torque.
pub fn unit_force_star(case: &Case) -> Option<f64> {
    FrictionUnit::new(&case.scales, &case.model).force(1.0)
}

/// Converts the recorded times, paths and friction of a run to SI units.
pub(crate) fn in_si_units(case: &Case, traced: Tracing) -> RunCurve {
    let scales = &case.scales;
    let times = |mut values: Vec<f64>, unit: f64| {
        values.iter_mut().for_each(|value| *value *= unit);
        values
    };
    let mu_static = scales.mu_static_mean;
    RunCurve {
        time: times(traced.time_star, scales.time()),
        displacement: times(traced.path, scales.displacement()),
        coefficient: times(traced.mu_star, mu_static),
        unit_force: FrictionUnit::new(scales, &case.model).force(1.0 / mu_static),
    }
}
