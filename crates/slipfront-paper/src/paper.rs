//! Runs all figures, and judges the claims about them.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread::Builder;

use slipfront_study::{self as study, RunJournal};

use crate::cache::FigureCache;
use crate::claims::{Claim, ClaimResult, claims, tally};
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::figures::{FIGURES, Figure};
use crate::number::MeasuredNumber;
use crate::runner::FigureRunner;
use crate::step_rule::StepRule;

/// Options for running figures.
#[derive(Clone, Copy, Debug)]
pub struct PaperOptions<'a> {
    /// Number of simultaneous figures. Their runs use rayon's pool, which has as many threads.
    pub threads: usize,
    /// Flag set by a signal: all runs end, and the finished runs of studies stay recorded.
    pub stop: &'a AtomicBool,
    /// Whether to use two random surfaces in place of five, one time step, and only the claims that can be
    /// judged with these.
    pub reduced: bool,
    /// Folder of the results. A figure is not run again if this program has stored its data there.
    pub folder: &'a Path,
}

/// Progress of the figures: their number, and a figure that is being run.
#[derive(Clone, Copy, Debug)]
pub struct Stage<'a> {
    /// Figures done so far, under both step rules together.
    pub done: usize,
    /// Figures to do.
    pub total: usize,
    /// Number of this figure among them, from 1.
    pub number: usize,
    /// The figure.
    pub figure: &'a Figure,
    /// Step rule of the figure.
    pub step: StepRule,
    /// Progress of the study that the figure is running, if it is running one.
    pub study: Option<&'a study::Progress>,
}

/// Data of the figures, and results of the claims about them.
#[derive(Debug)]
pub struct Paper {
    /// Each figure and its data with the time step of 0.1.
    pub figures: Vec<(Figure, FigureData)>,
    /// Results of the claims about these figures.
    pub results: Vec<ClaimResult>,
    /// Results of the same claims in the same order with the paper's time step; empty in the reduced version.
    pub results_by_paper_step: Vec<ClaimResult>,
    /// Whether the figures are of the reduced version.
    pub reduced: bool,
}

impl Paper {
    /// The claims with an unexpected verdict, under either step rule.
    pub fn unexpected_verdicts(&self) -> impl Iterator<Item = (StepRule, &ClaimResult)> {
        let both = [
            (StepRule::Auto, &self.results),
            (StepRule::Paper, &self.results_by_paper_step),
        ];
        both.into_iter().flat_map(|(rule, results)| {
            let unexpected = results.iter().filter(|result| !result.as_expected());
            unexpected.map(move |result| (rule, result))
        })
    }

    /// Number of claims with each verdict, as a sentence.
    pub(super) fn tally(&self) -> String {
        let verdicts: Vec<_> = self.results.iter().map(|result| result.verdict).collect();
        tally(&verdicts)
    }
}

/// Runs figures under each step rule and judges the claims about them. Figures that earlier calls have
/// finished in the same folder are part of the result as well.
///
/// # Errors
/// When a run fails, a record cannot be written, or a signal asks to stop.
pub fn run(
    figures: &[Figure],
    records: &RunJournal,
    options: &PaperOptions,
    watch: &(dyn Fn(&Stage) + Sync),
) -> Result<Paper, PaperError> {
    let rules: &[StepRule] = if options.reduced {
        &[StepRule::Auto]
    } else {
        &[StepRule::Auto, StepRule::Paper]
    };
    let cache = FigureCache::open(options.folder, options.reduced)?;
    let figures = with_finished(figures, &cache, rules);
    let mut data_by_rule = Vec::new();
    for (pass, &step) in rules.iter().enumerate() {
        let before = pass * figures.len();
        let done = AtomicUsize::new(before);
        // While one figure waits for its last run or draws, the runs of the others keep the pool busy.
        let data = map_at_once(&figures, options.threads, |index, figure| {
            let stage = Stage {
                done: done.load(Ordering::Relaxed),
                total: figures.len() * rules.len(),
                number: before + index + 1,
                figure,
                step,
                study: None,
            };
            watch(&stage);
            let data = data_of(&stage, records, options, &cache, watch);
            done.fetch_add(1, Ordering::Relaxed);
            data
        })?;
        data_by_rule.push(figures.iter().copied().zip(data).collect::<Vec<_>>());
    }
    let judged = |rule: usize| {
        let data = data_by_rule.get(rule);
        data.map_or(Ok(Vec::new()), |data| judge(data, options.reduced))
    };
    Ok(Paper {
        results: judged(0)?,
        results_by_paper_step: judged(1)?,
        figures: data_by_rule.swap_remove(0),
        reduced: options.reduced,
    })
}

/// Results of `work` for each item, in their order. The work is done on `threads` threads including the
/// present one, or fewer if the system refuses more. After an error, no further item is begun.
fn map_at_once<T: Sync, R: Send + Sync>(
    items: &[T],
    threads: usize,
    work: impl Fn(usize, &T) -> Result<R, PaperError> + Sync,
) -> Result<Vec<R>, PaperError> {
    let next = AtomicUsize::new(0);
    let results: Vec<OnceLock<Result<R, PaperError>>> = items.iter().map(|_| OnceLock::new()).collect();
    let take = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let (Some(item), Some(place)) = (items.get(index), results.get(index)) else {
                return;
            };
            if place.get_or_init(|| work(index, item)).is_err() {
                next.store(items.len(), Ordering::Relaxed);
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..threads.min(items.len()) {
            let _ = Builder::new().spawn_scoped(scope, take);
        }
        take();
    });
    // Items are begun in their order, so those that were not begun follow the error.
    results.into_iter().filter_map(OnceLock::into_inner).collect()
}

/// The wanted figures and those that earlier calls have finished, in the order of the paper.
fn with_finished(wanted: &[Figure], cache: &FigureCache, rules: &[StepRule]) -> Vec<Figure> {
    let is_wanted = |figure: &Figure| wanted.iter().any(|wanted| wanted.name == figure.name);
    let is_finished = |figure: &Figure| rules.iter().all(|&rule| cache.load(figure.name, rule).is_some());
    FIGURES
        .into_iter()
        .filter(|figure| is_wanted(figure) || is_finished(figure))
        .collect()
}

/// Data of a figure: from the cache, or measured now and stored there.
fn data_of(
    stage: &Stage,
    records: &RunJournal,
    options: &PaperOptions,
    cache: &FigureCache,
    watch: &(dyn Fn(&Stage) + Sync),
) -> Result<FigureData, PaperError> {
    let Stage { figure, step, .. } = *stage;
    if let Some(data) = cache.load(figure.name, step) {
        return Ok(data);
    }
    let mut runner = FigureRunner {
        records,
        stop: options.stop,
        step,
        reduced: options.reduced,
        watch: &mut |progress| {
            watch(&Stage {
                study: Some(progress),
                ..*stage
            });
        },
    };
    let mut data = FigureData::default();
    (figure.measure)(&mut runner, &mut data)?;
    cache.save(figure.name, step, &data)?;
    Ok(data)
}

/// Judges the claims about these figures.
fn judge(figures: &[(Figure, FigureData)], reduced: bool) -> Result<Vec<ClaimResult>, PaperError> {
    let numbers: BTreeMap<String, MeasuredNumber> = figures
        .iter()
        .flat_map(|(figure, data)| data.named_numbers(figure.name))
        .collect();
    let about = |claim: &Claim| figures.iter().any(|(figure, _)| figure.name == claim.figure());
    claims()?
        .into_iter()
        .filter(|claim| about(claim) && (claim.reduced || !reduced))
        .map(|claim| claim.judge(&numbers))
        .collect()
}
