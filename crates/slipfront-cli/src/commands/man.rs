//! `slipfront man`: manual pages.

use clap::{Args, Command};
use slipfront_run::program::VERSION;

use crate::failure::Failure;
use crate::print::print;

/// Print a manual page
///
/// Without a subcommand, prints the page of slipfront itself
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront man run | man -l -
  slipfront man > ~/.local/share/man/man1/slipfront.1
  slipfront man study merge > ~/.local/share/man/man1/slipfront-study-merge.1")]
pub(crate) struct ManCommand {
    /// Subcommand [default: slipfront itself]
    command: Vec<String>,
}

impl ManCommand {
    /// Prints the page; `all` is the description of the whole command line.
    pub(crate) fn execute(self, mut all: Command) -> Result<(), Failure> {
        all.build();
        let mut command = &all;
        for word in &self.command {
            let names: Vec<&str> = command.get_subcommands().map(Command::get_name).collect();
            command = command.find_subcommand(word).ok_or_else(|| {
                let sentence = match names.as_slice() {
                    [] => format!("`{}` has no subcommands", command.get_name()),
                    names => format!("there is no subcommand {word:?}: it can be {}", names.join(", ")),
                };
                Failure::input(sentence)
            })?;
        }
        let mut page = Vec::new();
        clap_mangen::Man::new(command.clone())
            .source(format!("slipfront {VERSION}"))
            .render(&mut page)
            .map_err(Failure::running)?;
        print(&String::from_utf8_lossy(&page))
    }
}
