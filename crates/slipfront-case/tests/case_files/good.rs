use std::fs;
use std::path::Path;

use slipfront::Edges;

use slipfront_case::case::Case;
use slipfront_case::case_file::{
    CaseFile, Cavity, CavitySize, Center, Damping, DriveSpeed, KineticFriction, RunTime, Snapshots, Texture,
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
    assert!(!case.load.redistribute);
    assert_eq!(case.drive.direction, 90.0);
    let case = good("set_pair_of_a_texture");
    let lambda = "3um".parse().unwrap();
    assert!(matches!(&case.texture[0], Texture::Cavity(cavity) if cavity.size == CavitySize::Lambda(lambda)));
    assert!(matches!(&case.texture[1], Texture::Groove(_)));
    assert_eq!(good("set_no_texture").texture, []);
    assert!(matches!(&good("set_new_texture").texture[..], [Texture::Mask(_)]));
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
    case.texture.push(Texture::Cavity(Cavity {
        s: 1,
        w: 2.0,
        size: CavitySize::Coverage(5.0),
        across: false,
        center: Center::Middle,
        rotate: 0.0,
        array: [1, 1],
    }));
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

/// The step is 0.1 where that is stable, and the run lasts as long as it takes to load the slider through its own drive springs.
#[test]
fn steps_and_durations_follow_the_blocks() {
    let case = |modulus: f64| {
        let grade = format!("{{ along = 'x', from = {modulus}, to = {modulus} }}");
        let text = format!("slider.blocks = [4, 4]\nslider.stiffness_grade = {grade}");
        Case::parse(&text, "case", &[]).unwrap()
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

/// Times are held against the end of the run as its own drive springs make it: later than 8/V* of a soft slider, earlier of a stiff
/// one, whose moduli are known only when a file is read.
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
        Case::parse_in(text, "case", folder.path(), &[key.to_owned()])
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
