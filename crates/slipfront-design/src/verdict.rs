//! The verdict on a design: its values on surfaces that the search has not used, compared with named
//! patterns.

use std::ops::Range;
use std::sync::Arc;

use serde::Serialize;

use crate::evaluate::{Evaluator, Wanted};
use crate::judge::{Contender, Judge, Surfaces};
use crate::mean::Mean;
use crate::sensitivity::{self, Sensitivity};
use crate::subject::Fidelity;
use crate::tolerance::WithinTolerance;
use crate::trial::Trial;
use crate::wish::Measured;
use slipfront_study::StudyError;

/// Largest number of designs of the search among the finalists.
const MOST_FINALISTS: usize = 8;

/// Largest number of named patterns among the finalists.
const NAMED_FINALISTS: usize = 4;

/// Values of a texture on fresh surfaces in one case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FreshValues {
    /// Number of surfaces over which the means are taken: all, unless the texture is lost on some.
    pub surfaces: u64,
    /// The quantity of the wish in units of mu_s, if the runs have it; for a curve, the largest mu*.
    pub wished_star: Option<Mean>,
    /// The largest mu*.
    pub static_friction_star: Mean,
    /// The first peak of mu*.
    pub first_peak_star: Mean,
    /// Kinetic friction mu_k*, if runs are long enough.
    pub kinetic_friction_star: Option<Mean>,
}

/// A texture on fresh surfaces.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OnFresh {
    /// Name of the texture.
    pub name: String,
    /// Share of the blocks that are textured, %.
    pub coverage_percent: f64,
    /// Values in each case.
    pub cases: Vec<FreshValues>,
    /// Loss over all cases; infinite if the texture is lost.
    pub loss: f64,
    /// Half the width of the interval of the loss, due to the scatter over surfaces.
    pub loss_half_width: Option<f64>,
    /// Standard deviation of the loss over surfaces.
    pub loss_deviation: Option<f64>,
    /// Parts within the tolerance of the wish, if it has one and there is a texture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub within_tolerance: Option<WithinTolerance>,
    /// Reason why the texture is lost, if it is: one of its runs does not have the numbers of the wish.
    pub lost: Option<String>,
    /// The loss of this texture minus that of the design, paired by surface: above 0 if the design is better;
    /// none for the design itself.
    pub design_is_better_by: Option<Mean>,
}

/// The verdict.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// Number of fresh surfaces of the verdict.
    pub surfaces: u64,
    /// Number of the first fresh surface, added to the seed of the case.
    pub first_surface: u64,
    /// The design.
    pub design: OnFresh,
    /// Whether the design is a named pattern, because no searched texture is better on fresh surfaces than
    /// the best of them.
    pub is_named: bool,
    /// The slider without texture, the groove across and the best named pattern, if they exist; and the best
    /// of the search if it was not better.
    pub others: Vec<OnFresh>,
    /// The loss on fresh surfaces minus the loss on the surfaces of the search.
    pub optimism: f64,
    /// The design under changes of its texture, of the speed and of the mesh, compared with the best named
    /// pattern.
    pub sensitivity: Sensitivity,
}

/// The winner, and the textures of its comparison.
pub(crate) struct Judged {
    /// Blocks of the winner.
    pub(crate) texture: Arc<Vec<bool>>,
    /// Every texture that was judged, by its name, the winner first.
    pub(crate) compared: Vec<(String, Option<Arc<Vec<bool>>>)>,
    /// The verdict.
    pub(crate) verdict: Verdict,
}

impl Judge<'_, '_> {
    /// Largest number of runs of a verdict on `named` patterns, and their cost in steps times blocks.
    /// `beside` is the number of textures that are judged in any case.
    pub(crate) fn most_runs(evaluator: &Evaluator, named: usize, beside: usize) -> (usize, f64) {
        let Surfaces { compared, judged } = Surfaces::new(evaluator);
        let n = |surfaces: Range<u64>| (surfaces.end - surfaces.start) as usize;
        let [cases, compared, judged] = [evaluator.subjects.len(), n(compared), n(judged)];
        // The judged textures include the slider without texture, the best named pattern and the design.
        let finalists = MOST_FINALISTS + NAMED_FINALISTS + 1;
        // The shortlist of named patterns is made on one surface, with the slider without texture.
        let runs = cases * (named + 1 + finalists * compared + (3 + beside) * judged);
        let work = runs as f64 * evaluator.work(Fidelity::Verdict);
        let (changed_runs, changed_work) = sensitivity::most_runs(evaluator);
        (runs + changed_runs, work + changed_work)
    }

