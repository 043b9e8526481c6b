//! Errors of a case give a message and status 2, and nothing is written.

use crate::support::process::{program, send, stderr, wait_for_signal_handlers};
use crate::support::workspace::Workspace;

#[test]
fn bad_cases_are_refused_with_a_remedy() {
    let workspace = Workspace::small();
    for (text, words) in [
        (
            "[load]\npressur = '1 kPa'\n",
            &["unknown key `pressur`", "did you mean `pressure`?"][..],
        ),
        ("[lod]\n", &["did you mean", "[load]"]),
        (
            "[load]\npressure = 100\n",
            &["`load.pressure`", "has no unit", "bad.toml:2:"],
        ),
        ("[load]\npressure = '3 mm/s'\n", &["pressure", "speed"]),
        (
            "[drive]\nv_star = 0.1\nspeed = '1 mm/s'\n",
            &["`v_star`", "`speed`"],
        ),
        ("[drive]\nv_star = nan\n", &["`drive.v_star`"]),
        ("[drive\n", &["not valid TOML"]),
        (
            "study.replicates = 3\n",
            &["belongs in a study file", "`slipfront study`"],
        ),
        (
            "[base]\nslider.blocks = [9, 9]\n[design]\ncoverage = [0, 10]\n",
            &["belongs in a design file", "`slipfront design`", "bad.toml:3:"],
        ),
        (
            "[[texture]]\nshape = 'mask'\nfile = 'none.png'\n",
            &["none.png", "relative to the case file"],
        ),
        (
            "[[texture]]\nshape = 'groove'\nwidth = '25 um'\n",
            &["covers all 625 blocks"],
        ),
        ("[friction]\nlaw = 'literl'\n", &["did you mean \"literal\"?"]),
    ] {
        workspace.write("bad.toml", text);
        for command in ["run bad.toml", "check bad.toml", "texture bad.toml -o mask.png"] {
            let said = workspace.fail(command, 2);
            for word in words {
                assert!(said.contains(word), "{word:?} is missing for {text:?}:\n{said}");
            }
        }
    }
    assert_eq!(workspace.files(".").len(), 2, "something has been written");
}

/// Reading these files takes a second, and no command has finished when the signal arrives.
#[cfg(unix)]
#[test]
fn a_signal_ends_the_reading_of_any_file() {
    let workspace = Workspace::small();
    let npy = |kind: &str, side: usize| {
        let header = format!(
            "{{'descr': '{kind}', 'fortran_order': False, 'shape': ({side}, {side}), }}{:60}\n",
            ""
        );
        let length = (header.len() as u16).to_le_bytes();
        [&b"\x93NUMPY\x01\0"[..], &length, header.as_bytes()].concat()
    };
    workspace.write("mu.csv", format!("{}1\n", "1,".repeat(1999)).repeat(2000));
    workspace.write(
        "mu.npy",
        [npy("<f8", 2000), 1_f64.to_le_bytes().repeat(2000 * 2000)].concat(),
    );
    workspace.write("mask.npy", [npy("|b1", 8000), vec![0; 8000 * 8000]].concat());
    workspace.write("map.npy", [npy("|u1", 4000), vec![0; 4000 * 4000]].concat());
    workspace.write("map.csv", "# a comment\n".repeat(4_000_000));
    let map =
        |file: &str| format!("[[texture]]\nshape = 'height_map'\nfile = '{file}'\nbearing_percent = 50\n");
    for case in [
        "slider.blocks = [2000, 2000]\nfriction.mu_static_field = 'mu.csv'\n".to_owned(),
        "slider.blocks = [2000, 2000]\nload.pressure_field = 'mu.npy'\n".to_owned(),
        "slider = { blocks = [8000, 8000], outline = 'mask', outline_file = 'mask.npy' }\n".to_owned(),
        map("map.npy"),
        map("map.csv"),
    ] {
        workspace.write("large.toml", &case);
        for command in ["check large.toml", "run large.toml -o out"] {
            let child = workspace.start(command);
            wait_for_signal_handlers(&child);
            send(&child, "-INT");
            let output = child.ended();
            assert_eq!(
                output.status.code(),
                Some(130),
                "{command} {case}: {}",
                stderr(&output)
            );
            let said = "error: stopped while the case was prepared; nothing was written\n";
            assert_eq!(stderr(&output), said, "{command} {case}");
        }
    }
    assert!(!workspace.exists("out"));
}

