//! The start of a run: a dead shear load, and displacements and velocities from files.

use std::fmt::Write as _;
use std::path::Path;

use slipfront::lattice::{K_DRIVE, K_STRAIGHT};
use slipfront::{Execution, Kernel, Simulation, Stop};
use slipfront_case::case::{Case, Files, FilesInMemory, Ranks};
use slipfront_case::case_file::{CaseError, CaseFile};
use test_case::{test_case, test_matrix};

/// A case with tables of numbers in memory, one line per row of the lattice.
fn case(text: &str, tables: &[(&str, &[Vec<f64>])]) -> Result<Case, CaseError> {
    let in_memory: FilesInMemory = tables
        .iter()
        .map(|(name, rows)| {
            let mut text = String::new();
            for row in *rows {
                let numbers: Vec<String> = row.iter().map(|value| format!("{value:?}")).collect();
                writeln!(text, "{}", numbers.join(",")).unwrap();
            }
            ((*name).to_owned(), text.into_bytes().into())
        })
        .collect();
    let files = Files {
        folder: Path::new(""),
        in_memory: Some(&in_memory),
    };
    let file = CaseFile::parse(text, "case.toml", &[])?;
    Case::to_run(file, "case", files, &mut |_| true, Ranks::ALONE)
}

fn begin(case: &Case, kernel: Kernel) -> Simulation {
    let execution = Execution {
        kernel,
        ..Execution::default()
    };
    Simulation::new(
        case.model.clone(),
        case.time_plan.dt_star,
        case.state(),
        execution,
    )
}

/// Equal blocks with R* = 0.5.
const EQUAL: &str = "friction = { sigma_static_star = 0, sigma_kinetic_star = 0, mu_static = 0.4 }\n";

/// A load of 0.3 P mu_s, given as a stress or as a ratio, leaves 0.7 to the drive.
#[test_case("load.shear = '12 kPa'"; "stress")]
#[test_case("load.shear_star = 0.3"; "ratio")]
#[test_case("load = { shear_star = 0.15, shear_field = 'two.csv' }"; "field")]
fn a_shear_load_leaves_the_rest_to_the_drive(load: &str) {
    let text = format!("{EQUAL}slider.blocks = [30, 30]\ndrive.direction = 60\n{load}");
    let case = case(&text, &[("two.csv", &vec![vec![2.0; 30]; 30])]).unwrap();
    let [along, across] = case.model.mean_dead_load();
    // The direction of the drive is rounded.
    assert!((along - 0.3).abs() < 1e-15 && across.abs() < 1e-15);
    let exact = 0.7 / (K_DRIVE * 0.03);
    assert!((case.expected.first_slip_star.unwrap() / exact - 1.0).abs() < 1e-14);
    assert_eq!(
        case.share_of_shear().map(|share| (share * 1e9).round()),
        Some(3e8)
    );
    assert_eq!(case.expected.at_once.count, 0);
    let mut simulation = begin(&case, Kernel::Fused);
    simulation
        .run(Stop::at_step(case.time_plan.last_step), &mut [])
        .unwrap();
    let found = simulation.peak().first_slip_drive_time_star.unwrap();
    // The first slip is at the first instant after the exact time.
    assert!(found > exact * (1.0 - 1e-12) && found <= exact + case.time_plan.dt_star);
}

#[test]
fn blocks_that_slip_at_once_are_counted_and_the_first_is_named() {
    let mut field = vec![vec![1.0; 30]; 30];
    (field[4][7], field[9][2]) = (3.0, -2.1);
    let text =
        format!("{EQUAL}slider.blocks = [30, 30]\nload = {{ shear_star = 0.5, shear_field = 'field.csv' }}");
    let case = case(&text, &[("field.csv", &field)]).unwrap();
    assert_eq!(
        (case.expected.at_once.count, case.expected.at_once.first),
        (2, [7, 4])
    );
    assert_eq!(case.expected.first_slip_star, Some(0.0));
    let said =
        "2 blocks slip at t = 0, because the shear load exceeds their static friction; the first is (7, 4)";
    assert!(
        case.warnings().iter().any(|warning| warning == said),
        "{:?}",
        case.warnings()
    );
    let times = begin(&case, Kernel::Fused).snapshot().first_slip_time_star();
    let slips: Vec<usize> = (0..900).filter(|&b| times[b] == 0.0).collect();
    assert_eq!(slips, [127, 272]);
}

