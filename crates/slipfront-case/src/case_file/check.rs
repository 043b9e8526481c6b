//! The bounds of every value, as far as the file alone can tell.
//!
//! Bounds on quantities are generous: they keep out slips of the pen (a block of 1 km), not unusual materials.

use std::collections::BTreeSet;
use std::ops::Bound::{self, Excluded, Included};
use std::ops::RangeBounds;
use std::path::Path;

use super::{
    AutoOr, CaseError, CaseFile, Cavity, CavitySize, Center, Damping, DriveSpeed, Edge, GrooveSize,
    KineticFriction, Mask, RunTime, Snapshots, Step, Texture,
};
use crate::number_format::exact;
use crate::quantity::{Kind, Quantity};

/// Most blocks along an axis.
const MAX_BLOCKS: u32 = 100_000;
/// Most blocks altogether.
const MAX_BLOCKS_TOTAL: u64 = 4_000_000_000;
/// dt* at which the scheme becomes unstable: 2/sqrt(6.5 x 0.75) = 0.9058.
const UNSTABLE_STEP: f64 = 0.9058;
/// The longest time, in t*.
const MAX_TIME_STAR: f64 = 1e9;
/// The largest coordinate or size of a texture, m.
const MAX_LENGTH: f64 = 1e9;
/// TOML's largest integer.
const MAX_SEED: u64 = i64::MAX.unsigned_abs();

type Bounds = (Bound<f64>, Bound<f64>);

const POSITIVE_TIME: Bounds = (Excluded(0.0), Included(MAX_TIME_STAR));
const COVERAGE: Bounds = (Excluded(0.0), Excluded(100.0));
const DEGREES: Bounds = (Included(-360.0), Included(360.0));
const SIZE: Bounds = (Excluded(0.0), Included(MAX_LENGTH));
const COORDINATE: Bounds = (Included(-MAX_LENGTH), Included(MAX_LENGTH));
const SIGMA: Bounds = (Included(0.0), Included(1.0));

/// A range in words, such as "more than 0 and at most 10".
fn in_words((low, high): Bounds) -> String {
    let side = |bound, included: &str, excluded: &str| match bound {
        Included(limit) => Some(format!("{included} {}", exact(limit))),
        Excluded(limit) => Some(format!("{excluded} {}", exact(limit))),
        Bound::Unbounded => None,
    };
    let sides = [
        side(low, "at least", "more than"),
        side(high, "at most", "less than"),
    ];
    sides.into_iter().flatten().collect::<Vec<_>>().join(" and ")
}

impl CaseFile {
    /// Checks every bound that needs nothing but the file. [`parse`](Self::parse) has done so already.
    ///
    /// # Errors
    /// [`CaseError::Invalid`], with the value, its bound and what to do, at the place where the value was written.
    pub fn check(&self) -> Result<(), CaseError> {
        self.check_slider()?;
        self.check_load_and_drive()?;
        self.check_friction()?;
        for (i, texture) in self.texture.iter().enumerate() {
            self.check_texture(&format!("texture.{i}"), texture)?;
        }
        self.check_time()?;
        self.check_output()
    }

