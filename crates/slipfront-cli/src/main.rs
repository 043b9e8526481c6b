//! The program `slipfront`.

use std::process::ExitCode;

/// Allocator of static programs. The allocator of musl returns memory to the system and requests it again,
/// 900 times in a run of 50 x 50 blocks.
#[cfg(target_env = "musl")]
#[global_allocator]
static ALLOCATOR: dlmalloc::GlobalDlmalloc = dlmalloc::GlobalDlmalloc;

fn main() -> ExitCode {
    ExitCode::from(slipfront_cli::main(std::env::args_os(), None))
}
