//! The design file: a base case, the wish, the limits, and the length of the search.

use std::path::Path;

use serde::Deserialize;
use slipfront_case::case::{Case, PROGRAM, Ranks};
use slipfront_case::case_file::{CaseError, CaseFile, KeyKind, Override, Redistribute, key, names_of, whole};
use slipfront_case::key_rows;
use slipfront_case::quantity::{Force, Length};
use slipfront_case::table::TableOptions;
use slipfront_case::texture_file::{smallest, textured_blocks};
use slipfront_run::measured::Measure;
use toml::{Table, Value};

use crate::design::Design;
use crate::limits::{Limits, whole_blocks};
use crate::shapes::Shapes;
use crate::slider_blocks::SliderBlocks;
use crate::subject::Subject;
use crate::wish::{FrictionUnit, Quantity, Target, Wish};
use slipfront_study::StudyError;
use slipfront_study::Unknown;
use slipfront_study::axis::overrides;
use slipfront_study::measured_columns::MeasuredColumns;
use slipfront_study::project_file::ProjectFile;
use slipfront_study::project_folder::ProjectKind;
use slipfront_study::work_memory::WorkMemory;

/// Folders of designs. Their design file contains the base case as a table:
/// `slipfront design DIR/design.toml` repeats the design.
pub(crate) static DESIGN: ProjectKind = ProjectKind {
    name: "design",
    table: "design",
    file: "design.toml",
    journal: "design.jsonl",
    given: &[],
    found: &[
        ("case", "A case that has the texture"),
        (
            "design.",
            "The verdict on the texture, compared with other textures",
        ),
        ("evaluations.csv", "One row per tested draft"),
        (
            "first_slips.",
            "Picture: first slip of blocks, with the texture and with others",
        ),
        (
            "friction.",
            "Picture: friction against time, with the texture and with others",
        ),
        ("front.", "The best textures at some coverages"),
        ("mask.", "The texture that was found"),
    ],
};

/// Largest number of runs of a search.
const MAX_RUNS: u32 = 100_000_000;

/// Largest number of drafts at once: the cases of all of them are in memory.
const MAX_DRAFTS: u32 = 100_000;

/// A design file.
#[derive(Clone, Debug)]
pub struct DesignFile {
    /// Keys of the file.
    pub keys: DesignKeys,
    /// The base case, and the text of the file.
    pub project: ProjectFile,
}

