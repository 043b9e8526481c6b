//! Results of a calibration: numbers, tables, a case that runs, pictures, and a text for a person.

use std::io::Write;

use slipfront_base::number_format::{count, four_digits, in_print, si_prefix, with_si_prefix};
use slipfront_base::text::{COLUMNS, note, wrapped};
use slipfront_case::case::Case;
use slipfront_case::case_file::Override;
use slipfront_plot::{Estimate, Picture, PictureError, PictureSize, Response, Responses};
use slipfront_run::measured::Measure;
use slipfront_run::names::CASE;

use crate::findings::{Findings, InstrumentFindings, OnFinerBlocks, UnknownEstimate};
use crate::fit::Found;
use crate::predicted::{FrictionBand, PREDICTED};
use crate::record_check::at_step;
use crate::set_up::{Conditions, SetUp};
use slipfront_study::project_folder::Batch;
use slipfront_study::text_table::table;
use slipfront_study::{StudyError, Unknown};

/// The findings, as numbers and as a text.
pub(crate) const FOUND: [&str; 2] = ["calibration.json", "calibration.txt"];

/// Points that are drawn from the joint estimate of all unknowns, a row each.
const POSTERIOR: &str = "posterior.csv";

/// Report on the findings of a calibration.
pub(crate) struct Report<'a> {
    set_up: &'a SetUp,
    findings: &'a Findings,
}

impl<'a> Report<'a> {
    pub(crate) const fn new(set_up: &'a SetUp, findings: &'a Findings) -> Self {
        Self { set_up, findings }
    }

    /// The findings as a text for a person.
    pub(crate) fn text(&self) -> Result<String, StudyError> {
        Ok(in_words(self.findings) + &self.notes_on_case()?)
    }

    /// Writes all results, and returns the text.
    pub(crate) fn write(&self, found: &Found, batch: &mut Batch) -> Result<String, StudyError> {
        let [numbers, words] = FOUND;
        let (set_up, findings) = (self.set_up, self.findings);
        batch.write(numbers, |to| Ok(serde_json::to_writer_pretty(to, findings)?))?;
        batch.write(POSTERIOR, |to| Ok(write_sample(set_up, &found.sample, to)?))?;
        let records = found.records.iter().zip(&found.bands).zip(&set_up.conditions);
        for (number, ((record, band), conditions)) in records.enumerate() {
            write_record(number + 1, record, band, conditions, batch)?;
        }
        let case = self.case()?;
        batch.write(CASE, |to| to.write_all(case.as_bytes()))?;
        let text = self.text()?;
        batch.write(words, |to| to.write_all(text.as_bytes()))?;
        Ok(text)
    }

    /// The median of every unknown, as settings of keys of the case.
    pub(crate) fn set(&self) -> Vec<Override> {
        self.set_up.set_to(&self.medians())
    }

    /// The case with the median of every unknown.
    fn case(&self) -> Result<String, StudyError> {
        let set = self.set();
        let set: Vec<_> = set.iter().collect();
        Ok(self.set_up.base.parse()?.with(&set)?.to_toml()?)
    }

    /// The median of every unknown, as a share of its range.
    fn medians(&self) -> Vec<f64> {
        let unknowns = self.findings.unknowns.iter().zip(&self.set_up.unknowns);
        unknowns
            .map(|(estimate, unknown)| unknown.share_of(estimate.median))
            .collect()
    }

    /// Notes on how far the calibrated case represents an experiment: a slider that is too thick for a sheet
    /// under its texture, and too few blocks with random coefficients; each for the first record that it
    /// applies to.
    fn notes_on_case(&self) -> Result<String, StudyError> {
        let medians = self.medians();
        let records = self.set_up.conditions.iter();
        let cases: Vec<Case> = records
            .map(|conditions| self.set_up.case(&medians, 0, conditions))
            .collect::<Result<_, _>>()?;
        let of_kind = |kind: fn(&Case) -> Option<String>| cases.iter().find_map(kind);
        let sentences = [of_kind(Case::thick_for_texture), of_kind(Case::few_random_blocks)];
        let notes = sentences.iter().flatten();
        Ok(notes.map(|sentence| note(sentence, COLUMNS)).collect())
    }
}

/// A record and the band of the calibrated model, as a table and as a picture.
fn write_record(
    number: usize,
    record: &[f64],
    band: &FrictionBand,
    conditions: &Conditions,
    batch: &mut Batch,
) -> Result<(), StudyError> {
    let grid = &conditions.grid;
    let places = grid.places();
    let name = format!("band-{number}");
    let [x_name, y_name] = [grid.along, grid.quantity].map(|measure| title(measure, measure.unit()));
    batch.write(&format!("{name}.csv"), |to| {
        let mut table = csv::Writer::from_writer(to);
        table.write_record([&x_name, &y_name, "model 5 %", "model median", "model 95 %"])?;
        for (k, x) in places.iter().enumerate() {
            let row = [*x, record[k], band.low[k], band.median[k], band.high[k]];
            table.write_record(row.map(|value| value.to_string()))?;
        }
        table.flush()
    })?;
    let measures = [grid.along, grid.quantity];
    batch.draw(&name, |size| picture(&places, record, band, measures, size))
}

