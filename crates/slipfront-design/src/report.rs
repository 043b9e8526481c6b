//! Results of a design: the mask as files for programs and lasers, a case that reads it, tables, pictures,
//! and a text for a person.

use std::io::Write;
use std::path::Path;
use std::sync::Arc;

use serde::Serialize;
use slipfront::block_sets;
use slipfront_base::number_format::{count, four_digits, with_half_width, with_si_prefix};
use slipfront_base::text::{COLUMNS, note, wrapped};
use slipfront_case::arrays::{npy_of_mask, png_of_mask};
use slipfront_case::case::{Case, Files, FilesInMemory, Ranks};
use slipfront_case::case_file::CaseFile;
use slipfront_case::texture_file::{self, Options};
use slipfront_plot::{FieldMap, FieldMaps, FrictionAxes, FrictionCurve};
use slipfront_run::names::CASE;
use slipfront_run::running;

use crate::design::{Design, Outcome};
use crate::file::DesignFile;
use crate::mean::Mean;
use crate::numbers::{FoundNumber, columns_of_unknowns, numbers_at, numbers_found, table_of_numbers};
use crate::search::Rejected;
use crate::sensitivity::Changed;
use crate::stages::{RatedDraft, SearchLength};
use crate::subject::{Fidelity, MASK, masked};
use crate::tolerance::WithinTolerance;
use crate::verdict::{OnFresh, Verdict};
use crate::wish::{FrictionUnit, Wish};
use slipfront_study::StudyError;
use slipfront_study::project_folder::Batch;
use slipfront_study::text_table::table;

/// Table with every draft that was tried.
const EVALUATIONS: &str = "evaluations.csv";

/// The verdict, as numbers and as a text.
pub(crate) const VERDICT: [&str; 2] = ["design.json", "design.txt"];

/// Name of the mask without an ending; the mask is not a picture of results.
pub(crate) const MASK_NAME: &str = "mask";
/// Endings of the mask in other formats.
const MASK_ENDINGS: [&str; 3] = ["svg", "dxf", "gsf"];

/// The mask as a picture, which the case reads.
const PICTURE: &str = "mask.png";

/// Properties of the texture of a design on its blocks.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct AsMeshed {
    /// Share of the blocks that are textured, %.
    pub coverage_percent: f64,
    /// Number of features: pieces without a common edge of a block.
    pub features: usize,
    /// Smallest width of a feature, m.
    pub feature_m: Option<f64>,
    /// Smallest width of a gap, m.
    pub gap_m: Option<f64>,
    /// Length of the lines of a laser, m, if their distance is given.
    pub writing_length_m: Option<f64>,
}

/// Content of `design.json`.
#[derive(Serialize)]
struct DesignJson<'a> {
    search: SearchLength,
    rejected: &'a Rejected,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    unknowns: Vec<FoundNumber>,
    as_meshed: &'a AsMeshed,
    /// Unit of friction in the report, with the value of mu_s in it.
    unit: &'a FrictionUnit,
    #[serde(flatten)]
    verdict: &'a Verdict,
    version: &'static str,
}

/// Columns of `evaluations.csv` before those of the unknowns.
const COLUMNS_OF_DRAFTS: [&str; 7] = [
    "number",
    "stage",
    "origin",
    "coverage_percent",
    "loss",
    "texture",
    "lost",
];

/// Writer of the results of a design.
pub(crate) struct Report<'a> {
    /// Path of the results folder.
    pub(crate) path: &'a Path,
    /// Design file in the folder.
    pub(crate) file: &'a DesignFile,
    /// Files of the results.
    pub(crate) batch: &'a mut Batch,
}