key_rows! {
    /// The table `[design]`.
    #[derive(Clone, Debug, PartialEq, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct DesignKeys {
        /// Aim of the texture.
        wish: WishKeys = key("", KeyKind::Special("")).without("needed").note("[See below](#wish)."),
        /// Distance from the value of the wish up to which a part is good, in the unit of the value. [See
        /// below](#tolerance).
        tolerance: Option<Number> = key("", KeyKind::Special("more than 0")).without("none"),
        /// Least and largest share of the slider that is textured, %.
        coverage: [f64; 2] = key("", KeyKind::Special("from at least 0 to less than 100")).without("needed"),
        /// Smallest width of a feature, a length. In a mask it is rounded up to whole blocks; shapes with
        /// `unknowns` are measured as drawn, a circle by its diameter.
        feature: Option<Length> = key("", KeyKind::Special("more than 0")).without("one block"),
        /// Smallest width of a feature in blocks, in place of `feature`.
        feature_blocks: Option<u32> = key("", KeyKind::Special("1 and more")),
        /// Smallest width of the part in contact between two features, and between a feature and an edge of
        /// the slider.
        gap: Option<Length> = key("", KeyKind::Special("more than 0")).without("one block"),
        /// Smallest gap in blocks, in place of `gap`.
        gap_blocks: Option<u32> = key("", KeyKind::Special("1 and more")),
        /// Mirror symmetry of the texture: its left and right halves (`"x"`), its lower and upper halves
        /// (`"y"`), or both.
        mirror: Mirror = key("\"none\"", KeyKind::Words(names_of::<Mirror>)),
        /// `[columns, rows]` of equal cells into which the slider is divided, all with one texture.
        copies: [u32; 2] = key("[1, 1]", KeyKind::Special("must divide the blocks")),
        /// Parts that must touch: a list of textures, as in a case file, such as
        /// `[{ shape = "mask", file = "clamps.png" }]`.
        forbidden: Option<Value> = key("", KeyKind::Special("")).without("nothing"),
        /// Largest number of features: pieces without a common edge of a block.
        max_features: Option<u32> = key("", KeyKind::Special("1 and more")).without("any"),
        /// Spacing of the lines that a laser writes, and largest length of all lines together. With
        /// `line_spacing` alone the report gives the length; `max_length` limits the coverage.
        writing: Option<Writing> =
            key("", KeyKind::Special("`{ line_spacing = \"10 um\", max_length = \"2 m\" }`; more than 0")),
        /// Keys of several cases for which the texture is designed, such as
        /// `[{ drive.v_star = 0.01 }, { drive.v_star = 0.1 }]`, but for `texture`. All have the blocks of the
        /// base; each has the wish in its own units, so that a force is another share of mu_s under another
        /// load.
        cases: Vec<Table> = key("[]", KeyKind::Special("")).without("the base alone"),
        /// Loss of several cases: the mean, or that of the worst.
        judge_by: JudgeBy = key("\"mean\"", KeyKind::Words(names_of::<JudgeBy>)),
        /// Runs of the search. The verdict takes some hundreds more.
        pub runs: u32 = key("10000", whole(1, MAX_RUNS as u64)),
        /// Seed of the random drafts: another one is another search.
        start: u64 = key("1", KeyKind::Special("0 and more")),
        /// Number of drafts that are tried at once, by default 8 to 32 from `runs`. More keep many cores or a
        /// GPU busy; another number is another search.
        drafts_at_once: Option<u32> = key("", KeyKind::Special("1 to 100 000")).without("from `runs`"),
        /// Numbers of the textures of the base that are searched for in place of a mask, each with its range:
        /// `{ "texture.0.lambda" = ["2 um", "6 um"] }`.
        unknowns: Table = key("{}", KeyKind::Special("keys of textures")).without("none")
            .note("[See below](#unknowns)."),
        /// Textures with which the search begins in addition to named patterns: a list of lists, each as
        /// `[[texture]]` of a case file. They are judged too, however good they are; of one that breaks a
        /// limit the search takes what is legal, and a note says so.
        starts: Vec<Value> = key("[]", KeyKind::Special("")).without("none"),
        /// Coverages, %, such as `[2, 4, 6, 8]`: for each of them a design that covers no more is searched
        /// for with as many runs, and `front.csv` gives the best friction over coverage.
        pub front: Vec<f64> = key("[]", KeyKind::Special("rising, within `coverage`")).without("none"),
    }
}

/// The key `wish`: exactly one of its forms.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct WishKeys {
    least: Option<Quantity>,
    largest: Option<Quantity>,
    value: Option<Number>,
    of: Option<String>,
    curve: Option<CurveKeys>,
}

/// A coefficient, or a force with its unit.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
enum Number {
    Coefficient(f64),
    Force(String),
}

impl Number {
    /// The number, in N for a force, and whether it is a force.
    fn number(&self) -> Result<(f64, bool), String> {
        match self {
            Self::Coefficient(number) => Ok((*number, false)),
            Self::Force(text) => {
                let force = text.parse::<Force>().map_err(|error| error.to_string())?;
                Ok((force.si(), true))
            }
        }
    }
}

/// A curve to follow: two columns of a table, path of the drive and friction.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct CurveKeys {
    file: String,
    x: String,
    y: String,
    x_unit: Option<String>,
    y_unit: Option<String>,
}

