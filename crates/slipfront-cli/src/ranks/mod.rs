//! The processes that run one command together.

mod traffic;

use std::path::Path;
use std::sync::Arc;

use slipfront::Communicator;
use slipfront::communicator::Alone;
use slipfront_base::machine::machine_number;
use slipfront_case::same::{NamedInputs, expect_same, of_all};
use slipfront_run::agree::{RankFailure, agree};
use slipfront_run::resume_command::resume_command;

use self::traffic::Traffic;
use crate::failure::Failure;

/// The ranks of a command, as one of them sees them.
///
/// The ranks agree on the findings of each before they need each other, so that no rank waits for one that
/// has given up. Functions that end with [`RankFailure`] end so on every rank.
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

    /// Connection by which the ranks talk.
    pub(crate) fn communicator(&self) -> Arc<dyn Communicator> {
        Arc::clone(&self.communicator) as Arc<dyn Communicator>
    }

    /// Number of ranks on this machine, by its name.
    pub(crate) fn on_node(&self) -> usize {
        let own = machine_number();
        let machines = of_all(&*self.communicator, own).into_iter();
        machines.filter(|machine| *machine == own).count()
    }

    /// Number of ranks.
    pub(crate) fn size(&self) -> usize {
        self.communicator.size()
    }

    /// Whether this rank prints, and makes the folder, the manifest and the pictures, of which there is one.
    pub(crate) fn is_first(&self) -> bool {
        self.communicator.rank() == 0
    }

    /// Outcome of this rank, if all have succeeded.
    pub(crate) fn agree<T>(&self, outcome: Result<T, Failure>) -> Result<T, RankFailure> {
        agree(&*self.communicator, outcome.map_err(RankFailure::from))
    }

    /// Fails unless all ranks were given the same inputs.
    pub(crate) fn expect_same(&self, given: impl FnOnce() -> NamedInputs) -> Result<(), RankFailure> {
        let same = expect_same(&*self.communicator, given);
        same.map_err(|difference| Failure::input(difference).into())
    }

    /// Work of the first rank alone; none on the others.
    pub(crate) fn first<T>(
        &self,
        work: impl FnOnce() -> Result<T, Failure>,
    ) -> Result<Option<T>, RankFailure> {
        self.agree(self.is_first().then(work).transpose())
    }

    /// Whether `is_so` is true on any rank.
    pub(crate) fn any(&self, is_so: bool) -> bool {
        let mut largest = [f64::from(is_so)];
        self.largest(&mut largest);
        largest[0] > 0.0
    }

    /// Replaces every value by the largest that any rank has in its place.
    pub(crate) fn largest(&self, values: &mut [f64]) {
        self.communicator.largest(values);
    }

    /// The command that goes on with the run in a folder.
    pub(crate) fn resume_command(&self, folder: &Path) -> String {
        resume_command(self.program, folder)
    }

    /// Description of the messages of this rank to the others per step, over `steps` steps; none for one
    /// rank.
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
