//! A session: the run of one page, in a thread of its own, which works only while somebody looks.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::time::{Duration, Instant};

use slipfront::PositionBins;
use slipfront_run::program::VERSION;
use slipfront_run::summary::summary_json;
use toml::Value;

use crate::controls;
use crate::document::{Document, MAX_BLOCKS};
use crate::history::History;
use crate::live::{Live, Points};
use crate::opening::{Opened, Start};
use crate::outbox::Outbox;
use crate::picture::{self, Frame, Painter};
use crate::protocol::{
    CaseReply, CurveReply, NumbersReply, PresetEntry, ProbeReply, Reply, Request, Source, Units,
};
use crate::repeat::{Stoppable, repeat};
use crate::replay::{self, Recorded};
use crate::view::{AfterChange, View};
use crate::{base64, presets, save, shapes, zip};

/// Time between two reports of numbers, two of the block under the pointer, and two kymographs.
const NUMBERS: Duration = Duration::from_millis(200);
const PROBE: Duration = Duration::from_millis(100);
const KYMOGRAPH: Duration = Duration::from_millis(500);

/// Longest time of steps between two looks at the clock.
const PIECE: Duration = Duration::from_millis(3);

/// Most points of a stroke in one message.
const MAX_POINTS: usize = 4096;

/// Most seeds of a repetition.
const MAX_SEEDS: u64 = 32;

/// What all sessions share.
pub(crate) struct Setting {
    pub(crate) start: Start,
    /// The folder of results.
    pub(crate) results: PathBuf,
    pub(crate) threads: usize,
    pub(crate) presets: Vec<PresetEntry>,
}

/// Serves a page until it is gone. A defect of the simulation ends its run, not the session.
pub(crate) fn serve(
    setting: &Arc<Setting>,
    outbox: &Arc<Outbox>,
    requests: &Receiver<Request>,
    working: &Sender<()>,
) {
    Session::greet(setting, outbox);
    loop {
        let mut session = Session::new(setting, outbox, working);
        match catch_unwind(AssertUnwindSafe(|| session.serve(requests))) {
            Ok(()) => return,
            Err(_) => outbox.reply(&Reply::Failed {
                sentence: "the simulation failed by a defect of its own, which the terminal tells; the case can be opened again"
                    .to_owned(),
            }),
        }
    }
}

/// Whose untextured twin it is, as the text of its case.
struct Twin {
    live: Live,
    toml: String,
}

/// An edited case that is not run yet.
struct Edited {
    document: Document,
    gesture: u64,
    of: &'static str,
}

struct Session {
    setting: Arc<Setting>,
    /// Held by every thread as long as it works.
    working: Sender<()>,
    outbox: Arc<Outbox>,
    view: View,
    history: Option<History>,
    edited: Option<Edited>,
    /// The texture while it is painted.
    mask: Option<(Vec<bool>, u64)>,
    live: Option<Live>,
    twin: Option<Twin>,
    recorded: Option<Recorded>,
    shown_recording: Option<usize>,
    painter: Painter,
    clock: Clock,
    /// Steps that were asked for one by one.
    single_steps: u64,
    repeating: Option<Stoppable>,
    saving: Option<Stoppable>,
    /// What is to be told with the next points.
    news: News,
}

/// What the page has not been told yet.
#[derive(Default)]
struct News {
    /// Something is to be drawn although nothing moved.
    redraw: bool,
    from_rest: bool,
    twin_reset: bool,
    recorded: bool,
    /// Whether the end was told.
    end_told: bool,
}

/// When things were done last.
struct Clock {
    picture: Instant,
    numbers: Instant,
    probe: Instant,
    kymograph: Instant,
    /// Steps that are due, as a number with its fraction, and when this was found out.
    due: f64,
    asked: Instant,
    counted_from: Instant,
    counted_steps: u64,
    steps_per_second: f64,
    seconds_per_step: f64,
}

impl Clock {
    fn new() -> Self {
        let now = Instant::now();
        let long_ago = now.checked_sub(Duration::from_secs(60)).unwrap_or(now);
        Self {
            picture: now,
            numbers: long_ago,
            probe: long_ago,
            kymograph: long_ago,
            due: 0.0,
            asked: now,
            counted_from: now,
            counted_steps: 0,
            steps_per_second: 0.0,
            seconds_per_step: 1e-4,
        }
    }

