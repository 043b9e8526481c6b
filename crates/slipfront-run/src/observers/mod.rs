//! The observers that only some runs have: each has its own file with its numbers, table and words, a row
//! here, and a field for its numbers in `summary.rs`.

pub mod cycles;
pub mod events;
mod observed;
pub mod precursors;

use serde::{Deserialize, Serialize};
use slipfront::Scales;
use slipfront::observe::{Cycles, Events, Precursors, Scheduled};
use slipfront_case::case::Case;

use self::observed::Observed;
pub(crate) use self::observed::Times;
pub use self::observed::{Table, TableColumns};
use crate::summary::Summary;

/// Makes the list of the observers, each under its name in the summary.
macro_rules! observers {
    ($($name:ident: $observer:ty,)*) => {
        /// The observers that only some runs have.
        #[derive(Clone, Debug, Serialize, Deserialize)]
        pub struct OptionalObservers {
            $(pub(crate) $name: Option<$observer>,)*
        }

        impl OptionalObservers {
            /// The observers of a run of this case, at its start.
            pub(crate) fn of_run(case: &Case) -> Self {
                Self { $($name: Observed::of_run(case),)* }
            }

            /// Whether the observers, at a checkpoint, can have begun as `new`.
            pub(crate) fn fit(&self, new: &Self, now: Times) -> bool {
                $(both(&self.$name, &new.$name, |old, new| old.fits(new, now)))&&*
            }

            pub(crate) fn scheduled(&mut self) -> impl Iterator<Item = Scheduled<'_>> {
                [$(self.$name.as_mut().map(|observer| Scheduled::always(observer))),*].into_iter().flatten()
            }

            /// Writes the numbers and warnings of the observers into a summary.
            pub(crate) fn write_into(&self, summary: &mut Summary) {
                $(
                    summary.$name = self.$name.as_ref().map(Observed::numbers);
                    summary.warnings.extend(self.$name.as_ref().and_then(Observed::warning));
                )*
            }

            /// The tables of the run, each with its content.
            ///
            /// # Errors
            /// When a row cannot be written as CSV.
            pub fn tables(&self, scales: &Scales) -> Result<Vec<(Table, Vec<u8>)>, csv::Error> {
                let tables = [$(table(&self.$name, scales)),*];
                tables.into_iter().flatten().collect()
            }
        }

        /// Every table that a run may have.
        pub fn tables() -> impl Iterator<Item = Table> {
            [$(<$observer>::TABLE),*].into_iter().flatten()
        }

        /// The numbers of the observers of a run as lines for a reader, each a name and a text.
        pub fn lines(summary: &Summary, case: &Case) -> impl Iterator<Item = (&'static str, String)> {
            [$(summary.$name.as_ref().map(|numbers| <$observer>::line(numbers, case))),*].into_iter().flatten()
        }

        /// The quantities of studies among the numbers of the observers: their names, and the values that a
        /// run has.
        pub fn quantities(summary: &Summary) -> Vec<(&'static str, Option<f64>)> {
            [$(quantities_of::<$observer>(summary.$name.as_ref())),*].concat()
        }
    };
}

observers! {
    precursors: Precursors,
    cycles: Cycles,
    events: Events,
}

/// Whether an observer that only some runs have fits one of a run that begins, or both do not exist.
pub(crate) fn both<O>(old: &Option<O>, new: &Option<O>, fits: impl FnOnce(&O, &O) -> bool) -> bool {
    match (old, new) {
        (Some(old), Some(new)) => fits(old, new),
        (old, new) => old.is_none() && new.is_none(),
    }
}

fn table<O: Observed>(observer: &Option<O>, scales: &Scales) -> Option<Result<(Table, Vec<u8>), csv::Error>> {
    let (observer, table) = (observer.as_ref()?, O::TABLE?);
    Some(observer.csv(scales).map(|contents| (table, contents)))
}

fn quantities_of<O: Observed>(numbers: Option<&O::Numbers>) -> Vec<(&'static str, Option<f64>)> {
    let quantities = O::QUANTITIES.iter();
    quantities
        .map(|(name, of)| (*name, numbers.and_then(of)))
        .collect()
}
