//! The numbers of a run, the content of `summary.json`.

use std::ops::RangeInclusive;
use std::path::Path;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use slipfront::lattice::shear_wave_speed;
use slipfront::observe::{
    Curve, Cycles, Energies, Frame, Kinetic, KineticHistory, NoUncertainty, Peak, Precursors, Quantiles,
    Scheduled, SlipEvent,
};
use slipfront::{Checkpoint, Scales, Simulation, StopReason};

use crate::error::ResultsError;
use crate::folder_error::FolderError;
use crate::friction_unit::FrictionUnit;
use crate::front::LatticeFront;
use crate::names::SUMMARY;
use crate::program::VERSION;
use crate::run_files::RunFile;
use slipfront_base::disk::{TEXT_MAX_BYTES, json};
use slipfront_case::case::{Case, Topography};
use slipfront_case::case_file::Motion;

/// The numbers of a run. Starred quantities are dimensionless (Eq. 11); times without a star are in s. A drive that is held
/// has its own time, which counts only while it moves.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Summary {
    /// mu_s*, the first peak of mu*; for a drive that is held the largest value before the kinetic window; without a
    /// transition the largest value.
    pub static_friction_star: f64,
    /// Static friction coefficient mu_s.
    pub static_friction: f64,
    /// Friction across the drive at the instant of mu_s*, over the load and mu_s, positive to the left of the drive.
    #[serde(default)]
    pub static_lateral_friction_star: f64,
    /// Time t_s* of the onset, on the time of the drive.
    pub onset_time_star: f64,
    /// Time t_s of the onset, s.
    pub onset_time_s: f64,
    /// t* of the first slip of a block in contact.
    pub first_slip_time_star: Option<f64>,
    /// Time of the first slip of a block in contact, s.
    pub first_slip_time_s: Option<f64>,
    /// mu_k*, the mean of mu* over the kinetic window.
    pub kinetic_friction_star: Option<f64>,
    /// Standard error of mu_k*; none where the window supports none (see the warnings).
    pub kinetic_friction_star_uncertainty: Option<f64>,
    /// Kinetic friction coefficient mu_k.
    pub kinetic_friction: Option<f64>,
    /// Mean friction across the drive over the kinetic window.
    #[serde(default)]
    pub kinetic_lateral_friction_star: Option<f64>,
    /// First and last t* of the kinetic window, on the time of the drive.
    pub kinetic_window_star: Option<[f64; 2]>,
    /// Mean N* over the kinetic window, %.
    pub sliding_percent_kinetic: Option<f64>,
    /// Largest N*, %.
    pub sliding_percent_max: f64,
    /// Largest mu* of the whole run; above mu_s* where a later peak is higher than the first.
    pub mu_star_max: f64,
    /// Whether mu* fell at least half-way to the steady level L and by (1 - L)/20 after its first peak, within the time of a
    /// transition, mu_k* is as much below the peak, and steady sliding takes less force than the blocks hold at rest.
    pub transition: bool,
    /// The instants A-F that were found.
    pub instants: Vec<InstantSummary>,
    /// Units of the starred quantities and laboratory values.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub si: Option<SiSummary>,
    /// Number of sites at which slip has nucleated. Like all values of the front, it belongs to a run with a transition, or
    /// to an event that crosses a slider driven at an edge.
    pub nucleation_sites: Option<usize>,
    /// Coordinate x of the first nucleation, m.
    pub nucleation_x_m: Option<f64>,
    /// Coordinate y of the first nucleation, m.
    pub nucleation_y_m: Option<f64>,
    /// All sites of nucleation.
    #[serde(default)]
    pub nucleations: Vec<NucleationSummary>,
    /// Share of the windows of 7 x 7 blocks through which a front passes. For a slider driven at an edge, this and the
    /// following values belong to the event that crosses it.
    #[serde(default)]
    pub front_share: Option<f64>,
    /// Median speed of the slip front over the speed of long shear waves; none where it passes through less than half of the windows.
    pub front_speed_c_s: Option<f64>,
    /// Speed below which 5 % of the front is, over the speed of long shear waves.
    pub front_speed_low_c_s: Option<f64>,
    /// Speed below which 95 % of the front is, over the speed of long shear waves.
    pub front_speed_high_c_s: Option<f64>,
    /// Median speed of the front, m/s.
    pub front_speed_m_s: Option<f64>,
    /// Speed below which 5 % of the front is, m/s.
    pub front_speed_low_m_s: Option<f64>,
    /// Speed below which 95 % of the front is, m/s.
    pub front_speed_high_m_s: Option<f64>,
    /// Duration from 5 to 95 % of the first slips, t*.
    pub front_duration_star: Option<f64>,
    /// Duration from 5 to 95 % of the first slips, s.
    pub front_duration_s: Option<f64>,
    /// Speed V* of the drive.
    pub v_star: f64,
    /// Ratio R* of the mean coefficients.
    pub r_star: f64,
    /// Damping Omega*.
    pub omega_star: f64,
    /// Spread sigma_s* of the static coefficients.
    pub sigma_static_star: f64,
    /// Spread sigma_k* of the kinetic coefficients.
    pub sigma_kinetic_star: f64,
    /// Strain of the load, eps = P mu_s l/(E h).
    pub epsilon: f64,
    /// Number N of blocks that exist.
    pub n_blocks: usize,
    /// Textured area A* as meshed, %.
    pub texture_percent: f64,
    /// Textured area A* as asked for, %; none where a mask or polygon gives it block by block only.
    pub texture_percent_asked: Option<f64>,
    /// Height maps among the textures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub topographies: Option<Vec<TopographySummary>>,
    /// Time step dt*.
    pub dt_star: f64,
    /// Number of steps done.
    pub steps: u64,
    /// Number of steps in which a held drive moved; in the others it stood.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drive_steps: Option<u64>,
    /// Seed of the random coefficients.
    pub seed: u64,
    /// Share of the variance of correlated random coefficients at a point that means over blocks keep, %.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub variance_of_blocks_percent: Option<f64>,
    /// Share of the variance of correlated random coefficients at a point that the mean of a surface has from seed to seed,
    /// %.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub variance_of_surfaces_percent: Option<f64>,
    /// Negative draws of the coefficients of blocks in contact that were set to 0.
    pub negative_draws: usize,
    /// Energy that is not accounted for, relative to the energy put in.
    pub energy_error: f64,
    /// Work of the drive, J.
    pub work_j: f64,
    /// Energy lost to friction, J.
    pub friction_loss_j: f64,
    /// Energy lost to damping, J.
    pub damping_loss_j: f64,
    /// Motion of a drive that rotates: mu* and its derivatives are the torque over P mu_s l^2 times the sum of all radii.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<Motion>,
    /// Events of slip of a slider driven at an edge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub precursors: Option<PrecursorSummary>,
    /// Peak of every part of a program of speeds in which the drive moves forwards.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cycles: Option<Vec<CycleSummary>>,
    /// Energy lost to the dampers between blocks, J, if there are any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub viscous_loss_j: Option<f64>,
    /// Energy lost with contacts that broke, J; none for contacts that store no energy.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub broken_spring_loss_j: Option<f64>,
    /// Part of the loss to friction that is the energy that falling strength takes, J; none where strength does not fall.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weakening_loss_j: Option<f64>,
    /// Mean state of the contacts at the end, t*; none for contacts without a state.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean_state_star: Option<f64>,
    /// Warnings that a reader should know before trusting the numbers.
    pub warnings: Vec<String>,
    /// Version of slipfront.
    pub version: String,
}

