//! The stages of a search: many drafts on one surface with a coarse step, then fewer on several with the step
//! of the case.

use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use serde::{Deserialize, Serialize};

use crate::evaluate::{Evaluator, Runs};
use crate::search::{Proposal, RatedTexture, Rejected, Search};
use crate::start::GENERATION;
use crate::subject::Fidelity;
use slipfront_study::StudyError;

/// Number of runs of a search for each of its parallel starts, which keep many threads busy. The drafts
/// depend on the number of starts, and not on the number of threads.
const RUNS_OF_START: usize = 2500;

/// Largest number of parallel starts.
const MAX_STARTS: usize = 4;

/// Share of the runs for drafts on one surface.
const EXPLORED: f64 = 0.7;

/// Number of surfaces of the second stage.
const REFINED_SURFACES: u64 = 4;

/// A draft that was tried.
#[derive(Clone, Debug)]
pub(crate) struct RatedDraft {
    /// Whether the draft was tried on several surfaces with the step of the case, rather than on one with a
    /// coarse step.
    pub(crate) is_refined: bool,
    /// Origin of the draft.
    pub(crate) origin: String,
    /// Blocks of the draft.
    pub(crate) texture: Arc<Vec<bool>>,
    /// Shares of the ranges of the unknowns, if numbers are designed.
    pub(crate) shares: Option<Vec<f64>>,
    /// Loss of the draft, a mean over surfaces.
    pub(crate) loss: f64,
    /// Reason why the loss is infinite, if it is.
    pub(crate) lost: Option<String>,
}

/// Stage of a design.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DesignStage {
    /// Drafts are tried on one surface with a coarse step.
    Exploring,
    /// Drafts are tried on several surfaces with the step of the case.
    Refining,
    /// The best are judged on fresh surfaces.
    Judging,
}

/// Progress of a design.
#[derive(Clone, Debug)]
pub struct SearchProgress {
    /// Runs done, of the search or of the verdict.
    pub runs: usize,
    /// Number of runs of the search, or largest number of runs of the verdict.
    pub total: usize,
    /// Number of textures that the search has tried.
    pub textures: usize,
    /// Number of drafts that were not tried, since they have no legal texture.
    pub rejected: usize,
    /// Present stage.
    pub stage: DesignStage,
    /// Value of the best draft of this stage, as in the report; NaN if there is none.
    pub best: f64,
    /// Blocks of the best draft.
    pub best_texture: Option<Arc<Vec<bool>>>,
    /// Shares of the ranges of the unknowns in the best draft, if numbers are designed.
    pub best_shares: Option<Vec<f64>>,
    /// Cost of the runs of this call, search and verdict.
    pub work: RunCost,
}

/// Cost of runs, in steps times blocks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunCost {
    /// Cost of the runs that this call has made.
    pub here: f64,
    /// Largest cost of the runs that remain.
    pub left: f64,
}

impl RunCost {
    /// Limits the remaining cost to what the time allows, for a search that has cost `here` in this share of
    /// its time.
    pub(crate) fn left_within(self, share_of_time: f64, here: f64) -> f64 {
        if share_of_time > 0.0 {
            self.left.min(here * (1.0 / share_of_time - 1.0).max(0.0))
        } else {
            self.left
        }
    }
}

/// Bounds on the length of a search.
pub struct Bounds<'a> {
    /// Runs of the search, without those of the verdict.
    pub runs: usize,
    /// Share of the allowed time that has passed; stays below 1 without such a bound.
    pub share_of_time: &'a dyn Fn() -> f64,
    /// Flag that ends all runs.
    pub stop: &'a AtomicBool,
    /// Point at which an earlier search ran out of time, to repeat that search; none for a new one.
    pub cut: Option<Cut>,
}

/// Number of runs at the end of each stage of a search that ran out of time. With it, the search can be
/// repeated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Cut {
    /// Number of runs after the stage on one surface.
    pub explored: usize,
    /// Number of runs after both stages.
    pub refined: usize,
}

impl Bounds<'_> {
    /// Share of a time limit, in seconds, that has passed, at most 1; 1 if the limit is not positive, and 0
    /// without a limit.
    pub fn share_of(passed: f64, most: Option<f64>) -> f64 {
        match most {
            Some(most) if passed < most => passed / most,
            Some(_) => 1.0,
            None => 0.0,
        }
    }
}

