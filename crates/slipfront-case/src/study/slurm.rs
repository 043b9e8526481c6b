//! A batch script for Slurm: few tasks, each a shard that uses all cores of its node.

/// What a batch script is made for.
#[derive(Clone, Debug, PartialEq)]
pub struct Batch {
    /// Name of the job.
    pub name: String,
    /// Path of the study file, as the job will see it.
    pub study: String,
    /// Folder of the results; every task has one of its own in it.
    pub out: String,
    /// Number of tasks.
    pub tasks: usize,
}

/// The script. A task that is killed or requeued goes on where it was: finished runs are recorded and never
/// repeated.
pub fn script(batch: &Batch) -> String {
    let Batch {
        name,
        study,
        out,
        tasks,
    } = batch;
    let (study, out) = (quote(study), quote(out));
    let name: String = name
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '-' })
        .collect();
    format!(
        r#"#!/bin/bash
# {tasks} tasks, each a part of the points of the study on a node of its own.
# Submit it with `sbatch`; when all tasks are done, unite them with the last line of this file.
#SBATCH --job-name={name}
#SBATCH --array=1-{tasks}
#SBATCH --nodes=1
#SBATCH --ntasks=1
#SBATCH --exclusive
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=slurm-{name}-%a.log

set -eu
# --exclusive gives the whole node: all its cores are used, one run on each.
exec slipfront study {study} --shard slurm --out {out}/shard-"$SLURM_ARRAY_TASK_ID" \
  --threads "${{SLURM_CPUS_ON_NODE:-$(nproc)}}"

# slipfront study merge {out}/shard-* --out {out}/merged
"#
    )
}

/// A word for the shell.
fn quote(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_-./".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}
