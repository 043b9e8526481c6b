//! The search for a texture: drafts are changed at random, and the best are kept.
//!
//! ```text
//! ask: new drafts of the population, of named patterns or of nothing -> their textures, legal and none asked for before
//! tell: their losses -> the population of the best that differ
//! ```
//!
//! A population that has not become better for a while makes room for another start; its best stay among the finalists. The
//! textures asked for depend only on the start number and on the losses so far.

use std::collections::HashSet;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use super::grid::Grid;
use super::limits::Limits;
use super::named::Named;
use super::patch::{Draft, Form, Patch};
use crate::draws::Draws;

/// Drafts in a population.
const POPULATION: usize = 24;

/// Times that a population is asked without becoming better by [`PROGRESS`] before another start.
const PATIENCE: usize = 25;

/// Loss by which a population must become better.
const PROGRESS: f64 = 1e-4;

/// Number of drafts that are tried for every texture asked for.
const TRIES: usize = 50;

/// Largest number of patches of a draft.
const MAX_PATCHES: usize = 12;

/// A texture that was asked for.
#[derive(Clone, Debug)]
pub(crate) struct Proposal {
    /// Origin of the texture, in a word or by its name.
    pub(crate) origin: String,
    /// Blocks of the texture.
    pub(crate) texture: Arc<Vec<bool>>,
    draft: Draft,
}

/// A texture with its loss.
#[derive(Clone, Debug)]
pub(crate) struct Found {
    /// The texture.
    pub(crate) proposal: Proposal,
    /// Loss of the texture: the lower, the better.
    pub(crate) loss: f64,
}

/// A search in progress.
#[derive(Debug)]
pub(crate) struct Search {
    grid: Grid,
    limits: Limits,
    draws: Draws,
    /// Patterns that were not proposed yet, the next one last.
    starts: Vec<Named>,
    /// Every texture that was asked for, as hashes.
    seen: HashSet<[u8; 32]>,
    /// The best textures of this start, the best first.
    population: Vec<Found>,
    /// The best textures of all starts, the best first.
    best: Vec<Found>,
    /// Times asked since the population has become better.
    idle: usize,
    /// Best loss of the population when it last became better.
    reached: f64,
}

impl Search {
    /// A search that begins with named patterns.
    pub(crate) fn new(grid: Grid, limits: Limits, start: u64, mut starts: Vec<Named>) -> Self {
        starts.reverse();
        Self {
            grid,
            limits,
            draws: Draws::new(start),
            starts,
            seen: HashSet::new(),
            population: Vec::new(),
            best: Vec::new(),
            idle: 0,
            reached: f64::INFINITY,
        }
    }

    /// Up to `n` textures that were not asked for before; fewer where the limits leave few or once `ends` returns true, and
    /// none where the limits leave none.
    pub(crate) fn ask(&mut self, n: usize, ends: &dyn Fn() -> bool) -> Vec<Proposal> {
        let mut asked = Vec::new();
        for _ in 0..n * TRIES {
            if asked.len() == n || ends() {
                break;
            }
            let (origin, draft) = self.draft();
            let Some(texture) = self.limits.texture(&self.grid, &draft) else {
                continue;
            };
            if self.seen.insert(hash(&texture)) {
                asked.push(Proposal {
                    origin,
                    texture: texture.into(),
                    draft,
                });
            }
        }
        asked
    }

    /// Takes the losses of textures that were asked for, in their order.
    pub(crate) fn tell(&mut self, found: &[Found]) {
        let found: Vec<Found> = found
            .iter()
            .filter(|found| found.loss.is_finite())
            .cloned()
            .collect();
        merge(&mut self.best, &found, FINALISTS, self.limits.feature);
        merge(&mut self.population, &found, POPULATION, self.limits.feature);
        let best = self.population.first().map_or(f64::INFINITY, |found| found.loss);
        if best < self.reached - PROGRESS {
            (self.reached, self.idle) = (best, 0);
        } else {
            self.idle += 1;
        }
        if self.idle > PATIENCE {
            self.population.clear();
            (self.reached, self.idle) = (f64::INFINITY, 0);
        }
    }

    /// A proposal for a texture of the caller, whose loss may be told as if it had been asked for.
    pub(crate) fn of_other(&self, texture: Vec<bool>) -> Proposal {
        Proposal {
            origin: "another search".to_owned(),
            draft: Draft::drawn(&self.grid, &texture),
            texture: texture.into(),
        }
    }

    /// The best textures so far, which differ, the best first.
    pub(crate) fn best(&self) -> &[Found] {
        &self.best
    }

    /// Number of textures that were asked for.
    pub(crate) fn n_asked(&self) -> usize {
        self.seen.len()
    }

    /// Forgets all losses, because later ones are measured otherwise; textures that were asked for are not asked for again.
    pub(crate) fn begin_again(&mut self) {
        self.best.clear();
        self.population.clear();
        self.starts.clear();
        (self.reached, self.idle) = (f64::INFINITY, 0);
    }

    /// A new draft, and its origin.
    fn draft(&mut self) -> (String, Draft) {
        if let Some(Named { name, draft }) = self.starts.pop() {
            return (name, draft);
        }
        let few = self.population.len() < POPULATION / 2;
        if few && (self.population.is_empty() || self.draws.uniform() < 0.5) {
            return ("random".to_owned(), self.random_draft());
        }
        let mut draft = self.parent().clone();
        let mut origin = "changed";
        if self.draws.uniform() < 0.15 {
            let other = self.parent().clone();
            self.mix(&mut draft, other);
            origin = "mixed";
        }
        let changes = 1 + self.draws.below(3);
        for _ in 0..changes {
            self.change(&mut draft);
        }
        (origin.to_owned(), draft)
    }