    /// Compares the finalists of a search with the best of the named patterns, and returns the winner with
    /// the verdict on it; none if there is no texture. The textures `beside` them are judged in any case; the
    /// groove is the first of them if it is legal.
    pub(crate) fn verdict(
        &mut self,
        searched: &[Contender],
        named: &[Contender],
        beside: &[Contender],
    ) -> Result<Option<Judged>, StudyError> {
        let Surfaces { compared, judged } = Surfaces::new(self.evaluator);
        let searched = &searched[..searched.len().min(MOST_FINALISTS)];
        let named = &self.shortlist(named)?;
        let all: Vec<&Contender> = searched.iter().chain(named).collect();
        self.run(&all, &compared)?;
        let by_loss = |contenders: &[Contender]| {
            let loss = |contender: &Contender| self.trial(contender, &compared).loss();
            let best = contenders.iter().min_by(|a, b| loss(a).total_cmp(&loss(b)));
            best.cloned()
        };
        let (winner, best_named) = (by_loss(searched), by_loss(named));
        let without_search = || best_named.clone().filter(|_| !self.asks_for_numbers);
        let Some(first) = winner.clone().or_else(without_search) else {
            return Ok(None);
        };
        let to_judge: Vec<&Contender> = winner.iter().chain(&best_named).chain(beside).collect();
        self.run(&to_judge, &judged)?;
        // If both are lost, neither is better.
        let is_better = |named: &Contender| self.difference(named, &first, &judged).low() > 0.0;
        let is_named =
            !self.asks_for_numbers && (winner.is_none() || !best_named.as_ref().is_none_or(is_better));
        let design = match &best_named {
            Some(named) if is_named => named.clone(),
            _ => first.clone(),
        };
        let mut others: Vec<&Contender> = Vec::new();
        for other in beside
            .iter()
            .take(1)
            .chain(&best_named)
            .chain(&winner)
            .chain(beside)
        {
            if other.texture != design.texture && others.iter().all(|known| known.texture != other.texture) {
                others.push(other);
            }
        }
        let other = best_named
            .as_ref()
            .filter(|named| named.texture != design.texture)
            .or(beside.first().filter(|other| other.texture != design.texture));
        let sensitivity = self.sensitivity(&design, other)?;
        let on_fresh = |contender: Option<&Contender>| self.on_fresh(contender, &design, &judged);
        let loss = |surfaces: &Range<u64>| self.trial(&design, surfaces).loss();
        let verdict = Verdict {
            surfaces: judged.end - judged.start,
            first_surface: judged.start,
            design: on_fresh(Some(&design)),
            is_named,
            others: std::iter::once(None)
                .chain(others.iter().copied().map(Some))
                .map(on_fresh)
                .collect(),
            optimism: loss(&judged) - loss(&compared),
            sensitivity,
        };
        let compared = others
            .iter()
            .map(|other| (other.name.clone(), Some(Arc::clone(&other.texture))));
        let compared = [
            (design.name.clone(), Some(Arc::clone(&design.texture))),
            (verdict.others[0].name.clone(), None),
        ]
        .into_iter()
        .chain(compared)
        .collect();
        Ok(Some(Judged {
            texture: design.texture,
            compared,
            verdict,
        }))
    }

    /// The named patterns that are best on the surface of the search, with the step of the case.
    fn shortlist(&mut self, named: &[Contender]) -> Result<Vec<Contender>, StudyError> {
        let textures: Vec<_> = named.iter().map(|named| Arc::clone(&named.texture)).collect();
        let wanted = self.evaluator.wanted(&textures, 0..1, Fidelity::Fine);
        self.evaluator.run(&wanted, self.runs)?;
        let loss = |named: &Contender| {
            let trial = self
                .evaluator
                .trial(&named.texture, 0..1, Fidelity::Fine, self.runs.known);
            trial.loss()
        };
        let mut named = named.to_vec();
        named.sort_by(|a, b| loss(a).total_cmp(&loss(b)));
        named.dedup_by(|a, b| a.texture == b.texture);
        named.truncate(NAMED_FINALISTS);
        Ok(named)
    }

    /// Values of a texture on fresh surfaces; without a texture those of the bare slider.
    fn on_fresh(&self, contender: Option<&Contender>, design: &Contender, surfaces: &Range<u64>) -> OnFresh {
        let given = |subject: usize| self.fresh_values(contender, subject, surfaces);
        let trial = contender.map(|contender| self.trial(contender, surfaces));
        let loss = trial.as_ref().map(Trial::mean_loss);
        OnFresh {
            name: contender
                .map_or("no texture", |contender| &contender.name)
                .to_owned(),
            coverage_percent: contender.map_or(0.0, |found| self.evaluator.grid.percent(&found.texture)),
            cases: (0..self.evaluator.subjects.len()).map(given).collect(),
            loss: loss.map_or(f64::NAN, |loss| loss.mean),
            loss_half_width: loss.and_then(|loss| loss.half_width),
            loss_deviation: loss.and_then(|loss| loss.deviation),
            within_tolerance: trial.as_ref().and_then(Trial::within),
            lost: trial.as_ref().and_then(Trial::lost),
            design_is_better_by: contender
                .filter(|contender| contender.texture != design.texture)
                .map(|contender| self.difference(contender, design, surfaces)),
        }
    }

    /// Values of a texture in one case on some surfaces; without a texture those of the bare slider.
    pub(crate) fn fresh_values(
        &self,
        contender: Option<&Contender>,
        subject: usize,
        surfaces: &Range<u64>,
    ) -> FreshValues {
        let run = |surface| Wanted {
            subject,
            texture: contender.map(|contender| Arc::clone(&contender.texture)),
            surface,
            fidelity: Fidelity::Verdict,
        };
        let ended = |surface| self.evaluator.ended(&run(surface), self.runs.known).ok();
        let found: Vec<Measured> = surfaces.clone().filter_map(ended).collect();
        let mean =
            |of: &dyn Fn(&Measured) -> f64| Mean::from_values(&found.iter().map(of).collect::<Vec<_>>());
        let kinetic: Option<Vec<f64>> = found.iter().map(|found| found.kinetic_star).collect();
        let quantity = self.evaluator.wish().quantity();
        FreshValues {
            surfaces: found.len() as u64,
            wished_star: Some(mean(&|found| found.get(quantity))).filter(|mean| mean.mean.is_finite()),
            static_friction_star: mean(&|found| found.largest_star),
            first_peak_star: mean(&|found| found.first_peak_star),
            kinetic_friction_star: kinetic.map(|values| Mean::from_values(&values)),
        }
    }
}
