//! Updates of the page: the case, the curve, pictures and numbers.

use std::time::Duration;

use slipfront::PositionBins;
use slipfront::lattice::K_DRIVE;
use slipfront_base::ordered::map_of;
use slipfront_case::case_file::Motion;
use slipfront_run::run_curve::unit_force_star;
use slipfront_run::summary::summary_json;
use slipfront_study::note_on_seeds;

use super::clock::is_due;
use super::state::{PendingUpdates, Session};
use crate::live::CurvePoints;
use crate::picture::{self, PictureFrame};
use crate::protocol::{CaseReply, CurveReply, NumbersReply, ProbeReply, Reply, Units};
use crate::{controls, search, shapes};

/// Times between two reports of numbers, two reports of the block under the pointer, and two kymographs.
const NUMBERS_INTERVAL: Duration = Duration::from_millis(200);
/// Number of steps of a bulk body under slow loading up to its onset: some forty increments, and some 25
/// steps until the blocks rest after each.
const STEPS_TO_ONSET: f64 = 1000.0;
const PROBE_INTERVAL: Duration = Duration::from_millis(100);
const KYMOGRAPH_INTERVAL: Duration = Duration::from_millis(500);

impl Session {
    /// Sends the present case, with the reason for sending it.
    pub(super) fn send_case(&mut self, why: &'static str) {
        let (Some(history), Some(live)) = (&self.history, &self.live) else {
            return;
        };
        let (document, case) = (history.present(), live.case());
        let (scales, lattice) = (&case.scales, &case.model.lattice);
        let is_pulled = case.file.drive.motion == Motion::Translation;
        let reply = CaseReply {
            name: &document.name,
            toml: document.toml(),
            files: document.files().keys().map(String::as_str).collect(),
            link_files_bytes: document.files().values().map(|file| file.len()).sum(),
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
                friction_n: unit_force_star(case),
                friction_coefficient: scales.mu_static_mean,
            },
            dt_star: case.time_plan.dt_star,
            duration_star: case.time_plan.end_star(),
            kinetic_from_star: {
                let peak = live.running().snapshot().peak;
                case.time_plan
                    .kinetic
                    .time_star(&peak, case.model.loading_speed())
            },
            onset_star: if case.model.rests_by_excess() {
                STEPS_TO_ONSET * case.time_plan.dt_star
            } else {
                case.expected.onset_star[0].min(case.time_plan.end_star())
            },
            drive_degrees: is_pulled.then_some(case.file.drive.direction),
            loading_rate: is_pulled.then(|| case.model.loading_speed() * K_DRIVE),
            steady_level: case.expected.steady_level,
            can_undo: history.can_undo(),
            can_redo: history.can_redo(),
            leg: live.leg,
            why,
            time_before_s: live.before.time_s,
            twin: self.twin.is_some(),
            has_memory: live.has_memory(),
            mesh: case.deciding_length(),
            warnings: case.warnings(),
            too_coarse: case.too_coarse(),
            seeds: note_on_seeds(case),
            search: search::limits(case),
        };
        self.host.reply(Reply::Case(Box::new(reply)).json());
    }

    /// Sends the points of the curves that were not sent to the page yet.
    pub(super) fn send_curve(&mut self) {
        let Some(live) = &mut self.live else { return };
        let points = live.take_unsent_points();
        let twin = self
            .twin
            .as_mut()
            .map_or_else(CurvePoints::default, |twin| twin.live.take_unsent_points());
        let from_rest = std::mem::take(&mut self.pending.from_rest);
        let twin_reset = std::mem::take(&mut self.pending.twin_reset);
        let is_recorded_new = std::mem::take(&mut self.pending.recorded);
        if !from_rest && !twin_reset && points.time_star.is_empty() && twin.time_star.is_empty() {
            return;
        }
        let recorded = self.recorded.as_ref().filter(|_| is_recorded_new);
        let curve = Reply::Curve(CurveReply {
            leg: live.leg,
            from_rest,
            t: points.time_star,
            mu: points.mu_star,
            sliding: points.sliding_percent,
            twin_reset,
            twin_t: twin.time_star,
            twin_mu: twin.mu_star,
            recorded_t: recorded.map(|recorded| &*recorded.time_star),
            recorded_mu: recorded.map(|recorded| &*recorded.mu_star),
        });
        self.host.reply(curve.json());
    }

    /// Sends new points of the curves, the picture and the numbers.
    pub(super) fn send_updates(&mut self, now: Duration) {
        self.send_curve();
        let ends = self.count_ended();
        let stages = match &mut self.live {
            // At full speed no stage needs to be reported early.
            Some(live) if self.view.pace > 0.0 || ends > 0 => live.look_for_stages(),
            _ => self.pending.stages_sent,
        };
        let is_new = ends != self.pending.ends_sent || stages != self.pending.stages_sent;
        let redraw = self.pending.redraw;
        self.pending = PendingUpdates {
            ends_sent: ends,
            stages_sent: stages,
            ..PendingUpdates::default()
        };
        self.send_picture();
        if redraw | is_new | is_due(&mut self.clock.numbers, NUMBERS_INTERVAL, now) {
            self.send_numbers(now);
        }
        if redraw | is_new | is_due(&mut self.clock.probe, PROBE_INTERVAL, now) {
            self.send_probe();
        }
        if self.view.kymograph
            && (redraw | is_new | is_due(&mut self.clock.kymograph, KYMOGRAPH_INTERVAL, now))
        {
            self.send_kymograph();
        }
    }

    /// Sends the picture of the run, or of the recorded snapshot on the page.
    fn send_picture(&mut self) {
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
                let frame = PictureFrame {
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
                self.painter.paint(&frame, shown, &values, exists)
            }
            None => {
                let now = live.running().snapshot();
                self.painter
                    .paint_snapshot(&now, &case.scales, live.origin(), shown)
            }
        };
        self.host.picture(picture);
    }

    /// Sends the numbers of the run at this instant.
    fn send_numbers(&mut self, at: Duration) {
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
        let before = live.before.drive_time_star;
        let instants = live
            .running()
            .instants()
            .map(|(letter, time)| (letter, before + time));
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
            instants: map_of(instants),
            crossed: live.crossed,
            steps_per_second: self.clock.steps_per_second(at),
            ended: live.ended.is_some(),
            summary,
        };
        self.host.reply(Reply::Numbers(Box::new(reply)).json());
    }

    /// Sends the state of the block under the pointer.
    fn send_probe(&mut self) {
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
        let probe = Reply::Probe(ProbeReply {
            block: [i, j],
            exists: case.model.slider().exists(b),
            textured,
            sliding: block.slides,
            mu_static: surface.mu_static[b],
            mu_kinetic: surface.mu_kinetic[b],
            contact_stress_pa: block.contact_stress() * case.scales.stress(),
            traction_pa: if textured {
                0.0
            } else {
                block.traction() * case.scales.stress()
            },
            displacement_m: libm::hypot(x + from_x, y + from_y),
            speed_m_s: libm::hypot(block.velocity[0], block.velocity[1]) * case.scales.speed(),
            first_slip_star: (!first_slip.is_nan()).then_some(first_slip),
        });
        self.host.reply(probe.json());
    }

    /// Sends the kymograph of this leg.
    fn send_kymograph(&mut self) {
        let Some(live) = &self.live else { return };
        let case = live.case();
        let bins = PositionBins::new(&case.model.lattice, &case.model.drive);
        if let Some(picture) = picture::kymograph(
            live.running().kymograph(),
            &bins,
            case.time_plan.dt_star,
            live.before.time_star,
        ) {
            self.host.kymograph(picture);
        }
    }
}