    /// A draft of the population: the better of two that are drawn.
    fn parent(&mut self) -> &Draft {
        let n = self.population.len();
        let index = self.draws.below(n).min(self.draws.below(n));
        &self.population[index].proposal.draft
    }

    /// One to five random patches.
    fn random_draft(&mut self) -> Draft {
        let n = 1 + self.draws.below(5);
        let [least, most] = self.limits.coverage;
        Draft {
            patches: (0..n).map(|_| self.random_patch()).collect(),
            drawn: None,
            percent: if self.draws.uniform() < 0.5 {
                most
            } else {
                self.draws.between(least, most)
            },
        }
    }

    /// A strip or cavity anywhere, mostly along an axis.
    fn random_patch(&mut self) -> Patch {
        let draws = &mut self.draws;
        let size = self.grid.size().map(|n| n as f64);
        let angle = match draws.below(4) {
            0 => 0.0,
            1 => FRAC_PI_2,
            2 => draws.between(0.0, PI),
            _ => FRAC_PI_2 + 0.2 * draws.normal(),
        };
        let form = if draws.uniform() < 0.8 {
            Form::Rectangle
        } else {
            Form::Ellipse
        };
        let longest = 0.7 * (size[0] + size[1]);
        let length = longest * draws.uniform() * draws.uniform();
        Patch {
            center: size.map(|n| draws.between(0.0, n)),
            half: [0.5 * length, draws.between(0.0, 0.5 * self.limits.feature as f64)],
            angle,
            form,
        }
    }

    /// Takes some of the patches of another draft in place of its own.
    fn mix(&mut self, draft: &mut Draft, other: Draft) {
        let draws = &mut self.draws;
        draft.patches.retain(|_| draws.uniform() < 0.6);
        let taken = other.patches.into_iter().filter(|_| draws.uniform() < 0.6);
        draft.patches.extend(taken);
        draft.patches.truncate(MAX_PATCHES);
        if draft.drawn.is_none() {
            draft.drawn = other.drawn;
        }
    }

    /// One random change.
    fn change(&mut self, draft: &mut Draft) {
        let n = draft.patches.len();
        if n == 0 {
            let patch = self.random_patch();
            draft.patches.push(patch);
            return;
        }
        let which = self.draws.below(n);
        // Steps of a block up to a quarter of the slider, small ones as often as large ones.
        let side = self.grid.size()[0].max(self.grid.size()[1]) as f64;
        let step = 0.5 * libm::pow(0.5 * side, self.draws.uniform());
        match self.draws.below(20) {
            0..=5 => {
                for axis in 0..2 {
                    let moved = draft.patches[which].center[axis] + step * self.draws.normal();
                    draft.patches[which].center[axis] = moved.clamp(0.0, self.grid.size()[axis] as f64);
                }
            }
            6..=8 => {
                let half = &mut draft.patches[which].half;
                half[0] = (half[0] + step * self.draws.normal()).clamp(0.0, 2.0 * side);
            }
            9 | 10 => {
                let half = &mut draft.patches[which].half;
                half[1] = (half[1] + 0.5 * self.draws.normal()).clamp(0.0, 0.5 * side);
            }
            11..=13 => {
                let angle = &mut draft.patches[which].angle;
                // A whole step turns the end of a strip across the slider by that much.
                *angle = match self.draws.below(8) {
                    0 => FRAC_PI_2,
                    1 => 0.0,
                    _ => *angle + 2.0 * step / side * self.draws.normal(),
                };
            }
            14 if n < MAX_PATCHES => {
                let patch = self.random_patch();
                draft.patches.push(patch);
            }
            15 if n > 1 => drop(draft.patches.swap_remove(which)),
            16 => draft.patches[which] = self.random_patch(),
            17 if n < MAX_PATCHES => {
                let mut patch = draft.patches[which].clone();
                let axis = self.draws.below(2);
                patch.center[axis] = self.grid.size()[axis] as f64 - patch.center[axis];
                if self.draws.uniform() < 0.5 {
                    patch.angle = -patch.angle;
                }
                draft.patches.push(patch);
            }
            18 => {
                let [least, most] = self.limits.coverage;
                let changed = draft.percent + 0.2 * (most - least) * self.draws.normal();
                draft.percent = if self.draws.uniform() < 0.3 {
                    most
                } else {
                    changed.clamp(least, most)
                };
            }
            _ => {
                for patch in &mut draft.patches {
                    for axis in 0..2 {
                        patch.center[axis] += 0.5 * step * self.draws.normal();
                    }
                }
            }
        }
    }
}

/// Number of textures that a search hands on.
pub(crate) const FINALISTS: usize = 24;

/// Adds to a list that is sorted by loss, and keeps the best that differ from every better one by more than a square of
/// `feature` blocks.
fn merge(list: &mut Vec<Found>, found: &[Found], most: usize, feature: usize) {
    let mut all = std::mem::take(list);
    all.extend_from_slice(found);
    all.sort_by(|a, b| a.loss.total_cmp(&b.loss));
    let least = (feature * feature).min(9);
    for candidate in all {
        if list.len() == most {
            break;
        }
        let differs = |kept: &Found| {
            let pairs = kept
                .proposal
                .texture
                .iter()
                .zip(candidate.proposal.texture.iter());
            pairs.filter(|(kept, new)| kept != new).take(least).count() == least
        };
        if list.iter().all(differs) {
            list.push(candidate);
        }
    }
}

/// Hash of a texture.
pub(crate) fn hash(texture: &[bool]) -> [u8; 32] {
    let bytes: Vec<u8> = texture.iter().map(|&is_in| is_in.into()).collect();
    *blake3::hash(&bytes).as_bytes()
}
