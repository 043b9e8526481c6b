//! The program `slipfront`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(slipfront_cli::main(std::env::args_os(), None))
}