/// A periodic chain of 20 frictionless blocks between the two sides of one block that holds.
const FREE: usize = 20;

fn chain(initial: &str, rows: &[Vec<f64>]) -> Case {
    let text = format!(
        "{EQUAL}slider = {{ blocks = [{}, 1], edges = ['periodic', 'free'], omega_star = 0 }}\n\
         drive = {{ v_star = 1e-9, stiffness_star = 1e-12 }}\ntime = {{ step = 0.2, duration_star = 100 }}\n\
         texture = [{{ shape = 'mask', file = 'free.npy' }}]\ninitial = {{ {initial} }}",
        FREE + 1
    );
    let mut textured = vec![true; FREE + 1];
    textured[0] = false;
    let mask = slipfront_case::arrays::npy_of_mask(FREE + 1, &textured);
    let mut table = String::new();
    for row in rows {
        let numbers: Vec<String> = row.iter().map(|value| format!("{value:?}")).collect();
        writeln!(table, "{}", numbers.join(" ")).unwrap();
    }
    let in_memory = FilesInMemory::from([
        ("free.npy".to_owned(), mask.into()),
        ("mode.csv".to_owned(), table.into_bytes().into()),
    ]);
    let files = Files {
        folder: Path::new(""),
        in_memory: Some(&in_memory),
    };
    let file = CaseFile::parse(&text, "case.toml", &[]).unwrap();
    Case::to_run(file, "case", files, &mut |_| true, Ranks::ALONE).unwrap()
}

/// A mode of the chain oscillates at the frequency of the scheme, sin(w dt/2) = w_0 dt/2, with w_0 of the
/// springs. From rest half a step before t = 0 it is u_0 cos(w (n + 1/2) dt)/cos(w dt/2); from a velocity at
/// the rest sites it is dt v sin(w n dt)/sin(w dt). The initial state is in SI units or in units of the
/// model.
#[test_matrix([1, 3, 20], [Kernel::Fused, Kernel::General], [false, true], [false, true])]
fn a_mode_swings_at_the_frequency_of_the_scheme(mode: usize, kernel: Kernel, moves: bool, has_unit: bool) {
    let angle = std::f64::consts::PI * mode as f64 / (FREE + 1) as f64;
    let shape: Vec<f64> = (0..=FREE).map(|i| (angle * i as f64).sin()).collect();
    let plain = chain("", &[]);
    let (key, unit) = if moves {
        ("velocity", format!("'{:e} m/s'", plain.scales.speed()))
    } else {
        ("displacement", format!("'{:e} m'", plain.scales.displacement()))
    };
    let unit = if has_unit {
        format!(", {key}_unit = {unit}")
    } else {
        String::new()
    };
    let mut along_x = shape.clone();
    along_x[0] = 0.0;
    let case = chain(&format!("{key}_x = 'mode.csv'{unit}"), &[along_x]);
    let mut simulation = begin(&case, kernel);
    let (dt, steps) = (case.time_plan.dt_star, 400);
    let square = 4.0 * K_STRAIGHT * (0.5 * angle).sin().powi(2) + case.model.drive.k_drive;
    let turn = 2.0 * (0.5 * dt * square.sqrt()).asin();
    for step in 1..=steps {
        simulation.step();
        let step = f64::from(step);
        let factor = if moves {
            dt * (turn * step).sin() / turn.sin()
        } else {
            (turn * (step + 0.5)).cos() / (0.5 * turn).cos()
        };
        let u = simulation.state().displacement;
        for (i, shape) in shape.iter().enumerate() {
            // Rounding over 400 steps, for displacements up to 8.
            assert!(
                (u.x[i] - factor * shape).abs() < 1e-9,
                "{step} {i}: {} {}",
                u.x[i],
                factor * shape
            );
        }
        assert!(u.y.iter().all(|&y| y == 0.0));
    }
}

