//! A design: a wish with its limits, the search for a texture, and the verdict on the result.

use std::cell::Cell;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use slipfront::device::Device;
use slipfront_case::case::Case;
use slipfront_case::case_file::CaseError;

use crate::evaluate::{Evaluator, Keep, MadeRun, RunCache, Runs};
use crate::judge::{Contender, Judge};
use crate::limits::{Illegal, Limits};
use crate::named_patterns::{GROOVE, Named, named};
use crate::open_search::OpenSearch;
use crate::search::{Proposal, Rejected, Search};
use crate::shapes::Shapes;
use crate::slider_blocks::SliderBlocks;
use crate::space::Space;
use crate::stages::{Bounds, DesignStage, RatedDraft, RunCost, SearchLength, SearchProgress, Stages};
use crate::subject::{Fidelity, Subject};
use crate::verdict::Verdict;
use crate::wish::Wish;
use slipfront_study::StudyError;

/// A wish with its limits, and the cases in which designs are tried.
#[derive(Debug)]
pub struct Design {
    pub(crate) evaluator: Evaluator,
    pub(crate) limits: Limits,
    /// Seed of the random drafts of the search.
    start: u64,
    /// Number of drafts that are tried at once; by default from the number of runs.
    drafts_at_once: Option<usize>,
    /// Textures that the search also starts from.
    drawn: Vec<Drawn>,
    /// Shapes with unknown numbers, if numbers are searched for in place of masks.
    pub(crate) shapes: Option<Arc<Shapes>>,
}

/// A texture that a search also starts from.
#[derive(Debug)]
struct Drawn {
    name: String,
    textured: Vec<bool>,
    /// Smallest width of its shapes in blocks, if numbers of shapes are searched for.
    feature: Option<f64>,
}

/// Result of a search.
#[derive(Debug)]
pub struct Outcome {
    /// Textured blocks of the design.
    pub texture: Arc<Vec<bool>>,
    /// Shares of the ranges of the unknowns, if numbers were searched for.
    pub(crate) shares: Option<Vec<f64>>,
    /// Verdict on the design.
    pub verdict: Verdict,
    /// Every texture that was judged, by its name, the design first.
    pub(crate) compared: Vec<(String, Option<Arc<Vec<bool>>>)>,
    /// Length of the search.
    pub(crate) length: SearchLength,
    /// Drafts without a legal texture.
    pub(crate) rejected: Rejected,
    /// Drafts that were tried, in their order.
    pub(crate) tried: Vec<RatedDraft>,
}

impl Design {
    /// A design for at least one case. All cases have the same blocks, and each has the wish in its own
    /// units. With `is_worst`, the loss is that of the worst case instead of the mean over the cases.
    ///
    /// # Errors
    /// When a case cannot be run for as long as the search needs, or one of its files has changed since the
    /// case was made.
    ///
    /// # Panics
    /// Without a case.
    pub fn new(
        cases: &[(&Case, Wish)],
        is_worst: bool,
        limits: Limits,
        start: u64,
    ) -> Result<Self, StudyError> {
        let subject = |(case, wish): &(&Case, Wish)| Subject::new(case, wish.clone(), limits.coverage[1]);
        let subjects = cases.iter().map(subject).collect::<Result<Vec<_>, _>>()?;
        let grid = SliderBlocks::from_case(cases[0].0);
        Ok(Self {
            evaluator: Evaluator {
                subjects,
                grid,
                is_worst,
                device: None,
            },
            limits,
            start,
            drafts_at_once: None,
            drawn: Vec::new(),
            shapes: None,
        })
    }

    /// Makes the runs on a device, with the same results. A wish for a curve is for the CPU alone.
    #[must_use]
    pub fn on_device(mut self, device: Option<Arc<dyn Device>>) -> Self {
        self.evaluator.device = device.filter(|_| !matches!(self.evaluator.wish(), Wish::Curve(_)));
        self
    }

    /// Tries this many drafts at once, which makes it another search.
    pub(crate) fn try_at_once(&mut self, drafts: usize) {
        self.drafts_at_once = Some(drafts);
    }