impl Report<'_> {
    /// Writes the results of a design, and returns the text of the verdict.
    ///
    /// # Errors
    /// When the system refuses to write, or a picture cannot be drawn.
    pub(crate) fn write(&mut self, design: &Design, outcome: &Outcome) -> Result<String, StudyError> {
        let texture = outcome.texture.as_slice();
        let shares = outcome.shares.as_deref();
        let case = self.write_texture(design, texture, shares)?;
        for ending in MASK_ENDINGS {
            let name = format!("{MASK_NAME}.{ending}");
            let (bytes, _) = texture_file::contents(&case, Path::new(&name), Options::default())?;
            self.batch.write(&name, |to| to.write_all(&bytes))?;
        }
        self.write_pictures(design, outcome)?;
        self.batch
            .write(EVALUATIONS, |to| Ok(evaluations(design, outcome, to)?))?;
        let drawn = shares.map(|_| texture_file::smallest(&case)).transpose()?;
        let as_meshed = self.as_meshed(design, texture, &case, drawn.and_then(|drawn| drawn.feature));
        let [numbers, words] = VERDICT;
        let written = DesignJson {
            search: outcome.length,
            rejected: &outcome.rejected,
            unknowns: numbers_found(design, shares),
            as_meshed: &as_meshed,
            unit: &design.evaluator.subjects[0].unit,
            verdict: &outcome.verdict,
            version: env!("CARGO_PKG_VERSION"),
        };
        self.batch
            .write(numbers, |to| Ok(serde_json::to_writer_pretty(to, &written)?))?;
        let text = self.in_words(design, outcome, &as_meshed, &case);
        self.batch.write(words, |to| to.write_all(text.as_bytes()))?;
        Ok(text)
    }

    /// Writes a texture as a mask, and the cases with this texture; returns the first of these cases. If
    /// `shares` of the ranges are given, the cases have the shapes with these numbers.
    pub(crate) fn write_texture(
        &mut self,
        design: &Design,
        texture: &[bool],
        shares: Option<&[f64]>,
    ) -> Result<Case, StudyError> {
        let [nx, ny] = design.evaluator.grid.size();
        self.batch
            .write(MASK, |to| to.write_all(&npy_of_mask(nx, texture)))?;
        let path = self.path.join(PICTURE);
        let picture = png_of_mask(nx, ny, texture).map_err(|source| StudyError::Write { path, source })?;
        self.batch.write(PICTURE, |to| to.write_all(&picture))?;
        // A picture can be applied to any mesh, while an array belongs to its blocks.
        let textures = match design.shapes.as_ref().zip(shares) {
            Some((shapes, shares)) => shapes.textures(shares)?,
            None => vec![masked(PICTURE)],
        };
        let mut first = None;
        for (k, Case { mut file, .. }) in self.file.cases()?.into_iter().enumerate() {
            file.texture.clone_from(&textures);
            let text = file.to_toml()?;
            self.batch
                .write(&case_name(k), |to| to.write_all(text.as_bytes()))?;
            first.get_or_insert(text);
        }
        // The case as it will be read from the folder.
        let in_memory = FilesInMemory::from([(PICTURE.to_owned(), picture.into())]);
        let files = Files {
            folder: self.path,
            in_memory: Some(&in_memory),
        };
        let file = CaseFile::parse(&first.unwrap_or_default(), CASE, &[])?;
        Ok(Case::to_run(file, "case", files, &mut |_| true, Ranks::ALONE)?)
    }

    /// Properties of a texture. `drawn` is the smallest width of its shapes in blocks, if they are known.
    fn as_meshed(&self, design: &Design, texture: &[bool], case: &Case, drawn: Option<f64>) -> AsMeshed {
        let grid = &design.evaluator.grid;
        let size = case.scales.block_size;
        let width = |set: &[bool]| block_sets::width(&grid.lattice, set).map(|blocks| blocks as f64 * size);
        let area = 0.01 * grid.percent(texture) * grid.n_blocks() as f64 * size * size;
        AsMeshed {
            coverage_percent: grid.percent(texture),
            features: block_sets::n_pieces(&grid.lattice, texture),
            feature_m: drawn.map_or_else(|| width(texture), |drawn| Some(drawn * size)),
            gap_m: width(&grid.others(texture)),
            writing_length_m: self.file.line_spacing().map(|spacing| area / spacing),
        }
    }

    /// Writes curves and maps of the first slips of the design and of the textures it is compared with, on a
    /// fresh surface.
    fn write_pictures(&mut self, design: &Design, outcome: &Outcome) -> Result<(), StudyError> {
        let subject = &design.evaluator.subjects[0];
        let [nx, ny] = design.evaluator.grid.size();
        let (mut curves, mut maps, mut latest) = (Vec::new(), Vec::new(), 0.0_f64);
        for (name, texture) in &outcome.compared {
            let texture = texture.as_ref().map(|texture| texture.as_slice());
            let case = Arc::new(subject.case(texture, outcome.verdict.first_surface, Fidelity::Verdict)?);
            // The verdict includes this surface, so only the run of a lost texture can fail.
            let Ok(record) = running::run(&case, 1) else {
                continue;
            };
            curves.push(FrictionCurve {
                label: name.clone(),
                x: record.rows.iter().map(|row| row.time_star).collect(),
                friction: record.rows.iter().map(|row| row.point.mu_star).collect(),
                sliding_percent: record.rows.iter().map(|row| row.point.sliding_percent).collect(),
                ..FrictionCurve::default()
            });
            let slips = record.first_slip_time_star.iter().map(|time| *time as f32);
            let finite = record
                .first_slip_time_star
                .iter()
                .copied()
                .filter(|time| time.is_finite());
            latest = finite.fold(latest, f64::max);
            maps.push(FieldMap {
                label: name.clone(),
                note: format!("largest \u{3bc}* {}", four_digits(record.summary.mu_star_max)),
                nx,
                ny,
                values: slips.collect(),
                textured: texture.map_or_else(|| vec![false; nx * ny], <[bool]>::to_vec),
                marks: Vec::new(),
            });
        }
        let maps = FieldMaps {
            value_title: "t* of the first slip".to_owned(),
            range: [0.0, latest.max(1.0)],
            columns: 2,
            maps,
        };
        self.batch.draw("friction", |size| {
            slipfront_plot::friction(&curves, &FrictionAxes::default(), size)
        })?;
        self.batch
            .draw("first_slips", |size| slipfront_plot::field_maps(&maps, size))
    }
}