/// A run in SI units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SiSummary {
    /// Pressure P, Pa.
    pub pressure_pa: f64,
    /// Young's modulus E, Pa.
    pub young_modulus_pa: f64,
    /// Density rho, kg/m^3.
    pub density_kg_m3: f64,
    /// Edge of a block l, m.
    pub block_size_m: f64,
    /// Area of all blocks, m^2.
    pub area_m2: f64,
    /// Load that the blocks in contact carry, N.
    pub normal_force_n: f64,
    /// Largest friction of the first peak, N; none for a drive that rotates.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub static_friction_force_n: Option<f64>,
    /// Mean friction over the kinetic window, N.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kinetic_friction_force_n: Option<f64>,
    /// Torque of the first peak, N m, for a drive that rotates.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub static_torque_n_m: Option<f64>,
    /// One unit of t*, s.
    pub time_unit_s: f64,
    /// One unit of displacement, m.
    pub displacement_unit_m: f64,
    /// One unit of stress, P mu_s, Pa.
    pub stress_unit_pa: f64,
    /// Largest contact stress of a block at any time, tau_c, Pa.
    pub contact_stress_max_pa: f64,
}

/// A height map: parameters of ISO 25178-2 of all of its points, and its height of contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TopographySummary {
    /// Position of the height map's texture in the case file, from 0.
    pub texture: usize,
    /// Points along x and along y.
    pub points: [usize; 2],
    /// True size along x and along y, m.
    pub size_m: [f64; 2],
    /// Arithmetical mean height Sa, m.
    pub sa_m: f64,
    /// Root mean square height Sq, m.
    pub sq_m: f64,
    /// Skewness Ssk; none for a plane.
    pub ssk: Option<f64>,
    /// Kurtosis Sku; none for a plane.
    pub sku: Option<f64>,
    /// The least height of a block that touches, m.
    pub contact_height_m: f64,
}