#[test]
fn a_case_that_is_no_file_is_refused() {
    let workspace = Workspace::small();
    std::fs::create_dir(workspace.path("folder")).unwrap();
    workspace.write("binary.toml", [0xff, 0xfe, 0x00]);
    assert!(
        workspace
            .fail("run missing.toml", 2)
            .contains("cannot read missing.toml")
    );
    assert!(workspace.fail("run folder", 2).contains("is a folder"));
    assert!(workspace.fail("run binary.toml", 2).contains("not UTF-8"));
}

/// Text in UTF-16, with or without a byte order mark, is refused with the remedy.
#[test]
fn utf16_is_refused_by_its_name() {
    let workspace = Workspace::small();
    let text = "[slider]\nblocks = [5, 6]\n";
    let little: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let big: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
    for (mark, bytes) in [
        (&[0xff, 0xfe][..], &little),
        (&[], &little),
        (&[0xfe, 0xff], &big),
        (&[], &big),
    ] {
        workspace.write("wide.toml", [mark, bytes].concat());
        let said = workspace.fail("check wide.toml", 2);
        assert_eq!(
            said,
            "error: wide.toml is UTF-16 text, not UTF-8: save it again with the encoding UTF-8\n"
        );
    }
}

/// A key and its value are one word: if a shell has split them, the error names the word that was meant.
#[test]
fn divided_overrides_are_told() {
    let workspace = Workspace::small();
    for (command, meant) in [
        ("check --set drive.v_star 0.05", "drive.v_star=0.05"),
        ("run small.toml --set drive.v_star 0.05", "drive.v_star=0.05"),
        ("check --set drive.v_star = 0.05", "drive.v_star=0.05"),
        ("check --set drive.v_star= 0.05", "drive.v_star=0.05"),
        ("check --set drive.direction -30", "drive.direction=-30"),
        ("check --set=drive.v_star 0.05", "drive.v_star=0.05"),
        ("check --set slider.blocks=[50, 50]", "'slider.blocks=[50, 50]'"),
        (
            "check small.toml --set slider.blocks=[50, 50] --seed 2",
            "'slider.blocks=[50, 50]'",
        ),
    ] {
        let said = workspace.fail(command, 2);
        let end = format!(": --set {meant}\n");
        let or_quoted = format!(": put it in quotes, --set {meant}\n");
        assert!(
            said.ends_with(&end) || said.ends_with(&or_quoted),
            "{command}: {said}"
        );
    }
    // A case, another option and a missing word are not taken for a value.
    for command in [
        "check --set drive.v_star small.toml",
        "check --set drive.v_star --seed 2",
        "check --set drive.v_star",
        "check --set slider.blocks=[50,",
    ] {
        let said = workspace.fail(command, 2);
        assert!(
            !said.contains("one word") && !said.contains("in quotes"),
            "{command}: {said}"
        );
    }
}

/// Without a named case there is no file: errors refer to the command line, or only to the key.
#[test]
fn errors_of_the_baseline_show_no_line_of_a_file() {
    let workspace = Workspace::small();
    let said = workspace.fail(
        "check --set slider.blocks.0=60000 --set slider.blocks.1=60000 --set output.snapshots=[]",
        2,
    );
    assert!(
        said.starts_with("error: --set slider.blocks.1=60000: ") && said.contains("`slider.blocks`"),
        "{said}"
    );
    let said = workspace.fail(
        "run --set output.stride=9 --set drive.v_star=1e-6 --set time.step=1e-6",
        2,
    );
    assert!(!said.contains("baseline:"), "{said}");
}