    fn check_slider(&self) -> Result<(), CaseError> {
        let slider = &self.slider;
        let [nx, ny] = slider.blocks;
        let blocks = |sentence: String| Err(self.source.error("slider.blocks", sentence));
        if slider.blocks.iter().any(|n| !(1..=MAX_BLOCKS).contains(n)) {
            return blocks(format!(
                "`slider.blocks` is [{nx}, {ny}]: both must be from 1 to {MAX_BLOCKS}"
            ));
        }
        let total = u64::from(nx) * u64::from(ny);
        if total > MAX_BLOCKS_TOTAL {
            return blocks(format!(
                "`slider.blocks` is [{nx}, {ny}], {total} blocks together: more than {MAX_BLOCKS_TOTAL}; take fewer along one axis"
            ));
        }
        for (axis, n, edge) in [("x", nx, slider.edges[0]), ("y", ny, slider.edges[1])] {
            if edge == Edge::Periodic && n < 3 {
                let key = if self.source.has("slider.blocks") {
                    "slider.blocks"
                } else {
                    "slider.edges"
                };
                return Err(self.source.error(
                    key,
                    format!("{n} block(s) along {axis} are too few for periodic edges: take at least 3, or free edges along {axis}"),
                ));
            }
        }
        self.quantity(
            "slider.block_size",
            &slider.block_size,
            (Included(1e-12), Included(1e3)),
        )?;
        self.quantity(
            "slider.young_modulus",
            &slider.young_modulus,
            (Included(1e-3), Included(1e15)),
        )?;
        self.quantity("slider.density", &slider.density, (Included(1e-6), Included(1e9)))?;
        match &slider.damping {
            Damping::OmegaStar(omega_star) => self.number(
                "slider.omega_star",
                *omega_star,
                (Included(0.0), Included(1e3)),
                "a slider that rings little has 1",
            ),
            Damping::Rate(rate) => {
                self.quantity("slider.damping_rate", rate, (Included(0.0), Included(1e24)))
            }
        }
    }

    fn check_load_and_drive(&self) -> Result<(), CaseError> {
        self.quantity(
            "load.pressure",
            &self.load.pressure,
            (Included(1e-9), Included(1e15)),
        )?;
        match &self.drive.speed {
            DriveSpeed::VStar(v_star) => {
                self.number(
                    "drive.v_star",
                    *v_star,
                    (Excluded(0.0), Included(10.0)),
                    "the paper's runs have 0.01 to 0.2",
                )?;
            }
            DriveSpeed::Speed(speed) => {
                self.quantity("drive.speed", speed, (Included(1e-18), Included(1e6)))?;
            }
        }
        self.number(
            "drive.direction",
            self.drive.direction,
            DEGREES,
            "it is in degrees from x towards y",
        )
    }

    fn check_friction(&self) -> Result<(), CaseError> {
        let friction = &self.friction;
        let r_star = (Included(0.0), Included(10.0));
        self.number(
            "friction.mu_static",
            friction.mu_static,
            (Excluded(0.0), Included(100.0)),
            "it is the scale of all forces",
        )?;
        match friction.kinetic {
            KineticFriction::RStar(value) => {
                self.number(
                    "friction.r_star",
                    value,
                    r_star,
                    "it is the kinetic over the static coefficient",
                )?;
            }
            KineticFriction::MuKinetic(value) => {
                let most = 10.0 * friction.mu_static;
                self.number(
                    "friction.mu_kinetic",
                    value,
                    (Included(0.0), Included(most)),
                    "at most 10 times `mu_static`",
                )?;
            }
        }
        let relative = "it is relative to the mean coefficient, so that 0.05 is 5 percent";
        self.number(
            "friction.sigma_static_star",
            friction.sigma_static_star,
            SIGMA,
            relative,
        )?;
        self.number(
            "friction.sigma_kinetic_star",
            friction.sigma_kinetic_star,
            SIGMA,
            relative,
        )?;
        if friction.seed > MAX_SEED {
            let sentence = format!(
                "`friction.seed` is {}: it must be from 0 to {MAX_SEED}",
                friction.seed
            );
            return Err(self.source.error("friction.seed", sentence));
        }
        for (key, path) in [
            ("friction.mu_static_field", &friction.mu_static_field),
            ("friction.mu_kinetic_field", &friction.mu_kinetic_field),
        ] {
            if let Some(path) = path {
                self.file(key, path, &["npy", "csv"])?;
            }
        }
        Ok(())
    }