impl Report<'_> {
    /// The verdict as a text for a person.
    fn in_words(&self, design: &Design, outcome: &Outcome, as_meshed: &AsMeshed, case: &Case) -> String {
        let (wish, verdict) = (design.evaluator.wish(), &outcome.verdict);
        let mut text = format!("{}\n\n", wrapped(&headline(design, verdict), COLUMNS));
        let numbers = numbers_found(design, outcome.shares.as_deref());
        text += &table_of_numbers(&numbers);
        text += &on_fresh(wish, verdict);
        text += &if design.evaluator.scatters() {
            format!(
                "\nTested on {} not used by the search, with 95 % intervals. {}\n",
                count(verdict.surfaces as usize, "surface"),
                optimism(wish, verdict)
            )
        } else {
            "\nCoefficients are not random, so the test uses the same surface as the search.\n".to_owned()
        };
        let unit = &design.evaluator.subjects[0].unit;
        text += &friction_of_parts(unit, wish, verdict).unwrap_or_default();
        let length =
            |length: Option<f64>| length.map_or("none".to_owned(), |length| with_si_prefix(length, "m"));
        text += &format!(
            "Texture as meshed: {} % in {}, features at least {} wide, gaps at least {}",
            four_digits(as_meshed.coverage_percent),
            count(as_meshed.features, "piece"),
            length(as_meshed.feature_m),
            length(as_meshed.gap_m)
        );
        if let Some(length) = as_meshed.writing_length_m {
            text += &format!(", {} of laser lines", with_si_prefix(length, "m"));
        }
        text += ".\n";
        let cases = self.file.case_keys();
        if !cases.is_empty() {
            let rows = cases.into_iter().enumerate();
            let rows: Vec<Vec<String>> = rows
                .map(|(k, keys)| vec![(k + 1).to_string(), keys, case_name(k)])
                .collect();
            text += "\nThe cases, each with this texture:\n";
            text += &table(&["case", "the base with", "file"], &rows);
        }
        text += "\nUnder changes:\n";
        text += &under_changes(design, verdict);
        for left_out in &verdict.sensitivity.left_out {
            text += &note(
                &format!("nothing is known of {}: {}", left_out.change, left_out.why),
                COLUMNS,
            );
        }
        let thick = as_meshed
            .feature_m
            .and_then(|feature| case.thick_for_feature(feature));
        let rejected = outcome.rejected.in_words().map(|rejected| {
            let tested = count(outcome.tried.len(), "draft");
            format!("the search tested {tested}; {rejected}")
        });
        let sentences = rejected
            .into_iter()
            .chain(losses(&outcome.tried, verdict))
            .chain(design.notes())
            .chain(numbers.iter().filter_map(FoundNumber::end_of_range_note))
            .chain(thick);
        text.extend(sentences.map(|sentence| note(&sentence, COLUMNS)));
        let lengths = case.file.lengths_of_a_block();
        if !lengths.is_empty() {
            let names: Vec<String> = lengths.iter().map(ToString::to_string).collect();
            let sentence = format!(
                "the gain depends on the block size, because the block size sets {}: give them as lengths of the material, and \
                 estimate the mesh error with `slipfront converge`",
                names.join(", ")
            );
            text += &note(&sentence, COLUMNS);
        }
        text
    }
}

