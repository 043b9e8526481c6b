//! A texture with its runs on some surfaces: its distance from the wish, and the reason why it has none.

use std::ops::Range;
use std::sync::Arc;

use crate::evaluate::{Evaluator, RunCache, Wanted};
use crate::mean::Mean;
use crate::subject::Fidelity;
use crate::tolerance::WithinTolerance;
use slipfront_study::statistics::mean;

/// A texture with its known runs on some surfaces in every case.
pub(crate) struct Trial<'a> {
    pub(crate) evaluator: &'a Evaluator,
    pub(crate) texture: &'a Arc<Vec<bool>>,
    pub(crate) surfaces: Range<u64>,
    pub(crate) fidelity: Fidelity,
    pub(crate) known: &'a RunCache,
}

impl Trial<'_> {
    /// Deviation from the wish in the run of a case on a surface, or the reason why there is none.
    fn deviation(&self, subject: usize, surface: u64) -> Result<f64, String> {
        let wish = &self.evaluator.subjects[subject].wish;
        let ended = |texture| {
            let run = Wanted {
                subject,
                texture,
                surface,
                fidelity: self.fidelity,
            };
            self.evaluator.ended(&run, self.known)
        };
        let with = ended(Some(Arc::clone(self.texture)))?;
        if !wish.is_relative() {
            return wish.deviation(&with, None);
        }
        let without = ended(None).map_err(|why| format!("without texture: {why}"))?;
        wish.deviation(&with, Some(&without))
    }

    /// Deviations in one case, one per surface; NaN where there is none.
    fn deviations(&self, subject: usize) -> Vec<f64> {
        let surfaces = self.surfaces.clone();
        surfaces
            .map(|surface| self.deviation(subject, surface).unwrap_or(f64::NAN))
            .collect()
    }

    /// The loss: the mean, or the largest, of the losses of the cases; infinite if the texture is
    /// [lost](Self::lost) on any surface.
    pub(crate) fn loss(&self) -> f64 {
        let cases = self.evaluator.subjects.len();
        let losses = (0..cases).map(|subject| {
            let loss = self.evaluator.wish().loss(&self.deviations(subject));
            if loss.is_nan() { f64::INFINITY } else { loss }
        });
        if self.evaluator.is_worst {
            losses.fold(f64::NEG_INFINITY, f64::max)
        } else {
            losses.sum::<f64>() / cases as f64
        }
    }

    /// Contributions of the surfaces to the [loss](Self::loss): their mean is the loss, and their scatter
    /// gives its uncertainty. If the worst case counts, they are the contributions in that case.
    pub(crate) fn loss_by_surface(&self) -> Vec<f64> {
        let of_case = |subject: usize| -> Vec<f64> {
            let parts = self.evaluator.wish().parts_of_loss(&self.deviations(subject));
            let or_lost = |part: f64| if part.is_nan() { f64::INFINITY } else { part };
            parts.into_iter().map(or_lost).collect()
        };
        let cases: Vec<Vec<f64>> = (0..self.evaluator.subjects.len()).map(of_case).collect();
        if self.evaluator.is_worst {
            let worst = cases.into_iter().max_by(|a, b| mean(a).total_cmp(&mean(b)));
            return worst.unwrap_or_default();
        }
        let of_surface = |k: usize| mean(&cases.iter().map(|parts| parts[k]).collect::<Vec<_>>());
        (0..self.surfaces.clone().count()).map(of_surface).collect()
    }

    /// The loss with the confidence interval from its scatter over surfaces.
    pub(crate) fn mean_loss(&self) -> Mean {
        Mean::from_values(&self.loss_by_surface())
    }

    /// Number of parts within the tolerance of the wish in every case, where each surface is a part; none
    /// without a tolerance.
    pub(crate) fn within(&self) -> Option<WithinTolerance> {
        self.evaluator.wish().is_within(0.0)?;
        let parts = self.surfaces.clone().count();
        let mut is_good = vec![true; parts];
        for (number, subject) in self.evaluator.subjects.iter().enumerate() {
            for (is_good, deviation) in is_good.iter_mut().zip(self.deviations(number)) {
                // A lost part has no deviation, and does not count as within.
                *is_good &= subject.wish.is_within(deviation) == Some(true);
            }
        }
        let within = is_good.into_iter().filter(|&is_good| is_good).count();
        Some(WithinTolerance { within, parts })
    }

    /// Reason why the texture is lost: that of the first run without a deviation from the wish, with its case
    /// and seed if there are several.
    pub(crate) fn lost(&self) -> Option<String> {
        let subjects = &self.evaluator.subjects;
        let cases = 0..subjects.len();
        let surfaces = self.surfaces.clone();
        let mut runs = surfaces.flat_map(|surface| cases.clone().map(move |subject| (subject, surface)));
        runs.find_map(|(subject, surface)| {
            let why = self.deviation(subject, surface).err()?;
            let case = (subjects.len() > 1).then(|| format!("case {}", subject + 1));
            let seed =
                (surface > 0).then(|| format!("`friction.seed` = {}", subjects[subject].seed + surface));
            let mut place = case.into_iter().chain(seed).collect::<Vec<_>>().join(", ");
            if !place.is_empty() {
                place += ": ";
            }
            Some(place + &why)
        })
    }
}
