//! Compares the memory and disk space of runs with their estimates. The allocator counts for a whole process,
//! so every test runs in its own process.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

use std::alloc::{GlobalAlloc, Layout, System};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use png::{BitDepth, ColorType, Encoder};
use slipfront::Execution;
use slipfront::communicator::Alone;
use slipfront::testing::{Threads, alone};
use slipfront_calibrate::{CalibrationFile, CalibrationFolder};
use slipfront_case::case::{Case, PICTURES, PROGRAM, Ranks};
use slipfront_case::case_file::CaseFile;
use slipfront_design::{Bounds, DesignFile, RunCache};
use slipfront_plot::PictureLook;
use slipfront_run::checkpoint::Checkpoints;
use slipfront_run::manifest::Processors;
use slipfront_run::measured::Measure;
use slipfront_run::run_curve::run_curve_unless;
use slipfront_run::run_files::RunFiles;
use slipfront_run::run_folder::RunFolder;
use slipfront_run::run_folder::unfinished::Unfinished;
use slipfront_run::running::Running;
use slipfront_run::{pictures, results, running};
use slipfront_study as study;
use slipfront_study::{Plan, RunJournal, StudyFile};

/// The system's allocator, which counts the bytes of all threads.
struct Counting;

static LIVE: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

fn grow(bytes: usize) {
    let live = LIVE.fetch_add(bytes, Ordering::Relaxed) + bytes;
    PEAK.fetch_max(live, Ordering::Relaxed);
}

