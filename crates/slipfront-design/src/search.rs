//! The search for a texture from several starts, one after another or some in parallel.
//!
//! ```text
//! ask: named patterns first, then drafts of the starts -> their textures, legal and none asked for before
//! tell: their losses -> the drafts of each start move towards its better ones; what has ended makes room for another start
//! ```
//!
//! Starts begin alternately with random patches and with one of the best textures so far. The proposed
//! textures depend only on the start number and on the losses so far.

use std::collections::HashSet;
use std::sync::Arc;

use serde::Serialize;
use slipfront_base::number_format::count;

use crate::named_patterns::Named;
use crate::space::{Draft, Space};
use crate::start::{GENERATION, Start};
use slipfront_study::draws::Draws;

/// Largest number of drafts that are generated for every texture asked for.
const TRIES: usize = 50;

/// Standard deviation of drafts from a random start, as a share of the range of every number.
const WIDE: f64 = 0.2;

/// Standard deviation of drafts from a good texture.
const NEAR: f64 = 0.05;

/// A proposed texture.
#[derive(Clone, Debug)]
pub(crate) struct Proposal {
    /// Origin of the texture: the name of a pattern, or the number of a start.
    pub(crate) origin: String,
    /// Blocks of the texture.
    pub(crate) texture: Arc<Vec<bool>>,
    draft: Draft,
    /// Number of the start that drew the draft, and the standard normal numbers that it was made from.
    drawn: Option<(usize, Vec<f64>)>,
}

impl Proposal {
    /// Shares of the ranges of the unknowns, if numbers are searched for.
    pub(crate) fn shares(&self) -> Option<Vec<f64>> {
        match &self.draft {
            Draft::Shapes(shares) => Some(shares.clone()),
            Draft::Patches(_) => None,
        }
    }
}

/// A texture with its loss.
#[derive(Clone, Debug)]
pub(crate) struct RatedTexture {
    /// The texture.
    pub(crate) proposal: Proposal,
    /// Loss of the texture: the lower, the better.
    pub(crate) loss: f64,
}

/// A search in progress.
#[derive(Debug)]
pub(crate) struct Search {
    space: Space,
    /// Smallest width of a feature in blocks, for the least difference between the best textures.
    feature: usize,
    draws: Draws,
    /// Patterns that were not proposed yet, the next one last.
    named: Vec<Named>,
    /// Hashes of all proposed textures.
    seen: HashSet<[u8; 32]>,
    /// The best textures of all starts, the best first.
    best: Vec<RatedTexture>,
    /// Starts that have not ended.
    starts: Vec<Start>,
    /// Number of starts so far.
    n_starts: usize,
    /// Whether every start begins with one of the best textures.
    is_refining: bool,
    /// Number of drafts without a legal texture, and the reason of the last of them.
    pub(crate) rejected: Rejected,
}

/// Drafts of a search that were not tried, since they have no legal texture.
#[derive(Clone, Debug, Default, Serialize)]
pub(crate) struct Rejected {
    /// Number of these drafts.
    pub drafts: usize,
    /// Reason why the last of them was rejected.
    pub last: Option<String>,
}

impl Rejected {
    /// A clause for a person; none if no draft was rejected.
    pub(crate) fn in_words(&self) -> Option<String> {
        let last = self.last.as_ref()?;
        let drafts = count(self.drafts, "draft");
        Some(format!("{drafts} rejected before a run; the last: {last}"))
    }
}

impl Search {
    /// A search that begins with named patterns.
    pub(crate) fn new(space: Space, feature: usize, start: u64, mut named: Vec<Named>) -> Self {
        // Patterns are taken from the end.
        named.reverse();
        Self {
            space,
            feature,
            draws: Draws::new(start),
            named,
            seen: HashSet::new(),
            best: Vec::new(),
            starts: Vec::new(),
            n_starts: 0,
            is_refining: false,
            rejected: Rejected::default(),
        }
    }

    /// Proposes up to `n` new textures, a generation of every start; fewer if the limits leave few or once
    /// `ends` returns true, and none if the limits leave none.
    pub(crate) fn ask(&mut self, n: usize, ends: &dyn Fn() -> bool) -> Vec<Proposal> {
        let mut asked = Vec::new();
        let mut in_vain = 0;
        // Bounded, since limits may leave fewer textures than are asked for.
        for _ in 0..n * TRIES {
            if asked.len() == n || ends() {
                break;
            }
            let place = asked.len() / GENERATION;
            let (origin, draft, drawn) = self.draft(place);
            let texture = match self.space.texture(&draft) {
                Ok(texture) => Some(texture),
                Err(why) => {
                    self.rejected.drafts += 1;
                    self.rejected.last = Some(why);
                    None
                }
            };
            if let Some(texture) = texture.filter(|texture| self.seen.insert(hash(texture))) {
                in_vain = 0;
                asked.push(Proposal {
                    origin,
                    texture: texture.into(),
                    draft,
                    drawn,
                });
            } else {
                // If all drafts of a start are illegal or known, the start has converged: another takes its
                // place.
                in_vain += 1;
                if in_vain == TRIES && place < self.starts.len() {
                    self.starts[place] = self.new_start();
                    in_vain = 0;
                }
            }
        }
        asked
    }

