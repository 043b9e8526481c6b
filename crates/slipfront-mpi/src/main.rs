//! The program `slipfront-mpi`.

use std::process::ExitCode;

fn main() -> ExitCode {
    slipfront_mpi::on_ranks(|ranks| slipfront_cli::main_on_ranks(std::env::args_os(), ranks).into())
}
