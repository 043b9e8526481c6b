//! Shards: a study is divided into parts that are run on different machines.

use std::fmt;
use std::str::FromStr;

use crate::error::StudyError;
use slipfront_base::text::truncated;

/// Part `number` of `count`, counted from 1. A shard contains every `count`-th point, so that all shards have
/// nearly equal sizes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    number: usize,
    count: usize,
}

impl Shard {
    /// Whether the shard holds the point with this index.
    pub fn holds(self, index: usize) -> bool {
        index % self.count == self.number - 1
    }

    /// The shard of a task of a Slurm array, from its environment.
    fn of_slurm(given: &str) -> Result<Self, StudyError> {
        let read = |name: &str| -> Result<usize, StudyError> {
            let value = std::env::var(name)
                .map_err(|_| refused(given, format!("{name} is not set: this is not an array task")))?;
            let number = value.parse();
            number.map_err(|_| refused(given, format!("{name} = {value} is not a number")))
        };
        // The first index of an array may be any number.
        let first = read("SLURM_ARRAY_TASK_MIN").unwrap_or(1);
        let number = read("SLURM_ARRAY_TASK_ID")?
            .saturating_add(1)
            .saturating_sub(first);
        let count = read("SLURM_ARRAY_TASK_COUNT")?;
        if read("SLURM_ARRAY_TASK_MAX")
            .is_ok_and(|last| last.saturating_add(1) != first.saturating_add(count))
        {
            let why = "the indices of the array have gaps, so that they name no parts";
            return Err(refused(given, why.to_owned()));
        }
        Self::new(number, count, given)
    }

    fn new(number: usize, count: usize, given: &str) -> Result<Self, StudyError> {
        if (1..=count).contains(&number) {
            Ok(Self { number, count })
        } else {
            Err(refused(given, format!("there is no part {number} of {count}")))
        }
    }
}

fn refused(given: &str, why: String) -> StudyError {
    let given = truncated(given);
    StudyError::Shard { given, why }
}

impl FromStr for Shard {
    type Err = StudyError;

    fn from_str(given: &str) -> Result<Self, StudyError> {
        if given == "slurm" {
            return Self::of_slurm(given);
        }
        let no_numbers = || refused(given, "it is not two numbers".to_owned());
        let (number, count) = given.split_once('/').ok_or_else(no_numbers)?;
        let read = |text: &str| text.trim().parse().map_err(|_| no_numbers());
        Self::new(read(number)?, read(count)?, given)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_hold_every_point_once() {
        let shards: Vec<Shard> = (1..=3).map(|k| format!("{k}/3").parse().unwrap()).collect();
        for index in 0..20 {
            assert_eq!(shards.iter().filter(|shard| shard.holds(index)).count(), 1);
        }
        for wrong in ["0/3", "4/3", "1", "a/b", "1/0"] {
            assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        }
    }
}