/// Name of the file of a case with the texture.
fn case_name(k: usize) -> String {
    if k == 0 {
        CASE.to_owned()
    } else {
        format!("case_{}.toml", k + 1)
    }
}

/// Writes a row for every draft that was tried.
fn evaluations(design: &Design, outcome: &Outcome, to: &mut impl Write) -> Result<(), csv::Error> {
    let mut table = csv::Writer::from_writer(to);
    let header = COLUMNS_OF_DRAFTS.map(str::to_owned).into_iter();
    table.write_record(header.chain(columns_of_unknowns(design)))?;
    for (k, tried) in outcome.tried.iter().enumerate() {
        let hash = blake3::Hash::from_bytes(crate::search::hash(&tried.texture));
        let stage = if tried.is_refined {
            "several surfaces"
        } else {
            "one surface"
        };
        table.serialize((
            k + 1,
            stage,
            &tried.origin,
            design.evaluator.grid.percent(&tried.texture),
            tried.loss,
            &hash.to_hex()[..16],
            tried.lost.as_deref().unwrap_or_default(),
            numbers_at(design, tried.shares.as_deref()),
        ))?;
    }
    Ok(table.flush()?)
}

/// Notes on everything that counts as lost: drafts of the search, textures on fresh surfaces, and the design
/// under changes.
fn losses(tried: &[RatedDraft], verdict: &Verdict) -> Vec<String> {
    let drafts = tried
        .iter()
        .enumerate()
        .filter_map(|(k, tried)| Some((k + 1, tried.lost.as_ref()?)));
    let n_drafts = drafts.clone().count();
    let of_search = drafts.take(1).map(|(number, why)| {
        format!(
            "{} of the {} tested by the search failed ({EVALUATIONS} has the reasons); the first, number {number}: {why}",
            n_drafts,
            count(tried.len(), "draft")
        )
    });
    let judged = std::iter::once(&verdict.design).chain(&verdict.others);
    let on_fresh = judged.filter_map(|found| {
        let why = found.lost.as_ref()?;
        Some(format!("on new surfaces the {} fails: {why}", found.name))
    });
    let changed = verdict.sensitivity.changed.iter().filter_map(|changed| {
        let why = changed.lost.as_ref()?;
        Some(format!("the design fails at {}: {why}", changed.change))
    });
    of_search.into_iter().chain(on_fresh).chain(changed).collect()
}