/// Writes a row for every drawn point, in the units of the unknowns.
fn write_sample(set_up: &SetUp, sample: &[Vec<f64>], to: &mut impl Write) -> Result<(), csv::Error> {
    let unknowns = &set_up.unknowns;
    let mut table = csv::Writer::from_writer(to);
    table.write_record(unknowns.iter().map(Unknown::column))?;
    for point in sample {
        let values = unknowns.iter().zip(point);
        table.write_record(values.map(|(unknown, &share)| unknown.at(share).to_string()))?;
    }
    Ok(table.flush()?)
}

/// Title of a column or an axis.
fn title(measure: Measure, unit: &str) -> String {
    let quantity = match measure {
        Measure::Time => "time",
        Measure::Displacement => "displacement of the drive",
        Measure::Force => "friction force",
        Measure::Coefficient => return "friction coefficient \u{3bc}".to_owned(),
    };
    format!("{quantity} ({unit})")
}

/// A record over the band of the calibrated model.
fn picture(
    places: &[f64],
    record: &[f64],
    band: &FrictionBand,
    measures: [Measure; 2],
    size: PictureSize,
) -> Result<Picture, PictureError> {
    let prefixes = [places, &band.high].map(|values| {
        let largest = values.iter().map(|value| value.abs()).fold(0.0, f64::max);
        si_prefix(largest)
    });
    let prefix = |axis: usize| match measures[axis] {
        Measure::Coefficient => (1.0, ""),
        _ => prefixes[axis],
    };
    let scaled = |values: &[f64], axis: usize| -> Vec<f64> {
        values.iter().map(|value| value / prefix(axis).0).collect()
    };
    let x = scaled(places, 0);
    let [low, median, high] = [&band.low, &band.median, &band.high].map(|values| scaled(values, 1));
    let model = (0..x.len()).map(|k| (x[k], Estimate::between(low[k], median[k], high[k])));
    let curves = vec![
        Response {
            label: "model".to_owned(),
            points: model.collect(),
            line: true,
        },
        Response {
            line: true,
            ..Response::of_values("record", &x, &scaled(record, 1))
        },
    ];
    let [x_title, y_title] = [0, 1].map(|axis| {
        title(
            measures[axis],
            &format!("{}{}", in_print(prefix(axis).1), measures[axis].unit()),
        )
    });
    let responses = Responses {
        x_title,
        y_title,
        note: format!("median and 90 % of {PREDICTED} runs"),
        curves,
        ..Responses::default()
    };
    slipfront_plot::response(&responses, size)
}

/// The findings as a text for a person.
fn in_words(found: &Findings) -> String {
    let mut text = String::new();
    if found.is_refused {
        text += &paragraph(&refusal(found));
        text.push('\n');
    }
    let rows: Vec<Vec<String>> = found
        .unknowns
        .iter()
        .map(|estimate| row(estimate, found))
        .collect();
    text += &table(&["key", "median", "from", "to", "range"], &rows);
    if !found.is_refused {
        text += &accepted_intervals(found);
        text += &paragraph(&accepted(found));
    }
    text += &paragraph(&instrument(found));
    for (number, percent) in found.within_band_percent.iter().enumerate() {
        text += &paragraph(&format!(
            "{:.0} % of the values of record {} lie within the 90 % band of the calibrated model.",
            percent,
            number + 1
        ));
    }
    text += &at_finer_step(found);
    text += &on_finer_blocks(found);
    text += &further(found);
    text
}

/// How far the intervals of accepted records determine the unknowns.
fn accepted_intervals(found: &Findings) -> String {
    let mut text = paragraph(&format!(
        "Each interval contains the true value with a probability of 90 %. This was checked with training runs left out of {}, \
         with noise of {} % of the mean friction.",
        count(found.runs, "run"),
        four_digits(100.0 * found.noise)
    ));
    for estimate in found.unknowns.iter().filter(|estimate| !estimate.is_determined) {
        text += &paragraph(&format!("The records do not determine {}.", estimate.key));
    }
    for pair in &found.pairs {
        let [one, other] = &pair.keys;
        let way = if pair.correlation > 0.0 {
            "larger"
        } else {
            "smaller"
        };
        text += &paragraph(&format!(
            "The records determine {one} and {other} only in combination: if one is larger, the other is {way} (correlation {:.2}).",
            pair.correlation
        ));
    }
    text
}

/// A sentence that is wrapped into lines, with a line break at the end.
fn paragraph(sentence: &str) -> String {
    format!("{}\n", wrapped(sentence, COLUMNS))
}

/// Row of an unknown, whose last cell says why its median is not a property of the surface, if it is not.
fn row(estimate: &UnknownEstimate, found: &Findings) -> Vec<String> {
    let [low, high] = estimate.interval;
    let [from, to] = estimate.range.map(four_digits);
    let mut row = vec![
        estimate.key.clone(),
        estimate.text(estimate.median),
        estimate.text(low),
        estimate.text(high),
        format!("[{from}, {to}]"),
    ];
    if found.is_refused {
        row.push("does not describe the records".to_owned());
    } else if !estimate.is_determined {
        row.push("not determined".to_owned());
    } else if estimate.belongs_to_block {
        row.push("belongs to the block".to_owned());
    } else if estimate.depends_on_step {
        row.push("depends on the step".to_owned());
    }
    row
}