    /// Searches for numbers of shapes in place of masks. Named patterns and masks are only compared with the
    /// result, and cannot be the answer.
    pub(crate) fn vary(&mut self, shapes: Shapes) {
        self.shapes = Some(Arc::new(shapes));
    }

    /// Adds a mask, or the legal part of it, to the starts of the search. It counts as a named pattern, and
    /// is always judged, good or not. `feature` is the smallest width in blocks of the shapes that it was
    /// meshed from; none for the widths of the mask.
    pub fn begin_with(&mut self, name: String, textured: Vec<bool>, feature: Option<f64>) {
        self.drawn.push(Drawn {
            name,
            textured,
            feature,
        });
    }

    /// The legal part of a starting mask.
    fn legal_part(&self, drawn: &Drawn) -> Result<Vec<bool>, Illegal> {
        let (grid, limits) = (&self.evaluator.grid, &self.limits);
        if self.shapes.is_some() && limits.check(grid, &drawn.textured, drawn.feature).is_ok() {
            return Ok(drawn.textured.clone());
        }
        limits.texture(grid, &Named::drawn(grid, &drawn.name, &drawn.textured).draft)
    }

    /// Notes on starting masks that break a limit or that a case refuses.
    pub(crate) fn notes(&self) -> Vec<String> {
        let (grid, limits) = (&self.evaluator.grid, &self.limits);
        let note = |drawn: &Drawn| {
            let name = &drawn.name;
            if !drawn.textured.contains(&true) {
                return Some(format!("the {name} covers no block, and was left out"));
            }
            let part = self.legal_part(drawn);
            let refused = part
                .as_ref()
                .ok()
                .and_then(|part| self.evaluator.check(part).err());
            if let Some(refused) = refused {
                return Some(format!("the {name} was left out: {}", refused.without_place()));
            }
            let illegal = limits.check(grid, &drawn.textured, drawn.feature).err()?;
            let made = match part {
                Ok(_) if self.shapes.is_some() => "the part within the limits is tested, under this name",
                Ok(_) => "the search starts with the part within the limits, under this name",
                Err(_) => "no part is within the limits, so it was left out",
            };
            Some(format!("the {name} violates a limit: {illegal}; {made}"))
        };
        self.drawn.iter().filter_map(note).collect()
    }

    /// Searches, and judges the result on fresh surfaces.
    ///
    /// # Errors
    /// When the limits leave no texture, when the slider without texture has no value to compare with, when
    /// runs cannot be made or kept, and after a stop.
    pub fn run(
        &self,
        bounds: &Bounds,
        known: &mut RunCache,
        keep: &mut Keep,
        watch: &mut dyn FnMut(&SearchProgress),
    ) -> Result<Outcome, StudyError> {
        let (starts, textures) = self.starts(&|| bounds.stop.load(Ordering::Relaxed));
        let pairs = starts.iter().zip(textures);
        let legal: Vec<Contender> = pairs
            .map(|(named, texture)| Contender {
                name: named.name.clone(),
                texture: texture.into(),
                shapes: None,
            })
            .collect();
        let names: Vec<String> = legal.iter().map(|named| named.name.clone()).collect();
        let (total, total_work) = self.most_of_verdict(&names);
        let groove = legal.iter().filter(|named| named.name == GROOVE);
        let drawn = legal.iter().filter(|named| self.is_drawn(&named.name));
        let beside: Vec<Contender> = groove.chain(drawn).cloned().collect();
        let mut stages = Stages::new(&self.evaluator, self.search_from(starts), self.drafts_at_once);
        let (made, here) = (Cell::new(0), Cell::new(0.0));
        let mut kept = |runs: &[MadeRun]| {
            made.set(made.get() + runs.len());
            here.set(here.get() + runs.iter().map(|run| run.work).sum::<f64>());
            keep(runs)
        };
        let mut runs = Runs {
            known,
            keep: &mut kept,
            stop: bounds.stop,
        };
        let best = stages.run(bounds, &mut runs, &mut |now| {
            watch(&SearchProgress {
                work: RunCost {
                    here: here.get(),
                    left: now.work.left_within((bounds.share_of_time)(), here.get()) + total_work,
                },
                ..now.clone()
            });
        })?;
        let textures = stages.n_textures();
        let contender = |found: &Proposal| {
            let shapes = self.shapes.as_ref().zip(found.shares());
            let shapes = shapes.map(|(shapes, shares)| shapes.textures(&shares));
            Ok(Contender {
                name: "design".to_owned(),
                texture: Arc::clone(&found.texture),
                shapes: shapes.transpose()?.map(Arc::new),
            })
        };
        let searched: Vec<Contender> = best.iter().map(contender).collect::<Result<_, StudyError>>()?;
        let (searched_runs, searched_work) = (made.get(), here.get());
        let mut kept = |runs: &[MadeRun]| {
            kept(runs)?;
            let runs = made.get() - searched_runs;
            watch(&SearchProgress {
                runs,
                total,
                textures,
                stage: DesignStage::Judging,
                best: f64::NAN,
                rejected: stages.rejected().drafts,
                best_texture: None,
                best_shares: None,
                work: RunCost {
                    here: here.get(),
                    left: (total_work - (here.get() - searched_work)).max(0.0),
                },
            });
            Ok(())
        };
        let mut judge = Judge {
            evaluator: &self.evaluator,
            runs: &mut Runs {
                known,
                keep: &mut kept,
                stop: bounds.stop,
            },
            asks_for_numbers: self.shapes.is_some(),
        };
        let judged = judge
            .verdict(&searched, &legal, &beside)?
            .ok_or_else(|| stages.no_design())?;
        let winner = best.iter().find(|found| found.texture == judged.texture);
        Ok(Outcome {
            shares: winner.and_then(Proposal::shares),
            texture: judged.texture,
            verdict: judged.verdict,
            compared: judged.compared,
            length: stages.length(bounds),
            rejected: stages.rejected().clone(),
            tried: stages.tried,
        })
    }

