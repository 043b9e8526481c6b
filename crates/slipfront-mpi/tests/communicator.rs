//! Communication between ranks: messages reach the right rank, and no rank waits for one that has failed.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

mod support;

use std::process::{Command, ExitCode};
use std::sync::Arc;
use std::thread;

use rstest::rstest;
use slipfront::Communicator;
use slipfront_mpi::{MpiCommunicator, on_ranks};
use slipfront_run::agree::{RankFailure, agree};

use crate::support::{output, printed, ranks_of_test};

/// Runs a check on every rank, in a process that mpirun has started for it.
fn check_ranks(check: impl FnOnce(&MpiCommunicator)) {
    on_ranks(|ranks: Arc<MpiCommunicator>| {
        check(&ranks);
        ExitCode::SUCCESS
    });
}

#[rstest]
fn what_ranks_tell_each_other_is_right(
    #[values(1, 2, 3, 4)] ranks: usize,
    #[values("exchange", "largest_and_sum", "agreement", "one_thread")] check: &str,
) {
    let output = output(&mut ranks_of_test(ranks, &format!("rank_{check}")));
    assert!(output.status.success(), "{}", printed(&output));
    let passed = printed(&output).matches("1 passed").count();
    assert_eq!(passed, ranks, "{}", printed(&output));
}

/// Values of a message, from its sender, round, direction and length.
fn message(rank: usize, round: usize, upwards: bool, length: usize) -> Vec<f64> {
    let head = (rank * 1000 + round * 10 + usize::from(upwards)) as f64;
    (0..length).map(|k| head + k as f64 / length as f64).collect()
}

#[test]
#[ignore = "runs under mpirun"]
fn rank_exchange() {
    check_ranks(|ranks| {
        let (rank, size) = (ranks.rank(), ranks.size());
        let [below, above] = [(rank + size - 1) % size, (rank + 1) % size];
        // Empty messages in one or both directions, and messages below and above the length from which on MPI
        // waits for the receiver.
        let lengths = [
            [1, 1],
            [3, 7],
            [0, 5],
            [5, 0],
            [0, 0],
            [200, 200],
            [100_000, 70_000],
        ];
        for (round, [down, up]) in lengths.into_iter().cycle().take(50).enumerate() {
            let to = [message(rank, round, false, down), message(rank, round, true, up)];
            let mut from = [vec![f64::NAN; up], vec![f64::NAN; down]];
            let [from_below, from_above] = &mut from;
            let mut between = 0;
            ranks.exchange([&to[0], &to[1]], [from_below, from_above], &mut || between += 1);
            assert_eq!(between, 1);
            assert_eq!(from[0], message(below, round, true, up));
            assert_eq!(from[1], message(above, round, false, down));
        }
    });
}

#[test]
#[ignore = "runs under mpirun"]
fn rank_largest_and_sum() {
    check_ranks(|ranks| {
        let (rank, size) = (ranks.rank() as f64, ranks.size() as f64);
        let mut largest = [rank, -rank, f64::NEG_INFINITY, 5.0];
        ranks.largest(&mut largest);
        assert_eq!(largest, [size - 1.0, 0.0, f64::NEG_INFINITY, 5.0]);

        let size = size as i64;
        let mut sum = [1, -1, i64::MAX, i64::MIN];
        ranks.sum(&mut sum);
        let wrapped = [i64::MAX, i64::MIN].map(|value| value.wrapping_mul(size));
        assert_eq!(sum, [size, -size, wrapped[0], wrapped[1]]);
        ranks.largest(&mut []);
        ranks.sum(&mut []);
    });
}

#[test]
#[ignore = "runs under mpirun"]
fn rank_agreement() {
    check_ranks(|ranks| {
        let (rank, size) = (ranks.rank(), ranks.size());
        // Every subset of the ranks fails.
        for failing in 0..1_usize << size {
            let fails = failing >> rank & 1 == 1;
            let failure = RankFailure {
                status: 100 + rank as u8,
                sentence: format!("no room \u{2014} on disk {rank}"),
            };
            let agreed = agree(ranks, if fails { Err(failure) } else { Ok(rank) });
            let lowest = failing.trailing_zeros() as usize;
            let prefix = match lowest {
                0 => String::new(),
                _ => format!("rank {lowest}: "),
            };
            let expected = match failing {
                0 => Ok(rank),
                _ => Err(RankFailure {
                    status: 100 + lowest as u8,
                    sentence: format!("{prefix}no room \u{2014} on disk {lowest}"),
                }),
            };
            assert_eq!(agreed, expected);
        }
    });
}

#[test]
#[ignore = "runs under mpirun"]
fn rank_one_thread() {
    check_ranks(|ranks| {
        let elsewhere = thread::scope(|scope| scope.spawn(|| ranks.sum(&mut [1])).join());
        let sentence = elsewhere.unwrap_err().downcast::<String>().unwrap();
        assert!(
            sentence.contains("only the thread that initialized MPI"),
            "{sentence}"
        );
    });
}

/// The last rank fails while the others wait for it.
#[rstest]
#[case::panic("rank_panics", "the last rank gives up")]
#[case::kill("rank_is_killed", "signal 9")]
fn the_end_of_one_rank_is_the_end_of_all(
    #[values(1, 2, 3, 4)] ranks: usize,
    #[case] test: &str,
    #[case] sentence: &str,
) {
    let output = output(&mut ranks_of_test(ranks, test));
    let printed = printed(&output);
    // No rank has waited until the `--timeout` of mpirun.
    assert!(!printed.contains("mpirun --timeout"), "{printed}");
    assert!(!output.status.success(), "{printed}");
    assert_eq!(printed.matches(sentence).count(), 1, "{printed}");
    assert_eq!(printed.matches("passed").count(), 0, "{printed}");
}

/// Calls `give_up` on the last rank after some messages; the other ranks continue for ever.
fn give_up_on_last_rank(give_up: impl Fn()) {
    check_ranks(|ranks| {
        for round in 0_u64.. {
            if round == 10 && ranks.rank() + 1 == ranks.size() {
                give_up();
            }
            ranks.exchange([&[1.0], &[2.0]], [&mut [0.0], &mut [0.0]], &mut || {});
        }
    });
}

#[test]
#[ignore = "runs under mpirun"]
fn rank_panics() {
    give_up_on_last_rank(|| panic!("the last rank gives up"));
}

#[test]
#[ignore = "runs under mpirun"]
fn rank_is_killed() {
    give_up_on_last_rank(|| {
        let mut kill = Command::new("kill");
        let _ = kill.args(["-KILL", &std::process::id().to_string()]).status();
    });
}
