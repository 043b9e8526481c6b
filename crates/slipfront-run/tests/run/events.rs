//! The catalogue of events of a run: its rows, numbers and limits, on any number of ranks, and across stops.

use std::path::Path;
use std::sync::Arc;

use slipfront::testing::Threads;
use slipfront::{Execution, StopReason};
use slipfront_case::case::{Case, Ranks};
use slipfront_case::case_file::CaseFile;
use slipfront_run::observers::events::{EventRow, read_csv};
use slipfront_run::run_files::RunFile;
use slipfront_run::running::{self, RunData, RunState, Running};

fn parsed(text: &str) -> Arc<Case> {
    Arc::new(Case::parse(text, "case", "", &[]).unwrap())
}

/// The table of a run as it is written.
fn table(data: &RunData, case: &Case) -> Vec<u8> {
    let tables = data.observers.tables(&case.scales).unwrap();
    let (_, contents) = tables
        .into_iter()
        .find(|(table, _)| table.file == "events.csv")
        .unwrap();
    contents
}

fn rows(data: &RunData, case: &Case) -> Vec<EventRow> {
    read_csv(RunFile::of_bytes("events.csv", &table(data, case))).unwrap()
}

/// Small blocks with a different thickness, so that no scale is 1.
const UNITS: &str = "slider.block_size = '2 um'\nslider.thickness = '5 um'\nslider.young_modulus = '3 GPa'\n\
                     load.pressure = '50 kPa'\nfriction.mu_static = 0.6\n";

/// One block that sticks and slips without damping: the numbers of the summary follow from the rows, the
/// units from the scales of the case, and the potency is the slip times the area of the block.
#[test]
fn numbers_follow_from_the_rows() {
    let text = format!(
        "{UNITS}slider.blocks = [1, 1]\nslider.omega_star = 0\nfriction.sigma_static_star = 0\nfriction.sigma_kinetic_star = 0\n\
         drive.v_star = 0.05\ntime = {{ step = 0.01, duration_star = 250 }}\noutput = {{ events = true, snapshots = [] }}\n"
    );
    let case = parsed(&text);
    let data = running::run(&case, 1).unwrap();
    let (rows, events) = (rows(&data, &case), data.summary.events.clone().unwrap());
    assert!(rows.len() > 3 && events.count == rows.len() && events.not_listed == 0);
    assert_eq!((events.whole_share, events.blocks_max), (Some(1.0), Some(1)));
    let moments = || rows.iter().map(|row| row.moment_star);
    assert_eq!(events.moment_star_max, moments().reduce(f64::max));
    assert_eq!(events.moment_star_sum, moments().sum::<f64>());
    // The motion of one block is periodic, except that its beginning and end are rounded to time steps: 0.02
    // of 45.
    let period = (rows.last().unwrap().time_star - rows[0].time_star) / (rows.len() - 1) as f64;
    assert_eq!(events.waiting_time_star, Some(period));
    assert!(events.waiting_time_variation.unwrap() < 0.02 / period);
    let scales = &case.scales;
    let is_near = |one: f64, other: f64| (one / other - 1.0).abs() < 4.0 * f64::EPSILON;
    for row in rows {
        assert!(is_near(row.time_s, row.time_star * scales.time()));
        assert!(is_near(
            row.until_s.unwrap(),
            row.until_star.unwrap() * scales.time()
        ));
        assert!(is_near(
            row.potency_m3,
            row.moment_star * scales.displacement() * 4e-12
        ));
        assert!(is_near(
            row.slip_speed_max_m_s,
            row.slip_speed_star_max * scales.speed()
        ));
        assert!(is_near(row.friction_coefficient_before, 0.6 * row.mu_star_before));
        assert_eq!(row.drive_time_star, row.time_star);
    }
}

/// A run that does not ask for a catalogue has none, in its files, numbers and checkpoints.
#[test]
fn a_catalogue_is_asked_for() {
    let text = "slider.blocks = [4, 3]\ndrive.v_star = 0.2\ntime.duration_star = 40\n";
    let [without, with] = ["", "output.events = true\n"].map(|more| parsed(&format!("{text}{more}")));
    assert!(!without.file.to_toml().unwrap().contains("events"));
    let data = running::run(&without, 1).unwrap();
    assert!(data.summary.events.is_none() && data.observers.tables(&without.scales).unwrap().is_empty());
    let asked = running::run(&with, 1).unwrap();
    assert!(asked.summary.events.is_some());
    // Within an event, each block has one more number.
    let columns = |case: &Arc<Case>| {
        let mut running = Running::start(case, None, Execution::default());
        let mut found = Vec::new();
        while running.advance(10).unwrap().is_none() {
            found.push(running.columns()[0].count);
        }
        found.sort_unstable();
        found.dedup();
        found
    };
    let plain = columns(&without);
    assert_eq!(columns(&with), [plain[0], plain[0] + 1]);
    assert_eq!(plain.len(), 1);
}