    /// Searches without a verdict; the best textures on the surfaces of the search, the best first.
    ///
    /// # Errors
    /// When the limits leave no texture, when runs cannot be made, and after a stop.
    pub fn search(
        &self,
        bounds: &Bounds,
        watch: &mut dyn FnMut(&SearchProgress),
    ) -> Result<Vec<Arc<Vec<bool>>>, StudyError> {
        let starts = self.starts(&|| bounds.stop.load(Ordering::Relaxed)).0;
        let mut stages = Stages::new(&self.evaluator, self.search_from(starts), self.drafts_at_once);
        let mut runs = Runs {
            known: &mut RunCache::new(),
            keep: &mut |_| Ok(()),
            stop: bounds.stop,
        };
        let best = stages.run(bounds, &mut runs, watch)?;
        if best.is_empty() {
            return Err(stages.no_design());
        }
        Ok(best.into_iter().map(|found| found.texture).collect())
    }

    /// A new search; a search for masks begins with these patterns.
    fn search_from(&self, starts: Vec<Named>) -> Search {
        let (space, starts) = match &self.shapes {
            Some(shapes) => (Space::shapes(Arc::clone(shapes)), Vec::new()),
            None => {
                let (grid, limits) = (self.evaluator.grid.clone(), self.limits.clone());
                (Space::patches(grid, limits), starts)
            }
        };
        Search::new(space, self.limits.feature_blocks(), self.start, starts)
    }

    /// Whether a pattern is one of the starting masks.
    fn is_drawn(&self, name: &str) -> bool {
        self.drawn.iter().any(|drawn| drawn.name == name)
    }

    /// Largest number of runs of the verdict with legal patterns of these names, and their cost in steps
    /// times blocks.
    pub(crate) fn most_of_verdict(&self, patterns: &[String]) -> (usize, f64) {
        let is_judged = |name: &&String| *name == GROOVE || self.is_drawn(name);
        let judged = patterns.iter().filter(is_judged).count();
        Judge::most_runs(&self.evaluator, patterns.len(), judged)
    }

    /// The legal patterns that a search begins with, named patterns and masks, and their textures, without
    /// those that a case refuses; fewer once `ends` returns true.
    pub(crate) fn starts(&self, ends: &dyn Fn() -> bool) -> (Vec<Named>, Vec<Vec<bool>>) {
        let (grid, limits) = (&self.evaluator.grid, &self.limits);
        let drawn = self.drawn.iter().filter_map(|drawn| {
            let texture = self.legal_part(drawn).ok()?;
            Some((Named::drawn(grid, &drawn.name, &drawn.textured), texture))
        });
        let all = named(grid, limits, ends).into_iter().chain(drawn);
        all.take_while(|_| !ends())
            .filter(|(_, texture)| self.evaluator.check(texture).is_ok())
            .unzip()
    }

