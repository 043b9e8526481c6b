//! Values that the engine computes for the numbers of the lessons.

use std::collections::BTreeMap;
use std::sync::Arc;

use rayon::prelude::*;
use slipfront_run::running;
use slipfront_run::summary::Summary;

use super::content::{Keys, Number, Quantity, case};

/// Runs from which numbers are taken, each computed once.
pub(crate) struct Runs(BTreeMap<String, Run>);

struct Run {
    summary: Summary,
    slipped_percent_at_peak: f64,
    v_star_n_x: f64,
}

/// A run as text: the file of its case and the changed keys.
fn name(file: &str, keys: &Keys) -> String {
    format!("{file} {keys:?}")
}

/// Runs behind a number, one pair for each surface: its own run, and the run that it is relative to.
fn parts(number: &Number) -> Vec<(Keys, Option<Keys>)> {
    let on = |seed: Option<&u64>| {
        let mut keys = number.set.clone();
        if let Some(seed) = seed {
            keys.insert("friction.seed".to_owned(), (*seed).into());
        }
        let against = number.against.as_ref().map(|changes| {
            let mut against = keys.clone();
            against.extend(changes.clone());
            against
        });
        (keys, against)
    };
    if number.seeds.is_empty() {
        return vec![on(None)];
    }
    number.seeds.iter().map(|seed| on(Some(seed))).collect()
}

impl Runs {
    /// All runs that these numbers need.
    pub(crate) fn for_numbers<'a>(numbers: impl Iterator<Item = &'a Number>) -> Self {
        let mut wanted = BTreeMap::new();
        for number in numbers.filter(|number| number.quantity != Quantity::Key) {
            for keys in parts(number)
                .into_iter()
                .flat_map(|(keys, against)| [Some(keys), against])
                .flatten()
            {
                wanted.insert(name(&number.case, &keys), (number.case.clone(), keys));
            }
        }
        let run = |(name, (file, keys)): (String, (String, Keys))| (name, Run::new(&file, &keys));
        Self(wanted.into_par_iter().map(run).collect())
    }

    /// The value of a number: the mean over its surfaces.
    pub(crate) fn value(&self, number: &Number) -> f64 {
        let get = |keys: &Keys| &self.0[&name(&number.case, keys)];
        let of = |(keys, against): &(Keys, Option<Keys>)| {
            let run = get(keys);
            run.value(number.quantity, against.as_ref().map(get))
        };
        let parts = parts(number);
        parts.iter().map(of).sum::<f64>() / parts.len() as f64
    }
}

impl Run {
    fn new(file: &str, keys: &Keys) -> Self {
        let case = Arc::new(case(file, keys));
        let record = running::run(&case, 1).unwrap_or_else(|error| panic!("{file}: {error}"));
        let textured = &case.model.surface.textured;
        let contact = |(_, is_textured): &(&f64, &bool)| !**is_textured;
        let first_slips: Vec<f64> = record
            .first_slip_time_star
            .iter()
            .zip(textured)
            .filter(contact)
            .map(|(time, _)| *time)
            .collect();
        let onset = record.summary.onset_time_star;
        let slipped = first_slips.iter().filter(|time| **time <= onset).count();
        Self {
            slipped_percent_at_peak: 100.0 * slipped as f64 / first_slips.len() as f64,
            v_star_n_x: case.groups.v_star * f64::from(case.file.slider.blocks[0]),
            summary: record.summary,
        }
    }

    fn value(&self, quantity: Quantity, against: Option<&Self>) -> f64 {
        let summary = &self.summary;
        let found = match quantity {
            Quantity::Key => None,
            Quantity::StaticFrictionStar => Some(summary.static_friction_star),
            Quantity::KineticFrictionStar => summary.kinetic_friction_star,
            Quantity::OnsetTimeStar => Some(summary.onset_time_star),
            Quantity::FirstSlipTimeStar => summary.first_slip_time_star,
            Quantity::FrictionAfterFall => {
                let lowest = summary.instants.iter().find(|instant| instant.instant == 'E');
                lowest.map(|instant| instant.mu_star)
            }
            Quantity::StaticReductionPercent => against.map(|run| {
                let without = run.summary.static_friction_star;
                100.0 * (without - summary.static_friction_star) / without
            }),
            Quantity::SlippedPercentAtPeak => Some(self.slipped_percent_at_peak),
            Quantity::TexturePercent => Some(summary.texture_percent),
            Quantity::FrontSpeedCS => summary.front_speed_c_s,
            Quantity::VStar => Some(summary.v_star),
            Quantity::VStarNX => Some(self.v_star_n_x),
        };
        found.unwrap_or_else(|| panic!("{quantity:?}: this run has none"))
    }
}