/// One of the instants A-F.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InstantSummary {
    /// Letter of the instant, A-F.
    pub instant: char,
    /// Time t* of the instant.
    pub time_star: f64,
    /// t* of a held drive at the instant.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drive_time_star: Option<f64>,
    /// Friction coefficient mu* at the instant.
    pub mu_star: f64,
    /// Share of sliding blocks N* at the instant, %.
    pub sliding_percent: f64,
}

impl InstantSummary {
    fn of((letter, frame): &(char, Frame), is_held: bool) -> Self {
        Self {
            instant: *letter,
            time_star: frame.time_star,
            drive_time_star: is_held.then_some(frame.drive_time_star),
            mu_star: frame.point.mu_star,
            sliding_percent: frame.point.sliding_percent,
        }
    }
}

/// A site at which slip has nucleated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NucleationSummary {
    /// Coordinate x of the site's first block, m.
    pub x_m: f64,
    /// Coordinate y of the site's first block, m.
    pub y_m: f64,
    /// t* of the first slip of the site.
    pub time_star: f64,
}

/// Events of slip of a slider driven at an edge.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PrecursorSummary {
    /// Number of events; each is a row of `precursors.csv`.
    pub events: usize,
    /// t* at which the first one begins that crosses the whole slider.
    pub crossing_time_star: Option<f64>,
    /// mu* at the beginning of the first event that crosses the whole slider.
    pub crossing_mu_star: Option<f64>,
    /// Number of precursors: events before the one that crosses the whole slider, or all events if none crosses.
    pub precursor_count: usize,
    /// Length of the longest precursor, over that of the slider.
    pub precursor_length_max: Option<f64>,
    /// mu* when the first event begins over mu* when the first one begins that crosses the whole slider: the load at nucleation over that
    /// at the transition.
    pub nucleation_load_ratio: Option<f64>,
}

/// A part of a program of speeds in which the drive moves forwards.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CycleSummary {
    /// t* at which the part begins.
    pub from_star: f64,
    /// Speed V* of the part.
    pub v_star: f64,
    /// Largest mu* in the part.
    pub mu_star_max: f64,
    /// t* of the largest mu*.
    pub time_star: f64,
}

