//! Runs the cases and studies of a figure with a step rule.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use rayon::prelude::*;
use slipfront::StopReason;

use crate::embedded_cases::FILES;
use crate::error::PaperError;
use crate::run::{FigureRun, recorded_at};
use crate::step_rule::StepRule;
use crate::sweep::ParameterSweep;
use slipfront_case::case::Case;
use slipfront_case::case_file::CaseError;
use slipfront_run::running;
use slipfront_run::summary::Summary;
use slipfront_study as study;
use slipfront_study::{FinishedRun, Outcome, Plan, RunJournal, StudyError, StudyFile, StudyResults};

/// Runs the cases and studies of a figure.
pub(super) struct FigureRunner<'a> {
    /// Finished runs of studies.
    pub(super) records: &'a RunJournal,
    /// Flag set by a signal: all runs end.
    pub(super) stop: &'a AtomicBool,
    pub(super) step: StepRule,
    /// Whether to use two surfaces in place of five.
    pub(super) reduced: bool,
    /// Called with the progress of a study after every run of it.
    pub(super) watch: &'a mut dyn FnMut(&study::Progress),
}

impl FigureRunner<'_> {
    /// A case of this crate, changed by `overrides`.
    pub(super) fn case(&self, file: &str, overrides: &[&str]) -> Result<Case, PaperError> {
        let text = with_step(text_of(file)?, self.step)?;
        let overrides: Vec<String> = overrides.iter().map(|&key| key.to_owned()).collect();
        Ok(Case::parse(&text, file, "", &overrides)?)
    }

    /// Number of random surfaces: five, or two in the reduced version.
    fn surfaces(&self) -> u64 {
        if self.reduced { 2 } else { 5 }
    }

    /// Note on the bands of a picture of means over the random surfaces.
    pub(super) fn note_on_bands(&self) -> String {
        format!("95 % interval of the mean, n = {}", self.surfaces())
    }

    /// A case on each of the random surfaces.
    pub(super) fn case_on_surfaces(&self, file: &str) -> Result<Vec<Case>, PaperError> {
        (1..=self.surfaces())
            .map(|seed| self.case(file, &[&format!("friction.seed={seed}")]))
            .collect()
    }

    /// Runs cases in parallel and returns the runs in the order of the cases.
    pub(super) fn run(&self, cases: Vec<Case>) -> Result<Vec<FigureRun>, PaperError> {
        let stop = self.stop;
        cases.into_par_iter().map(|case| run_case(case, stop)).collect()
    }

    pub(super) fn run_one(&self, case: Case) -> Result<FigureRun, PaperError> {
        // Use the pool, as all other runs do, to limit the number of simultaneous runs.
        rayon::scope(|_| run_case(case, self.stop))
    }

    /// Repeats `run` of a case with its fields at the times when these shares of the blocks have slipped, up
    /// to the last of these times. Maps of the new run have the scale of the whole run.
    pub(super) fn run_seen_at_shares(
        &self,
        case: Case,
        run: &FigureRun,
        shares: &[f64],
    ) -> Result<FigureRun, PaperError> {
        let times = shares.iter().map(|&share| run.time_of_share(share));
        let mut again = self.run_one(recorded_at(case, &times.collect::<Result<Vec<_>, _>>()?))?;
        again.record.contact_stress_max = run.record.contact_stress_max;
        Ok(again)
    }

    /// A study of this crate, without any run.
    pub(super) fn plan(&self, name: &str) -> Result<ParameterSweep, PaperError> {
        let mut file = StudyFile::parse(text_of(name)?, name, name, Path::new(""))?;
        file.base.text = with_step(&file.base.text, self.step)?;
        if self.reduced {
            file.settings.replicates = file.settings.replicates.min(2);
        }
        Ok(ParameterSweep {
            plan: Plan::new(&file, None)?,
            results: StudyResults::default(),
        })
    }

    /// A study of this crate with its results: recorded runs are reused, the others are run.
    pub(super) fn study(&mut self, name: &str) -> Result<ParameterSweep, PaperError> {
        let plan = self.plan(name)?.plan;
        // No run folders are kept, so the folder is not used.
        let results = study::execute(&plan, self.records, Path::new(""), self.stop, self.watch)?;
        if let Some((_, reason)) = results.failures().next() {
            return Err(PaperError::StudyRun {
                study: name.to_owned(),
                reason: reason.to_owned(),
            });
        }
        Ok(ParameterSweep { plan, results })
    }

    /// A study with its results, as from [`study`](Self::study), and the runs of the first `replicates` of
    /// its points with their curves and fields, ordered by replicate and then by point. If the study runs to
    /// the same end, it reuses these runs.
    pub(super) fn study_with_runs(
        &mut self,
        name: &str,
        replicates: usize,
    ) -> Result<(ParameterSweep, Vec<FigureRun>), PaperError> {
        let plan = self.plan(name)?;
        let keys = plan.keys(replicates);
        let cases = keys.iter().map(|&key| plan.case_of(key));
        let runs = self.run(cases.collect::<Result<_, _>>()?)?;
        let whole = keys.iter().zip(&runs);
        let whole = whole.filter(|(_, run)| run.case.file.time.stop == StopReason::End);
        let records = whole.map(|(&key, run)| FinishedRun {
            id: plan.plan.identity(key),
            wall_time_s: run.wall_time_s,
            // A study has no instants A-F.
            outcome: Outcome::from_summary(Summary {
                instants: Vec::new(),
                ..run.record.summary.clone()
            }),
            kept: None,
        });
        self.records.append(&records.collect::<Vec<_>>())?;
        Ok((self.study(name)?, runs))
    }
}

fn run_case(case: Case, stop: &AtomicBool) -> Result<FigureRun, PaperError> {
    let began = Instant::now();
    let case = Arc::new(case);
    let record =
        running::run_unless(&case, &|| stop.load(Ordering::Relaxed)).ok_or(StudyError::Interrupted)?;
    let record = record.map_err(|source| PaperError::Run {
        name: case.name.clone(),
        source,
    })?;
    Ok(FigureRun {
        case,
        record,
        wall_time_s: began.elapsed().as_secs_f64(),
    })
}

fn text_of(file: &str) -> Result<&'static str, PaperError> {
    let found = FILES.iter().find(|(name, _)| *name == file);
    found.map(|(_, text)| *text).ok_or_else(|| PaperError::Lacks {
        file: "the list of the paper's cases".to_owned(),
        what: format!("{file}.toml"),
    })
}

/// The text of a case under a step rule; a step in the case itself has precedence.
fn with_step(text: &str, step: StepRule) -> Result<String, PaperError> {
    if step == StepRule::Auto {
        return Ok(text.to_owned());
    }
    let mut case: toml::Table = text.parse()?;
    let time = case
        .entry("time")
        .or_insert_with(|| toml::Table::new().into())
        .as_table_mut();
    if let Some(time) = time {
        time.entry("step").or_insert_with(|| "paper".into());
    }
    Ok(toml::to_string(&case).map_err(CaseError::from)?)
}
