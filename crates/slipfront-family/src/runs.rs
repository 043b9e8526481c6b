//! Runs of the chapters.

use std::path::Path;
use std::sync::Arc;

use slipfront::communicator::Alone;
use slipfront::exact_solutions::oscillation_growth;
use slipfront::lattice::K_DRIVE;
use slipfront::observe::{Curve, CurveRow, Event, Events, Scheduled};
use slipfront::{
    Drive, Execution, Friction, Lattice, Model, Simulation, Snapshot, State, Stop, Surface, VectorField,
    scales,
};
use slipfront_case::case::{Case, Files, FilesInMemory, Ranks};
use slipfront_case::case_file::CaseFile;

use crate::error::FamilyError;

/// A finished run.
pub(crate) struct AnswerRun {
    /// The simulation at the end of the run.
    pub(crate) simulation: Simulation,
    /// Rows of every step.
    pub(crate) rows: Vec<CurveRow>,
}

/// A slider that a case file cannot describe.
pub(crate) struct Experiment {
    pub(crate) model: Arc<Model>,
    pub(crate) dt_star: f64,
    /// State at the start; at rest if there is none.
    pub(crate) state: Option<State>,
}

impl AnswerRun {
    /// Runs a case with equal blocks from the text of a case file, in which coefficients do not scatter.
    pub(crate) fn of_equal_blocks(name: &str, text: &str) -> Result<Self, FamilyError> {
        let equal = "friction.sigma_static_star = 0\nfriction.sigma_kinetic_star = 0\n";
        let (experiment, last_step) = Experiment::of_case(name, &format!("{equal}{text}"))?;
        experiment.run(name, last_step)
    }

    /// Time of the first slip of any block; NaN if none has slipped.
    pub(crate) fn first_slip(&self) -> f64 {
        self.simulation
            .peak()
            .first_slip_drive_time_star
            .unwrap_or(f64::NAN)
    }

    /// mu* at the row nearest to a time.
    pub(crate) fn mu_star_at(&self, time_star: f64) -> f64 {
        let after = self.rows.partition_point(|row| row.time_star < time_star - 1e-9);
        self.rows.get(after).map_or(f64::NAN, |row| row.point.mu_star)
    }

    /// mu* at its first peak.
    pub(crate) fn peak(&self) -> f64 {
        self.simulation.peak().mu_star
    }

    /// The largest mu* of the run.
    pub(crate) fn largest(&self) -> f64 {
        self.simulation.peak().largest.mu_star
    }
}

impl Experiment {
    /// A slider at rest.
    pub(crate) fn at_rest(model: Model, dt_star: f64) -> Self {
        Self {
            model: Arc::new(model),
            dt_star,
            state: None,
        }
    }

    /// The experiment that a case describes, and its last step.
    pub(crate) fn of_case(name: &str, text: &str) -> Result<(Self, u64), FamilyError> {
        Self::of_case_with(name, text, &FilesInMemory::new())
    }

    /// The experiment that a case with these files describes, and its last step.
    pub(crate) fn of_case_with(
        name: &str,
        text: &str,
        files: &FilesInMemory,
    ) -> Result<(Self, u64), FamilyError> {
        let files = Files {
            folder: Path::new(""),
            in_memory: Some(files),
        };
        let file = CaseFile::parse(text, name, &[])?;
        let case = Case::to_run(file, name, files, &mut |_| true, Ranks::ALONE)?;
        let experiment = Self {
            model: Arc::clone(&case.model),
            dt_star: case.time_plan.dt_star,
            state: None,
        };
        Ok((experiment, case.time_plan.last_step))
    }

    /// Runs the experiment to this step and lists its events of slip.
    pub(crate) fn events(&self, name: &str, last_step: u64) -> Result<Vec<Event>, FamilyError> {
        let mut events = Events::new(&self.model);
        self.observed(name, last_step, Scheduled::always(&mut events))?;
        Ok(events.events().to_vec())
    }

    /// Runs the experiment to this step.
    pub(crate) fn run(&self, name: &str, last_step: u64) -> Result<AnswerRun, FamilyError> {
        let mut curve = Curve::every(1);
        Ok(AnswerRun {
            simulation: self.observed(name, last_step, Scheduled::always(&mut curve))?,
            rows: curve.rows,
        })
    }

    fn observed(&self, name: &str, last_step: u64, observer: Scheduled) -> Result<Simulation, FamilyError> {
        let mut simulation = self.begin();
        let ended = simulation.run(Stop::at_step(last_step), &mut [observer]);
        ended.map_err(FamilyError::of_run(name))?;
        Ok(simulation)
    }

    /// The simulation at the first instant.
    pub(crate) fn begin(&self) -> Simulation {
        let (model, state) = (Arc::clone(&self.model), self.state.clone());
        Simulation::new(model, self.dt_star, state, Execution::default())
    }

    /// Results of `value` at these times, in ascending order.
    pub(crate) fn values<const N: usize>(
        &self,
        times: [f64; N],
        value: impl Fn(&Snapshot) -> f64,
    ) -> [f64; N] {
        let mut simulation = self.begin();
        times.map(|time| {
            let step = (time / self.dt_star).round() as u64;
            while simulation.snapshot().step < step {
                simulation.step();
            }
            value(&simulation.snapshot())
        })
    }
}

/// Reason for a first slip up to a step late.
pub(crate) const LATE_SLIP: &str = "slip is detected at the next step";

/// Reason for the distance that [`rounding`] allows for the level of steady sliding with Omega* = 1, in steps
/// of 0.1.
pub(crate) const ROUNDING: &str = "rounding of displacements by ε X/2 per step within the decay time 2/Ω; the initial oscillation has decayed";

/// Rounding error of mu* in steady sliding with Omega* = 1 and steps of 0.1, after this path of the far ends:
/// `k_s (eps X/2)` from each of the last `2/(Omega dt)` steps.
pub(crate) fn rounding(path: f64) -> f64 {
    K_DRIVE * f64::EPSILON * path / (scales::damping(1.0) * 0.1)
}

/// Growth rate of a small perturbation of steady sliding, for blocks that move together, from `t* = first`
/// on, as for [`oscillation_growth`].
pub(crate) fn growth_of_perturbation(
    drive: Drive,
    damping: f64,
    friction: Friction,
    dt_star: f64,
    [first, apart]: [f64; 2],
) -> f64 {
    let lattice = Lattice::free(2, 2);
    let surface = Surface::uniform(&lattice, 1.0, 0.5);
    let v_star = drive.v_star;
    let model = Model::new(lattice, surface, drive, damping, 0.0, friction);
    let behind = model.steady_level(&Alone) / model.drive.k_drive;
    let experiment = Experiment {
        state: Some(State {
            displacement: along_x(1e-6 - behind, 4),
            velocity: along_x(v_star, 4),
        }),
        ..Experiment::at_rest(model, dt_star)
    };
    let times = [0.0, 1.0, 2.0, 3.0].map(|k| first + k * apart);
    let values = experiment.values(times, |now| {
        now.block(0).displacement[0] + behind - v_star * now.time_star
    });
    oscillation_growth(values, apart)
}

/// Equal vectors along x of some blocks.
pub(crate) fn along_x(x: f64, blocks: usize) -> VectorField {
    VectorField {
        x: vec![x; blocks],
        y: vec![0.0; blocks],
    }
}
