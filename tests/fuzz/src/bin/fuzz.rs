//! Runs libFuzzer on the target that `SLIPFRONT_FUZZ` names: see `run.sh`.

#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use slipfront_fuzz::Target;

static TARGET: LazyLock<&Target> = LazyLock::new(|| {
    let name = std::env::var("SLIPFRONT_FUZZ").unwrap_or_default();
    match slipfront_fuzz::named(&name) {
        Some(target) => target,
        None => panic!("SLIPFRONT_FUZZ = {name:?} names no target"),
    }
});

fuzz_target!(|input: &[u8]| TARGET.run(input));