/// Inputs must be files: reading a pipe could wait for ever, and a device never ends.
#[cfg(unix)]
#[test]
fn inputs_are_files() {
    let workspace = Workspace::small();
    std::fs::create_dir(workspace.path("folder.csv")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", workspace.path("device.csv")).unwrap();
    for name in ["folder.csv", "device.csv"] {
        let said = workspace.fail(
            &format!("run small.toml --set friction.mu_static_field={name}"),
            2,
        );
        assert!(
            said.contains(&format!("{name}`: it is not a regular file")),
            "{said}"
        );
    }
}

/// The copy of an input is limited to the bytes that its lattice can need, however long the file is.
#[test]
fn inputs_are_no_longer_than_their_lattice_needs() {
    let workspace = Workspace::small();
    let mut npy =
        b"\x93NUMPY\x01\x00\x46\x00{'descr': '|u1', 'fortran_order': False, 'shape': (5, 6), }".to_vec();
    npy.resize(79, b' ');
    npy.push(b'\n');
    npy.extend([1; 30]);
    workspace.write("mu.npy", &npy);
    workspace.succeed("check small.toml --set friction.mu_static_field=mu.npy");
    let file = std::fs::OpenOptions::new()
        .write(true)
        .open(workspace.path("mu.npy"))
        .unwrap();
    file.set_len(1 << 40).unwrap();
    let said = workspace.fail("run small.toml --set friction.mu_static_field=mu.npy", 2);
    assert!(
        said.contains("1099511627776 bytes where 5 rows of 6 numbers take at most 10240"),
        "{said}"
    );
}

#[test]
fn what_no_machine_holds_is_refused_in_a_sentence() {
    let workspace = Workspace::small();
    let long = "--set time.step=0.01 --set time.duration_star=3.9e7";
    for (sets, word) in [
        (
            "--set slider.blocks=[100000,40000] --set output.snapshots=[]",
            "for 4000000000 blocks",
        ),
        (&format!("{long} --set output.series=0.01"), "rows of the series"),
        (
            &format!("{long} --set output.snapshots={{every=0.01}} --set output.fields=[]"),
            "snapshots of 0 fields",
        ),
    ] {
        for command in ["check", "run"] {
            let said = workspace.fail(&format!("{command} small.toml {sets}"), 2);
            assert!(said.contains("iB of memory") && said.contains(word), "{said}");
        }
    }
    assert!(!workspace.exists("results"));
    let groove = "texture.0={shape=\"groove\",width=\"1um\",offset=\"1m\"}";
    let said = workspace.fail(&format!("check small.toml --set {groove}"), 2);
    assert!(said.contains("check its units"), "{said}");
}

/// A memory limit of the process is reported in an error message: the process may have less memory than the
/// machine.
#[cfg(target_os = "linux")]
#[test]
fn a_limit_of_the_process_is_refused_in_a_sentence() {
    let workspace = Workspace::small();
    // The process itself takes less than 1 GB, including its threads' stacks.
    for (blocks, status) in [("[300,300]", 0), ("[16000,1000]", 2)] {
        let output = workspace.shell(&format!(
            "ulimit -v 2000000; exec {} check small.toml --set slider.blocks={blocks}",
            program()
        ));
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(status), "{said}");
        // The threads of many cores leave less than a GiB.
        assert!(status == 0 || said.contains("iB are available"), "{said}");
    }
}

#[test]
fn bad_overrides_are_refused() {
    let workspace = Workspace::small();
    for (set, word) in [
        ("drive.sped=1", "did you mean `speed`?"),
        ("drive.v_star", "="),
        ("texture.3.coverage=5", "texture"),
        ("friction.seed=9223372036854775808", "seed"),
    ] {
        let said = workspace.fail(&format!("run small.toml --set {set}"), 2);
        assert!(said.contains(word) && said.contains("--set"), "{word:?}: {said}");
    }
    assert!(
        workspace
            .fail("run small.toml --seed 18446744073709551615", 2)
            .contains("seed")
    );
    assert!(!workspace.exists("results"));
}
