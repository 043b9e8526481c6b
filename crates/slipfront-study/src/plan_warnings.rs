//! Warnings about the cases of a study, the first of each kind.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use slipfront_case::case::Case;

/// A warning about points of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Warning {
    /// The warning.
    pub sentence: String,
    /// Number of points.
    pub points: usize,
    /// Position of the first of these points in the plan.
    pub first: usize,
}

/// Warnings about the points so far.
#[derive(Default)]
pub(crate) struct Warnings {
    pub(crate) found: Vec<Warning>,
    /// Position in `found`, and the last point to which the warning applies, by kind.
    known: HashMap<String, (usize, usize)>,
}

impl Warnings {
    /// Adds the warnings about a run of the point at this position.
    pub(crate) fn add(&mut self, position: usize, sentences: Vec<String>) {
        for sentence in sentences {
            // Sentences of the same kind differ only in their numbers.
            let kind = sentence.replace(|c: char| c.is_ascii_digit() || c == '.', "");
            match self.known.entry(kind) {
                Entry::Occupied(mut known) => {
                    let (at, last) = known.get_mut();
                    self.found[*at].points += usize::from(*last != position);
                    *last = position;
                }
                Entry::Vacant(unknown) => {
                    unknown.insert((self.found.len(), position));
                    self.found.push(Warning {
                        sentence,
                        points: 1,
                        first: position,
                    });
                }
            }
        }
    }
}

/// Note on the effect of the seed on runs of a case, for intervals over seeds; none if static coefficients
/// are random.
pub fn note_on_seeds(case: &Case) -> Option<&'static str> {
    let (friction, groups) = (&case.file.friction, &case.groups);
    if friction.mu_static_field.is_none() && groups.sigma_static_star > 0.0 {
        None
    } else if friction.mu_kinetic_field.is_none() && groups.sigma_kinetic_star * groups.r_star > 0.0 {
        Some(
            "only the kinetic coefficients differ from seed to seed, and intervals show no more than that: the static ones \
             are the same for every seed",
        )
    } else {
        Some("every seed gives the same run, because no coefficient is random: one seed is enough")
    }
}