    /// Seconds since this was asked last, a quarter of one at most: a page that was hidden is not made up for.
    fn since_asked(&mut self) -> f64 {
        let since = self.asked.elapsed().as_secs_f64();
        self.asked = Instant::now();
        since.min(0.25)
    }

    /// Counts steps that took some time.
    fn count(&mut self, steps: u64, took: Duration) {
        if steps == 0 {
            return;
        }
        let each = took.as_secs_f64() / steps as f64;
        self.seconds_per_step += 0.2 * (each - self.seconds_per_step);
        self.counted_steps += steps;
    }

    /// The steps of the last second.
    fn rate(&mut self) -> f64 {
        let elapsed = self.counted_from.elapsed().as_secs_f64();
        if elapsed >= 1.0 {
            self.steps_per_second = self.counted_steps as f64 / elapsed;
            (self.counted_from, self.counted_steps) = (Instant::now(), 0);
        }
        self.steps_per_second
    }

    /// Steps that take a small piece of time.
    fn piece(&self) -> u64 {
        ((PIECE.as_secs_f64() / self.seconds_per_step) as u64).max(1)
    }
}

fn is_due(last: &mut Instant, every: Duration) -> bool {
    let due = last.elapsed() >= every;
    if due {
        *last = Instant::now();
    }
    due
}

impl Session {
    fn new(setting: &Arc<Setting>, outbox: &Arc<Outbox>, working: &Sender<()>) -> Self {
        Self {
            working: working.clone(),
            setting: Arc::clone(setting),
            outbox: Arc::clone(outbox),
            view: View::default(),
            history: None,
            edited: None,
            mask: None,
            live: None,
            twin: None,
            recorded: None,
            shown_recording: None,
            painter: Painter::default(),
            clock: Clock::new(),
            single_steps: 0,
            repeating: None,
            saving: None,
            news: News::default(),
        }
    }

    /// Tells what there is to choose from.
    pub(crate) fn greet(setting: &Setting, outbox: &Outbox) {
        outbox.reply(&Reply::Hello {
            version: VERSION,
            presets: &setting.presets,
            folders: replay::folders(&setting.results),
            results: slipfront_case::text::display_path(&setting.results),
            max_blocks: MAX_BLOCKS,
            controls: &controls::CONTROLS,
        });
    }

