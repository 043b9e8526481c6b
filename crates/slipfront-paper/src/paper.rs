//! All figures run, and the claims about them judged.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use slipfront_run::study::{self, Records};

use crate::cache::Saved;
use crate::claims::{Claim, Judged, claims};
use crate::error::PaperError;
use crate::figures::{FIGURES, Figure};
use crate::measurements::{Found, Number};
use crate::runner::{Bench, StepRule};

/// How the paper is gone through.
#[derive(Clone, Copy, Debug)]
pub struct Options<'a> {
    /// Runs at once.
    pub threads: usize,
    /// Set by a signal: everything ends, finished runs of studies are safe.
    pub stop: &'a AtomicBool,
    /// Two random surfaces in place of five, one time step, and only the claims that survive that.
    pub reduced: bool,
    /// Folder in which findings are kept: a figure that this program has finished there is not run again.
    pub folder: &'a Path,
}

/// How far it has come.
#[derive(Clone, Copy, Debug)]
pub struct Stage<'a> {
    /// Figures done so far, under both step rules together.
    pub done: usize,
    /// Figures to do.
    pub total: usize,
    /// The present one.
    pub figure: &'a Figure,
    /// Its time step.
    pub step: StepRule,
    /// The present study of that figure, if it has come to one.
    pub study: Option<&'a study::Progress>,
}

/// What came of the figures and claims.
#[derive(Debug)]
pub struct Paper {
    /// Each figure and what it found with the step of 0.1.
    pub figures: Vec<(Figure, Found)>,
    /// The claims about them.
    pub judged: Vec<Judged>,
    /// The same claims in the same order, measured with the paper's step; empty in the reduced version.
    pub judged_by_paper_step: Vec<Judged>,
    /// Whether this is the reduced version.
    pub reduced: bool,
}

impl Paper {
    /// The claims whose verdict is not the expected one, under either step rule.
    pub fn surprises(&self) -> impl Iterator<Item = (StepRule, &Judged)> {
        let both = [
            (StepRule::Auto, &self.judged),
            (StepRule::Paper, &self.judged_by_paper_step),
        ];
        both.into_iter().flat_map(|(rule, judged)| {
            judged
                .iter()
                .filter(|judged| !judged.as_expected())
                .map(move |judged| (rule, judged))
        })
    }
}

/// Runs figures and judges the claims about them, and about those that earlier calls have finished, with both time steps.
///
/// # Errors
/// When a run fails, a record cannot be written, or a signal asks to stop.
pub fn run(
    figures: &[Figure],
    records: &mut Records,
    options: &Options,
    watch: &mut dyn FnMut(&Stage),
) -> Result<Paper, PaperError> {
    let rules: &[StepRule] = match options.reduced {
        true => &[StepRule::Auto],
        false => &[StepRule::Auto, StepRule::Paper],
    };
    let saved = Saved::open(options.folder, options.reduced)?;
    // What earlier calls have finished costs nothing, and the report is of all that is there.
    let is_there = |figure: &Figure| rules.iter().all(|&rule| saved.load(figure.name, rule).is_some());
    let is_wanted = |figure: &Figure| figures.iter().any(|wanted| wanted.name == figure.name);
    let figures: Vec<Figure> = FIGURES
        .into_iter()
        .filter(|figure| is_wanted(figure) || is_there(figure))
        .collect();
    let total = figures.len() * rules.len();
    let mut done = 0;
    let mut passes = Vec::new();
    for &step in rules {
        let mut pass = Vec::new();
        for figure in &figures {
            let stage = Stage {
                done,
                total,
                figure,
                step,
                study: None,
            };
            watch(&stage);
            let mut bench = Bench {
                records: &mut *records,
                threads: options.threads,
                stop: options.stop,
                step,
                reduced: options.reduced,
                watch: &mut |progress| {
                    watch(&Stage {
                        study: Some(progress),
                        ..stage
                    });
                },
            };
            let found = match saved.load(figure.name, step) {
                Some(found) => found,
                None => {
                    let found = (figure.find)(&mut bench)?;
                    saved.save(figure.name, step, &found)?;
                    found
                }
            };
            pass.push((*figure, found));
            done += 1;
        }
        passes.push(pass);
    }
    let judge = |pass: &[(Figure, Found)]| judge(pass, options.reduced);
    let judged = passes
        .iter()
        .map(|pass| judge(pass))
        .collect::<Result<Vec<_>, _>>()?;
    let mut judged = judged.into_iter();
    Ok(Paper {
        judged: judged.next().unwrap_or_default(),
        judged_by_paper_step: judged.next().unwrap_or_default(),
        figures: passes.swap_remove(0),
        reduced: options.reduced,
    })
}

/// The claims about these figures.
fn judge(figures: &[(Figure, Found)], reduced: bool) -> Result<Vec<Judged>, PaperError> {
    let numbers: BTreeMap<String, Number> = figures
        .iter()
        .flat_map(|(_, found)| found.numbers.iter().map(|(name, number)| (name.clone(), *number)))
        .collect();
    let about = |claim: &Claim| figures.iter().any(|(figure, _)| figure.name == claim.figure());
    claims()?
        .into_iter()
        .filter(|claim| about(claim) && (claim.reduced || !reduced))
        .map(|claim| claim.judge(&numbers))
        .collect()
}