/// The observers that every run has, and their numbers.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct SummaryObservers {
    pub(crate) curve: Curve,
    history: KineticHistory,
    /// Events of slip under a drive at an edge.
    pub(crate) precursors: Option<Precursors>,
    /// Peaks under a program of speeds.
    cycles: Option<Cycles>,
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
            precursors: case.file.drive.edge().map(Precursors::new),
            cycles: case.model.drive.program.is_some().then(Cycles::default),
        }
    }

    /// Whether the observers can be those that began as `new`, at a checkpoint of steps of `dt_star`.
    pub(crate) fn is_consistent_with(&self, new: &Self, checkpoint: &Checkpoint, dt_star: f64) -> bool {
        let [time_star, drive_time_star] =
            [checkpoint.step, checkpoint.drive_steps].map(|steps| steps as f64 * dt_star);
        let precursors = match (&self.precursors, &new.precursors) {
            (Some(old), Some(new)) => old.is_consistent_with(new, time_star),
            (old, new) => old.is_none() && new.is_none(),
        };
        let cycles = match (&self.cycles, &new.cycles) {
            (Some(old), Some(_)) => old.is_consistent_with(drive_time_star),
            (old, new) => old.is_none() && new.is_none(),
        };
        precursors
            && cycles
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
        scheduled.extend(
            self.precursors
                .as_mut()
                .map(|precursors| Scheduled::always(precursors)),
        );
        scheduled.extend(self.cycles.as_mut().map(|cycles| Scheduled::always(cycles)));
        scheduled
    }

    /// The events of slip of a slider driven at an edge.
    fn precursors(&self) -> Option<PrecursorSummary> {
        let precursors = self.precursors.as_ref()?;
        let (events, crossing) = (precursors.events(), precursors.crossing());
        let is_precursor = |event: &&SlipEvent| event.length < 1.0;
        let before: Vec<f64> = events
            .iter()
            .take_while(is_precursor)
            .map(|event| event.length)
            .collect();
        let crossing_mu_star = crossing.map(|event| event.mu_star_before);
        let nucleation = events.first().map(|event| event.mu_star_before);
        Some(PrecursorSummary {
            events: events.len(),
            crossing_time_star: crossing.map(|event| event.from_star),
            crossing_mu_star,
            precursor_count: before.len(),
            precursor_length_max: before.into_iter().reduce(f64::max),
            nucleation_load_ratio: nucleation
                .zip(crossing_mu_star)
                .map(|(first, crossing)| first / crossing),
        })
    }

    /// The t* in which a front passes: all t* of a run with a transition, or the event that crosses a slider driven at an
    /// edge; none if there is no front.
    pub(crate) fn times_of_front(&self, transition: bool) -> Option<RangeInclusive<f64>> {
        let Some(precursors) = &self.precursors else {
            return transition.then_some(0.0..=f64::INFINITY);
        };
        let crossing = precursors.crossing()?;
        let until = crossing.after.map_or(f64::INFINITY, |(time_star, _)| time_star);
        Some(crossing.from_star..=until)
    }

    /// The peaks under a program of speeds.
    fn cycles(&self) -> Option<Vec<CycleSummary>> {
        let cycles = self.cycles.as_ref()?.cycles().iter();
        let peaks = cycles.map(|cycle| CycleSummary {
            from_star: cycle.from_star,
            v_star: cycle.v_star,
            mu_star_max: cycle.mu_star,
            time_star: cycle.time_star,
        });
        Some(peaks.collect())
    }

    /// Friction in the kinetic window as it follows from a peak, up to now.
    pub(crate) fn kinetic(&self, case: &Case, peak: &Peak) -> Option<Kinetic> {
        let (plan, speed) = (&case.time_plan, case.model.loading_speed());
        let from = plan.kinetic.time_star(peak, speed);
        let mut kinetic = self.history.kinetic(from, plan.dt_star, speed)?;
        if self.cycles.is_some() {
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
        let (peak, first_slip) = (simulation.peak(), simulation.snapshot().earliest_first_slip());
        // A run that stops at its onset has no kinetic phase, wherever the window was meant to begin, and neither has one
        // in which nothing slipped.
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
            (reason, is_held),
            &peak,
            transition,
            first_slip,
            kinetic,
            &energies,
        );
        Summary {
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
                .map(|found| InstantSummary::of(found, is_held))
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
            precursors: self.precursors(),
            cycles: self.cycles(),
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
            // The front is found when the simulation has given its memory back.
            ..Summary::default()
        }
    }
}

