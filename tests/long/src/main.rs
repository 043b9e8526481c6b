//! The program `slipfront`, for the tests of this package that start it: cargo tells a test only of programs
//! of its own package.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(slipfront_cli::main(std::env::args_os(), None))
}
