//! The processes that run one command together.

mod traffic;

use std::path::Path;
use std::sync::Arc;

use slipfront::Communicator;
use slipfront::communicator::Alone;
use slipfront_base::machine::machine_number;
use slipfront_case::same_on_ranks::{NamedInputs, expect_same, of_all};
use slipfront_run::agree::{RankFailure, agree};
use slipfront_run::resume_command::resume_command;

use self::traffic::Traffic;
use crate::failure::Failure;

/// The ranks of a command, from the view of one of them.
///
/// The ranks agree on the outcome of each before they depend on each other, so that no rank waits for one
/// that has failed. A function that fails with [`RankFailure`] does so on every rank.
#[derive(Clone)]
pub(crate) struct CommandRanks {
    program: &'static str,
    communicator: Arc<Traffic>,
}

impl CommandRanks {
    /// The one rank of `slipfront`.
    pub(crate) fn alone() -> Self {
        Self::new("slipfront", Arc::new(Alone))
    }

    /// The ranks of a program.
    pub(crate) fn new(program: &'static str, communicator: Arc<dyn Communicator>) -> Self {
        let communicator = Arc::new(Traffic::count(communicator));
        Self {
            program,
            communicator,
        }
    }

    /// The connection between the ranks.
    pub(crate) fn communicator(&self) -> Arc<dyn Communicator> {
        Arc::clone(&self.communicator) as Arc<dyn Communicator>
    }

    /// Number of ranks on this machine, identified by its name.
    pub(crate) fn on_node(&self) -> usize {
        let own = machine_number();
        let machines = of_all(&*self.communicator, own).into_iter();
        machines.filter(|machine| *machine == own).count()
    }

    /// Number of ranks.
    pub(crate) fn size(&self) -> usize {
        self.communicator.size()
    }

    /// Whether this rank prints and writes the folder, the manifest and the pictures.
    pub(crate) fn is_first(&self) -> bool {
        self.communicator.rank() == 0
    }

    /// Returns the outcome of this rank, if all ranks have succeeded.
    pub(crate) fn agree<T>(&self, outcome: Result<T, Failure>) -> Result<T, RankFailure> {
        agree(&*self.communicator, outcome.map_err(RankFailure::from))
    }

    /// Fails unless all ranks have the same inputs.
    pub(crate) fn expect_same(&self, given: impl FnOnce() -> NamedInputs) -> Result<(), RankFailure> {
        let same = expect_same(&*self.communicator, given);
        same.map_err(|difference| Failure::input(difference).into())
    }

    /// Does work on the first rank only; returns none on the others.
    pub(crate) fn first<T>(
        &self,
        work: impl FnOnce() -> Result<T, Failure>,
    ) -> Result<Option<T>, RankFailure> {
        self.agree(self.is_first().then(work).transpose())
    }

    /// Whether `is_so` is true on any rank.
    pub(crate) fn any(&self, is_so: bool) -> bool {
        self.largest_of(f64::from(is_so)) > 0.0
    }

    /// The maximum of a value over the ranks.
    pub(crate) fn largest_of(&self, value: f64) -> f64 {
        let mut largest = [value];
        self.largest(&mut largest);
        largest[0]
    }

    /// Replaces every value by its maximum over the ranks.
    pub(crate) fn largest(&self, values: &mut [f64]) {
        self.communicator.largest(values);
    }

    /// The command that resumes the run in a folder.
    pub(crate) fn resume_command(&self, folder: &Path) -> String {
        resume_command(self.program, folder)
    }

    /// Description of the messages that this rank sends per step, over `steps` steps; none for a single rank.
    pub(crate) fn traffic(&self, steps: u64) -> Option<String> {
        (self.size() > 1 && steps > 0).then(|| self.communicator.per_step(steps))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use slipfront::testing::Threads;

    #[test]
    fn threads_are_on_one_machine() {
        for size in 1..4 {
            let of_rank = |rank: &Threads| CommandRanks::new("slipfront-mpi", Arc::new(rank.clone()));
            let found = Threads::run(size, |rank| of_rank(rank).on_node());
            assert_eq!(found, vec![size; size]);
        }
    }
}
