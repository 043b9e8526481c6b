//! Plans of designs: the search and its cost, without any run.

use serde::Serialize;
use slipfront_case::case_file::CaseError;
use slipfront_run::estimate_cost::StepTime;
use slipfront_study::StudyError;

use crate::design::Design;
use crate::evaluate::Evaluator;
use crate::file::DesignFile;
use crate::stages::most_work;
use crate::subject::Fidelity;

/// The cost of a design and of the designs of its front.
#[derive(Clone, Debug, Serialize)]
pub struct DesignPlan {
    /// Name of the design.
    pub name: String,
    /// Blocks along x and along y.
    pub blocks: [usize; 2],
    /// Unknown keys of shapes, with the ends of their ranges; empty for a search for masks.
    pub unknowns: Vec<(String, [String; 2])>,
    /// Allowed share of textured blocks, %.
    pub coverage_percent: [f64; 2],
    /// Names of the legal patterns that the design is compared with.
    pub patterns: Vec<String>,
    /// Cases in which every texture is tried.
    pub cases: usize,
    /// Number of designs: one, and those of the front.
    pub designs: usize,
    /// Runs of each search.
    pub search_runs: usize,
    /// Largest number of runs of each verdict.
    pub verdict_runs: usize,
    /// Largest cost of all runs, in steps times blocks, without steps during which a held drive is stopped.
    pub block_steps: f64,
    /// Bounds of the time of all runs, in s; infinite, or null in JSON, if a held drive may pause.
    #[serde(rename = "seconds")]
    pub time: [f64; 2],
}

impl DesignFile {
    /// The plan of the design with a search of `runs` runs, on `threads` threads of this machine.
    ///
    /// # Errors
    /// As [`design`](Self::design).
    pub fn plan(&self, runs: usize, threads: usize) -> Result<DesignPlan, StudyError> {
        let design = self.design()?;
        let (starts, _) = design.starts(&|| false);
        let patterns: Vec<String> = starts.into_iter().map(|named| named.name).collect();
        let (verdict_runs, verdict_work) = design.most_of_verdict(&patterns);
        let search_work = most_work(&design.evaluator, runs, 0);
        let designs = 1 + self.keys.front.len();
        let block_steps = designs as f64 * (search_work + verdict_work);
        Ok(DesignPlan {
            name: self.project.name.clone(),
            blocks: design.size(),
            unknowns: design.unknowns(),
            coverage_percent: design.limits.coverage,
            patterns,
            cases: design.evaluator.subjects.len(),
            designs,
            search_runs: runs,
            verdict_runs,
            block_steps,
            time: per_block_step(&design.evaluator)?.map(|time| block_steps / threads as f64 * time),
        })
    }
}

impl Design {
    /// Unknown keys of shapes, with the ends of their ranges.
    fn unknowns(&self) -> Vec<(String, [String; 2])> {
        let unknowns = self.shapes.iter().flat_map(|shapes| &shapes.unknowns);
        unknowns
            .map(|unknown| (unknown.key().to_owned(), unknown.range_in_words()))
            .collect()
    }
}

/// Bounds of the time of a block-step in s: the means over the cases.
fn per_block_step(evaluator: &Evaluator) -> Result<[f64; 2], CaseError> {
    let mut sum = [0.0; 2];
    for subject in &evaluator.subjects {
        let case = subject.case(None, 0, Fidelity::Fine)?;
        let steps = case.expected_steps();
        let time = StepTime::measure(&case).of_steps(&steps);
        let blocks = case.model.n_blocks() as f64;
        for k in 0..2 {
            sum[k] += time[k] / (steps.steps[k] * blocks);
        }
    }
    Ok(sum.map(|sum| 1.0 / evaluator.subjects.len() as f64 * sum))
}
