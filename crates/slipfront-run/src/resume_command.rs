//! The command that goes on with an interrupted run, for messages.

use std::path::Path;

use slipfront_case::text::{display_path, shell_quoted};

/// The command of a program, `slipfront` or `slipfront-mpi`, that goes on with the run in a folder, as a shell reads it.
pub fn resume_command(program: &str, folder: &Path) -> String {
    let mut folder = display_path(folder);
    // Else it would be taken for an option.
    if folder.starts_with('-') {
        folder.insert_str(0, "./");
    }
    format!("{program} run --resume {}", shell_quoted(&folder))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_suggested_command_can_be_typed() {
        let of = |name: &str| resume_command("slipfront", Path::new(name));
        assert_eq!(of("results/a-1"), "slipfront run --resume results/a-1");
        assert_eq!(of("my run"), "slipfront run --resume 'my run'");
        assert_eq!(of("$HOME"), "slipfront run --resume '$HOME'");
        assert_eq!(of("-o"), "slipfront run --resume ./-o");
    }
}