/// A rough surface with a cavity: events of few blocks and of many; the last one is in progress at the end.
const ROUGH: &str = "slider.blocks = [19, 23]\nslider.omega_star = 0.3\nfriction.sigma_static_star = 0.2\n\
                     drive = { v_star = 0.05, loading = 'held', direction = 25 }\n\
                     time = { step = 0.2, duration_star = 55, kinetic_from_star = 54 }\n\
                     output = { events = true, snapshots = [] }\n[[texture]]\nshape = 'cavity'\ncoverage = 12\n";

#[test]
fn ranks_have_equal_tables() {
    let case = parsed(ROUGH);
    let alone = running::run(&case, 1).unwrap();
    let expected = table(&alone, &case);
    let small = rows(&alone, &case).iter().filter(|row| row.blocks < 10).count();
    assert!(small > 3, "{small}");
    for size in [2, 3] {
        let found = Threads::run(size, |rank| {
            let ranks = Ranks {
                communicator: rank,
                on_node: size,
            };
            let file = CaseFile::parse(ROUGH, "case", &[]).unwrap();
            let case = Arc::new(Case::to_run(file, "case", Path::new(""), &mut |_| true, ranks).unwrap());
            let execution = Execution {
                communicator: Arc::new(rank.clone()),
                ..Execution::default()
            };
            let mut running = Running::start(&case, None, execution);
            let reason = until_end(&mut running);
            let data = running.record(reason);
            (table(&data, &case), data.summary.events)
        });
        for (found, events) in found {
            assert!(found == expected, "{size} ranks");
            assert_eq!(events, alone.summary.events);
        }
    }
}

fn until_end(running: &mut Running) -> StopReason {
    loop {
        if let Some(reason) = running.advance(u64::MAX).unwrap() {
            return reason;
        }
    }
}

/// A run that is stopped at regular steps, within events and between them, and resumed from its saved state
/// has the same catalogue.
#[test]
fn a_catalogue_goes_on_where_it_was_stopped() {
    let case = parsed(ROUGH);
    let expected = table(&running::run(&case, 1).unwrap(), &case);
    let plain = Running::start(&case, None, Execution::default()).columns()[0].count;
    let mut running = Running::start(&case, None, Execution::default());
    let (mut within, mut between) = (0, 0);
    let reason = loop {
        if let Some(reason) = running.advance(23).unwrap() {
            break reason;
        }
        let state = postcard::to_stdvec(&running.state()).unwrap();
        let mut columns = Vec::new();
        running
            .write_columns(|offset, bytes| {
                let end = offset as usize + bytes.len();
                columns.resize(columns.len().max(end), 0);
                columns[offset as usize..end].copy_from_slice(bytes);
                Ok::<(), std::convert::Infallible>(())
            })
            .unwrap();
        if running.columns()[0].count > plain {
            within += 1;
        } else {
            between += 1;
        }
        let state: RunState = postcard::from_bytes(&state).unwrap();
        let read = |offset: u64, bytes: &mut [u8]| {
            bytes.copy_from_slice(&columns[offset as usize..][..bytes.len()]);
            Ok::<(), std::convert::Infallible>(())
        };
        let resumed = Running::resume(&case, state, Execution::default(), read).unwrap();
        running = resumed.expect("the state is one of the case");
    };
    assert!(within > 5 && between > 0, "{within} {between}");
    assert!(table(&running.record(reason), &case) == expected);
}

/// The train of Burridge and Knopoff slips in events of all sizes: most of one block, some of all blocks.
#[test]
fn a_train_of_blocks_slips_in_events_of_all_sizes() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let text = std::fs::read_to_string(cases.join("burridge_knopoff.toml")).unwrap();
    let case = parsed(&text);
    let data = running::run(&case, 1).unwrap();
    let rows = rows(&data, &case);
    let of_blocks = |blocks: std::ops::RangeInclusive<usize>| {
        rows.iter().filter(|row| blocks.contains(&row.blocks)).count()
    };
    let [one, some, all] = [1..=1, 2..=199, 200..=200].map(of_blocks);
    assert!(one > some && some > 10 * all && all > 3, "{one} {some} {all}");
    // A block that slips alone moves by about twice its force drop over the stiffness of its springs,
    // 0.02/1.5; in a slip of the whole train, each block moves by half of its load over the stiffness of its
    // drive spring, 0.5/0.0075.
    let moments: Vec<f64> = rows.iter().map(|row| row.moment_star).collect();
    let least = moments.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(data.summary.events.unwrap().moment_star_max > Some(1e5 * least));
}