    fn check_texture(&self, key: &str, texture: &Texture) -> Result<(), CaseError> {
        match texture {
            Texture::Cavity(cavity) => self.check_cavity(key, cavity),
            Texture::Groove(groove) => {
                match &groove.size {
                    GrooveSize::Coverage(coverage) => self.coverage(key, *coverage)?,
                    GrooveSize::Width(width) => self.quantity(&format!("{key}.width"), width, SIZE)?,
                }
                self.quantity(&format!("{key}.offset"), &groove.offset, COORDINATE)
            }
            Texture::Polygon(polygon) => {
                let key = format!("{key}.points");
                if polygon.points.len() < 3 {
                    let sentence = format!(
                        "`{key}` has {} point(s): a polygon needs at least 3",
                        polygon.points.len()
                    );
                    return Err(self.source.error(&key, sentence));
                }
                polygon
                    .points
                    .iter()
                    .flatten()
                    .try_for_each(|length| self.quantity(&key, length, COORDINATE))
            }
            Texture::Mask(Mask { file, threshold }) => {
                self.file(&format!("{key}.file"), file, &["png", "npy"])?;
                let bounds = (Excluded(0.0), Excluded(1.0));
                self.number(
                    &format!("{key}.threshold"),
                    *threshold,
                    bounds,
                    "it is a share of white",
                )
            }
        }
    }

    fn check_cavity(&self, key: &str, cavity: &Cavity) -> Result<(), CaseError> {
        if !(1..=64).contains(&cavity.s) {
            let sentence = format!(
                "`{key}.s` is {}: it must be a whole number from 1 to 64",
                cavity.s
            );
            return Err(self.source.error(&format!("{key}.s"), sentence));
        }
        let (most, advice) = match cavity.s {
            1 => (Excluded(1.0), "at 1 the cavity is a line".to_owned()),
            s => (
                Included(1.0 / f64::from(s)),
                format!("beyond 1/s = 1/{s} the outline crosses itself"),
            ),
        };
        let least = most.map(|most: f64| -most);
        self.number(&format!("{key}.w"), cavity.w, (least, most), &advice)?;
        match &cavity.size {
            CavitySize::Coverage(coverage) => self.coverage(key, *coverage)?,
            CavitySize::Lambda(lambda) => self.quantity(&format!("{key}.lambda"), lambda, SIZE)?,
        }
        if let Center::At(center) = &cavity.center {
            let key = format!("{key}.center");
            center
                .iter()
                .try_for_each(|length| self.quantity(&key, length, COORDINATE))?;
        }
        self.number(
            &format!("{key}.rotate"),
            cavity.rotate,
            DEGREES,
            "it is in degrees from x towards y",
        )?;
        if cavity.array.iter().any(|n| !(1..=1000).contains(n)) {
            let [nx, ny] = cavity.array;
            let sentence = format!("`{key}.array` is [{nx}, {ny}]: both must be from 1 to 1000");
            return Err(self.source.error(&format!("{key}.array"), sentence));
        }
        Ok(())
    }

    fn check_time(&self) -> Result<(), CaseError> {
        let time = &self.time;
        match &time.duration {
            RunTime::Auto => {}
            RunTime::Star(star) => self.number(
                "time.duration_star",
                *star,
                POSITIVE_TIME,
                "8/V* shows onset and sliding",
            )?,
            RunTime::Duration(duration) => {
                self.quantity("time.duration", duration, (Included(1e-24), Included(1e12)))?;
            }
        }
        match (time.step, &self.drive.speed) {
            (Step::Number(dt_star), _) => {
                let bounds = (Excluded(0.0), Excluded(UNSTABLE_STEP));
                self.number(
                    "time.step",
                    dt_star,
                    bounds,
                    "beyond it the scheme is unstable; \"auto\" is 0.1",
                )?;
            }
            (Step::Paper, DriveSpeed::VStar(v_star)) if v_star * 2.0 / 3.0 >= UNSTABLE_STEP => {
                let sentence = format!(
                    "`time.step` = \"paper\" is (2/3) V* = {:.4}: it must be less than {UNSTABLE_STEP}; take \"auto\", or a smaller `drive.v_star`",
                    v_star * 2.0 / 3.0
                );
                return Err(self.source.error("time.step", sentence));
            }
            _ => {}
        }
        if let AutoOr::Number(from) = time.kinetic_from_star {
            let end = match (&time.duration, &self.drive.speed) {
                (RunTime::Star(star), _) => Excluded(*star),
                (RunTime::Auto, DriveSpeed::VStar(v_star)) => Excluded(8.0 / v_star),
                _ => Included(MAX_TIME_STAR),
            };
            let advice = "the average is taken from there to the end of the run";
            self.number("time.kinetic_from_star", from, (Included(0.0), end), advice)?;
        }
        Ok(())
    }