    /// A search for which the caller makes the runs.
    pub fn open_search(&self) -> OpenSearch {
        OpenSearch::new(self.search_from(self.starts(&|| false).0))
    }

    /// Checks that a mask is legal.
    ///
    /// # Errors
    /// The first limit that it breaks.
    pub fn check(&self, textured: &[bool]) -> Result<(), Illegal> {
        self.limits.check(&self.evaluator.grid, textured, None)
    }

    /// Blocks along x and along y.
    pub fn size(&self) -> [usize; 2] {
        self.evaluator.grid.size()
    }

    /// Loss of each texture, a distance from the wish, as a mean over the first `surfaces` surfaces of the
    /// search, with a coarse step or the step of the case; or the reason why a texture has no loss.
    ///
    /// # Errors
    /// When runs cannot be made, and after a stop.
    pub fn losses(
        &self,
        textures: Vec<Vec<bool>>,
        surfaces: u64,
        is_coarse: bool,
        known: &mut RunCache,
        stop: &AtomicBool,
    ) -> Result<Vec<Result<f64, String>>, StudyError> {
        let fidelity = if is_coarse {
            Fidelity::Coarse
        } else {
            Fidelity::Fine
        };
        let textures: Vec<Arc<Vec<bool>>> = textures.into_iter().map(Arc::new).collect();
        self.make_runs(&textures, 0..surfaces, fidelity, known, stop)?;
        let loss = |texture| {
            let trial = self.evaluator.trial(texture, 0..surfaces, fidelity, known);
            trial.lost().map_or(Ok(trial.loss()), Err)
        };
        Ok(textures.iter().map(loss).collect())
    }

    /// Makes the runs of some textures on some surfaces.
    fn make_runs(
        &self,
        textures: &[Arc<Vec<bool>>],
        surfaces: Range<u64>,
        fidelity: Fidelity,
        known: &mut RunCache,
        stop: &AtomicBool,
    ) -> Result<(), StudyError> {
        let mut runs = Runs {
            known,
            keep: &mut |_| Ok(()),
            stop,
        };
        let wanted = self.evaluator.wanted(textures, surfaces, fidelity);
        self.evaluator.run(&wanted, &mut runs)
    }

    /// Loss of each texture, a distance from the wish, on each of `surfaces` surfaces that the search has not
    /// used, with the steps and times of a verdict. If surfaces do not differ, there is one.
    ///
    /// # Errors
    /// When runs cannot be made, and after a stop.
    pub fn losses_on_fresh(
        &self,
        textures: &[Arc<Vec<bool>>],
        surfaces: u64,
        stop: &AtomicBool,
    ) -> Result<Vec<Vec<f64>>, StudyError> {
        let surfaces = if self.evaluator.scatters() {
            Stages::UNSEEN..Stages::UNSEEN + surfaces
        } else {
            0..1
        };
        let (mut known, verdict) = (RunCache::new(), Fidelity::Verdict);
        self.make_runs(textures, surfaces.clone(), verdict, &mut known, stop)?;
        let losses = |texture: &Arc<Vec<bool>>| {
            let loss = |surface| {
                let trial = self
                    .evaluator
                    .trial(texture, surface..surface + 1, verdict, &known);
                trial.loss()
            };
            surfaces.clone().map(loss).collect()
        };
        Ok(textures.iter().map(losses).collect())
    }

    /// Block-steps of the first trial of a texture, on one surface with a coarse step.
    ///
    /// # Errors
    /// When a case cannot be made.
    pub fn block_steps_per_texture(&self) -> Result<f64, StudyError> {
        let subjects = self.evaluator.subjects.iter();
        let all: Result<f64, CaseError> = subjects
            .map(|subject| Ok(subject.case(None, 0, Fidelity::Coarse)?.block_steps()))
            .sum();
        Ok(all?)
    }
}
