//! `slipfront texture`: a mask that is written and read back is the same texture, and outlines can be written
//! too.

use crate::fixtures::{MASKED, SMALL};
use crate::support::process::{send, stderr, wait_for_signal_handlers};
use crate::support::workspace::Workspace;

/// An array that takes long to mesh: combs of 5000 teeth over all rows, on top of each other.
fn long() -> String {
    let tooth = |k: usize| {
        let x = k as f64 * 0.038;
        format!("['{x:.3} um', '0 um'], ['{:.3} um', '190 um'], ", x + 0.019)
    };
    let teeth: String = (0..5000).map(tooth).collect();
    format!(
        "slider.blocks = [200, 200]\n[[texture]]\nshape = 'polygon'\npoints = [{teeth}['190 um', '-1 um'], ['0 um', '-1 um']]\n\
         array = [22, 22]\n"
    )
}

/// A signal ends a texture that takes long.
#[cfg(unix)]
#[test]
fn a_signal_ends_a_texture_that_takes_long() {
    let workspace = Workspace::small();
    workspace.write("long.toml", long());
    for command in [
        "check long.toml",
        "run long.toml",
        "texture long.toml -o long.png",
    ] {
        let child = workspace.start(command);
        wait_for_signal_handlers(&child);
        send(&child, "-INT");
        let output = child.ended();
        assert_eq!(output.status.code(), Some(130), "{command}: {}", stderr(&output));
        assert_eq!(
            stderr(&output),
            "error: stopped while the case was prepared; nothing was written\n"
        );
    }
    assert_eq!(workspace.files(".").len(), 2);
}

#[test]
fn a_mask_read_back_is_the_same_texture() {
    let workspace = Workspace::small();
    // The texture has no symmetry that could hide a mirrored picture.
    let cavity =
        "[[texture]]\nshape = 'cavity'\ncoverage = 20\ncenter = ['2 um', '1 um']\nw = 0.3\nrotate = 20\n";
    workspace.write("cavity.toml", format!("{SMALL}{cavity}"));
    let said = workspace.succeed("texture cavity.toml -o mask.png");
    assert!(
        said.contains("% of the blocks, 20 % asked") && said.ends_with("mask.png\n"),
        "{said}"
    );
    workspace.write(
        "mask.toml",
        format!("{SMALL}[[texture]]\nshape = 'mask'\nfile = 'mask.png'\n"),
    );
    workspace.succeed("run cavity.toml -o a");
    workspace.succeed("run mask.toml -o b");
    for name in ["series.csv", "fields.nc", "stress.png"] {
        assert!(
            workspace.read(&format!("a/{name}")) == workspace.read(&format!("b/{name}")),
            "{name}"
        );
    }
    let percent = |folder: &str| workspace.summary(folder)["texture_percent"].as_f64().unwrap();
    assert_eq!(percent("a"), percent("b"));
    assert!(percent("a") > 5.0, "nothing is textured");
}

#[test]
fn a_picture_is_replaced_only_by_force() {
    let workspace = Workspace::small();
    workspace.write("mask.png", "mine");
    assert!(
        workspace
            .fail("texture small.toml -o mask.png", 2)
            .contains("--force")
    );
    assert_eq!(workspace.read("mask.png"), b"mine");
    workspace.succeed("texture small.toml -o mask.png --force");
    assert_eq!(workspace.read("mask.png")[1..4], *b"PNG");
    workspace.fail("texture small.toml -o no/such/folder/mask.png", 1);
    // Even --force does not replace a file that the case reads.
    workspace.write("masked.toml", MASKED.replace("spot.png", "mask.png"));
    let said = workspace.fail("texture masked.toml -o mask.png --force", 2);
    assert!(
        said.contains("would replace mask.png, an input of the case"),
        "{said}"
    );
    let said = workspace.fail("texture small.toml -o mask.jpg", 2);
    assert!(
        said.contains("use the extension .svg or .dxf for outlines, .png for a picture"),
        "{said}"
    );
}

/// Every format can be written, with the smallest lengths and a note if blocks are too coarse for them.
#[test]
fn outlines_and_fields_are_written() {
    let workspace = Workspace::small();
    let dimples = "[[texture]]\nshape = 'cavity'\nlambda = '0.4 um'\npitch = '2 um'\n";
    workspace.write("dimples.toml", format!("{SMALL}{dimples}"));
    for (name, beginning) in [
        ("a.svg", &b"<svg"[..]),
        ("a.dxf", b"0\nSECTION"),
        ("a.gsf", b"Gwyddion Simple Field 1.0"),
        ("a.png", b"\x89PNG"),
    ] {
        let said = workspace.succeed(&format!("texture dimples.toml -o {name}"));
        assert!(
            said.contains("smallest feature 800 nm\nsmallest gap 1.2 um\n"),
            "{said}"
        );
        let said_in_one_line = said.replace("\n      ", " ");
        assert!(
            said_in_one_line.contains(
                "the smallest dimple is 0.8 blocks across and the smallest gap 1.2; the outline needs 5 and 2"
            ),
            "{said}"
        );
        assert!(said.ends_with(&format!("{name}\n")), "{said}");
        assert!(workspace.read(name).starts_with(beginning));
    }
    workspace.succeed("texture dimples.toml -o b.png --scale 3");
    assert!(workspace.read("b.png") != workspace.read("a.png"));
    let said = workspace.fail("texture dimples.toml -o b.svg --scale 3", 2);
    assert!(said.contains("`--scale` applies to pictures"), "{said}");
    workspace.fail("texture dimples.toml -o c.png --scale 0", 2);
}
