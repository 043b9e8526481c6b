//! Comparison of textures on fresh surfaces: their losses, and paired differences on each surface.

use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use slipfront_case::case_file::Texture;

use crate::evaluate::{Evaluator, Keep, RunCache};
use crate::mean::Mean;
use crate::stages::Stages;
use crate::subject::Fidelity;
use crate::tolerance::WithinTolerance;
use slipfront_study::StudyError;

/// Number of surfaces on which finalists are compared.
pub(crate) const COMPARED: u64 = 16;

/// Number of surfaces on which the winner is judged.
pub(crate) const JUDGED: u64 = 64;

/// A texture that is compared with others, under its name.
#[derive(Clone, Debug)]
pub(crate) struct Contender {
    /// Name of the texture.
    pub(crate) name: String,
    /// Blocks of the texture.
    pub(crate) texture: Arc<Vec<bool>>,
    /// Shapes that the blocks were meshed from, if any.
    pub(crate) shapes: Option<Arc<Vec<Texture>>>,
}

/// Numbers of the surfaces on which finalists are compared and judged.
pub(crate) struct Surfaces {
    pub(crate) compared: Range<u64>,
    pub(crate) judged: Range<u64>,
}

impl Surfaces {
    pub(crate) fn of(evaluator: &Evaluator) -> Self {
        let first = Stages::UNSEEN;
        if evaluator.scatters() {
            let judged = first + COMPARED;
            Self {
                compared: first..judged,
                judged: judged..judged + JUDGED,
            }
        } else {
            Self {
                compared: 0..1,
                judged: 0..1,
            }
        }
    }
}

/// Inputs of a verdict.
pub(crate) struct Judge<'a> {
    /// Evaluator that makes the runs.
    pub(crate) evaluator: &'a Evaluator,
    /// Flag that ends all runs.
    pub(crate) stop: &'a AtomicBool,
    /// Whether the answer must be a result of the search, even if a named pattern is as good: a pattern has
    /// no numbers.
    pub(crate) asks_for_numbers: bool,
}

impl Judge<'_> {
    /// Makes the runs of some textures on some surfaces.
    pub(crate) fn run(
        &self,
        contenders: &[&Contender],
        surfaces: Range<u64>,
        known: &mut RunCache,
        keep: &mut Keep,
    ) -> Result<(), StudyError> {
        let textures: Vec<_> = contenders
            .iter()
            .map(|found| Arc::clone(&found.texture))
            .collect();
        // One surface after the other, so that a stop loses the runs of at most one surface.
        for surface in surfaces {
            let wanted = self
                .evaluator
                .wanted(&textures, surface..surface + 1, Fidelity::Verdict);
            self.evaluator.run(&wanted, known, self.stop, keep)?;
        }
        Ok(())
    }

    pub(crate) fn loss(&self, contender: &Contender, surfaces: Range<u64>, known: &RunCache) -> f64 {
        self.evaluator
            .loss(&contender.texture, surfaces, Fidelity::Verdict, known)
    }

    /// The loss of a texture with the confidence interval from its scatter over surfaces.
    pub(crate) fn mean_loss(&self, contender: &Contender, surfaces: Range<u64>, known: &RunCache) -> Mean {
        Mean::of(&self.loss_by_surface(contender, surfaces, known))
    }

    /// The loss of one texture minus that of another, paired by surface.
    pub(crate) fn difference(
        &self,
        one: &Contender,
        other: &Contender,
        surfaces: Range<u64>,
        known: &RunCache,
    ) -> Mean {
        let [one, other] = [one, other].map(|found| self.loss_by_surface(found, surfaces.clone(), known));
        let pairs = one.iter().zip(&other);
        Mean::of(&pairs.map(|(one, other)| one - other).collect::<Vec<_>>())
    }

    /// Reason why a texture has no loss on some surfaces, if it has none.
    pub(crate) fn lost(
        &self,
        contender: &Contender,
        surfaces: Range<u64>,
        known: &RunCache,
    ) -> Option<String> {
        self.evaluator
            .lost(&contender.texture, surfaces, Fidelity::Verdict, known)
    }

    /// Parts of a texture within the tolerance of the wish, if it has one.
    pub(crate) fn within(
        &self,
        contender: &Contender,
        surfaces: Range<u64>,
        known: &RunCache,
    ) -> Option<WithinTolerance> {
        self.evaluator
            .within(&contender.texture, surfaces, Fidelity::Verdict, known)
    }

    fn loss_by_surface(&self, contender: &Contender, surfaces: Range<u64>, known: &RunCache) -> Vec<f64> {
        self.evaluator
            .loss_by_surface(&contender.texture, surfaces, Fidelity::Verdict, known)
    }
}