/// mu* along and across the drive and t* of static friction: at the first peak, or at the largest mu* if there is no
/// transition.
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
    let area = model.n_blocks() as f64 * scales.block_size * scales.block_size;
    let unit = FrictionUnit::of(scales, model);
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

impl Summary {
    /// Adds the values of the front.
    pub(crate) fn add_front(&mut self, front: &LatticeFront, scales: &Scales) {
        let nucleations = front.nucleations.iter().map(|nucleation| NucleationSummary {
            x_m: nucleation.place[0] * scales.block_size,
            y_m: nucleation.place[1] * scales.block_size,
            time_star: nucleation.time_star,
        });
        self.nucleations = nucleations.collect();
        self.nucleation_sites = Some(self.nucleations.len());
        let first = self.nucleations.first();
        self.nucleation_x_m = first.map(|nucleation| nucleation.x_m);
        self.nucleation_y_m = first.map(|nucleation| nucleation.y_m);
        let speeds = |unit: f64| {
            let speed = |of: fn(Quantiles) -> f64| front.speed.map(|speed| of(speed) * unit);
            [speed(|s| s.median), speed(|s| s.low), speed(|s| s.high)]
        };
        [
            self.front_speed_c_s,
            self.front_speed_low_c_s,
            self.front_speed_high_c_s,
        ] = speeds(1.0 / shear_wave_speed());
        [
            self.front_speed_m_s,
            self.front_speed_low_m_s,
            self.front_speed_high_m_s,
        ] = speeds(scales.block_size / scales.time());
        self.front_share = front.share;
        self.front_duration_star = front.duration_star;
        self.front_duration_s = front.duration_star.map(|star| star * scales.time());
    }
}

/// Reads `summary.json` of a run folder.
pub fn read_summary(run: &Path) -> Result<Summary, ResultsError> {
    summary_of(&run.join(SUMMARY).into())
}

/// Reads the largest contact stress of a run, Pa, from its `summary.json`, and nothing else of it; none if the run was written without units.
pub fn contact_stress_max_of(file: &RunFile<'_>) -> Result<Option<f64>, ResultsError> {
    #[derive(Deserialize)]
    struct Stress {
        contact_stress_max_pa: f64,
    }
    #[derive(Deserialize)]
    struct WithStress {
        si: Option<Stress>,
    }
    let summary: WithStress = read_json(file)?;
    Ok(summary.si.map(|si| si.contact_stress_max_pa))
}

/// Reads the summary of a run from its `summary.json`.
pub fn summary_of(file: &RunFile<'_>) -> Result<Summary, ResultsError> {
    read_json(file)
}

/// Reads a `summary.json`, or a part of it.
fn read_json<T: DeserializeOwned>(file: &RunFile<'_>) -> Result<T, ResultsError> {
    let path = file.path();
    let bytes = file.read(TEXT_MAX_BYTES).map_err(FolderError::read(path))?;
    serde_json::from_slice(&bytes).map_err(|source| ResultsError::Summary {
        path: path.to_owned(),
        source,
    })
}

/// The summary as it stands in `summary.json`.
pub fn summary_json(summary: &Summary) -> String {
    String::from_utf8_lossy(&json(summary)).into_owned()
}

/// Share of unaccounted energy above which there is a warning; a step of 0.1 stays a factor of ten below.
const LARGE_ENERGY_ERROR: f64 = 0.01;

