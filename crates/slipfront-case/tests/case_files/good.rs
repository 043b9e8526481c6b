use std::fs;
use std::path::Path;

use slipfront::Edges;

use slipfront_case::case::Case;
use slipfront_case::case_file::{
    CaseFile, Cavity, CavitySize, Center, Damping, DriveSpeed, KineticFriction, Pattern, Redistribute,
    RunTime, Shape, Snapshots, Texture,
};

use super::{files, notes};

fn good(name: &str) -> CaseFile {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/good")
        .join(name)
        .with_extension("toml");
    let text = fs::read_to_string(&path).unwrap();
    CaseFile::load(&path, &notes(&text, "set")).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn every_good_file_is_read_and_printed() {
    for path in files("good") {
        let case = good(path.file_stem().unwrap().to_str().unwrap());
        let printed = case.to_toml().unwrap();
        let again =
            CaseFile::parse(&printed, "printed", &[]).unwrap_or_else(|error| panic!("{error}\n{printed}"));
        assert_eq!(again, case, "{}", path.display());
        assert_eq!(again.to_toml().unwrap(), printed, "{}", path.display());
    }
}

#[test]
fn an_empty_file_is_the_baseline() {
    assert_eq!(good("empty"), CaseFile::default());
}

#[test]
fn the_other_key_displaces_the_default() {
    let case = good("physical");
    assert!(matches!(&case.slider.damping, Damping::Rate(rate) if rate.si() == 2.7e8));
    assert!(matches!(&case.drive.speed, DriveSpeed::Speed(speed) if speed.si() == 0.0949e-3));
    assert_eq!(case.friction.kinetic, KineticFriction::MuKinetic(0.5));
    assert!(matches!(&case.time.duration, RunTime::Duration(duration) if duration.si() == 84e-9));
    assert_eq!(case.slider.edges, [Edges::Periodic, Edges::Free]);
    let printed = case.to_toml().unwrap();
    for key in ["omega_star", "v_star", "r_star", "duration_star"] {
        assert!(!printed.contains(&format!("\n{key} ")), "{key} in\n{printed}");
    }
}

#[test]
fn overrides_change_what_they_name() {
    let case = good("set_strings_and_numbers");
    assert!(matches!(&case.drive.speed, DriveSpeed::Speed(speed) if speed.to_string() == "1 mm/s"));
    assert_eq!(case.load.pressure.si(), 2e5);
    assert_eq!(case.slider.edges, [Edges::Periodic; 2]);
    assert_eq!(case.slider.blocks, [5, 5]);
    assert_eq!(case.load.redistribute, Redistribute::All(false));
    assert_eq!(case.drive.direction, 90.0);
    let case = good("set_pair_of_a_texture");
    let lambda = "3um".parse().unwrap();
    assert!(
        matches!(&case.texture[0].shape, Shape::Cavity(cavity) if cavity.size == CavitySize::Lambda(lambda))
    );
    assert!(matches!(&case.texture[1].shape, Shape::Groove(_)));
    assert_eq!(good("set_no_texture").texture, []);
    let textures = good("set_new_texture").texture;
    assert!(matches!(
        &textures[..],
        [Texture {
            shape: Shape::Mask(_),
            ..
        }]
    ));
    assert_eq!(good("set_snapshots").output.snapshots, Snapshots::Every(3.0));
    assert_eq!(good("set_last_holds").drive.speed, DriveSpeed::VStar(0.2));
}

#[test]
fn a_later_stage_can_name_the_place() {
    let case = CaseFile::parse(
        "[drive]\n\tv_star = 0.1\n",
        "a.toml",
        &["slider.blocks=[9, 9]".to_owned()],
    )
    .unwrap();
    let at = |key| case.source.error(key, "no good").to_string();
    assert_eq!(
        at("drive.v_star"),
        "a.toml:2:11: no good\n  \tv_star = 0.1\n  \t         ^^^"
    );
    assert_eq!(at("slider.blocks"), "--set slider.blocks=[9, 9]: no good");
    assert_eq!(at("load.pressure"), "no good");
    assert_eq!(at("drive"), "a.toml:1:1: no good\n  [drive]\n  ^^^^^^^");
    assert!(case.source.has("slider.blocks") && !case.source.has("load.pressure"));
    assert_eq!(case.source.name(), "a.toml");
}

#[test]
fn a_case_changed_in_code_is_checked_without_a_place() {
    let mut case = CaseFile::default();
    case.drive.speed = DriveSpeed::VStar(f64::NAN);
    assert!(
        case.check()
            .unwrap_err()
            .to_string()
            .starts_with("`drive.v_star` is NaN")
    );
    case.drive.speed = DriveSpeed::VStar(0.1);
    case.slider.block_size = f64::INFINITY.into();
    assert!(
        case.check()
            .unwrap_err()
            .to_string()
            .starts_with("`slider.block_size` is \"inf m\"")
    );
    case.slider.block_size = 1e-6.into();
    case.texture.push(Texture {
        shape: Shape::Cavity(Cavity {
            s: 1,
            w: 2.0,
            size: CavitySize::Coverage(5.0),
            across: false,
            center: Center::Middle,
            rotate: 0.0,
        }),
        pattern: Pattern::default(),
    });
    assert!(
        case.check()
            .unwrap_err()
            .to_string()
            .starts_with("`texture.0.w` is 2")
    );
    case.texture.clear();
    case.check().unwrap();
    case.friction.seed = u64::MAX;
    assert!(
        case.to_toml()
            .unwrap_err()
            .to_string()
            .starts_with("`friction.seed` is 18446744073709551615")
    );
}

/// The step is 0.1 where this is stable, and the run is long enough to load the slider through its own drive
/// springs.
#[test]
fn steps_and_durations_follow_the_blocks() {
    let case = |modulus: f64| {
        let grade = format!("{{ along = 'x', from = {modulus}, to = {modulus} }}");
        let text = format!("slider.blocks = [4, 4]\nslider.stiffness_grade = {grade}");
        Case::parse(&text, "case", "", &[]).unwrap()
    };
    for (modulus, step_limit) in [(0.5, 0.9058), (1.0, 0.9058), (80.0, 0.1013), (1000.0, 0.02864)] {
        let found = case(modulus);
        let limit = found.time_plan.step_limit;
        assert!((limit / step_limit - 1.0).abs() < 1e-3, "{modulus}: {limit}");
        let plan = found.time_plan;
        assert_eq!(plan.dt_star, if limit > 0.1 { 0.1 } else { 0.5 * limit });
        let duration = 8.0 / 0.03 / modulus;
        assert!(duration <= plan.end_star() + 1e-6 && plan.end_star() < duration + plan.dt_star);
    }
}

/// The total stiffness of the springs of the driven blocks is the given one, whatever the single springs are.
#[test]
fn a_total_stiffness_is_the_sum_of_all_drive_springs() {
    for attach in ["all", "left"] {
        for [from, to] in [[1.0, 1.0], [1.0, 0.1], [1000.0, 0.001]] {
            let text = format!(
                "slider.blocks = [10, 7]\nslider.stiffness_grade = {{ along = 'x', from = {from:?}, to = {to:?} }}\n\
                 drive.attach = '{attach}'\ndrive.total_stiffness_star = 0.5"
            );
            let case = Case::parse(&text, "case", "", &[]).unwrap();
            let (slider, k_drive) = (case.model.slider(), case.model.drive.k_drive);
            let sum: f64 = (0..70).map(|b| k_drive * slider.drive_spring(b)).sum();
            // Rounding of 70 terms.
            assert!((sum / 0.5 - 1.0).abs() < 1e-13, "{attach}, {from} to {to}: {sum}");
            let sum = k_drive * slider.sum_of_drive_springs(&case.model.lattice);
            assert!((sum / 0.5 - 1.0).abs() < 1e-13, "{attach}, {from} to {to}: {sum}");
        }
    }
}

/// For equal blocks of any modulus and density, the warning has the V* of a case with this material; for a
/// grade, it has the equivalent speed.
#[test]
fn fast_loading_is_told_in_the_speed_that_equal_blocks_would_have() {
    let fast = |keys: &str| {
        let text = format!("slider.blocks = [50, 50]\n{keys}");
        let warnings = Case::parse(&text, "case", "", &[]).unwrap().warnings();
        let fast = warnings.into_iter().find(|warning| warning.contains("above 0.2"));
        fast.map(|warning| warning.split(" above 0.2").next().unwrap().to_owned())
    };
    let grade = |key: &str, from: f64, to: f64| {
        format!("slider.{key}_grade = {{ along = 'x', from = {from:?}, to = {to:?} }}\n")
    };
    assert_eq!(fast(""), None);
    assert_eq!(fast("drive.v_star = 0.3"), Some("V* = 0.3 is".to_owned()));
    // 2 mm/s over a scale of 1 mm/s sqrt(10).
    assert_eq!(fast("drive.speed = '2 mm/s'"), Some("V* = 0.6325 is".to_owned()));
    // sqrt(10) 0.03 = 0.095, and sqrt(1000) 0.03 = 0.9487.
    assert_eq!(fast(&grade("stiffness", 10.0, 10.0)), None);
    let of_equal = |speed: &str| {
        format!(
            "V* = 0.03 loads this slider as fast as V* = {speed} loads equal blocks on the paper's springs,"
        )
    };
    assert_eq!(
        fast(&grade("stiffness", 1000.0, 1000.0)),
        Some(of_equal("0.9487"))
    );
    assert_eq!(fast(&grade("density", 1000.0, 1000.0)), Some(of_equal("0.9487")));
    // mean(e) = 500 and mean(1/sqrt(e)) over 50 blocks with e from 10 to 990.
    let slowness = (0..50)
        .map(|i| 1.0 / (10.0 + 20.0 * f64::from(i)).sqrt())
        .sum::<f64>()
        / 50.0;
    let expected = format!("{:.4}", 0.03 * 500.0 * slowness);
    let graded = fast(&grade("stiffness", 1000.0, 1e-6));
    assert_eq!(graded, Some(of_equal(&expected)));
}

/// Where fewer than half of the blocks touch, the run lasts until their own drive springs bear their load,
/// and 2.5/V* longer. Under an edge drive, the springs of other blocks bear the load.
#[test]
fn runs_last_longer_where_few_blocks_touch() {
    let end = |texture: &str, changes: &[&str]| {
        let text = format!("[slider]\nblocks = [50, 50]\n{texture}");
        let changes: Vec<String> = changes.iter().map(ToString::to_string).collect();
        let case = Case::parse(&text, "case", "", &changes).unwrap();
        (case.time_plan.end_star(), case.expected.onset_star)
    };
    let groove = |percent: u32| format!("[[texture]]\nshape = 'groove'\nwidth = '{} um'", percent / 2);
    let usual = 8.0 / 0.03;
    let close = |[found, expected]: [f64; 2]| (0.0..0.1 + 1e-9).contains(&(found - expected));
    for percent in [0, 30, 50] {
        let texture = if percent == 0 {
            String::new()
        } else {
            groove(percent)
        };
        let (found, _) = end(&texture, &[]);
        assert!(close([found, usual]), "{percent}: {found}");
    }
    for (percent, factor) in [(60, 2.5), (80, 5.0), (90, 10.0)] {
        let (found, [from, to]) = end(&groove(percent), &[]);
        assert!(
            close([found, (factor / 0.375 + 2.5) / 0.03]),
            "{percent}: {found}"
        );
        assert!(from >= 2.5 / 0.03 && (to / (2.5 / 0.03 * factor) - 1.0).abs() < 1e-12);
        let kept = end(&groove(percent), &["load.redistribute=false"]);
        assert!(close([kept.0, usual]));
        // All forces are smaller by the factor.
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
        assert!(near(kept.1[0] * factor, from) && near(kept.1[1] * factor, to));
        let edge = end(&groove(percent), &["drive.attach='left'"]);
        assert!(close([edge.0, 50.0 * usual]), "{}", edge.0);
        assert_eq!(edge.1[0], edge.1[1]);
    }
}

/// A block with a multiple of the mean pressure slips long after the others, and a dead load against the
/// drive delays every block by the path on which its drive spring takes it up: the run follows both, and so
/// does the expected onset.
#[test]
fn runs_last_until_the_block_with_the_largest_load_slips() {
    let folder = tempfile::tempdir().unwrap();
    // A mean pressure of 1: half of the blocks bear 20 times the load of the others.
    let row = [2.0 / 21.0, 40.0 / 21.0]
        .map(|pressure| pressure.to_string())
        .join(",");
    std::fs::write(folder.path().join("half.csv"), format!("{row}\n").repeat(2)).unwrap();
    let one = [[4.0 / 23.0; 3], [4.0 / 23.0, 80.0 / 23.0, 4.0 / 23.0]];
    let one: Vec<String> = one
        .iter()
        .map(|row| row.map(|pressure| pressure.to_string()).join(","))
        .collect();
    std::fs::write(folder.path().join("one.csv"), one.join("\n")).unwrap();
    let found = |text: &str| {
        let case = Case::parse(&format!("drive.v_star = 0.1\n{text}"), "case", folder.path(), &[]).unwrap();
        (case.time_plan.end_star(), case.expected.onset_star[1])
    };
    // Rounded up to a whole step.
    let close = |found: f64, expected: f64| (0.0..0.1 + 1e-9).contains(&(found - expected));
    for (text, largest) in [
        ("slider.blocks = [2, 2]", 1.0),
        (
            "slider.blocks = [2, 2]\nload.pressure_field = 'half.csv'",
            40.0 / 21.0,
        ),
        (
            "slider.blocks = [3, 2]\nload.pressure_field = 'one.csv'",
            80.0 / 23.0,
        ),
    ] {
        let (end, onset) = found(text);
        // 3/8 is the stiffness of a drive spring.
        assert!(
            close(end, f64::max(8.0, largest / 0.375 + 2.5) / 0.1),
            "{text}: {end}"
        );
        assert!(
            (onset / (2.5 * largest / 0.1) - 1.0).abs() < 1e-12,
            "{text}: {onset}"
        );
    }
    let plain = "slider.blocks = [2, 2]\nload.shear_star = ";
    for (shear, later) in [(-0.3, 0.3 / 0.375 / 0.1), (0.3, 0.0)] {
        let (end, _) = found(&format!("{plain}{shear}"));
        assert!(close(end, 80.0 + later), "{shear}: {end}");
    }
}

/// A run of too many steps is refused with a speed that suffices, as far as a speed can.
#[test]
fn too_slow_a_drive_is_refused_with_one_that_does() {
    let parse = |keys: &str| Case::parse(&format!("slider.blocks = [4, 4]\n{keys}"), "case", "", &[]);
    let said = |keys: &str| parse(keys).unwrap_err().to_string();
    let slow = said("drive = { v_star = 1e-8, stiffness_star = 0.01 }");
    // 8/V* at 0.01/0.375 of the paper's stiffness, in steps of 0.1: 75 times too many.
    assert!(
        slow.contains("75 times stiffer would do, or `drive.v_star` = 7.500e-7"),
        "{slow}"
    );
    assert!(parse("drive = { v_star = 7.5e-7, stiffness_star = 0.01 }").is_ok());
    assert!(parse("drive = { v_star = 1e-8, stiffness_star = 0.75 }").is_ok());
    let soft = said("drive = { v_star = 9, stiffness_star = 1e-12 }");
    assert!(
        soft.contains("times stiffer") && !soft.contains("drive.v_star"),
        "{soft}"
    );
    let long = said("time = { duration_star = 1e9, step = 1e-4 }");
    assert!(long.contains("reduce its duration by a factor of 2500"), "{long}");
}

/// Speeds of a program that no step has are named.
#[test]
fn speeds_after_the_end_of_the_run_have_a_note() {
    let note = |duration: &str| {
        let text = format!(
            "slider.blocks = [30, 30]\ntime.duration_star = {duration}\ndrive.program = [{{ v_star = 0.03, until_star = 110 }}, \
             {{ v_star = -0.03, until_star = 330 }}, {{ v_star = 0.03 }}]"
        );
        let warnings = Case::parse(&text, "case", "", &[]).unwrap().warnings();
        warnings
            .into_iter()
            .find(|warning| warning.contains("drive.program"))
    };
    let said = note("60").unwrap();
    assert!(
        said.contains("the last 2 speeds of `drive.program` begin, the first at t* = 110"),
        "{said}"
    );
    let said = note("330").unwrap();
    assert!(
        said.contains("the last 1 speed of `drive.program` begins, the first at t* = 330"),
        "{said}"
    );
    assert_eq!(note("340"), None);
}

/// A pressure in millipascals is read as it is written, with a note on the unit that was probably meant.
#[test]
fn a_pressure_below_a_pascal_has_a_note() {
    let notes = |pressure: &str| {
        let text = format!("slider.blocks = [30, 30]\nload.pressure = '{pressure}'");
        Case::parse(&text, "case", "", &[]).unwrap().warnings().join("\n")
    };
    assert!(notes("2 mPa").contains("`load.pressure` is \"2 mPa\", less than 1 Pa"));
    assert!(!notes("2 MPa").contains("less than 1 Pa"));
}

/// Times are compared with the end of the run, which the drive springs of the slider determine: later than
/// 8/V* for a soft slider, earlier for a stiff one. The moduli are known only when a file is read.
#[test]
fn times_are_held_against_the_end_of_the_run_itself() {
    let folder = tempfile::tempdir().unwrap();
    let case = |modulus: &str, key: &str| {
        std::fs::write(
            folder.path().join("moduli.csv"),
            format!("{modulus},{modulus}\n").repeat(2),
        )
        .unwrap();
        let text = "slider.blocks = [2, 2]\nslider.stiffness_field = \"moduli.csv\"\ndrive.v_star = 0.1";
        Case::parse(text, "case", folder.path(), &[key.to_owned()])
    };
    // 8/V* is 80.
    for key in ["time.kinetic_from_star=120", "output.snapshots=[120]"] {
        assert!(case("0.5", key).is_ok(), "{key}");
        let refused = case("1", key).unwrap_err().to_string();
        assert!(refused.contains("t* = 120: the run ends at 80.0000"), "{refused}");
    }
    let refused = case("2", "time.kinetic_from_star=60").unwrap_err().to_string();
    assert!(refused.contains("the run ends at 40.0000"), "{refused}");
}

/// A coverage below 1 % has a note with its value as a fraction of 1; 1 % and more, and sizes, have none.
#[test]
fn a_coverage_that_may_be_a_share_is_noted() {
    let note = |size: &str| {
        let text = format!("slider.blocks = [50, 50]\n[[texture]]\nshape = 'groove'\n{size}");
        let warnings = Case::parse(&text, "case", "", &[]).unwrap().warnings();
        warnings
            .into_iter()
            .find(|warning| warning.contains("percent of the area"))
    };
    let expected =
        "`coverage` = 0.1 of texture 1 means 0.1 percent of the area; for 10 percent write `coverage` = 10";
    assert_eq!(note("coverage = 0.1").as_deref(), Some(expected));
    assert_eq!(note("coverage = 1"), None);
    assert_eq!(note("width = '0.1 um'"), None);
}

/// The coverage of a pattern does not depend on its form: a pitch that fills the slider, a count, an array in
/// an array, or a mask in each cell.
#[test]
fn patterns_can_be_said_in_several_ways() {
    let case = |pattern: &str| {
        let text = format!(
            "slider = {{ blocks = [48, 24], edges = 'periodic' }}\n[[texture]]\nshape = 'cavity'\nlambda = '2 um'\n{pattern}"
        );
        let case = Case::parse(&text, "case", "", &[]).unwrap();
        let warnings = case.warnings();
        (case.model.surface.textured.clone(), case.texture, warnings)
    };
    let (counted, report, warnings) = case("array = [4, 2]");
    assert_eq!(counted.iter().filter(|&&t| t).count() % 8, 0);
    assert_eq!(case("pitch = '12 um'").0, counted);
    assert_eq!(case("pitch = ['12 um', '12 um']\narray = [4, 2]").0, counted);
    assert_eq!(case("array = [2, 1]\nrepeat = { array = [2, 2] }").0, counted);
    assert_eq!(
        case("pitch = '12 um'\narray = [2, 1]\nrepeat = { pitch = ['24 um', '12 um'] }").0,
        counted
    );
    assert!(
        warnings.iter().all(|warning| !warning.contains("pattern")),
        "{warnings:?}"
    );
    // pi 2^2 blocks out of 144.
    assert!((report.asked_percent.unwrap() - 100.0 * std::f64::consts::PI * 4.0 / 144.0).abs() < 1e-12);
    let (inverted, report, _) = case("array = [4, 2]\ninvert = true");
    assert!(counted.iter().zip(&inverted).all(|(one, other)| one != other));
    assert!(
        (report.asked_percent.unwrap() - 100.0 * (1.0 - std::f64::consts::PI * 4.0 / 144.0)).abs() < 1e-12
    );
    let (staggered, ..) = case("array = [4, 2]\nlattice = 'staggered'");
    // Half a cell to the right, and one row of cells up.
    for b in 0..staggered.len() {
        let (i, j) = (b % 48, b / 48);
        assert_eq!(staggered[b], staggered[(j + 12) % 24 * 48 + (i + 6) % 48]);
    }
    let warnings = |pattern: &str| case(pattern).2.join("\n");
    assert!(warnings("array = [4, 3]\nlattice = 'staggered'").contains("odd number of rows, 3"));
    assert!(
        warnings("pitch = '11 um'").contains("leaves 4.00 blocks free at the periodic edges that bound x")
    );
    assert!(
        warnings("array = [4, 2]\nlattice = 'hexagonal'")
            .contains("leaves 3.22 blocks free at the periodic edges that bound y")
    );
    assert!(!warnings("array = [2, 2]\npitch = '5 um'").contains("periodic edges"));
}

/// Coverage is that of all copies together, for every shape that has a coverage.
#[test]
fn copies_share_the_coverage() {
    for (texture, blocks) in [
        ("shape = 'groove'\ncoverage = 20\narray = [5, 1]", 500),
        ("shape = 'groove'\ncoverage = 20\npitch = '10 um'", 500),
        (
            "shape = 'groove'\ncoverage = 20\norientation = 'along'\narray = [1, 5]",
            500,
        ),
        (
            "shape = 'groove'\ncoverage = 20\npitch = '10 um'\ninvert = true",
            2000,
        ),
        (
            "shape = 'groove'\ncoverage = 20\narray = [5, 2]\nlattice = 'staggered'",
            500,
        ),
        (
            "shape = 'polygon'\npoints = [['23 um', '24 um'], ['27 um', '24 um'], ['27 um', '26 um'], ['23 um', '26 um']]\npitch = '10 um'",
            200,
        ),
    ] {
        let text = format!("slider.blocks = [50, 50]\n[[texture]]\n{texture}");
        let case = Case::parse(&text, "case", "", &[]).unwrap();
        let found = case.model.surface.textured.iter().filter(|&&t| t).count();
        assert_eq!(found, blocks, "{texture}");
        if let Some(asked) = case.texture.asked_percent {
            assert!((asked - blocks as f64 / 25.0).abs() < 1e-9);
        }
    }
}

/// A mask in every cell is the same as one mask of all cells.
#[test]
fn masks_fill_every_cell() {
    let folder = tempfile::tempdir().unwrap();
    let cell: Vec<bool> = (0..48).map(|b| b % 5 == 0 || b / 8 == 2).collect();
    std::fs::write(
        folder.path().join("cell.png"),
        slipfront_case::arrays::png_of_mask(8, 6, &cell).unwrap(),
    )
    .unwrap();
    let case = |pattern: &str| {
        let text =
            format!("slider.blocks = [32, 24]\n[[texture]]\nshape = 'mask'\nfile = 'cell.png'\n{pattern}");
        Case::parse(&text, "case", folder.path(), &[])
    };
    let said = case("pitch = '40 um'").unwrap_err().to_string();
    assert!(
        said.contains("40 x 40 blocks in every place of the pattern are more than the 32 x 24 of the slider"),
        "{said}"
    );
    for (pattern, shift) in [
        ("array = [4, 4]", 0),
        ("pitch = ['8 um', '6 um']", 0),
        ("array = [2, 4]\nrepeat = { array = [2, 1] }", 0),
        ("array = [4, 4]\nlattice = 'staggered'", 2),
    ] {
        for (b, textured) in case(pattern).unwrap().model.surface.textured.iter().enumerate() {
            let (i, j) = (b % 32, b / 32);
            // Even rows of cells are shifted by a quarter of a cell to the left, odd rows to the right.
            let column = if j / 6 % 2 == 0 {
                i + shift
            } else {
                i.wrapping_sub(shift)
            };
            let inside = column < 32 && cell[j % 6 * 8 + column % 8];
            assert_eq!(*textured, inside, "{pattern}: ({i}, {j})");
        }
    }
}
