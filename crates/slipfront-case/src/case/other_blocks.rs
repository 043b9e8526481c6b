//! The same slider on other blocks: the keys of a case with finer or coarser blocks and unchanged slider,
//! load, mount, friction and time.
//!
//! A key with a star is in units that depend on the block edge `l` and the thickness `h` of the sheet. It is
//! converted by the ratio of the two units, so that values in metres, seconds and pascals stay constant:
//!
//! ```text
//! speed P mu_s l/(h sqrt(E rho)),  time l sqrt(rho/E),  displacement P mu_s l^2/(E h),  spring on each block
//! E h for K l^2
//! ```

use slipfront::Scales;
use toml::{Table, Value};

use super::coarse::ten_digits;
use super::runnable::Case;
use super::time_plan::auto_onset_end;
use crate::case_file::{
    Attached, AttachedEdge, AutoOr, AutoOrStiffness, CaseError, CaseFile, DriveSpeed, DriveStiffness,
    FileUse, FrictionAlong, MAX_BLOCKS, NamedFile, Override, RunTime, StarUnit, star_unit,
};
use crate::quantity::Length;

/// A unit in SI, up to a factor that does not depend on the blocks.
fn size(unit: StarUnit, scales: &Scales) -> f64 {
    match unit {
        StarUnit::Speed => scales.speed(),
        StarUnit::Time => scales.time(),
        StarUnit::Rate => 1.0 / scales.time(),
        StarUnit::Displacement => scales.displacement(),
        StarUnit::SpringOfBlock => scales.stiffness() / scales.contact_area(),
        StarUnit::Stiffness => scales.stiffness(),
        StarUnit::One => 1.0,
    }
}

impl Case {
    /// The keys that put this slider on blocks finer by the factor `finer`, a power of two. Dimensions,
    /// textures, load, mount, damping, lengths of friction, speed and duration stay constant in metres,
    /// seconds and pascals. The time step stays a constant share of the travel time of sound across a block.
    /// Spreads of coefficients do not change: they are spreads over blocks of any size.
    ///
    /// # Errors
    /// When the blocks cannot be divided in this way, or when the case has values for its individual blocks.
    pub fn on_other_blocks(&self, finer: f64) -> Result<Vec<Override>, CaseError> {
        self.refuse_values_of_blocks()?;
        let blocks = self.other_blocks(finer)?;
        let block_size = self.scales.block_size / finer;
        let scales = Scales {
            block_size,
            contact_width: block_size,
            thickness: if self.file.slider.thickness_is_a_block() {
                self.scales.thickness / finer
            } else {
                self.scales.thickness
            },
            ..self.scales
        };
        let conversion = Conversion {
            from: &self.scales,
            to: &scales,
        };
        let mut set = vec![
            (
                "slider.block_size".to_owned(),
                Value::from(length_text(scales.block_size)),
            ),
            (
                "slider.blocks".to_owned(),
                Value::from(blocks.map(i64::from).to_vec()),
            ),
        ];
        // Increments of a held drive, and the rest after each, depend on no time.
        if !self.model.rests_by_excess() {
            set.push(("time.step".to_owned(), Value::from(self.time_plan.dt_star)));
        }
        // Every key of the case, with defaults filled in.
        let mut file = Value::try_from(self.explicit_times()).map_err(CaseError::from)?;
        if let Value::Table(file) = &mut file {
            for (name, table) in file.iter_mut() {
                conversion.convert(name, table, &mut set);
            }
        }
        if let DriveStiffness::Each(AutoOrStiffness::Stiffness(stiffness)) = &self.file.drive.stiffness {
            let area = scales.contact_area() / self.scales.contact_area();
            set.push((
                "drive.stiffness".to_owned(),
                Value::from(format!("{:e} N/m", stiffness.si() * area)),
            ));
        }
        Ok(set.iter().map(|(key, value)| Override::new(key, value)).collect())
    }

    /// The case file with explicit numbers for the "auto" times, which depend on the blocks.
    fn explicit_times(&self) -> CaseFile {
        let mut file = self.file.clone();
        if self.model.rests_by_excess() {
            return file;
        }
        let plan = &self.time_plan;
        if matches!(file.time.duration, RunTime::Star(AutoOr::Auto)) {
            file.time.duration = RunTime::Star(AutoOr::Number(plan.end_star()));
        }
        let onset_end = auto_onset_end(&self.file, &self.scales, &self.model);
        let is_steady = !matches!(file.drive.speed, DriveSpeed::Program(_));
        if is_steady && file.time.kinetic_from_star == AutoOr::Auto && onset_end < plan.end_star() {
            file.time.kinetic_from_star = AutoOr::Number(onset_end);
        }
        file
    }

