//! The numbers of a run, the content of `summary.json`.

use std::path::Path;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use slipfront::observe::Frame;
use slipfront_base::disk::{TEXT_MAX_BYTES, json};
use slipfront_case::case_file::Motion;

use crate::error::ResultsError;
use crate::folder_error::FolderError;
use crate::names::SUMMARY;
use crate::observers::cycles::CycleSummary;
use crate::observers::events::EventSummary;
use crate::observers::precursors::PrecursorSummary;
use crate::run_files::RunFile;

/// The numbers of a run. Starred quantities are dimensionless (Eq. 11); times without a star are in s. A
/// drive that is held has its own time, which counts only while it moves.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Summary {
    /// mu_s*, the first peak of mu*; for a drive that is held the largest value before the kinetic window;
    /// without a transition the largest value.
    pub static_friction_star: f64,
    /// Static friction coefficient mu_s.
    pub static_friction: f64,
    /// Friction across the drive at the instant of mu_s*, over the load and mu_s, positive to the left of the
    /// drive.
    #[serde(default)]
    pub static_lateral_friction_star: f64,
    /// Time t_s* of the onset, on the time of the drive.
    pub onset_time_star: f64,
    /// Time t_s of the onset, s.
    pub onset_time_s: f64,
    /// Time t* of the first slip of a block in contact, on the time of the drive.
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
    /// Whether there is a transition, which has three conditions. After its first peak, and within the time
    /// of a transition, mu* fell at least half-way to the steady level L and by (S - L)/20, where S is the
    /// share of the load on blocks in contact; mu_k* is below the peak by as much; and steady sliding takes
    /// less force than the blocks hold at rest.
    pub transition: bool,
    /// The instants A-F that were found.
    pub instants: Vec<InstantSummary>,
    /// Units of the starred quantities and laboratory values.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub si: Option<SiSummary>,
    /// Number of sites at which slip has nucleated. Like all values of the front, it belongs to a run with a
    /// transition, or to an event that crosses a slider driven at an edge.
    pub nucleation_sites: Option<usize>,
    /// Coordinate x of the first nucleation, m.
    pub nucleation_x_m: Option<f64>,
    /// Coordinate y of the first nucleation, m.
    pub nucleation_y_m: Option<f64>,
    /// All sites of nucleation.
    #[serde(default)]
    pub nucleations: Vec<NucleationSummary>,
    /// Share of the windows of 7 x 7 blocks through which a front passes. For a slider driven at an edge,
    /// this and the following values belong to the event that crosses it.
    #[serde(default)]
    pub front_share: Option<f64>,
    /// Median speed of the slip front over the speed of long shear waves; none where it passes through less
    /// than half of the windows.
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
    /// Textured area A* as requested, %; none if a mask or polygon gives it only block by block.
    pub texture_percent_asked: Option<f64>,
    /// Height maps among the textures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub topographies: Option<Vec<TopographySummary>>,
    /// Time step dt*.
    pub dt_star: f64,
    /// Number of steps done.
    pub steps: u64,
    /// Number of steps in which a held drive moved; in the others, it was at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drive_steps: Option<u64>,
    /// Seed of the random coefficients.
    pub seed: u64,
    /// Share of the variance of correlated random coefficients at a point that means over blocks keep, %.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub variance_of_blocks_percent: Option<f64>,
    /// Share of the variance of correlated random coefficients at a point that the mean of a surface has from
    /// seed to seed, %.
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
    /// Motion of a drive that rotates: mu* and numbers derived from it are the torque over P mu_s l^2 times
    /// the sum of all radii.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<Motion>,
    /// Events of slip of a slider driven at an edge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub precursors: Option<PrecursorSummary>,
    /// Peak of every part of a program of speeds in which the drive moves forwards.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cycles: Option<Vec<CycleSummary>>,
    /// Events of slip of a run that keeps a catalogue of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub events: Option<EventSummary>,
    /// Energy lost to the dampers between blocks, J, if there are any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub viscous_loss_j: Option<f64>,
    /// Energy lost with contacts that broke, J; none for contacts that store no energy.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub broken_spring_loss_j: Option<f64>,
    /// Part of the loss to friction that is the energy that falling strength takes, J; none where strength
    /// does not fall.
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
    pub(crate) fn new((letter, frame): &(char, Frame), is_held: bool) -> Self {
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

/// Keys of the numbers that the first peak of mu* defines. A run without a transition has none of these
/// numbers, whatever its summary says: its largest mu* is its `mu_star_max`.
pub const OF_PEAK: [&str; 5] = [
    "static_friction_star",
    "static_friction",
    "static_lateral_friction_star",
    "onset_time_star",
    "onset_time_s",
];

/// Keys of the numbers of the kinetic window. A run without a transition has these numbers only if the window
/// begins after its largest mu*: before that, mu* may still rise to the onset.
pub const OF_KINETIC_WINDOW: [&str; 5] = [
    "kinetic_friction_star",
    "kinetic_friction_star_uncertainty",
    "kinetic_friction",
    "kinetic_lateral_friction_star",
    "sliding_percent_kinetic",
];

/// Titles of numbers in pictures: key, words, symbol. The titles of other numbers are their keys.
pub const TITLES: [(&str, &str, &str); 2] = [
    ("static_friction_star", "static friction", "\u{3bc}\u{209b}*"),
    ("kinetic_friction_star", "kinetic friction", "\u{3bc}\u{2096}*"),
];

/// Reads `summary.json` of a run folder.
pub fn read_summary(run: &Path) -> Result<Summary, ResultsError> {
    summary_of(&run.join(SUMMARY).into())
}

/// Reads the largest contact stress of a run, Pa, from its `summary.json`, and nothing else of it; none if
/// the run was written without units.
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

/// The summary as written in `summary.json`.
pub fn summary_json(summary: &Summary) -> String {
    String::from_utf8_lossy(&json(summary)).into_owned()
}