fn headline(design: &Design, verdict: &Verdict) -> String {
    let (wish, unit) = (design.evaluator.wish(), &design.evaluator.subjects[0].unit);
    if verdict.design.lost.is_some() {
        return "no verdict: every tested texture failed on new surfaces".to_owned();
    }
    let design = &verdict.design;
    let loss = wish.reported_loss(design.loss);
    let half_width = design.loss_half_width.map(|half| wish.reported_difference(half));
    let found = match design.cases.as_slice() {
        [one] => one
            .wished_star
            .map_or("nothing".to_owned(), |mean| unit.mean_text(&mean)),
        _ => String::new(),
    };
    let mut text = wish.headline(loss, half_width, &found);
    if matches!(wish, Wish::Value(_)) && !found.is_empty() {
        text.extend(scatter(unit, verdict).map(|scatter| format!("; {scatter}")));
    }
    if let Some((parts, tolerance)) = design_within(wish, verdict) {
        text += &format!("; {}", parts.in_words(&tolerance));
    }
    if verdict.is_named {
        text += &format!(
            ". It is the {}: no texture of the search is better on new surfaces with 95 % confidence",
            verdict.design.name
        );
    }
    // A pattern can be better than the design only if the search was for numbers.
    let better = verdict.others.iter().filter_map(|other| {
        let by = other.design_is_better_by?;
        (by.mean + by.half_width.unwrap_or(0.0) < 0.0).then_some((&other.name, by))
    });
    if let Some((name, by)) = better.min_by(|one, other| one.1.mean.total_cmp(&other.1.mean)) {
        text += &format!(
            ". Another texture is better, by {}{}: {name}",
            four_digits(-wish.reported_difference(by.mean)),
            wish.loss_unit()
        );
    }
    text + wish.missed(loss)
}

/// The scatter of the design over parts in the unit of the wish, for a sentence; none if parts do not differ.
fn scatter(unit: &FrictionUnit, verdict: &Verdict) -> Option<String> {
    let mean = verdict.design.cases[0].wished_star?;
    let deviation = unit.scatter_text(mean.deviation?);
    Some(format!("parts scatter by {deviation} (1 s.d.)"))
}

/// The parts of the design within the tolerance of the wish, and the tolerance as text.
fn design_within(wish: &Wish, verdict: &Verdict) -> Option<(WithinTolerance, String)> {
    Some((verdict.design.within_tolerance?, wish.tolerance_text()?))
}

/// A line on the friction of the design in the unit of the wish, for a wish with a headline that does not
/// give it.
fn friction_of_parts(unit: &FrictionUnit, wish: &Wish, verdict: &Verdict) -> Option<String> {
    let [one] = verdict.design.cases.as_slice() else {
        return None;
    };
    if matches!(wish, Wish::Value(_)) {
        return None;
    }
    let end = scatter(unit, verdict).map_or(String::new(), |scatter| format!("; {scatter}"));
    Some(format!(
        "The {} of the design is {}{end}.\n",
        wish.quantity().name(),
        unit.mean_text(&one.wished_star?)
    ))
}

