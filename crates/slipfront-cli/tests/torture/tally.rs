//! The number of cases of the tests, their seed, and their outcomes.

use std::collections::BTreeMap;

use chacha20::ChaCha8Rng;
use chacha20::rand_core::{Rng, SeedableRng};

/// Largest number of findings of one test that are printed.
const SHOWN: usize = 40;

/// Requested share of all cases; none for the short form.
fn share() -> Option<f64> {
    match std::env::var("SLIPFRONT_TORTURE").ok()?.as_str() {
        "long" => Some(1.0),
        share => Some(share.parse().unwrap()),
    }
}

/// Whether the long form, or a share of it, was requested.
pub(crate) fn long() -> bool {
    share().is_some()
}

/// Number of cases to try if the long form has `all`.
pub(crate) fn cases(short: usize, all: usize) -> usize {
    share().map_or(short, |share| short.max((all as f64 * share) as usize))
}

fn seed() -> u64 {
    let given = std::env::var("SLIPFRONT_TORTURE_SEED").ok();
    given.map_or(1, |seed| seed.parse().unwrap())
}

/// Random choices of a test.
pub(crate) struct Chance(ChaCha8Rng);

impl Chance {
    pub(crate) fn new() -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed()))
    }

    /// A random integer below `bound`.
    pub(crate) fn below(&mut self, bound: usize) -> usize {
        // The bias is far too small for any test to notice.
        (self.0.next_u64() % bound.max(1) as u64) as usize
    }

    /// At most `count` of the elements, in order.
    pub(crate) fn some<T>(&mut self, mut of: Vec<T>, count: usize) -> Vec<T> {
        while of.len() > count {
            let gone = self.below(of.len());
            of.remove(gone);
        }
        of
    }
}

/// Outcomes of the cases of a test.
pub(crate) struct Tally {
    what: &'static str,
    outcomes: BTreeMap<String, usize>,
    findings: Vec<String>,
}

impl Tally {
    pub(crate) fn new(what: &'static str) -> Self {
        Self {
            what,
            outcomes: BTreeMap::new(),
            findings: Vec::new(),
        }
    }

    /// Records a case of some kind: its good outcome, or its error.
    pub(crate) fn note(&mut self, kind: &str, case: &str, ended: Result<&str, String>) {
        let ended = ended.unwrap_or_else(|finding| {
            self.findings.push(format!("{kind}, {case}: {finding}"));
            "FOUND"
        });
        *self.outcomes.entry(format!("{kind}: {ended}")).or_default() += 1;
    }

    /// Prints the number of cases, and fails if there is a finding.
    pub(crate) fn close(self) {
        let all: usize = self.outcomes.values().sum();
        let mut text = format!("{}: {all} cases\n", self.what);
        for (outcome, count) in &self.outcomes {
            text += &format!("{count:>8}  {outcome}\n");
        }
        eprint!("{text}");
        let findings = self.findings.len();
        let shown: Vec<String> = self.findings.into_iter().take(SHOWN).collect();
        assert!(
            findings == 0,
            "{text}{findings} findings with SLIPFRONT_TORTURE_SEED={}:\n{}",
            seed(),
            shown.join("\n")
        );
    }
}
