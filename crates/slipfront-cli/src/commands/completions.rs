//! `slipfront completions`: for the shell.

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use super::print;
use crate::Cli;
use crate::failure::Failure;

/// Print completions for a shell
#[derive(Args)]
#[command(after_help = "Example:
  slipfront completions bash > ~/.local/share/bash-completion/completions/slipfront")]
pub(crate) struct Completions {
    /// The shell
    shell: Shell,
}

impl Completions {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut Cli::command(), "slipfront", &mut script);
        print(&String::from_utf8_lossy(&script))
    }
}