/// Rows of the table: one for every judged texture in every case.
fn on_fresh(wish: &Wish, verdict: &Verdict) -> String {
    let within = wish
        .tolerance_text()
        .map(|tolerance| format!("within \u{b1} {tolerance}"));
    let mut header = vec![
        "texture",
        "covers",
        "largest mu*",
        "first peak",
        "mu_k*",
        wish.loss_name(),
        "the design is better by",
    ];
    header.extend(within.as_deref());
    let mut rows = Vec::new();
    for found in std::iter::once(&verdict.design).chain(&verdict.others) {
        for (k, given) in found.cases.iter().enumerate() {
            let name = if found.cases.len() == 1 {
                found.name.clone()
            } else {
                format!("{}, case {}", found.name, k + 1)
            };
            // If a texture is lost on some surfaces, a mean over the others would be too good.
            let is_whole = given.surfaces == verdict.surfaces;
            let mean = |mean: Mean| {
                if is_whole {
                    with_half_width(mean.mean, mean.half_width)
                } else {
                    "-".to_owned()
                }
            };
            let is_first = k == 0;
            let mut row = vec![
                name,
                format!("{} %", four_digits(found.coverage_percent)),
                mean(given.static_friction_star),
                mean(given.first_peak_star),
                given.kinetic_friction_star.map_or("-".to_owned(), mean),
                loss_cell(wish, found, is_first),
                better_cell(wish, found.design_is_better_by.filter(|_| is_first)),
            ];
            if within.is_some() {
                row.push(within_cell(found.within_tolerance.filter(|_| is_first)));
            }
            rows.push(row);
        }
    }
    table(&header, &rows)
}

fn loss_cell(wish: &Wish, found: &OnFresh, is_first: bool) -> String {
    if is_first && found.lost.is_some() {
        "lost".to_owned()
    } else if is_first && found.loss.is_finite() {
        format!(
            "{}{}",
            four_digits(wish.reported_loss(found.loss)),
            wish.loss_unit()
        )
    } else {
        "-".to_owned()
    }
}

fn within_cell(found: Option<WithinTolerance>) -> String {
    found.map_or("-".to_owned(), WithinTolerance::cell)
}

/// Cell of a difference of losses as reported.
fn better_cell(wish: &Wish, better: Option<Mean>) -> String {
    let finite = better.filter(|better| better.mean.is_finite());
    finite.map_or("-".to_owned(), |better| {
        let half_width = better.half_width.map(|half| wish.reported_difference(half));
        with_half_width(wish.reported_difference(better.mean), half_width)
    })
}

fn optimism(wish: &Wish, verdict: &Verdict) -> String {
    format!(
        "On the surfaces of the search the design was better by {}.",
        four_digits(wish.reported_difference(verdict.optimism))
    )
}

/// Rows of the table of changes; the friction under each change is given if there is only one case.
fn under_changes(design: &Design, verdict: &Verdict) -> String {
    let (wish, subjects) = (design.evaluator.wish(), &design.evaluator.subjects);
    let unit = match subjects.as_slice() {
        [one] => Some(&one.unit),
        _ => None,
    };
    let within = wish
        .tolerance_text()
        .map(|tolerance| format!("within \u{b1} {tolerance}"));
    let mut header = vec!["change"];
    if unit.is_some() {
        header.extend([wish.quantity().name(), "scatter (1 s.d.)"]);
    }
    header.extend(within.as_deref());
    header.extend([wish.loss_name(), "better than the best named pattern by"]);
    let row = |changed: &Changed| {
        let mut row = vec![changed.change.clone()];
        if let Some(unit) = unit {
            // If the design is lost on some surfaces, a mean over the others would be too good.
            let found = changed.wished_star.filter(|_| changed.lost.is_none());
            let deviation = found.and_then(|mean| mean.deviation);
            row.push(found.map_or("-".to_owned(), |mean| unit.mean_text(&mean)));
            row.push(deviation.map_or("-".to_owned(), |deviation| unit.scatter_text(deviation)));
        }
        if within.is_some() {
            row.push(within_cell(changed.within_tolerance));
        }
        row.push(if changed.lost.is_some() {
            "lost".to_owned()
        } else {
            let loss = wish.reported_loss(changed.loss.mean);
            format!("{}{}", four_digits(loss), wish.loss_unit())
        });
        row.push(better_cell(wish, changed.better_by));
        row
    };
    let rows: Vec<Vec<String>> = verdict.sensitivity.changed.iter().map(row).collect();
    table(&header, &rows)
}
