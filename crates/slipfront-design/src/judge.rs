//! Comparison of textures on fresh surfaces: their losses, and paired differences on each surface.

use std::ops::Range;
use std::sync::Arc;

use slipfront_case::case_file::Texture;

use crate::evaluate::{Evaluator, Runs};
use crate::mean::Mean;
use crate::stages::Stages;
use crate::subject::Fidelity;
use crate::trial::Trial;
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
    pub(crate) fn new(evaluator: &Evaluator) -> Self {
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

/// Judge of textures in some cases.
pub(crate) struct Judge<'a, 'r> {
    /// Evaluator that makes the runs.
    pub(crate) evaluator: &'a Evaluator,
    /// The runs.
    pub(crate) runs: &'a mut Runs<'r>,
    /// Whether the answer must be a result of the search, even if a named pattern is as good: a pattern has
    /// no numbers.
    pub(crate) asks_for_numbers: bool,
}

impl Judge<'_, '_> {
    /// Makes the runs of some textures on some surfaces.
    pub(crate) fn run(&mut self, contenders: &[&Contender], surfaces: &Range<u64>) -> Result<(), StudyError> {
        let textures: Vec<_> = contenders
            .iter()
            .map(|found| Arc::clone(&found.texture))
            .collect();
        // One surface after the other, so that a stop loses the runs of at most one surface.
        for surface in surfaces.clone() {
            let wanted = self
                .evaluator
                .wanted(&textures, surface..surface + 1, Fidelity::Verdict);
            self.evaluator.run(&wanted, self.runs)?;
        }
        Ok(())
    }

    /// The runs of a texture on some surfaces.
    pub(crate) fn trial<'t>(&'t self, contender: &'t Contender, surfaces: &Range<u64>) -> Trial<'t> {
        let (texture, surfaces) = (&contender.texture, surfaces.clone());
        self.evaluator
            .trial(texture, surfaces, Fidelity::Verdict, self.runs.known)
    }

    /// The loss of one texture minus that of another, paired by surface.
    pub(crate) fn difference(&self, one: &Contender, other: &Contender, surfaces: &Range<u64>) -> Mean {
        let [one, other] = [one, other].map(|found| self.trial(found, surfaces).loss_by_surface());
        let pairs = one.iter().zip(&other);
        Mean::from_values(&pairs.map(|(one, other)| one - other).collect::<Vec<_>>())
    }
}