/// Whether sliding goes on as high as a peak that a fall has ended: mu_s* is then one of many peaks of a slider that creeps.
fn is_kept_up(peak: &Peak, kinetic: Option<Kinetic>) -> bool {
    peak.ended && kinetic.is_some_and(|kinetic| !peak.is_above(kinetic.mu_star))
}

/// Excess of a later mu* over the first peak, relative to that peak, above which there is a warning. Equal peaks of
/// stick-slip differ by less, since steps do not meet their tops.
const HIGHER_LATER: f64 = 0.01;

/// Warnings that follow from the run itself.
fn after_run(
    (reason, is_held): (StopReason, bool),
    peak: &Peak,
    transition: bool,
    first_slip: Option<f64>,
    kinetic: Option<Kinetic>,
    energies: &Energies,
) -> Vec<String> {
    let mut warnings = Vec::new();
    if energies.error().abs() > LARGE_ENERGY_ERROR {
        warnings.push(format!(
            "{:.0} % of the energy put in is unaccounted for: the time step is too coarse for this case",
            100.0 * energies.error().abs()
        ));
    }
    if !peak.ended {
        let rises = kinetic.is_some_and(|kinetic| kinetic.window_star[0] <= peak.drive_time_star);
        warnings.push(format!(
            "mu* did not fall half-way to its steady level in the time of a transition: there was none, and static_friction_star is the \
             largest mu* of the run{}",
            if rises {
                "; the kinetic window begins before it, so that kinetic_friction_star may have a part of the rise"
            } else {
                ""
            }
        ));
    }
    if let Some(kinetic) = kinetic.filter(|_| is_kept_up(peak, kinetic)) {
        warnings.push(format!(
            "mu* slides on at {:.4} after a first peak of {:.4}, with less between them than a twentieth of what friction can lose: there was no \
             transition, and static_friction_star is the largest mu* of the run",
            kinetic.mu_star, peak.mu_star
        ));
    }
    if transition && peak.largest.mu_star > (1.0 + HIGHER_LATER) * peak.mu_star {
        let (first, remedy) = if is_held {
            (
                "before the kinetic window",
                "set time.kinetic_from_star after it to count it as static friction",
            )
        } else {
            (
                "at its first peak",
                "slow loading by drive.loading = \"held\" takes the largest",
            )
        };
        warnings.push(format!(
            "mu* is larger later than {first}: {:.4} at t* = {:.1}, {:.0} % above static_friction_star = {:.4}; {remedy}",
            peak.largest.mu_star,
            peak.largest.time_star,
            100.0 * (peak.largest.mu_star / peak.mu_star - 1.0),
            peak.mu_star
        ));
    }
    if first_slip.is_none() {
        warnings.push(
            "no block in contact slipped before the run ended: kinetic_friction_star is empty; lengthen \
             time.duration_star"
                .to_owned(),
        );
        return warnings;
    }
    match kinetic.map(|kinetic| kinetic.uncertainty) {
        None if reason == StopReason::Onset => {}
        None => warnings.push(
            "the run ended before the kinetic window began: kinetic_friction_star is empty; lengthen \
             time.duration_star or set time.kinetic_from_star"
                .to_owned(),
        ),
        Some(Err(NoUncertainty::TooShort { needed_time_star })) => warnings.push(format!(
            "mu_k* has no uncertainty: it takes a time.duration_star of {:.0} or more",
            needed_time_star.ceil()
        )),
        Some(Err(NoUncertainty::SpeedChanges)) => {
            warnings.push("mu_k* has no uncertainty, since the drive changes its speed".to_owned());
        }
        Some(Err(NoUncertainty::Drift { needed_time_star })) => warnings.push(format!(
            "mu_k* has no uncertainty, since mu* still drifts: run to time.duration_star = {needed_time_star:.0}, or begin \
             later by time.kinetic_from_star"
        )),
        Some(Ok(_)) => {}
    }
    warnings
}
