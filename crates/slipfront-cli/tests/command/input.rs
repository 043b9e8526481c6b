//! What is wrong with a case is said in a sentence, with status 2, and nothing is written.

use super::Bench;

#[test]
fn bad_cases_are_refused_with_a_remedy() {
    let bench = Bench::new();
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
            "[[texture]]\nshape = 'mask'\nfile = 'none.png'\n",
            &["none.png", "relative to the case file"],
        ),
        (
            "[[texture]]\nshape = 'groove'\nwidth = '25 um'\n",
            &["covers all 625 blocks"],
        ),
        ("[friction]\nlaw = 'literl'\n", &["did you mean \"literal\"?"]),
    ] {
        bench.write("bad.toml", text);
        for command in ["run bad.toml", "check bad.toml", "texture bad.toml -o mask.png"] {
            let said = bench.refused(command, 2);
            for word in words {
                assert!(said.contains(word), "{word:?} is missing for {text:?}:\n{said}");
            }
        }
    }
    assert_eq!(bench.files(".").len(), 2, "something has been written");
}

#[test]
fn a_case_that_is_no_file_is_refused() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path().join("folder")).unwrap();
    bench.write("binary.toml", [0xff, 0xfe, 0x00]);
    assert!(
        bench
            .refused("run missing.toml", 2)
            .contains("cannot read missing.toml")
    );
    assert!(bench.refused("run folder", 2).contains("is a folder"));
    assert!(bench.refused("run binary.toml", 2).contains("not UTF-8"));
}

/// A pipe would be waited for, and a device never ends.
#[cfg(unix)]
#[test]
fn inputs_are_files() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path().join("folder.csv")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", bench.path().join("device.csv")).unwrap();
    for name in ["folder.csv", "device.csv"] {
        let said = bench.refused(
            &format!("run small.toml --set friction.mu_static_field={name}"),
            2,
        );
        assert!(
            said.contains(&format!("{name}`: it is not a regular file")),
            "{said}"
        );
    }
}

/// The copy of an input takes no more than what can be meant, whatever follows it in the file.
#[test]
fn inputs_are_no_longer_than_their_lattice_needs() {
    let bench = Bench::new();
    let mut npy =
        b"\x93NUMPY\x01\x00\x46\x00{'descr': '|u1', 'fortran_order': False, 'shape': (5, 6), }".to_vec();
    npy.resize(79, b' ');
    npy.push(b'\n');
    npy.extend([1; 30]);
    bench.write("mu.npy", &npy);
    bench.done("check small.toml --set friction.mu_static_field=mu.npy");
    let file = std::fs::OpenOptions::new()
        .write(true)
        .open(bench.path().join("mu.npy"))
        .unwrap();
    file.set_len(1 << 40).unwrap();
    let said = bench.refused("run small.toml --set friction.mu_static_field=mu.npy", 2);
    assert!(
        said.contains("1099511627776 bytes where 5 rows of 6 numbers take at most 10240"),
        "{said}"
    );
}

#[test]
fn what_no_machine_holds_is_refused_in_a_sentence() {
    let bench = Bench::new();
    let long = "--set time.step=0.01 --set time.duration_star=1e9";
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
            let said = bench.refused(&format!("{command} small.toml {sets}"), 2);
            assert!(said.contains("iB of memory") && said.contains(word), "{said}");
        }
    }
    assert!(!bench.exists("results"));
    let groove = "texture.0={shape=\"groove\",width=\"1um\",offset=\"1m\"}";
    let said = bench.refused(&format!("check small.toml --set {groove}"), 2);
    assert!(said.contains("look at its units"), "{said}");
}

/// What the machine has is not what the process may have.
#[cfg(target_os = "linux")]
#[test]
fn a_limit_of_the_process_is_refused_in_a_sentence() {
    let bench = Bench::new();
    // A million blocks take some 200 MB with their snapshots; the process itself less than 1 GB, its threads' stacks included.
    for (blocks, status) in [("[1000,1000]", 0), ("[16000,1000]", 2)] {
        let script = format!(
            "ulimit -v 2000000; exec {} check small.toml --set slider.blocks={blocks}",
            super::program()
        );
        let output = std::process::Command::new("sh")
            .args(["-c", &script])
            .env("RAYON_NUM_THREADS", "2")
            .current_dir(bench.path())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{said}");
        assert!(status == 0 || said.contains("see `ulimit -v`"), "{said}");
    }
}

#[test]
fn bad_overrides_are_refused() {
    let bench = Bench::new();
    for (set, word) in [
        ("drive.sped=1", "did you mean `speed`?"),
        ("drive.v_star", "="),
        ("texture.3.coverage=5", "texture"),
        ("friction.seed=9223372036854775808", "seed"),
    ] {
        let said = bench.refused(&format!("run small.toml --set {set}"), 2);
        assert!(said.contains(word) && said.contains("--set"), "{word:?}: {said}");
    }
    assert!(
        bench
            .refused("run small.toml --seed 18446744073709551615", 2)
            .contains("seed")
    );
    assert!(!bench.exists("results"));
}
