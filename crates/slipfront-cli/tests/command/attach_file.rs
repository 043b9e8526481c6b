//! A slider that is driven at the blocks listed in a file.

use std::thread::sleep;
use std::time::Duration;

use crate::support::process::{send, stderr, stdout};
use crate::support::workspace::Workspace;

/// A case with these lines in its table `[drive]`. It takes half a second: long enough to be stopped.
fn case(drive: &str) -> String {
    format!("[slider]\nblocks = [60, 50]\n[drive]\nv_star = 1\n{drive}\n[time]\nduration_star = 500\n")
}

const TOTAL: &str = "total_stiffness_star = 20";

/// A `.npy` file of 60 x 50 blocks; blocks with the `value` 1 are attached.
fn npy(value: impl Fn(usize, usize) -> i8) -> Vec<u8> {
    let mut bytes =
        b"\x93NUMPY\x01\x00\x46\x00{'descr': '|i1', 'fortran_order': False, 'shape': (50, 60), }".to_vec();
    bytes.resize(79, b' ');
    bytes.push(b'\n');
    bytes.extend(
        (0..50)
            .flat_map(|j| (0..60).map(move |i| (i, j)))
            .map(|(i, j)| value(i, j).cast_unsigned()),
    );
    bytes
}

fn workspace() -> Workspace {
    let workspace = Workspace::new();
    workspace.write("file.toml", case(&format!("attach_file = 'edge.npy'\n{TOTAL}")));
    workspace
}

/// A file that lists the blocks of an edge gives the same bits as that edge in `attach`, and a stiffness with
/// a unit the same bits as without one. The run is resumed with its own copy of the file.
#[cfg(unix)]
#[test]
fn a_file_attaches_as_an_edge_does() {
    let workspace = workspace();
    workspace.write("edge.npy", npy(|i, _| i8::from(i == 0)));
    workspace.succeed("run file.toml -o whole");
    let series = |folder: &str| workspace.read(&format!("{folder}/series.csv"));
    workspace.write("left.toml", case(&format!("attach = 'left'\n{TOTAL}")));
    workspace.succeed("run left.toml -o left");
    assert_eq!(series("whole"), series("left"));
    assert!(!workspace.exists("whole/precursors.csv"), "a file names no edge");
    // E l is 100 GPa times 1 um.
    workspace.write(
        "unit.toml",
        case("attach_file = 'edge.npy'\ntotal_stiffness = '2000 kN/m'"),
    );
    workspace.succeed("run unit.toml -o unit");
    assert_eq!(series("whole"), series("unit"));

    let child = workspace.start_run("run file.toml -o stopped");
    sleep(Duration::from_millis(20));
    send(&child, "-INT");
    let output = child.ended();
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    workspace.remove("edge.npy");
    workspace.succeed("run --resume stopped");
    workspace.assert_same_run("whole", "stopped");

    workspace.succeed("verify whole");
    assert!(
        workspace
            .read_text("whole/manifest.json")
            .contains("inputs/edge.npy")
    );
    workspace.write("whole/inputs/edge.npy", npy(|i, _| i8::from(i == 1)));
    let output = workspace.output("verify whole");
    assert_eq!(output.status.code(), Some(1));
    assert!(stdout(&output).contains("whole/inputs/edge.npy differs"));
}

#[test]
fn files_that_attach_no_blocks_are_refused() {
    let workspace = workspace();
    let refused = |words: &str| {
        let said = workspace.fail("run file.toml", 2);
        let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            said.contains("drive.attach_file") || said.contains("attach_file"),
            "{said}"
        );
        assert!(said.contains(words), "{words}: {said}");
    };
    refused("cannot read `edge.npy`");
    workspace.write("edge.npy", npy(|_, _| 0));
    refused("attaches no block");
    workspace.write("edge.npy", npy(|i, j| if (i, j) == (7, 3) { -1 } else { 1 }));
    refused("has -1 in row 3, column 7 (both counted from 0), but must be 0 or 1 (1 is a dark pixel)");
    let turned = String::from_utf8_lossy(&npy(|_, _| 1)[..80]).replace("(50, 60)", "(60, 50)");
    workspace.write(
        "edge.npy",
        [b"\x93".as_slice(), &turned.as_bytes()[3..], &[1; 3000]].concat(),
    );
    refused("(60, 50)");
    workspace.write("edge.npy", &npy(|_, _| 1)[..3000]);
    refused("edge.npy");
    assert_eq!(workspace.files(".").len(), 2, "something has been written");
}
