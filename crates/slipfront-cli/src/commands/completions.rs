//! `slipfront completions`: a script that completes command lines in a shell.

use clap::{Args, Command};
use clap_complete::Shell;

use crate::failure::Failure;
use crate::print::print;

/// Print completions for a shell
#[derive(Args)]
#[command(after_help = "Example:
  slipfront completions bash > ~/.local/share/bash-completion/completions/slipfront")]
pub(crate) struct CompletionsCommand {
    /// The shell
    shell: Shell,
}

impl CompletionsCommand {
    /// Prints the completions; `command` is the description of the whole command line.
    pub(crate) fn execute(self, mut command: Command) -> Result<(), Failure> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut command, "slipfront", &mut script);
        print(&String::from_utf8_lossy(&script))
    }
}
