//! Every target on its seeds, on what fuzzing has found before, and on a fixed number of mutations of both.

// A helper that cannot do its work fails its test.
#![allow(clippy::unwrap_used)]

use std::process::Command;

use slipfront_fuzz::{Mutator, TARGETS, Target};

/// Runs a target on all of its inputs, in a process of its own since memory is measured for a whole process: there the test of this
/// name is run once more.
fn replay(name: &str) {
    const IS_ALONE: &str = "SLIPFRONT_TEST_IS_ALONE";
    if std::env::var_os(IS_ALONE).is_some() {
        return replay_here(name);
    }
    let mut again = Command::new(std::env::current_exe().unwrap());
    let done = again.args([name, "--exact"]).env(IS_ALONE, "").output().unwrap();
    let printed = String::from_utf8_lossy(&done.stdout);
    assert!(done.status.success() && printed.contains("1 passed"), "{printed}");
}

fn replay_here(name: &str) {
    let target = Target::named(name).unwrap();
    let inputs = [target.findings(), target.seeds()].concat();
    assert!(!inputs.is_empty(), "{name} has no seeds");
    for (name, bytes) in &inputs {
        run(target, bytes, name);
    }
    let seeds: Vec<Vec<u8>> = inputs.into_iter().map(|(_, bytes)| bytes).collect();
    let mut mutator = Mutator::new(1, &target.words(), target.max_bytes);
    for number in 0..target.mutations {
        run(target, &mutator.mutated(&seeds), &format!("mutation {number}"));
    }
    // Time or memory that grows with the square of the length is noticed only in long inputs.
    for number in 0..target.repetitions {
        run(
            target,
            &mutator.repeated(&seeds, LONG_BYTES),
            &format!("repetition {number}"),
        );
    }
}

/// Length of the long inputs, in bytes.
const LONG_BYTES: usize = 300_000;

fn run(target: &Target, bytes: &[u8], name: &str) {
    let failed = std::panic::catch_unwind(|| target.run(bytes)).is_err();
    assert!(
        !failed,
        "{} fails on {name}: {:?}",
        target.name,
        String::from_utf8_lossy(bytes)
    );
}

macro_rules! replay {
    ($($name:ident)*) => {
        $(#[test]
        fn $name() {
            replay(stringify!($name));
        })*

        #[test]
        fn every_target_is_replayed() {
            let names: Vec<&str> = TARGETS.iter().map(|target| target.name).collect();
            assert_eq!(names, [$(stringify!($name)),*]);
        }
    };
}

replay! {
    case_file
    case
    study_file
    quantity
    npy
    csv_table
    mask_png
    height_map
    records
    figure_cache
    checkpoint
    fields
    kymograph
    summary
    series
    precursors
    manifest
    journal
    plot
    requests
}
