//! The observers of the numbers of a run, and the summary that they make at its end.

use serde::{Deserialize, Serialize};
use slipfront::communicator::Communicator;
use slipfront::observe::{Curve, Frame, Kinetic, KineticHistory, NoUncertainty, Peak, Scheduled};
use slipfront::{Checkpoint, Simulation, StopReason};
use slipfront_case::case::{Case, Topography};
use slipfront_case::case_file::{AutoOr, Motion, RunTime};

use crate::friction_unit::FrictionUnit;
use crate::front::add_front;
use crate::observers::{OptionalObservers, Times};
use crate::program::VERSION;
use crate::run_warnings::{after_run, is_kept_up};
use crate::summary::{InstantSummary, SiSummary, Summary, TopographySummary};

/// The observers that every run has, and their numbers.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct SummaryObservers {
    pub(crate) curve: Curve,
    history: KineticHistory,
    pub(crate) optional: OptionalObservers,
}

impl SummaryObservers {
    /// Observers of a run of this case, at its start.
    pub(crate) fn new(case: &Case) -> Self {
        Self::with_rows_every(case.output.series_stride, case)
    }

    /// Observers of a run of this case that keep only the first and the last row of the curve.
    pub(crate) fn without_curve(case: &Case) -> Self {
        Self::with_rows_every(u64::MAX, case)
    }

    fn with_rows_every(stride: u64, case: &Case) -> Self {
        Self {
            curve: Curve::every(stride),
            history: KineticHistory::new(case.time_plan.last_step),
            optional: OptionalObservers::of_run(case),
        }
    }

    /// Whether the observers, at a checkpoint of a run with steps of `dt_star`, can have begun as `new`.
    pub(crate) fn is_consistent_with(&self, new: &Self, checkpoint: &Checkpoint, dt_star: f64) -> bool {
        let now = Times {
            time_star: checkpoint.step as f64 * dt_star,
            drive_time_star: checkpoint.drive_steps as f64 * dt_star,
        };
        self.optional.fit(&new.optional, now)
            && self.curve.is_consistent_with(&new.curve, checkpoint.drive_steps)
            && self
                .history
                .is_consistent_with(&new.history, checkpoint.drive_steps)
    }