    /// Blocks along each axis; an axis of one block stays unchanged.
    fn other_blocks(&self, finer: f64) -> Result<[u32; 2], CaseError> {
        let [nx, ny] = self.file.slider.blocks;
        let refuse = |sentence: String| self.file.source.error("slider.blocks", sentence);
        if [nx, ny] == [1, 1] {
            return Err(refuse("a single block has no finer or coarser mesh".to_owned()));
        }
        let mut other = [nx, ny];
        for blocks in other.iter_mut().filter(|blocks| **blocks > 1) {
            let found = f64::from(*blocks) * finer;
            if found.fract() != 0.0 || found < 2.0 {
                let times = 1.0 / finer;
                let nearest = |blocks: u32| (f64::from(blocks) * finer).round().max(2.0) * times;
                let [near_x, near_y] = [nx, ny].map(|blocks| if blocks > 1 { nearest(blocks) } else { 1.0 });
                return Err(refuse(format!(
                    "`slider.blocks` = [{nx}, {ny}] cannot be divided into blocks of {times} times the size: use multiples of \
                     {times}, such as [{near_x}, {near_y}]"
                )));
            }
            if found > MAX_BLOCKS as f64 {
                return Err(refuse(format!(
                    "`slider.blocks` = [{nx}, {ny}] becomes {found} blocks along an axis, more than {MAX_BLOCKS}: use fewer levels"
                )));
            }
            *blocks = found as u32;
        }
        Ok(other)
    }

    /// Refuses values that belong to the blocks of the case and have no meaning on others.
    fn refuse_values_of_blocks(&self) -> Result<(), CaseError> {
        let file = &self.file;
        if file.friction.along != FrictionAlong::Plane {
            return Err(file.source.error(
                "friction.along",
                "an upright sheet is in contact with its substrate along one row of blocks, given by its texture: with other \
                 blocks this would be another row",
            ));
        }
        let mut copy = file.clone();
        let (mut named, _) = copy.files_mut();
        if let Some(NamedFile { key, .. }) =
            named.find(|named| matches!(named.holds, FileUse::Numbers | FileUse::State))
        {
            return Err(file.source.error(
                &key,
                format!("`{key}` has one value per block of this case, so it does not apply to other blocks: leave it out, or give a slope or a length instead"),
            ));
        }
        let is_line = !matches!(file.drive.attached, Attached::At(AttachedEdge::All));
        let is_total = matches!(
            file.drive.stiffness,
            DriveStiffness::Total(_) | DriveStiffness::TotalStar(_)
        );
        if is_line && !is_total {
            let key = if matches!(file.drive.attached, Attached::File(_)) {
                "drive.attach_file"
            } else {
                "drive.attach"
            };
            return Err(file.source.error(
                key,
                "a drive at some of the blocks needs a total stiffness on other meshes: give `drive.total_stiffness`".to_owned(),
            ));
        }
        Ok(())
    }
}

/// A length with an SI prefix, if its ten digits reproduce the length to the last bit.
fn length_text(metres: f64) -> String {
    let text = ten_digits(metres);
    let read = text.parse::<Length>();
    if read.is_ok_and(|length| length.si() == metres) {
        text
    } else {
        format!("{metres:e} m")
    }
}

/// Conversion from the units of one mesh to those of another.
struct Conversion<'a> {
    from: &'a Scales,
    to: &'a Scales,
}