/// Length of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct SearchLength {
    /// Number of runs of the search.
    pub(crate) runs: usize,
    /// Whether the allowed time ended first, so that the drafts depend on the speed of the machine.
    pub(crate) is_cut_short: bool,
    /// Point at which the allowed time ended.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) cut: Option<Cut>,
}

/// A search, with the drafts that it has tried.
pub(crate) struct Stages<'a> {
    evaluator: &'a Evaluator,
    search: Search,
    /// Number of drafts that are tried at once; by default from the number of runs.
    drafts_at_once: Option<usize>,
    /// Runs of the search.
    runs: usize,
    /// Whether surfaces with different seeds differ.
    scatters: bool,
    /// Number of runs after the first stage.
    explored: usize,
    /// Whether the allowed time ended before all runs were made.
    is_cut_short: bool,
    /// All drafts that were tried, in their order.
    pub(crate) tried: Vec<RatedDraft>,
}

impl<'a> Stages<'a> {
    /// The stages of a new search.
    pub(crate) fn new(evaluator: &'a Evaluator, search: Search, drafts_at_once: Option<usize>) -> Self {
        Self {
            evaluator,
            search,
            drafts_at_once,
            runs: 0,
            explored: 0,
            scatters: evaluator.scatters(),
            is_cut_short: false,
            tried: Vec::new(),
        }
    }

    /// Runs both stages; returns the finalists, the best first.
    pub(crate) fn run(
        &mut self,
        bounds: &Bounds,
        runs: &mut Runs,
        watch: &mut dyn FnMut(&SearchProgress),
    ) -> Result<Vec<Proposal>, StudyError> {
        self.evaluator.check_reference(runs)?;
        let explored = explored(bounds.runs);
        while self.runs < explored && self.has_time(bounds, false) {
            let proposals = self.ask(self.batch(bounds), bounds)?;
            if !self.try_out(proposals, false, bounds, runs, watch)? {
                break;
            }
        }
        self.explored = self.runs;
        // Losses on one surface with a coarse step only rank the drafts, so the best are measured again.
        let best = self.search.refine();
        let surfaces = self.stage(true).0.count();
        // Each draft takes as many runs as there are surfaces, so fewer drafts keep the number of
        // simultaneous runs about equal.
        let refined_batch = (self.batch(bounds) / surfaces).max(GENERATION);
        let mut goes_on = self.try_out(best, true, bounds, runs, watch)?;
        while goes_on && self.runs < bounds.runs && self.has_time(bounds, true) {
            let proposals = self.ask(refined_batch, bounds)?;
            goes_on = self.try_out(proposals, true, bounds, runs, watch)?;
        }
        let best = self.search.best().iter();
        Ok(best.map(|found| found.proposal.clone()).collect())
    }

    /// Textures to try, unless the search ends: on a large lattice, drawing them takes seconds.
    fn ask(&mut self, n: usize, bounds: &Bounds) -> Result<Vec<Proposal>, StudyError> {
        let ends = || bounds.stop.load(Ordering::Relaxed);
        let asked = self.search.ask(n, &ends);
        if ends() {
            return Err(StudyError::Interrupted);
        }
        Ok(asked)
    }

    /// Whether there is time for more runs of a stage; in a repeated search, whether the earlier search made
    /// more.
    fn has_time(&mut self, bounds: &Bounds, is_refined: bool) -> bool {
        let has_time = match bounds.cut {
            // A repeated search must end at the same run; the clock would not reproduce that.
            Some(cut) if is_refined => self.runs < cut.refined,
            Some(cut) => self.runs < cut.explored,
            None => (bounds.share_of_time)() < if is_refined { 1.0 } else { EXPLORED },
        };
        self.is_cut_short |= !has_time;
        has_time
    }

    /// Textures that were tried.
    pub(crate) fn n_textures(&self) -> usize {
        self.search.n_asked()
    }

    /// Drafts that have no legal texture.
    pub(crate) fn rejected(&self) -> &Rejected {
        &self.search.rejected
    }

    /// The error if no texture was found.
    pub(crate) fn no_design(&self) -> StudyError {
        let lost = self.tried.iter().find_map(|tried| tried.lost.as_ref());
        let reasons = self.rejected().in_words().into_iter();
        let reasons = reasons.chain(lost.map(|why| format!("a tested draft failed: {why}")));
        let why = reasons.map(|reason| format!(" ({reason})")).collect();
        StudyError::NoDesign { why }
    }