    pub(crate) fn scheduled(&mut self) -> Vec<Scheduled<'_>> {
        let mut scheduled = vec![
            Scheduled::always(&mut self.curve),
            Scheduled::always(&mut self.history),
        ];
        scheduled.extend(self.optional.scheduled());
        scheduled
    }

    /// Adds the front to the numbers of a run that has ended, from the first slips of the blocks that this
    /// rank holds: of all t* of a run with a transition, or of the event that crosses a slider driven at an
    /// edge. All ranks must call this together.
    pub(crate) fn add_front(
        &self,
        numbers: &mut Summary,
        case: &Case,
        first_slips: &[f64],
        communicator: &dyn Communicator,
    ) {
        let during = match &self.optional.precursors {
            None => numbers.transition.then_some(0.0..=f64::INFINITY),
            Some(precursors) => precursors.crossing().map(|crossing| {
                let until = crossing.after.map_or(f64::INFINITY, |(time_star, _)| time_star);
                crossing.from_star..=until
            }),
        };
        if let Some(during) = during {
            add_front(numbers, case, first_slips, during, communicator);
        }
    }

    /// Friction in the kinetic window as it follows from a peak, up to now.
    pub(crate) fn kinetic(&self, case: &Case, peak: &Peak) -> Option<Kinetic> {
        let (plan, speed) = (&case.time_plan, case.model.loading_speed());
        let from = plan.kinetic.time_star(peak, speed);
        let mut kinetic = self.history.kinetic(from, plan.dt_star, speed)?;
        if case.model.drive.program.is_some() {
            kinetic.uncertainty = Err(NoUncertainty::SpeedChanges);
        }
        Some(kinetic)
    }

    /// The numbers of a run that has ended, with the instants A-F that it had.
    pub(crate) fn end(
        &self,
        case: &Case,
        simulation: &Simulation,
        reason: StopReason,
        instants: &[(char, Frame)],
    ) -> Summary {
        let peak = simulation.peak();
        let first_slip = peak.first_slip_drive_time_star;
        // A run that stops at its onset has no kinetic phase, wherever the window was meant to begin, and
        // neither has one in which nothing slipped.
        let kinetic = match reason {
            StopReason::End => first_slip.and_then(|_| self.kinetic(case, &peak)),
            StopReason::Onset => None,
        };
        let last = self.curve.rows.last();
        let is_held = case.model.drive.is_held();
        let last_row = last.copied().unwrap_or_default();
        let (steps, energies) = (last_row.step, last_row.energies);
        let law = case.model.friction.needs();
        let correlated = case.correlated_field();
        let (mean, time) = (case.scales.mu_static_mean, case.scales.time());
        let energy = case.scales.energy();
        let kinetic_star = kinetic.map(|kinetic| kinetic.mu_star);
        let transition = case.can_have_transition() && peak.ended && !is_kept_up(&peak, kinetic);
        let [static_star, lateral_star, onset_star] = static_friction(&peak, transition);
        let si = si(case, static_star, kinetic_star, simulation.contact_stress_max());
        let after_run = after_run(
            (
                reason,
                is_held,
                case.file.time.duration == RunTime::Star(AutoOr::Auto),
            ),
            &peak,
            transition,
            first_slip,
            kinetic,
            &energies,
        );
        let mut summary = Summary {
            static_friction_star: static_star,
            static_friction: static_star * mean,
            static_lateral_friction_star: lateral_star,
            onset_time_star: onset_star,
            onset_time_s: onset_star * time,
            first_slip_time_star: first_slip,
            first_slip_time_s: first_slip.map(|star| star * time),
            kinetic_friction_star: kinetic.map(|k| k.mu_star),
            kinetic_friction_star_uncertainty: kinetic.and_then(|k| k.uncertainty.ok()),
            kinetic_friction: kinetic.map(|k| k.mu_star * mean),
            kinetic_lateral_friction_star: kinetic.map(|k| k.mu_lateral_star),
            kinetic_window_star: kinetic.map(|k| k.window_star),
            sliding_percent_kinetic: kinetic.map(|k| k.sliding_percent),
            sliding_percent_max: self.history.sliding_percent_max(),
            mu_star_max: peak.largest.mu_star,
            transition,
            instants: instants
                .iter()
                .map(|found| InstantSummary::new(found, is_held))
                .collect(),
            si: Some(si),
            v_star: case.groups.v_star,
            r_star: case.groups.r_star,
            omega_star: case.groups.omega_star,
            sigma_static_star: case.groups.sigma_static_star,
            sigma_kinetic_star: case.groups.sigma_kinetic_star,
            epsilon: case.groups.epsilon,
            n_blocks: case.model.n_blocks(),
            texture_percent: case.texture.meshed_percent,
            texture_percent_asked: case.texture.asked_percent,
            topographies: topographies(case),
            dt_star: case.time_plan.dt_star,
            steps,
            drive_steps: is_held.then_some(last_row.drive_steps),
            seed: case.file.friction.seed,
            variance_of_blocks_percent: correlated
                .as_ref()
                .map(|field| 100.0 * field.variance_of_blocks()),
            variance_of_surfaces_percent: correlated.map(|field| 100.0 * field.variance_of_slider()),
            negative_draws: case.model.surface.negative_draws(),
            energy_error: energies.error(),
            work_j: energies.work * energy,
            friction_loss_j: energies.friction_loss * energy,
            damping_loss_j: energies.damping_loss * energy,
            motion: case.model.drive.rotation.map(|_| Motion::Rotation),
            viscous_loss_j: case
                .model
                .slider()
                .is_viscous()
                .then_some(energies.viscous_loss * energy),
            broken_spring_loss_j: law.stores_energy.then_some(energies.broken_springs_loss * energy),
            weakening_loss_j: law.weakens_with_slip.then_some(energies.weakening_loss * energy),
            mean_state_star: last.filter(|_| law.has_state).map(|row| row.mean_state),
            warnings: [case.warnings(), after_run].concat(),
            version: VERSION.to_owned(),
            // The front is found later, when the simulation has freed its memory.
            ..Summary::default()
        };
        self.optional.write_into(&mut summary);
        summary
    }
}

/// mu* along and across the drive and t* of static friction: at the first peak, or at the largest mu* if
/// there is no transition.
fn static_friction(peak: &Peak, transition: bool) -> [f64; 3] {
    if transition {
        [peak.mu_star, peak.mu_lateral_star, peak.drive_time_star]
    } else {
        let largest = &peak.largest;
        [largest.mu_star, largest.mu_lateral_star, largest.time_star]
    }
}

fn topographies(case: &Case) -> Option<Vec<TopographySummary>> {
    let of_file = |topography: &Topography| TopographySummary {
        texture: topography.texture,
        points: topography.points,
        size_m: topography.size,
        sa_m: topography.roughness.sa,
        sq_m: topography.roughness.sq,
        ssk: topography.roughness.ssk,
        sku: topography.roughness.sku,
        contact_height_m: topography.contact_height,
    };
    let topographies = &case.texture.topographies;
    (!topographies.is_empty()).then(|| topographies.iter().map(of_file).collect())
}

fn si(case: &Case, static_star: f64, kinetic_star: Option<f64>, contact_stress_max: f64) -> SiSummary {
    let (scales, model) = (&case.scales, &case.model);
    let area = model.surface.n_facing() as f64 * scales.block_size * scales.contact_width;
    let unit = FrictionUnit::new(scales, model);
    SiSummary {
        pressure_pa: scales.pressure,
        young_modulus_pa: scales.young_modulus,
        density_kg_m3: scales.density,
        block_size_m: scales.block_size,
        area_m2: area,
        normal_force_n: model.surface.mean_normal_force() * scales.pressure * area,
        static_friction_force_n: unit.force(static_star),
        kinetic_friction_force_n: kinetic_star.and_then(|star| unit.force(star)),
        static_torque_n_m: unit.torque(static_star),
        time_unit_s: scales.time(),
        displacement_unit_m: scales.displacement(),
        stress_unit_pa: scales.stress(),
        contact_stress_max_pa: contact_stress_max * scales.stress(),
    }
}