#[allow(unsafe_code)] // A global allocator cannot be written otherwise; all work is the system's.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        grow(layout.size());
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        LIVE.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.dealloc(block, layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        grow(layout.size());
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        LIVE.fetch_sub(layout.size(), Ordering::Relaxed);
        grow(size);
        unsafe { System.realloc(block, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Largest number of bytes in use at once during some work.
fn peak<T>(work: impl FnOnce() -> T) -> (f64, T) {
    PEAK.store(LIVE.load(Ordering::Relaxed), Ordering::Relaxed);
    let done = work();
    (PEAK.load(Ordering::Relaxed) as f64, done)
}

/// Largest ratio of estimated to used memory, apart from memory that does not depend on the run: an estimate
/// above it could refuse a run that fits.
const MARGIN: f64 = 1.5;

/// Part of the estimate that does not depend on the run: the program itself, which the allocator does not
/// see, and pictures.
const FIXED: f64 = PROGRAM + PICTURES + 2e6;

/// Part of the estimate that does not depend on the design or calibration: both draw their pictures at the
/// end.
const FIXED_WITHOUT_PICTURES: f64 = PROGRAM + 5e6;

fn is_near(said: f64, taken: f64, fixed: f64) -> bool {
    said - fixed <= MARGIN * taken
}

/// Asserts that the estimated memory is at least the used memory, and within the margin.
fn assert_honest(what: &str, said: f64, taken: f64, fixed: f64) {
    let [shown_said, shown_taken] = [said, taken].map(|bytes| bytes / 1e6);
    println!("{what}: {shown_said:.1} MB said, {shown_taken:.1} MB taken");
    assert!(
        said >= taken,
        "{what}: {shown_said} MB said, {shown_taken} MB taken"
    );
    assert!(
        is_near(said, taken, fixed),
        "{what}: {shown_said} MB said, only {shown_taken} MB taken"
    );
}

/// A `.npy` file of 400 x 400 values.
fn npy(descr: &str, data: impl Iterator<Item = u8>) -> Vec<u8> {
    let mut text = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': (400, 400), }}");
    text += &" ".repeat(118 - 1 - text.len());
    let mut bytes = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    bytes.extend(text.bytes().chain(*b"\n").chain(data));
    bytes
}

/// Writes input files: coefficients and a mask of 400 x 400 blocks, and a mask of 4000 x 4000 pixels, both
/// half textured.
fn write_inputs(folder: &Path) {
    let blocks = 400 * 400;
    let mu = npy("<f8", (0..blocks).flat_map(|_| 0.9f64.to_le_bytes()));
    std::fs::write(folder.join("mu.npy"), mu).unwrap();
    let mask = npy("|u1", (0..blocks).map(|block| u8::from(2 * block < blocks)));
    std::fs::write(folder.join("mask.npy"), mask).unwrap();
    let file = std::fs::File::create(folder.join("mask.png")).unwrap();
    let mut encoder = Encoder::new(file, 4000, 4000);
    encoder.set_color(ColorType::Grayscale);
    encoder.set_depth(BitDepth::One);
    let mut writer = encoder.write_header().unwrap();
    // The top row, with the largest y, comes first: bright above and dark below, in the half where the array
    // is textured too.
    let rows = [vec![255; 500 * 2000], vec![0; 500 * 2000]].concat();
    writer.write_image_data(&rows).unwrap();
    writer.finish().unwrap();
}

/// Does this work of the test `name` in its own process, in a folder with the input files.
fn alone_in_folder(name: &str, work: impl FnOnce(&Path)) {
    alone(name, || {
        let folder = tempfile::tempdir().unwrap();
        write_inputs(folder.path());
        work(folder.path());
    });
}

#[test]
fn runs_take_what_is_said() {
    alone_in_folder("runs_take_what_is_said", |folder| runs(&RUNS, folder));
}

#[test]
fn other_runs_take_what_is_said() {
    alone_in_folder("other_runs_take_what_is_said", |folder| runs(&OTHER_RUNS, folder));
}

#[test]
fn models_take_what_is_said() {
    alone_in_folder("models_take_what_is_said", models);
}

#[test]
fn checkpoints_take_what_is_said() {
    alone_in_folder("checkpoints_take_what_is_said", checkpoints);
}

#[test]
fn runs_at_once_take_what_is_said() {
    alone_in_folder("runs_at_once_take_what_is_said", |folder| {
        for base in [
            "",
            "base.slider = { outline = 'disc', viscosity_time_star = 0.1 }\n",
        ] {
            study(base, folder);
        }
    });
}

#[test]
fn designs_take_what_is_said() {
    alone_in_folder("designs_take_what_is_said", designs);
}

#[test]
fn calibrations_take_what_is_said() {
    alone_in_folder("calibrations_take_what_is_said", calibrations);
}

#[test]
fn masks_of_one_image_take_one_mask() {
    alone_in_folder("masks_of_one_image_take_one_mask", masks);
}

#[test]
fn ranks_take_no_more_than_one_process() {
    alone_in_folder("ranks_take_no_more_than_one_process", ranks);
}

#[test]
fn pictures_of_a_large_lattice_take_what_is_said() {
    alone_in_folder(
        "pictures_of_a_large_lattice_take_what_is_said",
        pictures_of_a_large_lattice,
    );
}

/// Whole runs that test pictures, rows of a series, lattices and fronts.
const RUNS: [&str; 7] = [
    // Pictures, and the rows of a long series.
    "slider.blocks=[1,1]",
    "slider.blocks=[25,25];output.snapshots=[]",
    "slider.blocks=[3,3];output.series=0.1;time.duration_star=8000",
    // The lattice.
    "slider.blocks=[600,600];time.duration_star=1;output.snapshots=[]",
    "slider.blocks=[256,256];drive.v_star=0.3",
    // Tall and wide pictures of the front.
    "slider.blocks=[60,180];drive.v_star=0.1;output.snapshots=[]",
    "slider.blocks=[300,75];drive.v_star=0.1;output.snapshots=[]",
];

/// Whole runs with other laws, in the other kernel, with events and snapshots, and of cases that read files.
const OTHER_RUNS: [&str; 18] = [
    // Laws of friction with more state variables.
    "slider.blocks=[400,400];time.duration_star=1;output.snapshots=[];friction.contact='springs';\
     friction.contact_stiffness_star=0.1",
    "slider.blocks=[300,300];time.duration_star=1;output.snapshots=[];friction.law='rate_and_state';friction.a=0.01;\
     friction.b=0.02;friction.d_c_star=0.5;friction.v_0_star=0.03",
    "slider.blocks=[3,3];output.series=0.1;time.duration_star=8000;friction.contact='springs';friction.contact_stiffness_star=0.1",
    "slider.blocks=[400,400];time.duration_star=1;output.snapshots=[];friction.ageing={law='logarithmic',beta=0.1,time_star=1};\
     friction.velocity={law='weakening',v_c_star=0.1,ratio=0.5}",
    // Blocks with different properties, in the other kernel.
    "slider.blocks=[500,500];slider.outline='disc';slider.viscosity_time_star=0.1;time.duration_star=1;output.snapshots=[]",
    "slider.blocks=[500,500];slider.stiffness_grade={along='x',from=1,to=2};slider.density_grade={along='y',from=1,to=2};\
     time.duration_star=1;output.snapshots=[]",
    // Bulk bodies, and the search for the strength of one, which has a simulation of its own.
    "slider.blocks=[400,400];slider.body='bulk';time.duration_star=1;output.snapshots=[]",
    "slider.blocks=[200,200];slider.body='bulk';friction.slip_weakening={length_star=0.5};time.stop='after_onset';output.snapshots=[]",
    // Events of slip.
    "slider.blocks=[60,1];slider.viscosity_time_star=0.3;slider.omega_star=0;friction.r_star=0.1;drive.attach='left';drive.v_star=1;\
     drive.total_stiffness_star=0.004;time.step=0.6;time.duration_star=20000;output.snapshots=[];output.series=100",
    // A catalogue of events, one for nearly every step of the drive.
    "slider.blocks=[60,1];slider.omega_star=0.5;friction.r_star=0.9;drive.v_star=1;drive.loading='held';time.duration_star=2000;\
     time.kinetic_from_star=100;output.snapshots=[];output.series=100;output.events=true",
    // Snapshots.
    "slider.blocks=[400,400];time.duration_star=2;output.snapshots={every=0.1}",
    "slider.blocks=[400,400];time.duration_star=2;output.snapshots={every=0.1};output.stride=3",
    "slider.blocks=[2,2];time.duration_star=200;output.snapshots={every=0.1};output.fields=[]",
    "slider.blocks=[256,256];time.duration_star=8;output.snapshots={every=0.1};output.fields=['contact_stress_star'];output.movie=true",
    // Input files.
    "slider.blocks=[400,400];time.duration_star=1;output.snapshots=[];friction.mu_static_field='mu.npy';\
     friction.mu_kinetic_field='mu.npy';texture=[{shape='mask',file='mask.png'},{shape='mask',file='mask.npy'}]",
    // Initial and final states.
    "slider.blocks=[400,400];time.duration_star=1;output.snapshots=[];output.final_state=true;load.shear_star=0.5;\
     load.shear_field='mu.npy';initial={displacement_x='mu.npy',velocity_y='mu.npy'}",
    "slider.blocks=[400,400];time.duration_star=1;output.snapshots=[];slider.viscosity_time_star=0.1;load.shear_star=0.5;\
     load.shear_field='mu.npy';slider.stiffness_grade={along='x',from=1,to=2}",
    // A thousand outlines of 4096 vertices.
    "slider.blocks=[64,64];time.duration_star=1;output.snapshots=[];texture=[{shape='cavity',s=3,w=0.2,coverage=20,array=[40,25]}]",
];

/// Options of a model: kernels, sliders, laws.
const MODELS: [&str; 19] = [
    "",
    ";slider.outline='disc'",
    ";slider.stiffness_grade={along='x',from=1,to=2}",
    ";slider.density_grade={along='y',from=1,to=2}",
    ";drive.attach='left'",
    ";load.profile={along='x',relative_slope=0.5}",
    ";friction.velocity={law='weakening',v_c_star=0.1,ratio=0.5}",
    ";friction.slip_weakening={length_star=0.5};friction.healing_time_star=1",
    ";slider.stiffness_grade={along='x',from=1,to=2};slider.density_grade={along='y',from=1,to=2};drive.attach='left';\
     load.profile={along='x',relative_slope=0.5}",
    ";slider.body='bulk'",
    ";slider.viscosity_time_star=0.1",
    ";slider.outline='disc';slider.viscosity_time_star=0.1",
    ";slider.stiffness_grade={along='x',from=1,to=2};slider.density_grade={along='y',from=1,to=2};drive.attach='left';\
     load.profile={along='x',relative_slope=0.5};slider.viscosity_time_star=0.1",
    ";drive.motion='rotation'",
    ";friction.law='reversal'",
    ";friction.contact='springs';friction.contact_stiffness_star=0.1",
    ";friction.law='rate_and_state';friction.a=0.01;friction.b=0.02;friction.d_c_star=0.5;friction.v_0_star=0.03",
    ";friction.ageing={law='logarithmic',beta=0.1,time_star=1};friction.velocity={law='weakening',v_c_star=0.1,ratio=0.5}",
    ";slider.outline='disc';slider.viscosity_time_star=0.1;drive.motion='rotation';\
     friction.ageing={law='logarithmic',beta=0.1,time_star=1};friction.velocity={law='weakening',v_c_star=0.1,ratio=0.5}",
];

/// Computes whole runs of cases with these keys, and compares memory and disk space.
fn runs(all: &[&str], folder: &Path) {
    for sets in all.iter().copied() {
        let overrides: Vec<String> = sets.split(';').map(str::to_owned).collect();
        let out = folder.join("out");
        let run = || {
            let file = CaseFile::parse("", "case", &overrides).unwrap();
            let case = Arc::new(Case::new(file, "case", folder, &mut |_| true, Ranks::ALONE).unwrap());
            let mut record = running::run(&case, 2).unwrap();
            let mut out = RunFolder::prepare(&out, false, &case.inputs).unwrap();
            results::write_case(&case, &mut out).unwrap();
            pictures::write_run(
                &case,
                &mut record,
                out,
                jiff::Timestamp::now(),
                Processors::threads(1),
            )
            .unwrap();
            (case.budget.memory(), case.budget.disk())
        };
        let (taken, (memory, disk)) = peak(run);
        assert_room(sets, disk, &out);
        std::fs::remove_dir_all(&out).unwrap();
        let movie = if sets.contains("movie") { 50e6 } else { 0.0 };
        let fixed = FIXED + movie;
        assert_honest(sets, memory, taken, fixed);
    }
}

/// Models with every option, on one thread and on as many threads as there are bands.
fn models(folder: &Path) {
    for sets in MODELS {
        let sets = format!("slider.blocks=[500,500];time.duration_star=0.5;output.snapshots=[]{sets}");
        let overrides: Vec<String> = sets.split(';').map(str::to_owned).collect();
        let taken_on = |threads| {
            let before = LIVE.load(Ordering::Relaxed) as f64;
            let (taken, said) = peak(|| {
                let file = CaseFile::parse("", "case", &overrides).unwrap();
                let case = Case::new(file, "case", folder, &mut |_| true, Ranks::ALONE).unwrap();
                let case = Arc::new(case);
                running::run(&case, threads).unwrap();
                case.budget.memory()
            });
            (said, taken - before)
        };
        let [(said, on_one), (_, on_many)] = [1, 16].map(taken_on);
        // The estimate does not know the number of threads.
        assert_honest(&sets, said, on_one.max(on_many), FIXED);
    }
}

/// Ranks that build a case together use no more memory than a single process, apart from the buffers of the
/// ranks that read.
fn ranks(folder: &Path) {
    let text = "slider.blocks = [400, 400]\nfriction = { mu_static_field = 'mu.npy', mu_kinetic_field = 'mu.npy' }\n\
                texture = [{ shape = 'mask', file = 'mask.png' }, { shape = 'mask', file = 'mask.npy' }]";
    let make = |ranks: Ranks| {
        let file = CaseFile::parse(text, "case", &[]).unwrap();
        Case::new(file, "case", folder, &mut |_| true, ranks).unwrap()
    };
    let before = LIVE.load(Ordering::Relaxed) as f64;
    let (alone, _) = peak(|| make(Ranks::ALONE));
    let on_ranks = |size: usize| {
        let (taken, _) = peak(|| {
            Threads::run(size, |communicator| {
                make(Ranks {
                    communicator,
                    on_node: size,
                })
            })
        });
        taken - before
    };
    let (alone, one, four) = (alone - before, on_ranks(1), on_ranks(4));
    // The decoder of an image, the reader of a file and the texts of a case hardly grow with the lattice.
    let buffers = 256.0 * 1024.0;
    assert!(
        four <= alone + 4.0 * buffers,
        "{four} bytes of four ranks, {alone} of one process"
    );
    assert!(
        (one - alone).abs() < buffers,
        "{one} bytes of one rank, {alone} of one process"
    );
}

/// A run that is resumed from a checkpoint and saves the next one uses no more memory than a new run.
fn checkpoints(folder: &Path) {
    for sets in [
        "slider.blocks=[600,600];time.duration_star=1;output.snapshots=[]",
        "slider.blocks=[400,400];time.duration_star=2;output.snapshots={every=0.1}",
        "slider.blocks=[400,400];time.duration_star=1;output.snapshots=[];friction.contact='springs';\
         friction.contact_stiffness_star=0.1",
    ] {
        let overrides: Vec<String> = sets.split(';').map(str::to_owned).collect();
        // `Case::parse` would reserve the memory of a run, to check whether it is available.
        let made = || {
            let file = CaseFile::parse("", "case", &overrides).unwrap();
            Arc::new(Case::new(file, "case", folder, &mut |_| true, Ranks::ALONE).unwrap())
        };
        let out = folder.join("saved");
        std::fs::create_dir(&out).unwrap();
        Unfinished::in_folder(&out).create().unwrap();
        let save = |case: &Case, running: &Running| {
            let mut checkpoints = Checkpoints::new(&out, case, jiff::Timestamp::UNIX_EPOCH);
            checkpoints.save(running, &Alone).unwrap();
        };
        let case = made();
        let mut running = Running::start(&case, None, Execution::default());
        running.advance(case.time_plan.last_step - 1).unwrap();
        save(&case, &running);
        drop((case, running));
        // The fonts of earlier pictures do not count: a resumed run has not loaded them yet.
        let before = LIVE.load(Ordering::Relaxed) as f64;
        let (taken, said) = peak(|| {
            let case = made();
            let loaded = Checkpoints::load(&out, &case, false, &Alone).unwrap().unwrap();
            let running = loaded.resume(&case, Execution::on_threads(2)).unwrap().unwrap();
            save(&case, &running);
            case.budget.memory()
        });
        let taken = taken - before;
        assert_honest(&format!("to go on with {sets}"), said, taken, FIXED);
        let room = made().budget.disk_of_checkpoints() / 3.0;
        assert_room(sets, room, &out);
        std::fs::remove_dir_all(out).unwrap();
    }
}

/// Maps are averaged while they are read, so their memory does not depend on the size of the lattice.
fn pictures_of_a_large_lattice(folder: &Path) {
    let sets = [
        "slider.blocks=[1500,1200]",
        "output.fields=['contact_stress_star']",
        "time.duration_star=1",
        "output.snapshots=[0,0.2,0.4,0.6,0.8,1]",
    ];
    let file = CaseFile::parse("", "case", &sets.map(str::to_owned)).unwrap();
    let case = Arc::new(Case::new(file, "case", folder, &mut |_| true, Ranks::ALONE).unwrap());
    let mut record = running::run(&case, 1).unwrap();
    let out = folder.join("out");
    let prepared = RunFolder::prepare(&out, false, &case.inputs).unwrap();
    pictures::write_run(
        &case,
        &mut record,
        prepared,
        jiff::Timestamp::now(),
        Processors::threads(1),
    )
    .unwrap();
    drop((case, record));
    let before = LIVE.load(Ordering::Relaxed) as f64;
    let (taken, drawn) = peak(|| pictures::draw(RunFiles::Folder(&out), &PictureLook::default()).unwrap());
    assert_eq!(drawn.len(), 2);
    let said = pictures::memory(std::slice::from_ref(&out)).unwrap();
    // The estimate allows for pictures of any size.
    assert_honest("pictures of a large lattice", said, taken - before, FIXED + 100e6);
    std::fs::remove_dir_all(out).unwrap();
}

/// Several textures of one image use the memory of a single mask of the lattice.
fn masks(folder: &Path) {
    let text = "[[texture]]\nshape = 'mask'\nfile = 'mask.png'\n".repeat(40);
    let before = LIVE.load(Ordering::Relaxed) as f64;
    let (taken, case) = peak(|| {
        let file = CaseFile::parse(&text, "case", &[]).unwrap();
        Case::new(file, "case", folder, &mut |_| true, Ranks::ALONE).unwrap()
    });
    // The centres of 13 of 25 rows of blocks are in the dark half; the middle row is on its first row of
    // pixels.
    assert_eq!((case.texture.meshed_percent, case.inputs.len()), (52.0, 1));
    // A sixteenth of the number of pixels, one byte each: this includes the decoder, the file and its copy.
    let taken = taken - before;
    assert!(taken < 1e6, "{taken} bytes for 625 blocks");
}

/// Bytes of all files below a folder.
fn bytes_in(folder: &Path) -> f64 {
    let entries = std::fs::read_dir(folder).unwrap().map(Result::unwrap);
    let bytes = |entry: std::fs::DirEntry| match entry.metadata().unwrap() {
        file if file.is_file() => file.len() as f64,
        _ => bytes_in(&entry.path()),
    };
    entries.map(bytes).sum()
}

fn assert_room(what: &str, said: f64, out: &Path) {
    let taken = bytes_in(out);
    assert!(said >= taken, "{what}: {said} bytes said, {taken} taken");
    // Pictures with few colours are small, and the estimate counts maps even if none is drawn.
    assert!(
        said <= MARGIN * taken + 4.5e6,
        "{what}: {said} bytes said, only {taken} taken"
    );
}

/// A design with its verdict, on one thread and on two.
fn designs(_: &Path) {
    let text = "[base]\nslider.blocks = [150, 150]\ndrive.v_star = 0.3\n\
                friction = { sigma_static_star = 0, sigma_kinetic_star = 0 }\n[design]\n\
                wish = { least = 'static_friction' }\ncoverage = [0, 15]\nfeature_blocks = 4\ngap_blocks = 4\n";
    let file = DesignFile::parse(text, "design.toml", "design", Path::new("")).unwrap();
    let runs = 4;
    let find = || {
        let bounds = Bounds {
            runs,
            share_of_time: &|| 0.0,
            stop: &AtomicBool::new(false),
            cut: None,
        };
        let design = file.design().unwrap();
        design.run(&bounds, &mut RunCache::new(), &mut |_| Ok(()), &mut |_| {})
    };
    assert_honest_on_threads(
        "a design",
        FIXED_WITHOUT_PICTURES,
        |threads| file.memory(runs).unwrap().on_threads(threads),
        |threads| drop(on_threads(threads, find).unwrap()),
    );
}

/// A calibration with its report, on one thread and on two.
fn calibrations(folder: &Path) {
    let text = "slider.blocks = [6, 6]\ntime.step = 0.4\ndrive = { v_star = 0.1, stiffness_star = 0.7 }";
    let case = Case::parse(text, "truth", "", &[]).unwrap();
    let curve = run_curve_unless(&case, Measure::Time, 120.0 * case.scales.time(), &|| false);
    let curve = curve.unwrap().unwrap();
    let unit = curve.unit_force.unwrap();
    let rows = curve.time.iter().zip(&curve.coefficient);
    let rows: String = rows
        .map(|(time, mu)| format!("{time:e},{:e}\n", unit * mu))
        .collect();
    let record = folder.join("record.csv");
    std::fs::write(&record, format!("time_s,force_n\n{rows}")).unwrap();
    let records = [record];
    let text = "[base]\nslider.blocks = [6, 6]\ndrive.v_star = 0.1\ntime.step = 0.4\n[calibrate]\nx = 'time_s'\n\
                y = 'force_n'\nnoise = 0.01\nruns = 1000\nfiner_runs = 200\n\
                unknowns = { 'friction.mu_static' = [0.3, 0.9], 'drive.stiffness_star' = [0.3, 0.9] }\n";
    let file = CalibrationFile::parse(text, "fit.toml", "fit", Path::new("")).unwrap();
    let mut most = 0.0_f64;
    for threads in [1, 2] {
        let out = folder.join("calibration");
        let before = LIVE.load(Ordering::Relaxed) as f64;
        let (taken, _) = peak(|| {
            let mut opened =
                CalibrationFolder::open(&out, None, &file, file.read(&records).unwrap(), false).unwrap();
            on_threads(threads, || {
                opened.find(None, &AtomicBool::new(false), &mut |_| {})
            })
            .unwrap()
        });
        // Two threads, of which one has to wait, take as much as one alone, and otherwise more.
        most = most.max(taken - before);
        let said = file
            .memory(&file.read(&records).unwrap())
            .unwrap()
            .on_threads(threads);
        assert_honest(
            &format!("a calibration on {threads} threads"),
            said,
            most,
            FIXED_WITHOUT_PICTURES,
        );
        std::fs::remove_dir_all(out).unwrap();
    }
}

/// Does work on this many threads, plus the thread that waits for it.
fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads + 1).build();
    pool.unwrap().install(work)
}

/// Measures the memory of work on one thread and on two, and compares it with the estimate `said`. Each
/// thread works on its own pieces, so their memory adds up.
fn assert_honest_on_threads(
    what: &str,
    fixed: f64,
    said: impl Fn(usize) -> f64,
    mut work: impl FnMut(usize),
) {
    let mut alone = 0.0;
    for threads in [1, 2] {
        // Memory left by an earlier part of the test, such as the fonts of pictures, does not count.
        let before = LIVE.load(Ordering::Relaxed) as f64;
        let (taken, ()) = peak(|| work(threads));
        let taken = taken - before;
        if threads == 1 {
            alone = taken;
        }
        // The largest pieces of two threads may or may not coincide: the estimate must allow for it.
        let most = taken.max(threads as f64 * alone);
        assert_honest(
            &format!("{what} on {threads} threads"),
            said(threads),
            most,
            fixed,
        );
    }
}

/// A study of runs of two sizes.
fn study(base: &str, folder: &Path) {
    let text = format!(
        "{base}base.time.duration_star = 2\n[study]\nreplicates = 2\n[[axes]]\nkey = 'slider.blocks'\n\
         list = [[10, 10], [500, 500]]"
    );
    let file = StudyFile::parse(&text, "study.toml", "study", folder).unwrap();
    let plan = Plan::new(&file, None).unwrap();
    assert_honest_on_threads(
        "a study",
        FIXED,
        |threads| plan.memory(threads),
        |threads| {
            let records = tempfile::tempdir().unwrap();
            let records = RunJournal::open(records.path()).unwrap();
            let never = AtomicBool::new(false);
            on_threads(threads, || {
                study::execute(&plan, &records, folder, &never, &mut |_| {})
            })
            .unwrap();
        },
    );
}