    /// The length of the search.
    pub(crate) fn length(&self, bounds: &Bounds) -> SearchLength {
        SearchLength {
            runs: bounds.runs,
            is_cut_short: self.is_cut_short,
            cut: self.is_cut_short.then_some(Cut {
                explored: self.explored,
                refined: self.runs,
            }),
        }
    }

    /// Makes the runs of some textures, and passes their losses to the search; returns whether there were
    /// any.
    fn try_out(
        &mut self,
        proposals: Vec<Proposal>,
        is_refined: bool,
        bounds: &Bounds,
        runs: &mut Runs,
        watch: &mut dyn FnMut(&SearchProgress),
    ) -> Result<bool, StudyError> {
        let (surfaces, fidelity) = self.stage(is_refined);
        let textures: Vec<_> = proposals.iter().map(|found| Arc::clone(&found.texture)).collect();
        let wanted = self.evaluator.wanted(&textures, surfaces.clone(), fidelity);
        self.evaluator.run(&wanted, runs)?;
        // Runs that are known already count, too, so a continued search equals one that never stopped.
        self.runs += wanted.len();
        let mut found = Vec::new();
        for proposal in proposals {
            let trial = self
                .evaluator
                .trial(&proposal.texture, surfaces.clone(), fidelity, runs.known);
            let loss = trial.loss();
            self.tried.push(RatedDraft {
                is_refined,
                origin: proposal.origin.clone(),
                texture: Arc::clone(&proposal.texture),
                shares: proposal.shares(),
                loss,
                lost: if loss.is_finite() { None } else { trial.lost() },
            });
            found.push(RatedTexture { proposal, loss });
        }
        // The limits may leave no new texture: then later batches have none, either.
        let has_any = !found.is_empty();
        self.search.add_losses(&found);
        watch(&self.progress(bounds, is_refined));
        Ok(has_any)
    }

    fn progress(&self, bounds: &Bounds, is_refined: bool) -> SearchProgress {
        let best = self.search.best().first();
        SearchProgress {
            runs: self.runs,
            total: bounds.runs,
            textures: self.n_textures(),
            rejected: self.rejected().drafts,
            stage: if is_refined {
                DesignStage::Refining
            } else {
                DesignStage::Exploring
            },
            best: best.map_or(f64::NAN, |found| self.evaluator.wish().reported_loss(found.loss)),
            best_texture: best.map(|found| Arc::clone(&found.proposal.texture)),
            best_shares: best.and_then(|found| found.proposal.shares()),
            work: RunCost {
                here: 0.0,
                left: self.work_left(bounds),
            },
        }
    }

    /// Largest cost of the runs of the search that remain.
    fn work_left(&self, bounds: &Bounds) -> f64 {
        most_work(self.evaluator, bounds.runs, self.runs)
    }

    /// Number of drafts in a batch: a generation of every start, unless the design says otherwise.
    fn batch(&self, bounds: &Bounds) -> usize {
        let of_starts = GENERATION * (bounds.runs / RUNS_OF_START).clamp(1, MAX_STARTS);
        self.drafts_at_once.unwrap_or(of_starts)
    }

    /// Surfaces and step of a stage.
    fn stage(&self, is_refined: bool) -> (Range<u64>, Fidelity) {
        if is_refined {
            (
                0..if self.scatters { REFINED_SURFACES } else { 1 },
                Fidelity::Fine,
            )
        } else {
            (0..1, Fidelity::Coarse)
        }
    }

    /// The first surface that the search has not used.
    pub(crate) const UNSEEN: u64 = REFINED_SURFACES;
}

/// Number of runs, out of `runs` of a search, after which drafts are tried on several surfaces.
fn explored(runs: usize) -> usize {
    (EXPLORED * runs as f64) as usize
}

/// Largest remaining cost of a search of `runs` runs after `made` of them, in steps times blocks.
pub(crate) fn most_work(evaluator: &Evaluator, runs: usize, made: usize) -> f64 {
    let explored = explored(runs);
    let coarse = explored.saturating_sub(made);
    let fine = runs.saturating_sub(explored.max(made));
    coarse as f64 * evaluator.work(Fidelity::Coarse) + fine as f64 * evaluator.work(Fidelity::Fine)
}