/// A front in a chain under the prestress tau = (F - mu_k)/(mu_s - mu_k) runs at c/sqrt(1 - tau^2), once
/// blocks at one end are set in motion. Here the case alone does this. The front takes a whole number of
/// steps per block, and half a step is 1 % at the highest speed; the effect of the drive springs is smaller.
#[test_case(0.6)]
#[test_case(0.8)]
fn a_case_of_a_prestressed_chain_has_the_speed_of_its_front(tau: f64) {
    let blocks = 200;
    let text = format!(
        "{EQUAL}slider = {{ blocks = [{blocks}, 1], omega_star = 0 }}\nload.shear_star = {:?}\n\
         drive = {{ v_star = 1e-9, stiffness_star = 1e-12 }}\ntime = {{ step = 0.01, duration_star = 300 }}\n\
         initial.velocity_x = 'push.csv'",
        0.5 + 0.5 * tau
    );
    let mut push = vec![0.0; blocks];
    push[..5].fill(0.3);
    let case = case(&text, &[("push.csv", &[push])]).unwrap();
    let mut simulation = begin(&case, Kernel::Fused);
    let first = simulation.snapshot().first_slip_time_star();
    assert!(
        first[..5].iter().all(|&time| time == 0.0),
        "blocks in motion slip from t = 0 on"
    );
    simulation.run(Stop::at_step(25_000), &mut []).unwrap();
    let first = simulation.snapshot().first_slip_time_star();
    let found = 80.0 / (first[180] - first[100]) / K_STRAIGHT.sqrt();
    let exact = 1.0 / (1.0 - tau * tau).sqrt();
    assert!((found / exact - 1.0).abs() < 0.01, "{found} {exact}");
}

#[test_case("initial.displacement_x = 'short.csv'", "has 2 lines of numbers"; "size")]
#[test_case("initial.displacement_x = 'nan.csv'", "but must be a finite number"; "no number")]
#[test_case("initial = { displacement_x = 'huge.csv', displacement_unit = '1 m' }",
    "it must be finite; check the unit of the file"; "unit")]
#[test_case("initial.velocity_x = 'one.csv'\ndrive.loading = 'held'", "a held drive starts with blocks at rest"; "held")]
#[test_case("initial.displacement_y = 'one.csv'\nslider.outline = 'disc'", "block (0, 0) has 1 in units of the model: it does not exist"; "outline")]
#[test_case("load = { shear_star = 0.1, shear_field = 'nan.csv' }", "but must be a finite number"; "shear")]
fn wrong_arrays_are_refused(text: &str, expected: &str) {
    let one = vec![vec![1.0; 6]; 6];
    let mut nan = one.clone();
    nan[3][2] = f64::NAN;
    let huge = vec![vec![1e305; 6]; 6];
    let tables = [
        ("one.csv", &one[..]),
        ("nan.csv", &nan),
        ("huge.csv", &huge),
        ("short.csv", &one[..2]),
    ];
    let said = case(&format!("slider.blocks = [6, 6]\n{text}"), &tables)
        .unwrap_err()
        .to_string();
    assert!(said.contains(expected), "{said}");
}

/// A held drive may begin with displaced blocks.
#[test]
fn a_held_drive_begins_over_displaced_blocks() {
    let one = vec![vec![0.1; 6]; 6];
    let text = "slider.blocks = [6, 6]\ndrive.loading = 'held'\ninitial.displacement_x = 'one.csv'";
    let case = case(text, &[("one.csv", &one)]).unwrap();
    let found = begin(&case, Kernel::Fused).snapshot().point.mu_star;
    // Pull of the drive springs, back to the rest sites.
    assert!((found + 0.1 * K_DRIVE).abs() < 1e-15);
}
