//! A disk that is too small for the files of a command: the command reports it and leaves only complete
//! files. With more space it continues to the same answer.

use std::process::Command;

use crate::jobs::{JOBS, expect_all, workspace};
use crate::tally::{Chance, Tally, cases};

/// Page size of memory, which is the unit of the size of such a disk.
const PAGE_BYTES: usize = 4096;

/// Whether a disk can be mounted, which takes rights that few users have.
fn can_mount() -> bool {
    let mount = "mount -t tmpfs -o size=4k tmpfs /mnt";
    let mounted = Command::new("unshare")
        .args(["--mount", "sh", "-c", mount])
        .output();
    mounted.is_ok_and(|output| output.status.success())
}

#[test]
fn a_full_disk_is_said_and_spoils_nothing() {
    if !can_mount() {
        eprintln!("SKIPPED: no right to mount a disk: none is full in this test");
        return;
    }
    let workspace = workspace();
    let mut tally = Tally::new("full disks");
    let mut chance = Chance::new();
    for job in &JOBS {
        let whole = job.undisturbed();
        // A repeated run writes only temporary files.
        let (place, written) = match whole.is_empty() {
            true => ("temporary", JOBS[0].undisturbed()),
            false => ("out", whole.clone()),
        };
        let pages = |bytes: &Vec<u8>| bytes.len().div_ceil(PAGE_BYTES);
        let most: usize = written.values().map(pages).sum();
        job.prepare(&workspace);
        let given = workspace.files_if_any("out");
        let least: usize = given.values().map(pages).sum();
        let sizes = (least + 1..=most).map(|pages| format!("size={}", pages * PAGE_BYTES));
        // The folder itself also counts.
        let counts = (given.len() + 2..=written.len() + 4).map(|files| format!("size=64m,nr_inodes={files}"));
        let disks: Vec<String> = sizes.chain(counts).collect();
        let tried = cases(2, disks.len());
        for disk in chance.some(disks, tried) {
            job.prepare(&workspace);
            for folder in ["disk", "left"] {
                workspace.remove(folder);
            }
            for folder in ["disk", place] {
                std::fs::create_dir_all(workspace.path(folder)).unwrap();
            }
            // A mount in its own namespace disappears by itself.
            let script = format!(
                "mount -t tmpfs -o {disk} tmpfs disk && cp -R {place}/. disk && mount --bind disk {place} || exit 77
                 \"$@\"
                 status=$?
                 cp -R disk/. left
                 exit $status"
            );
            let watcher = ["unshare", "--mount", "sh", "-c", &script, "sh"];
            let ended = workspace.run_watched(&watcher, job.line).and_then(|ended| {
                if place == "out" {
                    workspace.remove("out");
                    std::fs::rename(workspace.path("left"), workspace.path("out")).unwrap();
                }
                let ended = ended.ok_or("it was killed")?;
                let said = format!("{}{}", ended.stdout, ended.stderr);
                let outcome = match ended.status {
                    0 => expect_all(&workspace.files_if_any("out"), &whole).map(|()| "has room")?,
                    _ if said.contains("No space left on device") || said.contains(" free in ") => "refused",
                    _ => return Err(format!("the cause is not said: {said}")),
                };
                job.expect_honest(&workspace, &whole)?;
                job.finish(&workspace, &whole)?;
                Ok(outcome)
            });
            tally.note(job.name, &disk, ended);
        }
    }
    tally.close();
}