/// Limits of a laser's writing: the distance of its lines, and their largest total length.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Writing {
    line_spacing: Length,
    max_length: Option<Length>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Mirror {
    None,
    X,
    Y,
    Both,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum JudgeBy {
    Mean,
    Worst,
}

impl DesignFile {
    /// Loads a design file; a base case that it names is relative to it.
    ///
    /// # Errors
    /// As [`parse`](Self::parse), and when the file cannot be read.
    pub fn load(path: &Path) -> Result<Self, StudyError> {
        DESIGN.load(path, Self::parse)
    }

    /// Reads a design file called `file` in messages; a base case that it names is relative to `folder`.
    ///
    /// # Errors
    /// When it is not TOML, has unknown keys, or has values out of bounds.
    pub fn parse(text: &str, file: &str, name: &str, folder: &Path) -> Result<Self, StudyError> {
        let (project, keys): (_, DesignKeys) =
            ProjectFile::parse(&DESIGN, DesignKeys::KEYS, &[], text, file, name, folder)?;
        keys.check(&project)?;
        Ok(Self { keys, project })
    }

    /// The case in which designs are tried first, with its own texture.
    ///
    /// # Errors
    /// When the case is not valid.
    pub fn case(&self) -> Result<Case, CaseError> {
        self.case_with(&[])
    }

    /// The cases for which the texture is designed, with the texture of the base: one for every table of
    /// `cases`, or the base alone.
    ///
    /// # Errors
    /// When one of them is not valid.
    pub(crate) fn cases(&self) -> Result<Vec<Case>, CaseError> {
        if self.keys.cases.is_empty() {
            return Ok(vec![self.case()?]);
        }
        let case = |set: &Table| {
            let case = self.case_with(&overrides(set));
            case.map_err(|error| self.project.found_in("cases", error))
        };
        self.keys.cases.iter().map(case).collect()
    }

    /// Keys of each of several cases, as strings; empty for the base alone.
    pub(crate) fn case_keys(&self) -> Vec<String> {
        let keys = |set: &Table| {
            let set: Vec<String> = overrides(set).iter().map(ToString::to_string).collect();
            if set.is_empty() {
                "the base".to_owned()
            } else {
                set.join(", ")
            }
        };
        self.keys.cases.iter().map(keys).collect()
    }

    fn case_with(&self, set: &[Override]) -> Result<Case, CaseError> {
        let set: Vec<&Override> = set.iter().collect();
        let file: CaseFile = self.project.base.parse()?.with(&set)?;
        let case = Case::to_run(
            file,
            &self.project.name,
            self.project.base.folder.as_path(),
            &mut |_| true,
            Ranks::ALONE,
        )?;
        if case.model.body().is_some() && matches!(case.file.load.redistribute, Redistribute::All(true)) {
            let sentence = "a designed texture has no pitch, which a bulk body needs to redistribute load: give \
                            `load.redistribute` = { within = \"...\" } in the base, about twice the width of a feature";
            return Err(self.project.error("base", sentence.to_owned()));
        }
        Ok(case)
    }

    /// The base case with other textures instead of its own.
    fn with_textures(&self, key: &str, textures: &Value) -> Result<Case, CaseError> {
        if !textures.is_array() {
            let sentence = format!(
                "`{key}` must be a list of textures, each as in a case file, such as [{{ shape = \"mask\", file = \"mask.png\" }}]"
            );
            return Err(self.project.error(key, sentence));
        }
        let case = self.case_with(&[Override::new("texture", textures)]);
        case.map_err(|error| self.project.found_in(key, error))
    }

    /// Whether the wish is a curve.
    pub fn has_curve(&self) -> bool {
        self.keys.wish.curve.is_some()
    }

    /// The design that the file asks for.
    ///
    /// # Errors
    /// When one of its cases is not valid, or when its limits do not fit its blocks.
    pub fn design(&self) -> Result<Design, StudyError> {
        self.design_up_to(self.keys.coverage[1])
    }

    /// Refuses a design that is not valid, that needs too much memory for `threads` simultaneous runs, or
    /// that asks for a front although its search `is_timed`. `runs` is the number of runs of its search.
    ///
    /// # Errors
    /// As [`design`](Self::design); for memory, with the number of simultaneous runs that it is large enough
    /// for.
    pub fn check(&self, runs: usize, threads: usize, is_timed: bool) -> Result<(), StudyError> {
        if is_timed && !self.keys.front.is_empty() {
            let sentence = "a search with a time limit has no time for a front: give a number of runs, or leave out `front`";
            return Err(self.project.error("front", sentence.to_owned()).into());
        }
        let no_memory = |needed, available| StudyError::DesignMemory { needed, available };
        self.memory(runs)?.check(threads, no_memory)
    }

    /// Memory of the design with a search of this many runs.
    ///
    /// # Errors
    /// As [`design`](Self::design).
    pub fn memory(&self, runs: usize) -> Result<WorkMemory, StudyError> {
        // A draft keeps its patches and its row of the table, in addition to its blocks.
        const DRAFT: f64 = 2048.0;
        let evaluator = self.design()?.evaluator;
        // The verdict skips a mesh if memory is too small for a single run on it.
        let finer = evaluator.on_finer_blocks().ok();
        let mut run = evaluator.bytes_of_run()?;
        if let Some(finer) = finer {
            run = run.max(finer.bytes_of_run()?);
        }
        // Every design of a front keeps its drafts until all designs are written.
        let drafts = runs.saturating_mul(1 + self.keys.front.len());
        Ok(WorkMemory {
            // Masks, and the cases with them, take as much memory as 1.2 runs (measured).
            beside: PROGRAM + 1.25 * run + drafts as f64 * (DRAFT + evaluator.grid.n_blocks() as f64),
            pieces: vec![(run, usize::MAX)],
        })
    }

    /// The designs of a front: every coverage in `front`, and the design with at most that coverage.
    ///
    /// # Errors
    /// As [`design`](Self::design).
    pub fn designs_of_front(&self) -> Result<Vec<(f64, Design)>, StudyError> {
        let percents = self.keys.front.iter();
        percents
            .map(|&percent| Ok((percent, self.design_up_to(percent)?)))
            .collect()
    }

    fn design_up_to(&self, percent: f64) -> Result<Design, StudyError> {
        let base = self.case()?;
        let keys = &self.keys;
        let is_texture = |name: &String| name.split('.').next() == Some("texture");
        if keys.cases.iter().any(|set| set.keys().any(is_texture)) {
            let sentence = "`cases` differ in keys other than `texture`, because the texture is designed; put an initial \
                            drawing into `starts`"
                .to_owned();
            return Err(self.project.error("cases", sentence).into());
        }
        let cases = self.cases()?;
        let grid = SliderBlocks::from_case(&base);
        if cases.iter().any(|case| {
            SliderBlocks::from_case(case) != grid || case.scales.block_size != base.scales.block_size
        }) {
            let sentence = "all cases of a design have the blocks of the base".to_owned();
            return Err(self.project.error("cases", sentence).into());
        }
        let limits = self.limits(&base, &grid, percent)?;
        if keys.wish.curve.is_some() && cases.len() > 1 {
            let sentence =
                "a target curve belongs to one case: give `cases` one table, or leave it out".to_owned();
            return Err(self.project.error("cases", sentence).into());
        }
        let wished = cases.iter().map(|case| Ok((case, self.wish(case, &grid)?)));
        let wished: Vec<(&Case, Wish)> = wished.collect::<Result<_, StudyError>>()?;
        let is_worst = keys.judge_by == JudgeBy::Worst;
        let mut design = Design::new(&wished, is_worst, limits.clone(), keys.start)?;
        if let Some(drafts) = keys.drafts_at_once {
            design.try_at_once(drafts as usize);
        }
        let mut begin_with = |name: String, case: &Case| -> Result<(), CaseError> {
            let feature = if keys.unknowns.is_empty() {
                None
            } else {
                smallest(case)?.feature
            };
            design.begin_with(name, textured_blocks(case), feature);
            Ok(())
        };
        for (k, textures) in keys.starts.iter().enumerate() {
            let case = self.with_textures("starts", textures)?;
            begin_with(format!("start {} of the file", k + 1), &case)?;
        }
        if base.model.surface.texture_percent() > 0.0 {
            begin_with("texture of the case".to_owned(), &base)?;
        }
        if !keys.unknowns.is_empty() {
            let subject = Subject::new(&base, Wish::Least(Quantity::StaticFriction), limits.coverage[1])?;
            let shapes = Shapes::new(self.unknowns()?, &base, subject, grid, limits);
            design.vary(shapes.map_err(|error| self.project.found_in("unknowns", error))?);
        }
        Ok(design)
    }

    /// The unknown numbers of textures.
    fn unknowns(&self) -> Result<Vec<Unknown>, CaseError> {
        let refuse = |sentence: String| self.project.error("unknowns", sentence);
        let unknown = |(key, range): (&String, &Value)| {
            if !key.starts_with("texture.") {
                return Err(refuse(format!(
                    "the unknown `{key}` is not a key of a texture: give one of the base as in `--set`, such as \"texture.0.lambda\""
                )));
            }
            Unknown::read(key, range).map_err(refuse)
        };
        self.keys.unknowns.iter().map(unknown).collect()
    }

    /// The limits in blocks.
    fn limits(&self, base: &Case, grid: &SliderBlocks, percent: f64) -> Result<Limits, CaseError> {
        let keys = &self.keys;
        let narrowest = grid.size()[0].min(grid.size()[1]);
        let width = |[key, in_blocks]: [&str; 2], length: &Option<Length>, blocks: Option<u32>| {
            let of_length = |length: &Length| length.si() / base.scales.block_size;
            let blocks = blocks.map_or_else(|| length.as_ref().map_or(1.0, of_length), f64::from);
            if whole_blocks(blocks) > narrowest {
                let sentence = format!(
                    "`{key}` is {} blocks, more than the slider's {narrowest} across",
                    whole_blocks(blocks)
                );
                return Err(self
                    .project
                    .error(if length.is_some() { key } else { in_blocks }, sentence));
            }
            Ok(blocks)
        };
        let copies = keys.copies.map(|cells| cells as usize);
        for (axis, name) in ["columns", "rows"].into_iter().enumerate() {
            if copies[axis] == 0 || !grid.size()[axis].is_multiple_of(copies[axis]) {
                let sentence = format!(
                    "`copies` must divide the slider: it has {} {name} of blocks, which {} does not divide",
                    grid.size()[axis],
                    copies[axis]
                );
                return Err(self.project.error("copies", sentence));
            }
        }
        let forbidden = keys.forbidden.as_ref();
        let forbidden = forbidden
            .map(|textures| self.with_textures("forbidden", textures))
            .transpose()?
            .map(|case| textured_blocks(&case));
        Ok(Limits {
            coverage: [keys.coverage[0], self.largest_coverage(base, grid, percent)],
            feature: width(["feature", "feature_blocks"], &keys.feature, keys.feature_blocks)?,
            gap: whole_blocks(width(["gap", "gap_blocks"], &keys.gap, keys.gap_blocks)?),
            mirror: match keys.mirror {
                Mirror::None => [false, false],
                Mirror::X => [true, false],
                Mirror::Y => [false, true],
                Mirror::Both => [true, true],
            },
            copies,
            forbidden,
            max_features: keys.max_features.map(|most| most as usize),
        })
    }

    /// The largest coverage, %, up to `most`, that the length of a laser's lines allows.
    fn largest_coverage(&self, base: &Case, grid: &SliderBlocks, most: f64) -> f64 {
        let Some(Writing {
            line_spacing,
            max_length: Some(length),
        }) = &self.keys.writing
        else {
            return most;
        };
        let area = grid.n_blocks() as f64 * base.scales.block_size * base.scales.block_size;
        most.min(100.0 * length.si() * line_spacing.si() / area)
    }

    /// Distance between the lines of a laser, m, if the file gives one.
    pub(crate) fn line_spacing(&self) -> Option<f64> {
        self.keys
            .writing
            .as_ref()
            .map(|writing| writing.line_spacing.si())
    }

    /// The wish in units of mu_s and of t* of a case.
    fn wish(&self, case: &Case, grid: &SliderBlocks) -> Result<Wish, StudyError> {
        let refuse = |sentence: &str| Err(self.project.error("wish", sentence.to_owned()).into());
        let mu_s = case.scales.mu_static_mean;
        let load = case.scales.pressure * case.scales.block_size.powi(2) * grid.n_blocks() as f64;
        let keys = &self.keys.wish;
        let tolerance = self.keys.tolerance.as_ref();
        if let (Some(_), None) = (tolerance, &keys.value) {
            let sentence = "`tolerance` belongs to a target value, such as { value = 0.3, of = \"static_friction\" }: leave it \
                            out, or give a value";
            return Err(self.project.error("tolerance", sentence.to_owned()).into());
        }
        match (keys.least, keys.largest, &keys.value, &keys.of, &keys.curve) {
            (Some(quantity), None, None, None, None) => Ok(Wish::Least(quantity)),
            (None, Some(quantity), None, None, None) => Ok(Wish::Largest(quantity)),
            (None, None, Some(value), Some(of), None) => {
                let (name, is_star) = of
                    .strip_suffix("_star")
                    .map_or((of.as_str(), false), |name| (name, true));
                let quantity = match Quantity::of_name(name) {
                    Ok(quantity) => quantity,
                    Err(names) => {
                        return refuse(&format!(
                            "`of` must be {names}, also with _star for values relative to mu_s"
                        ));
                    }
                };
                let force_of_mu_s = load * mu_s;
                let unit = match value.number() {
                    Err(why) => return refuse(&format!("`value`: {why}")),
                    Ok((_, true)) if is_star => {
                        return refuse(
                            "`value` is a force, but `of` with _star is relative to mu_s: leave out _star",
                        );
                    }
                    Ok((force, true)) => FrictionUnit::force(force, force_of_mu_s),
                    Ok(_) if is_star => FrictionUnit::share(),
                    Ok(_) => FrictionUnit::coefficient(mu_s),
                };
                let in_mu_s = |key: &str, number: &Number| {
                    let refuse = |sentence: String| self.project.error(key, sentence);
                    let (number, is_force) =
                        number.number().map_err(|why| refuse(format!("`{key}`: {why}")))?;
                    if is_force != matches!(value, Number::Force(_)) {
                        let sentence =
                            "`tolerance` is in the unit of `value`: write both as forces, or both as numbers";
                        return Err(refuse(sentence.to_owned()));
                    }
                    let star = number / if is_force { force_of_mu_s } else { unit.mu_s };
                    if !(star > 0.0 && star.is_finite()) {
                        return Err(refuse(format!("`{key}` must be a number of more than 0")));
                    }
                    Ok(star)
                };
                Ok(Wish::Value(Target {
                    quantity,
                    star: in_mu_s("wish", value).map_err(|error| self.project.found_in("wish", error))?,
                    tolerance_star: tolerance.map(|given| in_mu_s("tolerance", given)).transpose()?,
                    unit: unit.clone(),
                }))
            }
            (None, None, None, None, Some(curve)) => self.curve(curve, case, load),
            _ => refuse(
                "`wish` is one of { least = \"static_friction\" }, { largest = \"static_friction\" }, { value = 0.3, of = \
                 \"static_friction\" } and { curve = { file = \"wanted.csv\", x = \"X (um)\", y = \"mu (1)\" } }",
            ),
        }
    }

    /// The curve of a table, as mu* over the time t* of the drive of a case.
    fn curve(&self, keys: &CurveKeys, case: &Case, load: f64) -> Result<Wish, StudyError> {
        if case.model.drive.program.is_some() {
            let sentence =
                "a curve against drive displacement needs a constant speed: leave out `drive.program`"
                    .to_owned();
            return Err(self.project.error("wish.curve", sentence).into());
        }
        let path = self.project.base.folder.join(&keys.file);
        let columns = MeasuredColumns::new(
            [&keys.x, &keys.y],
            [&keys.x_unit, &keys.y_unit],
            TableOptions::default(),
        );
        let record = columns.read(&path, Measure::Displacement);
        let record = record.map_err(|sentence| self.project.error("wish.curve", sentence))?;
        if let Some(footer) = record.footer {
            let sentence = format!("{footer}: remove them, or begin them with #");
            return Err(self.project.error("wish.curve", sentence).into());
        }
        if record.x.last().is_none_or(|&last| last <= 0.0) {
            let sentence =
                "the curve ends before the drive moves: its last displacement must be more than 0".to_owned();
            return Err(self.project.error("wish.curve", sentence).into());
        }
        let mu_s = case.scales.mu_static_mean;
        let unit = if record.quantity == Measure::Force {
            load * mu_s
        } else {
            mu_s
        };
        // The drive reaches the displacement X at t* = X/(V* l_x), where l_x is the unit of displacement.
        let path_of_time = case.groups.v_star * case.scales.displacement();
        let points = record.x.iter().zip(&record.y);
        Ok(Wish::Curve(
            points.map(|(x, y)| [x / path_of_time, y / unit]).collect(),
        ))
    }
}

impl DesignKeys {
    fn check(&self, project: &ProjectFile) -> Result<(), CaseError> {
        let refuse = |key: &str, sentence: String| Err(project.error(key, sentence));
        let [least, most] = self.coverage;
        if !(0.0 <= least && least <= most && 0.0 < most && most < 100.0) {
            let sentence = format!(
                "`coverage` = [{least}, {most}] must rise from at least 0 to less than 100, in %, such as [0, 10]"
            );
            return refuse("coverage", sentence);
        }
        for (key, length, blocks) in [
            ("feature", &self.feature, self.feature_blocks),
            ("gap", &self.gap, self.gap_blocks),
        ] {
            if length.is_some() && blocks.is_some() {
                let sentence = format!("`{key}` and `{key}_blocks` exclude each other: keep one");
                return refuse(key, sentence);
            }
            if blocks == Some(0) {
                return refuse(
                    &format!("{key}_blocks"),
                    format!("`{key}_blocks` = 0 must be at least 1"),
                );
            }
            if length
                .as_ref()
                .is_some_and(|length| length.si().is_nan() || length.si() <= 0.0)
            {
                return refuse(key, format!("`{key}` must be more than 0"));
            }
        }
        let rises = self.front.windows(2).all(|pair| pair[0] < pair[1]);
        if !rises
            || self
                .front
                .iter()
                .any(|&percent| !(least < percent && percent <= most))
        {
            let sentence = format!(
                "`front` must rise from more than {least} to at most {most}, the largest `coverage`, in %, such as [2, 4, 6, 8, 10]"
            );
            return refuse("front", sentence);
        }
        if !(1..=MAX_RUNS).contains(&self.runs) {
            let sentence = format!("`runs` = {} must lie between 1 and {MAX_RUNS}", self.runs);
            return refuse("runs", sentence);
        }
        if let Some(drafts) = self
            .drafts_at_once
            .filter(|drafts| !(1..=MAX_DRAFTS).contains(drafts))
        {
            let sentence = format!("`drafts_at_once` = {drafts} must lie between 1 and {MAX_DRAFTS}");
            return refuse("drafts_at_once", sentence);
        }
        if self.max_features == Some(0) {
            return refuse("max_features", "`max_features` must be at least 1".to_owned());
        }
        if let Some(writing) = &self.writing {
            let lengths = std::iter::once(&writing.line_spacing).chain(&writing.max_length);
            if lengths
                .into_iter()
                .any(|length| length.si().is_nan() || length.si() <= 0.0)
            {
                return refuse(
                    "writing",
                    "the lengths of `writing` must be more than 0".to_owned(),
                );
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The memory includes runs on blocks of half the size, and drafts with their blocks.
    #[test]
    fn threads_are_held_against_the_memory() {
        let file = |blocks: usize| {
            let text = format!(
                "[base]\nslider.blocks = [{blocks}, {blocks}]\n[design]\nwish = {{ least = 'static_friction' }}\ncoverage = [0, 10]"
            );
            DesignFile::parse(&text, "design.toml", "design", Path::new("")).unwrap()
        };
        let found = file(200).memory(100).unwrap();
        let [(run, _)] = found.pieces[..] else {
            panic!("{found:?}")
        };
        let fine = file(400).design().unwrap().evaluator.bytes_of_run().unwrap();
        // The number of blocks is equal, except for the row of a step at which the onset is expected.
        assert!((run / fine - 1.0).abs() < 0.01);
        let drafts = file(200).memory(300).unwrap().beside - found.beside;
        assert!((drafts - 200.0 * (2048.0 + 200.0 * 200.0)).abs() < 1.0);
        let available = found.on_threads(2) + 0.5 * run;
        let no_memory = |needed, available| StudyError::DesignMemory { needed, available };
        assert!(found.compare(2, available, no_memory).is_ok());
        assert!(matches!(
            found.compare(3, available, no_memory),
            Err(StudyError::Memory {
                threads: 3,
                fit: 2,
                ..
            })
        ));
        let said = found
            .compare(2, found.on_threads(1) - 1.0, no_memory)
            .unwrap_err()
            .to_string();
        assert!(
            said.starts_with("the design needs") && said.contains("reduce `slider.blocks` or `design.runs`"),
            "{said}"
        );
    }
}
