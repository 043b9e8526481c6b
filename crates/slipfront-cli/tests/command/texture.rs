//! `slipfront texture`: a mask written and read back is the same texture.

use super::{Bench, SMALL};

#[test]
fn a_mask_read_back_is_the_same_texture() {
    let bench = Bench::new();
    // No symmetry that could hide a mirrored picture.
    let cavity =
        "[[texture]]\nshape = 'cavity'\ncoverage = 20\ncenter = ['2 um', '1 um']\nw = 0.3\nrotate = 20\n";
    bench.write("cavity.toml", format!("{SMALL}{cavity}"));
    let said = bench.done("texture cavity.toml -o mask.png");
    assert!(
        said.contains("% of the blocks, 20 % asked") && said.ends_with("mask.png\n"),
        "{said}"
    );
    bench.write(
        "mask.toml",
        format!("{SMALL}[[texture]]\nshape = 'mask'\nfile = 'mask.png'\n"),
    );
    bench.done("run cavity.toml -o a");
    bench.done("run mask.toml -o b");
    for name in ["series.csv", "fields.nc", "stress.png"] {
        assert!(
            bench.read(&format!("a/{name}")) == bench.read(&format!("b/{name}")),
            "{name}"
        );
    }
    let percent = |folder: &str| bench.summary(folder)["texture_percent"].as_f64().unwrap();
    assert_eq!(percent("a"), percent("b"));
    assert!(percent("a") > 5.0, "nothing is textured");
}

#[test]
fn a_picture_is_replaced_only_by_force() {
    let bench = Bench::new();
    bench.write("mask.png", "mine");
    assert!(
        bench
            .refused("texture small.toml -o mask.png", 2)
            .contains("--force")
    );
    assert_eq!(bench.read("mask.png"), b"mine");
    bench.done("texture small.toml -o mask.png --force");
    assert_eq!(bench.read("mask.png")[1..4], *b"PNG");
    bench.refused("texture small.toml -o no/such/folder/mask.png", 1);
    // Not even then a file that the case reads.
    bench.write("masked.toml", super::MASKED.replace("spot.png", "mask.png"));
    let said = bench.refused("texture masked.toml -o mask.png --force", 2);
    assert!(
        said.contains("would replace mask.png, which the case reads"),
        "{said}"
    );
    let said = bench.refused("texture small.toml -o mask.jpg", 2);
    assert!(said.contains("name a file that ends in .png"), "{said}");
}