    fn serve(&mut self, requests: &Receiver<Request>) {
        loop {
            let first = if self.is_idle() {
                requests.recv().map_err(|_| RecvTimeoutError::Disconnected)
            } else {
                requests.recv_timeout(self.time_to_wait())
            };
            match first {
                Ok(request) => self.answer(request),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
            while let Ok(request) = requests.try_recv() {
                self.answer(request);
            }
            self.run_edited();
            self.work();
        }
    }

    /// Whether there is nothing to do before the page asks for something.
    fn is_idle(&self) -> bool {
        if !self.view.visible {
            return true;
        }
        let moves = self.live.as_ref().is_some_and(|live| live.ended.is_none())
            || self.twin.as_ref().is_some_and(|twin| twin.live.ended.is_none());
        let moves = moves && (!self.view.paused || self.single_steps > 0);
        !(moves || self.news.redraw || self.has_untold_end())
    }

    fn has_untold_end(&self) -> bool {
        !self.news.end_told && self.live.as_ref().is_some_and(|live| live.ended.is_some())
    }

    fn time_to_wait(&self) -> Duration {
        let next = self.clock.picture + Duration::from_secs_f64(1.0 / self.view.frames_per_second);
        match self.news.redraw || self.clock.due >= 1.0 {
            true => Duration::ZERO,
            false => next.saturating_duration_since(Instant::now()),
        }
    }

    fn answer(&mut self, request: Request) {
        let of = request.name();
        if let Err(sentence) = self.obey(request) {
            self.outbox.reply(&Reply::Refused { of, sentence });
        }
    }

    fn obey(&mut self, request: Request) -> Result<(), String> {
        match request {
            Request::Open { source } => self.open(source),
            Request::Set { keys, gesture } => self.set(keys, gesture),
            Request::Paint {
                points,
                radius,
                textured,
                gesture,
            } => self.paint(&points, radius, textured, gesture),
            Request::Image {
                png,
                threshold,
                gesture,
            } => self.image(&png, threshold, gesture),
            Request::Undo => self.go_back("undo", History::undo),
            Request::Redo => self.go_back("redo", History::redo),
            Request::Rest => {
                self.run_edited();
                self.run_present("rest", true)
            }
            Request::View(change) => {
                let had_twin = self.view.twin;
                self.view.change(&change)?;
                self.news.redraw = true;
                self.clock.due = 0.0;
                if had_twin != self.view.twin && self.history.is_some() {
                    self.begin_twin(true)?;
                }
                Ok(())
            }
            Request::Step { count } => {
                self.single_steps = count.clamp(1, 10_000);
                Ok(())
            }
            Request::Repeat { seeds } => self.repeat(seeds),
            Request::Save { name } => self.save(name),
            Request::SaveStop => {
                self.saving = None;
                Ok(())
            }
            Request::Export => self.export(),
            Request::FramesOf { index } => {
                self.shown_recording = index;
                self.painter.forget_scale();
                self.news.redraw = true;
                Ok(())
            }
            #[cfg(test)]
            Request::Panic => panic!("a defect that a test asks for"),
        }
    }

    fn open(&mut self, source: Source) -> Result<(), String> {
        let mut recorded = None;
        let document = if let Some(name) = source.preset {
            presets::document(&name)?
        } else if let Some(name) = source.folder {
            let (document, found) = replay::read(&replay::folder(&self.setting.results, &name)?)?;
            recorded = Some(found);
            document
        } else if let Some(toml) = source.toml {
            let mut files = BTreeMap::new();
            for (name, text) in source.files {
                files.insert(name, base64::decode(&text)?);
            }
            let read = |name: &str| {
                files
                    .get(name)
                    .cloned()
                    .ok_or_else(|| std::io::ErrorKind::NotFound.into())
            };
            Document::new("case", &toml, read).map_err(|error| error.to_string())?
        } else {
            match &self.setting.start.0 {
                Opened::Preset => presets::document(presets::OPENING)?,
                Opened::Case(document) => Document::clone(document),
                Opened::Folder(path) => {
                    let (document, found) = replay::read(path)?;
                    recorded = Some(found);
                    document
                }
            }
        };
        // Whether it can be run is known before anything is given up.
        let case = Arc::new(document.case_to_show().map_err(|error| error.to_string())?);
        (self.edited, self.mask) = (None, None);
        (self.repeating, self.shown_recording) = (None, None);
        self.history = Some(History::new(document));
        self.recorded = recorded;
        self.news.recorded = self.recorded.is_some();
        self.begin(case, "open", true)?;
        if let Some(snapshots) = self
            .recorded
            .as_ref()
            .and_then(|recorded| recorded.snapshots.as_ref())
        {
            let times_star = snapshots.frames.iter().map(|frame| frame.time_star).collect();
            self.outbox.reply(&Reply::Recorded { times_star });
        }
        Ok(())
    }

    /// The case as it is edited up to now.
    fn document(&self) -> Result<&Document, String> {
        let edited = self.edited.as_ref().map(|edited| &edited.document);
        edited
            .or(self.history.as_ref().map(History::present))
            .ok_or_else(|| "no case is open yet".to_owned())
    }

    fn set(&mut self, keys: serde_json::Map<String, serde_json::Value>, gesture: u64) -> Result<(), String> {
        self.run_painted();
        let mut changes = Vec::new();
        for (key, value) in keys {
            let value = match value {
                serde_json::Value::Null => None,
                value => Some(
                    Value::try_from(value)
                        .map_err(|error| format!("`{key}` is no value of TOML: {error}"))?,
                ),
            };
            changes.push((key, value));
        }
        let document = self.document()?.with(changes)?;
        self.edited = Some(Edited {
            document,
            gesture,
            of: "set",
        });
        Ok(())
    }

    fn paint(
        &mut self,
        points: &[[f64; 2]],
        radius: f64,
        textured: bool,
        gesture: u64,
    ) -> Result<(), String> {
        if points.is_empty() || points.len() > MAX_POINTS || !points.iter().flatten().all(|x| x.abs() < 1e6) {
            return Err(format!("a stroke has 1 to {MAX_POINTS} points near the slider"));
        }
        if !(0.1..=1000.0).contains(&radius) {
            return Err(format!(
                "the radius of the brush is {radius} blocks, where it may be from 0.1 to 1000"
            ));
        }
        self.run_set();
        let live = self.live.as_ref().ok_or("no case is open yet")?;
        let model = &live.case().model;
        let lattice = &model.lattice;
        let (mask, painted_by) = self
            .mask
            .get_or_insert_with(|| (model.surface.textured.clone(), gesture));
        *painted_by = gesture;
        // The last point once more, for a stroke of a single one.
        let ends = points.iter().skip(1).chain(points.last());
        for (from, to) in points.iter().zip(ends) {
            let rows = [from[1].min(to[1]) - radius, from[1].max(to[1]) + radius];
            let columns = [from[0].min(to[0]) - radius, from[0].max(to[0]) + radius];
            let within = |[low, high]: [f64; 2], count: usize| {
                (low.floor().max(0.0) as usize).min(count)..(high.ceil().max(0.0) as usize).min(count)
            };
            for j in within(rows, lattice.ny) {
                for i in within(columns, lattice.nx) {
                    let middle = [i as f64 + 0.5, j as f64 + 0.5];
                    if distance(middle, *from, *to) <= radius {
                        mask[lattice.block(i, j)] = textured;
                    }
                }
            }
        }
        Ok(())
    }

    fn image(&mut self, text: &str, threshold: f64, gesture: u64) -> Result<(), String> {
        self.run_painted();
        let image = base64::decode(text)?;
        let document = self
            .document()?
            .with_image(image, threshold)
            .map_err(|error| error.to_string())?;
        self.edited = Some(Edited {
            document,
            gesture,
            of: "image",
        });
        Ok(())
    }

    fn go_back(&mut self, why: &'static str, go: fn(&mut History) -> bool) -> Result<(), String> {
        self.run_edited();
        match self.history.as_mut().is_some_and(go) {
            true => self.run_present(why, self.view.after_change == AfterChange::Rest),
            false => Ok(()),
        }
    }

    /// Runs the case with all that was edited since.
    fn run_edited(&mut self) {
        self.run_painted();
        self.run_set();
    }

    /// Makes a case of what was painted.
    fn run_painted(&mut self) {
        let Some((mask, gesture)) = self.mask.take() else {
            return;
        };
        let made = self.document().map(|document| {
            let nx = self.live.as_ref().map_or(1, |live| live.case().model.lattice.nx);
            document.with_mask(&mask, nx).map_err(|error| error.to_string())
        });
        match made.and_then(|made| made) {
            Ok(document) => {
                self.edited = Some(Edited {
                    document,
                    gesture,
                    of: "paint",
                });
                self.run_set();
            }
            Err(sentence) => self.outbox.reply(&Reply::Refused {
                of: "paint",
                sentence,
            }),
        }
    }

    /// Runs the case whose keys were changed.
    fn run_set(&mut self) {
        let Some(Edited {
            document,
            gesture,
            of,
        }) = self.edited.take()
        else {
            return;
        };
        let from_rest = self.view.after_change == AfterChange::Rest;
        let made = document.case_to_show().map_err(|error| error.to_string());
        let begun = made.and_then(|case| {
            if let Some(history) = &mut self.history {
                history.change(document, gesture);
            }
            self.begin(Arc::new(case), "change", from_rest)
        });
        if let Err(sentence) = begun {
            self.outbox.reply(&Reply::Refused { of, sentence });
            // The page shows what it has asked for: it is told what holds.
            self.tell_case("refused");
        }
    }

    /// Runs the present case again, from rest or from where it is.
    fn run_present(&mut self, why: &'static str, from_rest: bool) -> Result<(), String> {
        let case = self
            .document()?
            .case_to_show()
            .map_err(|error| error.to_string())?;
        self.begin(Arc::new(case), why, from_rest)
    }

    /// Runs a case, of which the document is the present one.
    fn begin(
        &mut self,
        case: Arc<slipfront_case::case::Case>,
        why: &'static str,
        from_rest: bool,
    ) -> Result<(), String> {
        let went_on = match &mut self.live {
            // A run that cannot go on under this case begins again.
            Some(live) if !from_rest => live.change(&case).is_ok(),
            _ => false,
        };
        if !went_on {
            self.live = Some(Live::from_rest(&case, self.setting.threads));
            self.painter.forget_scale();
            self.clock.due = 0.0;
        }
        self.news.from_rest |= !went_on;
        self.news.redraw = true;
        self.news.end_told = false;
        self.shown_recording = None;
        self.begin_twin(!went_on)?;
        self.tell_case(why);
        Ok(())
    }

    /// Lets the slider without texture run beside it, if there is one to compare with.
    fn begin_twin(&mut self, from_rest: bool) -> Result<(), String> {
        let document = self.document()?;
        if !self.view.twin || document.textures().as_array().is_none_or(Vec::is_empty) {
            self.twin = None;
            return Ok(());
        }
        let document = document.without_texture();
        let toml = document.toml();
        // What it depends on has not changed: it stays as far as it is.
        if let Some(twin) = &self.twin
            && twin.toml == toml
            && (!from_rest || twin.live.leg == 0)
        {
            return Ok(());
        }
        let case = Arc::new(document.case_to_show().map_err(|error| error.to_string())?);
        let went_on = match &mut self.twin {
            Some(twin) if !from_rest => {
                twin.toml.clone_from(&toml);
                twin.live.change(&case).is_ok()
            }
            _ => false,
        };
        if !went_on {
            let live = Live::from_rest(&case, self.setting.threads);
            self.twin = Some(Twin { live, toml });
            self.news.twin_reset = true;
        }
        Ok(())
    }

    fn tell_case(&mut self, why: &'static str) {
        let (Some(history), Some(live)) = (&self.history, &self.live) else {
            return;
        };
        let (document, case) = (history.present(), live.case());
        let (scales, lattice) = (&case.scales, &case.model.lattice);
        let reply = CaseReply {
            name: &document.name,
            toml: document.toml(),
            files: document.files().keys().map(String::as_str).collect(),
            link_files_bytes: document.files().values().map(Vec::len).sum(),
            blocks: [lattice.nx, lattice.ny],
            block_size_m: scales.block_size,
            n_blocks: case.model.n_blocks(),
            texture_percent: case.texture.meshed_percent,
            texture: document.textures(),
            shapes: shapes::outlines(case),
            values: controls::values(case),
            units: Units {
                time_s: scales.time(),
                displacement_m: scales.displacement(),
                speed_m_s: scales.speed(),
                stress_pa: scales.stress(),
            },
            dt_star: case.time_plan.dt_star,
            duration_star: case.time_plan.end_star(),
            kinetic_from_star: {
                let peak = live.running().snapshot().peak;
                case.time_plan
                    .kinetic
                    .time_star(&peak, case.model.loading_speed())
            },
            steady_level: case.expected.steady_level,
            can_undo: history.can_undo(),
            can_redo: history.can_redo(),
            leg: live.leg,
            why,
            time_before_s: live.time_before_s(),
            twin: self.twin.is_some(),
            has_memory: live.has_memory(),
            warnings: case.warnings(),
        };
        self.outbox.reply(&Reply::Case(Box::new(reply)));
    }

    fn repeat(&mut self, seeds: u64) -> Result<(), String> {
        self.repeating = None;
        if seeds == 0 {
            return Ok(());
        }
        if !(2..=MAX_SEEDS).contains(&seeds) {
            return Err(format!(
                "{seeds} seeds were asked for, where there may be 2 to {MAX_SEEDS}"
            ));
        }
        self.run_edited();
        let (document, outbox) = (self.document()?.clone(), Arc::clone(&self.outbox));
        let work = Stoppable::begin(&self.working, move |stop| repeat(&document, seeds, &outbox, stop));
        self.repeating = Some(work.map_err(|error| error.to_string())?);
        Ok(())
    }

    fn save(&mut self, name: String) -> Result<(), String> {
        self.run_edited();
        save::folder(&self.setting.results, &name)?;
        let (document, outbox, setting) = (
            self.document()?.clone(),
            Arc::clone(&self.outbox),
            Arc::clone(&self.setting),
        );
        let work = Stoppable::begin(&self.working, move |stop| {
            save::save(document, &setting.results, &name, setting.threads, &outbox, stop);
        });
        self.saving = Some(work.map_err(|error| error.to_string())?);
        Ok(())
    }

    fn export(&mut self) -> Result<(), String> {
        self.run_edited();
        let document = self.document()?;
        let toml = document.toml();
        let files = document
            .files()
            .iter()
            .map(|(name, bytes)| (name.as_str(), bytes.as_slice()));
        let all = [("case.toml", toml.as_bytes())].into_iter().chain(files.clone());
        let archive = zip::archive(all).map_err(|error| format!("the archive cannot be made: {error}"))?;
        self.outbox.reply(&Reply::Exported {
            toml: &toml,
            files: files.map(|(name, bytes)| (name, base64::encode(bytes))).collect(),
            zip: base64::encode(&archive),
        });
        Ok(())
    }

    /// Steps until the next picture is due, and tells what is new.
    fn work(&mut self) {
        if !self.view.visible || self.live.is_none() || self.outbox.is_full() {
            return;
        }
        let period = Duration::from_secs_f64(1.0 / self.view.frames_per_second);
        let next = self.clock.picture + period;
        if let Err(sentence) = self.take_steps(next) {
            self.outbox.reply(&Reply::Failed { sentence });
            (self.live, self.twin) = (None, None);
            return;
        }
        if self.news.redraw || self.clock.picture.elapsed() >= period {
            self.clock.picture = Instant::now();
            self.tell();
        }
    }

    /// Takes the steps that are due until the next picture.
    fn take_steps(&mut self, next: Instant) -> Result<(), String> {
        let Some(live) = &mut self.live else { return Ok(()) };
        let dt_star = live.case().time_plan.dt_star;
        if self.view.paused {
            live.advance(std::mem::take(&mut self.single_steps).max(0))?;
            self.news.redraw = true;
            return Ok(());
        }
        self.clock.due = match self.view.pace {
            0.0 => f64::INFINITY,
            // What cannot be taken until the next picture is left out: the run is slower than asked for then.
            pace => (self.clock.due + pace / dt_star * self.clock.since_asked()).min(pace / dt_star),
        };
        loop {
            let before = live.step();
            let began = Instant::now();
            let steps = self.clock.piece().min(self.clock.due as u64);
            live.advance(steps)?;
            let taken = live.step() - before;
            self.clock.count(taken, began.elapsed());
            self.clock.due -= taken as f64;
            let twin = self.twin.as_mut().filter(|twin| twin.live.ended.is_none());
            let twin_left = match twin {
                Some(twin) if twin.live.time_star() < live.time_star() || live.ended.is_some() => {
                    twin.live.advance(self.clock.piece())?;
                    true
                }
                _ => false,
            };
            let is_left = live.ended.is_none() && self.clock.due >= 1.0;
            if !(is_left || twin_left) || Instant::now() >= next {
                break;
            }
        }
        if live.ended.is_some() {
            self.clock.due = 0.0;
        }
        Ok(())
    }

    /// Tells what is new: curve, picture, numbers.
    fn tell(&mut self) {
        let Some(live) = &mut self.live else { return };
        let ended_now = live.ended.is_some() && !self.news.end_told;
        let points = live.new_points();
        let twin = self.twin.as_mut().map_or_else(Points::default, |twin| {
            if self.news.twin_reset {
                twin.live.tell_again();
            }
            twin.live.new_points()
        });
        let recorded = self.recorded.as_ref().filter(|_| self.news.recorded);
        if self.news.from_rest
            || self.news.twin_reset
            || !points.time_star.is_empty()
            || !twin.time_star.is_empty()
        {
            self.outbox.reply(&Reply::Curve(CurveReply {
                leg: live.leg,
                from_rest: self.news.from_rest,
                t: points.time_star,
                mu: points.mu_star,
                sliding: points.sliding_percent,
                twin_reset: self.news.twin_reset,
                twin_t: twin.time_star,
                twin_mu: twin.mu_star,
                recorded_t: recorded.map(|recorded| &*recorded.time_star),
                recorded_mu: recorded.map(|recorded| &*recorded.mu_star),
            }));
        }
        let redraw = self.news.redraw;
        self.news = News {
            end_told: live.ended.is_some(),
            ..News::default()
        };
        self.paint_picture();
        if redraw | ended_now | is_due(&mut self.clock.numbers, NUMBERS) {
            self.tell_numbers();
        }
        if redraw | ended_now | is_due(&mut self.clock.probe, PROBE) {
            self.tell_probe();
        }
        if self.view.kymograph && (redraw | ended_now | is_due(&mut self.clock.kymograph, KYMOGRAPH)) {
            self.tell_kymograph();
        }
    }

    fn paint_picture(&mut self) {
        let Some(live) = &self.live else { return };
        let case = live.case();
        let shown = self.view.field;
        let recorded = self.recorded.as_ref();
        let snapshot = self.shown_recording.zip(recorded).and_then(|(index, recorded)| {
            let snapshots = recorded.snapshots.as_ref()?;
            let values = recorded.values(index, shown)?;
            Some((snapshots, snapshots.frames.get(index)?, values))
        });
        let picture = match snapshot {
            Some((snapshots, frame, values)) => {
                let frame = Frame {
                    step: frame.step,
                    time_star: frame.time_star,
                    mu_star: f64::NAN,
                    sliding_percent: f64::NAN,
                    size: [snapshots.nx, snapshots.ny],
                    textured: &snapshots.textured,
                    recorded: true,
                };
                let exists = case
                    .model
                    .slider()
                    .outline
                    .as_ref()
                    .map(|outline| &*outline.exists);
                self.painter.picture(&frame, shown, &values, exists)
            }
            None => {
                let now = live.running().snapshot();
                self.painter.live(&now, &case.scales, live.origin(), shown)
            }
        };
        self.outbox.picture(picture);
    }

    fn tell_numbers(&mut self) {
        let Some(live) = &self.live else { return };
        let now = live.running().snapshot();
        let (peak, twin_peak) = (live.peak(), self.twin.as_ref().and_then(|twin| twin.live.peak()));
        let change_percent = peak
            .zip(twin_peak)
            .filter(|(one, other)| one.certain && other.certain)
            .map(|(one, other)| 100.0 * (one.mu_star / other.mu_star - 1.0));
        let summary = live
            .summary()
            .and_then(|summary| serde_json::from_str(&summary_json(&summary)).ok());
        let reply = NumbersReply {
            step: live.step(),
            t_star: live.time_star(),
            time_s: live.time_s(),
            mu_star: now.point.mu_star,
            sliding_percent: now.point.sliding_percent,
            peak,
            twin_peak,
            change_percent,
            kinetic: live.running().kinetic().map(|kinetic| kinetic.mu_star),
            instants: live.running().instants().collect(),
            steps_per_second: self.clock.rate(),
            ended: live.ended.is_some(),
            summary,
        };
        self.outbox.reply(&Reply::Numbers(Box::new(reply)));
    }

    fn tell_probe(&mut self) {
        let (Some(live), Some([i, j])) = (&self.live, self.view.probe) else {
            return;
        };
        let (case, now) = (live.case(), live.running().snapshot());
        let lattice = &case.model.lattice;
        if i >= lattice.nx || j >= lattice.ny {
            return;
        }
        let b = lattice.block(i, j);
        let block = now.block(b);
        let surface = &case.model.surface;
        let textured = surface.textured[b];
        let [from_x, from_y] = live.origin().map_or([0.0; 2], |origin| origin[b].map(f64::from));
        let unit = case.scales.displacement();
        let [x, y] = block.displacement.map(|u| u * unit);
        let first_slip = now.first_slip_time_star()[b];
        self.outbox.reply(&Reply::Probe(ProbeReply {
            block: [i, j],
            exists: case.model.slider().exists(b),
            textured,
            sliding: block.slides(),
            mu_static: surface.mu_static[b],
            mu_kinetic: surface.mu_kinetic[b],
            contact_stress_pa: block.contact_stress() * case.scales.stress(),
            traction_pa: if textured {
                0.0
            } else {
                block.traction() * case.scales.stress()
            },
            displacement_m: (x + from_x).hypot(y + from_y),
            speed_m_s: block.velocity[0].hypot(block.velocity[1]) * case.scales.speed(),
            first_slip_star: (!first_slip.is_nan()).then_some(first_slip),
        }));
    }

    fn tell_kymograph(&mut self) {
        let Some(live) = &self.live else { return };
        let case = live.case();
        let bins = PositionBins::of(&case.model.lattice, &case.model.drive);
        if let Some(picture) = picture::kymograph(live.running().kymograph(), &bins, case.time_plan.dt_star) {
            self.outbox.kymograph(picture);
        }
    }
}

/// Distance of a point from a line between two others.
fn distance([x, y]: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let square = dx * dx + dy * dy;
    let along = match square > 0.0 {
        true => (((x - from[0]) * dx + (y - from[1]) * dy) / square).clamp(0.0, 1.0),
        false => 0.0,
    };
    (x - from[0] - along * dx).hypot(y - from[1] - along * dy)
}
