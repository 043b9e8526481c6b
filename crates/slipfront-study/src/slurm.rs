//! A batch script for Slurm: an array of tasks, each of which runs a shard on all cores of a node.

use std::path::PathBuf;

use slipfront_base::number_format::count;
use slipfront_base::text::shell_path;

/// The contents of a batch script.
#[derive(Clone, Debug, PartialEq)]
pub struct Batch {
    /// Name of the job.
    pub name: String,
    /// Path of the command, as the job will see it.
    pub command: PathBuf,
    /// Path of the study file, as the job will see it.
    pub study: PathBuf,
    /// Folder of the results; every task has its own subfolder.
    pub out: PathBuf,
    /// Number of tasks.
    pub tasks: usize,
}

/// The text of a batch script.
pub fn script(batch: &Batch) -> String {
    let [command, study, out] = [&batch.command, &batch.study, &batch.out].map(|path| shell_path(path));
    let name = batch.name.replace(|c: char| !c.is_ascii_alphanumeric(), "-");
    let (tasks, all) = (batch.tasks, count(batch.tasks, "task"));
    format!(
        r#"#!/bin/bash
# {all}, each a part of the points of the study on a node of its own. Submit this file with `sbatch`, and
# add what your cluster asks for there, such as --time and --account. A task that is killed or requeued goes on
# where it was: finished runs are recorded and never repeated. When all are done, unite them:
#
#   {command} study merge {out}/shard-* --out {out}/merged
#
#SBATCH --job-name={name}
#SBATCH --array=1-{tasks}
#SBATCH --nodes=1
#SBATCH --ntasks=1
#SBATCH --exclusive
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=slurm-{name}-%a.log

# --exclusive gives the whole node: all its cores are used, one run on each. The number of parts stands here in
# figures, so that a single task that is submitted again is the same part.
exec {command} study {study} --yes --shard "$SLURM_ARRAY_TASK_ID/{tasks}" --out {out}/shard-"$SLURM_ARRAY_TASK_ID" \
  --threads "${{SLURM_CPUS_ON_NODE:-$(nproc)}}"
"#
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_words_of_the_shell() {
        let script = script(&Batch {
            name: "my study".to_owned(),
            command: "/opt/slipfront".into(),
            study: "/data/it's mine/study.toml".into(),
            out: "/data/out".into(),
            tasks: 3,
        });
        assert!(
            script.contains(r#"study "/data/it's mine/study.toml" --yes"#),
            "{script}"
        );
        assert!(script.contains("#SBATCH --job-name=my-study\n#SBATCH --array=1-3\n"));
    }
}