    /// Takes the losses of proposed textures, in their order.
    pub(crate) fn add_losses(&mut self, found: &[RatedTexture]) {
        let finite: Vec<RatedTexture> = found
            .iter()
            .filter(|found| found.loss.is_finite())
            .cloned()
            .collect();
        // Lost textures guide a start away from them, but no start begins with one.
        merge(&mut self.best, &finite, self.feature);
        for RatedTexture { proposal, loss } in found {
            let Some((number, normal)) = &proposal.drawn else {
                continue;
            };
            if let Some(start) = self.starts.iter_mut().find(|start| start.number == *number) {
                start.add_loss(*loss, normal);
            }
        }
        self.starts.retain(|start| !start.has_ended(&self.space));
    }

    /// A proposal for a texture of the caller; its loss can be passed to [`add_losses`](Self::add_losses) as
    /// if the search had proposed it.
    pub(crate) fn of_other(&self, texture: Vec<bool>) -> Proposal {
        Proposal {
            origin: "another search".to_owned(),
            draft: self.space.drawn(&texture),
            texture: texture.into(),
            drawn: None,
        }
    }

    /// The best textures so far, distinct and sorted by loss.
    pub(crate) fn best(&self) -> &[RatedTexture] {
        &self.best
    }

    /// Number of proposed textures.
    pub(crate) fn n_asked(&self) -> usize {
        self.seen.len()
    }

    /// Returns the best textures, the best first, and discards all losses, because later ones are measured
    /// differently. The start of the best texture continues if it has not ended; others begin with the best
    /// textures. No texture is proposed twice.
    pub(crate) fn refine(&mut self) -> Vec<Proposal> {
        let best = std::mem::take(&mut self.best);
        let drawn = best.first().and_then(|found| found.proposal.drawn.as_ref());
        let of_best = drawn.map(|(number, _)| *number);
        self.named.clear();
        self.starts.retain(|start| Some(start.number) == of_best);
        self.starts.iter_mut().for_each(Start::forget_losses);
        self.is_refining = true;
        let proposals = best.into_iter().map(|found| Proposal {
            // The mean of the start has moved since the draft was drawn.
            drawn: None,
            ..found.proposal
        });
        proposals.collect()
    }

    /// A new draft, the next named pattern or one of the start at this place; its origin; and how the start
    /// has drawn it.
    fn draft(&mut self, place: usize) -> (String, Draft, Option<(usize, Vec<f64>)>) {
        if let Some(Named { name, draft }) = self.named.pop() {
            return (name, Draft::Patches(draft), None);
        }
        while self.starts.len() <= place {
            let start = self.new_start();
            self.starts.push(start);
        }
        let start = &self.starts[place];
        let (draft, normal) = start.draw(&self.space, &mut self.draws);
        (
            format!("start {}", start.number),
            draft,
            Some((start.number, normal)),
        )
    }

    fn new_start(&mut self) -> Start {
        self.n_starts += 1;
        let n = self.best.len();
        let is_near = n > 0 && (self.is_refining || self.n_starts.is_multiple_of(2));
        let near = is_near.then(|| {
            let draws = &mut self.draws;
            // The best of three random places: good textures are chosen more often, but every one has a
            // chance.
            let index = draws.below(n).min(draws.below(n)).min(draws.below(n));
            self.space.near(&self.best[index].proposal.draft, draws)
        });
        let (from, spread) = match near.flatten() {
            Some(from) => (from, NEAR),
            None => (self.space.anywhere(&mut self.draws), WIDE),
        };
        Start::new(self.n_starts, from, spread, &self.space)
    }
}

/// Number of best textures that a search keeps.
const FINALISTS: usize = 24;

/// Adds to the finalists, sorted by loss, and keeps the best that differ from every better one by at least
/// the number of blocks in a square of `feature` blocks along a side, or by 9 if that is less.
fn merge(list: &mut Vec<RatedTexture>, found: &[RatedTexture], feature: usize) {
    let mut all = std::mem::take(list);
    all.extend_from_slice(found);
    all.sort_by(|a, b| a.loss.total_cmp(&b.loss));
    let least = (feature * feature).min(9);
    for candidate in all {
        if list.len() == FINALISTS {
            break;
        }
        let differs = |kept: &RatedTexture| {
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
