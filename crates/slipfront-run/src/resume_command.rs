//! The command that resumes an interrupted run, for messages.

use std::path::Path;

use slipfront_base::text::shell_path;

/// The command of a program, `slipfront` or `slipfront-mpi`, that resumes the run in a folder, quoted for a
/// shell.
pub fn resume_command(program: &str, folder: &Path) -> String {
    format!("{program} run --resume {}", shell_path(folder))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_suggested_command_can_be_typed() {
        let of = |name: &str| resume_command("slipfront", Path::new(name));
        assert_eq!(of("my run"), "slipfront run --resume 'my run'");
        assert_eq!(of("-o"), "slipfront run --resume ./-o");
    }
}