/// Reasons why the model cannot have made the records.
fn refusal(found: &Findings) -> String {
    format!(
        "The model cannot reproduce these records: {}. The test rejects about 4 % of the model's own records. Correct a drift \
         of the sensor, describe its filter in [instrument], check law, units, mount and noise, and widen the ranges. The \
         numbers below do not describe them.",
        found.check.reasons().join("; ")
    )
}

/// Results of the tests, if none of them refuses the records.
fn accepted(found: &Findings) -> String {
    let [low, high] = found.check.misfit.drift.map(|drift| four_digits(100.0 * drift));
    let closest = match &found.check.closest {
        Some(closest) => format!(
            "the closest curve{} differs from them by {:.2} times the noise, which is white (correlation {:.2})",
            at_step(closest),
            closest.noise_ratio,
            closest.correlation
        ),
        None => format!(
            "they agree with runs of the calibrated model as well as these runs agree with each other ({:.0} % of the runs are farther away)",
            100.0 * found.check.comparison.rank
        ),
    };
    format!(
        "The model is consistent with the records: the drift of friction over the records is between {low} and {high} %, and {closest}."
    )
}

/// The instrument, the fastest change of the records and their noise.
fn instrument(found: &Findings) -> String {
    let InstrumentFindings {
        bandwidth_hz,
        fastest_swing_hz,
        noise_percent,
    } = &found.instrument;
    let passes = match bandwidth_hz {
        Some(hertz) => format!(
            "The instrument passes friction up to {}",
            with_si_prefix(*hertz, "Hz")
        ),
        None => {
            "No filter is assumed between friction and records, because the file has none in [instrument]"
                .to_owned()
        }
    };
    let fastest = match fastest_swing_hz {
        Some(hertz) => format!(
            "; friction changes as fast as an oscillation of {}",
            with_si_prefix(*hertz, "Hz")
        ),
        None => String::new(),
    };
    let noise: Vec<String> = noise_percent
        .iter()
        .map(|percent| format!("{} %", four_digits(*percent)))
        .collect();
    format!(
        "{passes}{fastest}. Values scatter about their neighbours by {} of the mean; `noise` is {} %.",
        noise.join(", "),
        four_digits(100.0 * found.noise)
    )
}

/// The medians at the finer time step, in words.
fn at_finer_step(found: &Findings) -> String {
    let moved: Vec<String> = found
        .unknowns
        .iter()
        .filter(|estimate| estimate.depends_on_step)
        .map(|estimate| format!("{} ({})", estimate.key, estimate.text(estimate.at_finer_step)))
        .collect();
    let step = match found.finer_step {
        2 => "half the time step".to_owned(),
        divisor => format!("1/{divisor} of the time step"),
    };
    paragraph(&if moved.is_empty() {
        format!("With {step} every median is within its interval.")
    } else {
        format!(
            "With {step} these medians are outside their intervals: {}. Reduce `time.step` of the case until all are inside.",
            moved.join(", ")
        )
    })
}

fn on_finer_blocks(found: &Findings) -> String {
    match &found.finer {
        OnFinerBlocks::NotAskedFor => {
            paragraph("Blocks of half the size were not tested, because `finer_runs` is 0.")
        }
        OnFinerBlocks::Impossible(reason) => {
            paragraph(&format!("Blocks of half the size were not tested: {reason}"))
        }
        OnFinerBlocks::Runs(runs) => {
            let moved: Vec<String> = found
                .unknowns
                .iter()
                .filter(|estimate| estimate.belongs_to_block)
                .filter_map(|estimate| {
                    Some(format!(
                        "{} ({})",
                        estimate.key,
                        estimate.text(estimate.on_finer_blocks?.0)
                    ))
                })
                .collect();
            let runs = count(*runs, "run");
            paragraph(&if moved.is_empty() {
                format!("With blocks of half the size ({runs}) every median is within its interval.")
            } else {
                format!(
                    "With blocks of half the size ({runs}) these medians are outside their intervals: {}. They depend on the \
                     block size, and are not properties of the material.",
                    moved.join(", ")
                )
            })
        }
    }
}

/// Reduction of the intervals by further experiments, in words.
fn further(found: &Findings) -> String {
    if found.next.is_empty() {
        return String::new();
    }
    let mut header = vec!["key"];
    header.extend(found.next.iter().map(|further| further.set.as_str()));
    let row = |(number, estimate): (usize, &UnknownEstimate)| {
        let widths = found
            .next
            .iter()
            .map(|further| format!("{:.2}", further.narrowed_to[number]));
        std::iter::once(estimate.key.clone()).chain(widths).collect()
    };
    let rows: Vec<Vec<String>> = found.unknowns.iter().enumerate().map(row).collect();
    format!(
        "\nWidths of the intervals with a further experiment, relative to those without:\n{}",
        table(&header, &rows)
    )
}