    fn check_output(&self) -> Result<(), CaseError> {
        let output = &self.output;
        match &output.snapshots {
            Snapshots::Auto => {}
            Snapshots::Every(every) => {
                // A table of its own in the file, or the value of `snapshots`: one place holds the other.
                self.number(
                    "output.snapshots.every",
                    *every,
                    POSITIVE_TIME,
                    "it is a spacing in t*",
                )?;
            }
            Snapshots::At(times) => {
                let bounds = (Included(0.0), Included(MAX_TIME_STAR));
                for time in times {
                    self.number("output.snapshots", *time, bounds, "snapshots are times t*")?;
                }
                if let Some(pair) = times.windows(2).find(|pair| pair[0] >= pair[1]) {
                    let sentence = format!(
                        "`output.snapshots` has {} after {}: list the times in increasing order, each once",
                        exact(pair[1]),
                        exact(pair[0])
                    );
                    return Err(self.source.error("output.snapshots", sentence));
                }
            }
        }
        let mut seen = BTreeSet::new();
        if !output.fields.iter().all(|field| seen.insert(field)) {
            let sentence = "`output.fields` names a field twice: name each once";
            return Err(self.source.error("output.fields", sentence));
        }
        if !(1..=MAX_BLOCKS).contains(&output.stride) {
            let sentence = format!(
                "`output.stride` is {}: it must be from 1 to {MAX_BLOCKS}; 1 writes every block",
                output.stride
            );
            return Err(self.source.error("output.stride", sentence));
        }
        match output.series {
            AutoOr::Auto => Ok(()),
            AutoOr::Number(spacing) => {
                self.number("output.series", spacing, POSITIVE_TIME, "it is a spacing in t*")
            }
        }
    }

    fn coverage(&self, key: &str, coverage: f64) -> Result<(), CaseError> {
        self.number(
            &format!("{key}.coverage"),
            coverage,
            COVERAGE,
            "it is in percent of the whole area",
        )
    }

    /// Refuses a number out of its bounds, or none (`nan`).
    fn number(&self, key: &str, value: f64, bounds: Bounds, remark: &str) -> Result<(), CaseError> {
        if bounds.contains(&value) && value.is_finite() {
            return Ok(());
        }
        let sentence = format!(
            "`{key}` is {}: it must be {}; {remark}",
            exact(value),
            in_words(bounds)
        );
        Err(self.source.error(key, sentence))
    }

    /// Refuses a quantity whose SI value is out of its bounds.
    fn quantity<K: Kind>(&self, key: &str, value: &Quantity<K>, bounds: Bounds) -> Result<(), CaseError> {
        if bounds.contains(&value.si()) && value.si().is_finite() {
            return Ok(());
        }
        let sentence = format!(
            "`{key}` is \"{value}\": it must be {} {}; look at number and unit",
            in_words(bounds),
            K::SI_UNIT
        );
        Err(self.source.error(key, sentence))
    }

    /// Refuses a file name that does not end as one of the formats does.
    fn file(&self, key: &str, path: &str, formats: &[&str]) -> Result<(), CaseError> {
        let ending = Path::new(path)
            .extension()
            .and_then(|ending| ending.to_str())
            .unwrap_or_default();
        if formats.iter().any(|format| ending.eq_ignore_ascii_case(format)) {
            return Ok(());
        }
        let sentence = format!(
            "`{key}` is {path:?}: it must name a .{} file",
            formats.join(" or .")
        );
        Err(self.source.error(key, sentence))
    }
}