impl Conversion<'_> {
    /// Adds the keys at and below `path` that have units, with their numbers in the new units.
    fn convert(&self, path: &str, value: &mut Value, set: &mut Vec<(String, Value)>) {
        let Value::Table(table) = value else { return };
        for (name, value) in table {
            let path = format!("{path}.{name}");
            match value {
                Value::Table(_) => self.convert(&path, value, set),
                // The segments of a program are one list.
                Value::Array(segments) if segments.iter().any(Value::is_table) => {
                    let tables = segments.iter_mut().filter_map(Value::as_table_mut);
                    if tables.map(|table| self.convert_table(table)).sum::<usize>() > 0 {
                        set.push((path, value.clone()));
                    }
                }
                _ => {
                    if let Some(number) = self.converted(name, value) {
                        set.push((path, number));
                    }
                }
            }
        }
    }

    /// Converts the numbers of a table; returns how many have units.
    fn convert_table(&self, table: &mut Table) -> usize {
        let mut count = 0;
        for (name, value) in table {
            if let Some(number) = self.converted(name, value) {
                *value = number;
                count += 1;
            }
        }
        count
    }

    /// The number in the new units, if its key has units.
    fn converted(&self, name: &str, value: &Value) -> Option<Value> {
        let unit = star_unit(name)?;
        let number = value
            .as_float()
            .or_else(|| value.as_integer().map(|number| number as f64))?;
        if unit == StarUnit::One || number == 0.0 {
            return None;
        }
        Some(Value::from(
            number * (size(unit, self.from) / size(unit, self.to)),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case_file::{KeyKind, SECTIONS};

    /// Every key with a star has a unit: a key without one would keep its number and change its meaning.
    #[test]
    fn every_key_with_a_star_has_a_unit() {
        let keys = SECTIONS.iter().flat_map(|section| section.keys);
        let inner = keys.clone().flat_map(|key| match key.kind {
            KeyKind::Table(_, inner) => inner,
            _ => &[],
        });
        for key in keys.chain(inner) {
            assert_eq!(key.name.ends_with("_star"), key.star.is_some(), "{}", key.name);
        }
    }

    fn case(text: &str) -> Case {
        Case::parse(text, "case", "", &[]).unwrap()
    }

    /// Values of a case in metres, seconds, newtons per metre and cubic metre.
    fn in_si(case: &Case) -> Vec<f64> {
        let (scales, model) = (&case.scales, &case.model);
        let side = |blocks: usize| blocks as f64 * scales.block_size;
        let spring = model.drive.k_drive * scales.stiffness();
        vec![
            side(model.lattice.nx),
            side(model.lattice.ny),
            model.drive.v_star * scales.speed(),
            model.damping / scales.time(),
            case.time_plan.end_star() * scales.time(),
            spring / scales.contact_area(),
        ]
    }

    /// Half and twice as many blocks along a side give the same slider: every number is converted by powers
    /// of two alone, and rounded once.
    #[test]
    fn other_blocks_are_the_same_slider() {
        let text = "[slider]\nblocks = [20, 40]\nblock_size = '20 um'\nthickness = '20 um'\nviscosity_time_star = 0.2\n\
            [drive]\nv_star = 0.01\nstiffness_star = 0.375\n[friction]\nslip_weakening = { length_star = 0.6 }\nhealing_time_star = 3\n\
            [time]\nstep = 0.1\nduration_star = 800";
        let own = case(text);
        for finer in [0.5, 1.0, 2.0, 4.0] {
            let overrides: Vec<String> = own
                .on_other_blocks(finer)
                .unwrap()
                .iter()
                .map(ToString::to_string)
                .collect();
            let other = Case::parse(text, "case", "", &overrides).unwrap();
            for (one, other) in in_si(&own).into_iter().zip(in_si(&other)) {
                assert!((one - other).abs() <= 1e-12 * one.abs(), "{finer}: {one} {other}");
            }
            assert_eq!(other.time_plan.dt_star, own.time_plan.dt_star);
            // Length unit in terms of displacement: over a fixed thickness, l^2.
            let length = |case: &Case| {
                let values = case.file.values();
                let found = values.iter().find(|(key, _)| key.ends_with(".length_star`"));
                found.unwrap().1.parse::<f64>().unwrap() * case.scales.displacement()
            };
            assert!((length(&own) / length(&other) - 1.0).abs() < 1e-12);
        }
    }

    /// A study sets the same keys on all meshes, including that of the case.
    #[test]
    fn every_mesh_sets_the_same_keys() {
        let case = case(
            "slider.blocks = [20, 20]\nslider.thickness = '1 um'\n\
             drive.program = [{ v_star = 0.02, until_star = 300 }, { v_star = 0 }]",
        );
        let sets = |finer: f64| case.on_other_blocks(finer).unwrap();
        let keys = |finer: f64| -> Vec<String> {
            let sets = sets(finer);
            sets.iter().map(|set| set.key().to_owned()).collect()
        };
        assert_eq!(keys(0.5), keys(1.0));
        assert_eq!(keys(2.0), keys(1.0));
        let program = sets(2.0).into_iter().find(|set| set.key() == "drive.program");
        let expected = "[{ v_star = 0.04, until_star = 600.0 }, { v_star = 0.0 }]";
        assert_eq!(program.unwrap().value().to_string(), expected);
    }

    #[test]
    fn what_belongs_to_blocks_is_refused() {
        for (text, expected) in [
            ("slider.blocks = [25, 25]", "cannot be divided"),
            ("slider.blocks = [1, 1]", "a single block"),
            (
                "slider.blocks = [20, 20]\ndrive.attach = 'left'",
                "give `drive.total_stiffness`",
            ),
        ] {
            let said = case(text).on_other_blocks(0.5).unwrap_err().to_string();
            assert!(said.contains(expected), "{said}");
        }
        // A chain keeps its one row.
        let chain = case("slider.blocks = [20, 1]").on_other_blocks(2.0).unwrap();
        assert!(chain.iter().any(|set| set.to_string() == "slider.blocks=[40, 1]"));
    }
}
