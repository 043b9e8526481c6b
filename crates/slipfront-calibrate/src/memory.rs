//! Memory of a calibration, compared with the memory of the machine before the first run.

use slipfront_base::machine::available_of;
use slipfront_base::number_format::byte_size;
use slipfront_case::case::{Budget, PROGRAM};
use slipfront_regression::Regression;
use slipfront_run::run_curve::{RunCurve, steps_to};

use crate::calibration::Calibration;
use crate::file::{CalibrationFile, GivenRecord};
use crate::set_up::SetUp;
use crate::summaries::n_summaries;
use slipfront_study::StudyError;
use slipfront_study::room::check_room;

/// Memory of a calibration, in bytes.
#[derive(Clone, Copy, Debug)]
struct CalibrationMemory {
    /// The program, the curves of all trainings, and what stays of the regressions.
    beside: f64,
    /// The largest run.
    run: f64,
    /// The largest regression while it is learnt.
    regression: f64,
    /// Number of regressions that are learnt at once.
    regressions: usize,
}

impl CalibrationFile {
    /// Refuses a calibration from these records if there is no memory for `threads` runs at once and the regressions behind them, and says
    /// how many there is memory for.
    ///
    /// # Errors
    /// When the ranges leave the bounds of the case, and with both figures of memory.
    pub fn check_memory(&self, records: &[GivenRecord], threads: usize) -> Result<(), StudyError> {
        let memory = self.memory(records)?;
        memory.compare(threads, available_of(memory.of(threads)))
    }

    fn memory(&self, records: &[GivenRecord]) -> Result<CalibrationMemory, StudyError> {
        let set_up = self.set_up(records)?;
        let [runs, finer_runs] = [self.keys.runs, self.keys.finer_runs].map(|runs| runs as usize);
        let further = self.further(&set_up)?;
        // Blocks of half the size that are not possible are left out of a calibration.
        let finer = set_up.finer().ok().filter(|_| finer_runs > 0);
        let all = std::iter::once(&set_up)
            .chain(&finer)
            .chain(further.iter().map(|(_, further)| further));
        let run = all
            .map(SetUp::bytes_of_run)
            .try_fold(0.0, |largest: f64, run| Ok::<_, StudyError>(largest.max(run?)))?;
        let own = set_up.bytes_of_curves(runs);
        let on_finer = finer.map_or(0.0, |finer| finer.bytes_of_curves(finer_runs));
        let of_further = further.iter().map(|(_, further)| further.bytes_of_curves(runs));
        let all = own + on_finer + of_further.clone().sum::<f64>();
        // What the journal has stays in memory. A training is a copy of it, and is copied once more beside a further experiment.
        let copied = of_further
            .map(|further| own + 2.0 * further)
            .fold(on_finer, f64::max);
        let curves = all + own + copied;
        let records = set_up.conditions.len();
        let [summaries, with_further] =
            [records, records + usize::from(!further.is_empty())].map(|records| records * n_summaries());
        let unknowns = set_up.unknowns.len();
        let kept = Calibration::bytes(runs, unknowns, summaries)
            + Calibration::bytes(runs, unknowns, with_further)
            + Calibration::bytes_to_learn(runs, with_further);
        Ok(CalibrationMemory {
            beside: PROGRAM + Budget::resident(curves + kept),
            run,
            regression: Budget::resident(Regression::bytes_to_learn(runs)),
            regressions: Calibration::n_regressions(unknowns),
        })
    }
}

impl SetUp {
    /// Memory of the curves of this many runs.
    fn bytes_of_curves(&self, runs: usize) -> f64 {
        let values: usize = self.conditions.iter().map(|one| one.grid.n_values()).sum();
        (runs * values * size_of::<f64>()) as f64
    }

    /// Memory of the largest run.
    fn bytes_of_run(&self) -> Result<f64, StudyError> {
        let middle = self.middle();
        let mut largest = 0.0_f64;
        for conditions in &self.conditions {
            let case = self.case(&middle, 0, conditions)?;
            let budget = case.budget;
            let steps = steps_to(&case, conditions.grid.along(), conditions.grid.end());
            let stepping = budget.blocks * (budget.surface + budget.kernel) + RunCurve::bytes(steps);
            largest = largest.max(Budget::resident(stepping.max(budget.making())));
        }
        Ok(largest)
    }
}

impl CalibrationMemory {
    /// Memory with `threads` runs, or regressions, at once.
    fn of(&self, threads: usize) -> f64 {
        let regressions = threads.min(self.regressions) as f64 * self.regression;
        self.beside + (threads as f64 * self.run).max(regressions)
    }

    fn compare(&self, threads: usize, available: f64) -> Result<(), StudyError> {
        check_room(
            |threads| self.of(threads),
            threads,
            available,
            |available| StudyError::CalibrationMemory {
                needed: byte_size(self.of(1)),
                available,
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    /// The memory of a calibration of a small slider from a record of 50 values.
    fn memory(keys: &str) -> CalibrationMemory {
        let folder = tempfile::tempdir().unwrap();
        let record = folder.path().join("record.csv");
        let rows: String = (0..50).map(|k| format!("{k}e-9,{k}\n")).collect();
        std::fs::write(&record, format!("t_s,f_n\n{rows}")).unwrap();
        let text = format!(
            "[base]\nslider.blocks = [8, 8]\n[calibrate]\nx = 't_s'\ny = 'f_n'\nnoise = 0.01\n{keys}\n\
             unknowns = {{ 'friction.r_star' = [0.3, 0.9], 'friction.mu_static' = [0.3, 0.9] }}"
        );
        let file = CalibrationFile::parse(&text, "fit.toml", "fit", Path::new("")).unwrap();
        file.memory(&file.read(&[record]).unwrap()).unwrap()
    }

    #[test]
    fn threads_are_held_against_the_memory() {
        let found = memory("runs = 2000\nfiner_runs = 0");
        assert_eq!(found.regressions, 3);
        // A kernel of all runs, which becomes its factor.
        assert_eq!(found.regression, Budget::resident(8.0 * 2000.0 * 2000.0));
        assert!(found.compare(2, found.of(2)).is_ok());
        assert!(matches!(
            found.compare(8, found.of(2)),
            Err(StudyError::Memory {
                threads: 8,
                fit: 2,
                ..
            })
        ));
        let said = found.compare(2, found.of(1) - 1.0).unwrap_err().to_string();
        assert!(
            said.starts_with("the calibration takes") && said.contains("or `calibrate.runs`"),
            "{said}"
        );
    }

    /// Blocks of half the size have runs of four times the blocks and twice the steps, and curves of their own.
    #[test]
    fn all_trainings_count() {
        let plain = memory("runs = 200\nfiner_runs = 0");
        let finer = memory("runs = 200\nfiner_runs = 200");
        let further = memory("runs = 200\nfiner_runs = 0\nnext = [{ drive.v_star = 0.01 }]");
        let curve = Budget::resident(8.0 * 50.0);
        assert!(finer.run > 1.9 * plain.run);
        assert!((finer.beside - plain.beside - 2.0 * 200.0 * curve).abs() < 1.0);
        assert!(further.beside - plain.beside > 4.0 * 200.0 * curve);
    }
}
