//! How much of a result belongs to the mesh: one slider on blocks of twice, once and half the size, and so on, as a study whose only axis is
//! the size of the blocks.
//!
//! Of three meshes `q_1, q_2, q_3`, each of half the blocks' size of the one before, with `d = q_2 - q_1` and `e = q_3 - q_2`:
//!
//! ```text
//! order p = log2(|d|/|e|), at least 1/2 and at most 2;  error of the mesh = max(|e|, max(|e|, |d|/4)/(2^p - 1))
//! ```
//!
//! A last difference that is smaller than a method of second order leaves is an accident of the outlines as they are meshed: `|d|/4` stands in its
//! place. No limit is claimed where the differences do not decrease, `|e| >= |d|`.

use std::io::Write as _;
use std::path::{Path, absolute};

use serde::Serialize;
use slipfront_case::case::Case;
use slipfront_case::case_file::{CaseError, CaseFile, Override};
use slipfront_run::names::CONVERGENCE;
use toml::{Table, Value};

use crate::error::StudyError;
use crate::folder::StudyFolder;
use crate::plan::Plan;
use crate::statistics::Sample;
use crate::study_file::{StudyFile, portable_text};
use crate::study_results::StudyResults;
use crate::summary_values::REDUCTION;

/// Fewest meshes: differences of two of them show no order.
pub const MIN_LEVELS: u8 = 3;
/// Most meshes: the finest has 64 times as many blocks along a side as the coarsest.
pub const MAX_LEVELS: u8 = 7;

/// What is measured on every mesh.
const QUANTITIES: [&str; 4] = [
    REDUCTION,
    "static_friction_star",
    "kinetic_friction_star",
    FRONT_SPEED,
];

/// The mean speed of the front, m/s.
const FRONT_SPEED: &str = "front_speed_m_s";

/// The study of a case on `levels` meshes: blocks of twice its own size, of its own, of half, and so on. The runs of a mesh differ by their
/// seeds alone; if the case has textures, every run has one without them beside it.
///
/// # Errors
/// When the case cannot be put on these blocks.
pub fn mesh_study(
    case: &Case,
    name: &str,
    folder: &Path,
    levels: u8,
    replicates: u32,
) -> Result<StudyFile, StudyError> {
    let made: Vec<Vec<Override>> = (0..levels)
        .map(|level| case.on_other_blocks(0.5 * f64::from(1_u32 << level)))
        .collect::<Result<_, CaseError>>()?;
    // Each key with its values on all meshes, those alone that differ between meshes or from the case.
    let mut zip = Table::new();
    for level in &made {
        for set in level {
            let list = zip.entry(set.key()).or_insert_with(|| Value::Array(Vec::new()));
            if let Value::Array(values) = list {
                values.push(set.value());
            }
        }
    }
    let mut base = Value::try_from(reading_originals(case)).map_err(CaseError::from)?;
    if let Some(base) = base.as_table_mut() {
        base.remove("output");
    }
    let mut study = Table::from_iter([("replicates".to_owned(), Value::from(replicates))]);
    if !case.file.texture.is_empty() {
        let none = Table::from_iter([("texture".to_owned(), Value::Array(Vec::new()))]);
        study.insert("reference".to_owned(), none.into());
    }
    let axis = Table::from_iter([("zip".to_owned(), Value::Table(zip))]);
    let table = Table::from_iter([
        ("base".to_owned(), base),
        ("study".to_owned(), study.into()),
        ("axes".to_owned(), Value::Array(vec![axis.into()])),
    ]);
    StudyFile::parse(&portable_text(table)?, name, name, folder)
}

/// The case file, which names the copies in a run folder, with the files that were copied in their place.
fn reading_originals(case: &Case) -> CaseFile {
    let mut file = case.file.clone();
    for named in file.files_mut().0 {
        if let Some(input) = case.inputs.iter().find(|input| input.name == *named.name) {
            let original = absolute(&input.original).unwrap_or_else(|_| input.original.clone());
            *named.name = original.display().to_string();
        }
    }
    file
}

/// A mesh, and what is meshed of the textures.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mesh {
    /// Edge of a block, as in the case file.
    pub block_size: String,
    /// Share of the blocks without contact, %.
    pub coverage_percent: f64,
}

/// A quantity on all meshes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Convergence {
    /// Its name in summaries.
    pub quantity: String,
    /// Mean over the seeds on each mesh, the coarsest first.
    pub means: Vec<f64>,
    /// Half width of the interval of each mean that the scatter over surfaces leaves; none of one seed.
    pub half_widths: Vec<Option<f64>>,
    /// What the meshes tell.
    pub verdict: Verdict,
}

/// What differences between meshes tell.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Differences decrease.
    Converges {
        /// Order of convergence, 1/2 to 2.
        order: f64,
        /// Error that the finest mesh leaves.
        mesh_error: f64,
    },
    /// All meshes have one value.
    Equal,
    /// Differences do not decrease; the values on meshes differ by up to so much.
    Open {
        /// Largest value less smallest of the last three meshes.
        spread: f64,
    },
}

impl Verdict {
    /// The verdict on the values of at least three meshes, the finest last.
    ///
    /// # Panics
    /// On fewer than three.
    pub fn on(values: &[f64]) -> Self {
        let [.., coarse, middle, fine] = values else {
            panic!("three meshes are needed, not {}", values.len());
        };
        let [before, last] = [middle - coarse, fine - middle].map(f64::abs);
        if before == 0.0 && last == 0.0 {
            return Self::Equal;
        }
        if last >= before {
            let [low, high] = [f64::min, f64::max].map(|of| of(*coarse, of(*middle, *fine)));
            return Self::Open { spread: high - low };
        }
        let order = libm::log2(before / last).clamp(0.5, 2.0);
        // At most of second order.
        let richardson = last.max(0.25 * before) / (libm::exp2(order) - 1.0);
        Self::Converges {
            order,
            mesh_error: last.max(richardson),
        }
    }
}

/// The meshes of a study that [`mesh_study`] made.
pub fn meshes(plan: &Plan) -> Vec<Mesh> {
    let points = plan.points.iter().enumerate();
    let mesh = |(position, point)| {
        let columns = plan.columns(point);
        let size = columns.iter().find(|(key, _)| *key == "slider.block_size");
        Mesh {
            block_size: size.map_or_else(String::new, |(_, size)| (*size).to_owned()),
            coverage_percent: plan.texture_percent(position),
        }
    };
    points.map(mesh).collect()
}

/// The first mesh on which no block is textured, of a case with textures.
pub fn without_texture(plan: &Plan) -> Option<usize> {
    let is_bare = |position: &usize| plan.has_reference() && plan.texture_percent(*position) == 0.0;
    (0..plan.points.len()).find(is_bare)
}

/// What every quantity does that all meshes have a value of.
fn convergences(plan: &Plan, results: &StudyResults) -> Vec<Convergence> {
    let of = |name: &&str| {
        let samples = (0..plan.points.len()).map(|position| results.sample(plan, position, name));
        let samples: Vec<Sample> = samples.collect::<Option<_>>()?;
        let means: Vec<f64> = samples.iter().map(|sample| sample.mean).collect();
        let verdict = Verdict::on(&means);
        Some(Convergence {
            quantity: (*name).to_owned(),
            means,
            half_widths: samples.iter().map(|sample| sample.half_width).collect(),
            verdict,
        })
    };
    QUANTITIES.iter().filter_map(of).collect()
}

/// What several meshes found of one slider.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OnMeshes {
    /// The meshes, the coarsest first.
    pub meshes: Vec<Mesh>,
    /// The quantities that all meshes have a value of.
    pub quantities: Vec<Convergence>,
    /// Lengths of the material that are those of a block: with any of them, every mesh is another material, and no limit is one of this
    /// slider.
    pub lengths_of_a_block: Vec<&'static str>,
}

impl OnMeshes {
    /// What the runs of the plan of a [`mesh_study`] found.
    pub fn of(plan: &Plan, results: &StudyResults, case: &Case) -> Self {
        Self {
            meshes: meshes(plan),
            quantities: convergences(plan, results),
            lengths_of_a_block: case.lengths_of_a_block(),
        }
    }

    /// Writes it to the folder of the study: as `convergence.json`, and as a text that a person reads.
    ///
    /// # Errors
    /// When the system refuses to write.
    pub fn write(&self, folder: &StudyFolder, text: &str) -> Result<(), StudyError> {
        let [numbers, words] = CONVERGENCE;
        folder.write(numbers, |file| Ok(serde_json::to_writer_pretty(file, self)?))?;
        folder.write(words, |file| file.write_all(text.as_bytes()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::summary_values::known;

    /// Sequences of a known order and limit.
    #[test]
    fn the_error_bounds_the_distance_to_the_limit() {
        for order in [0.5, 1.0, 1.5, 2.0, 3.0] {
            let values: Vec<f64> = (0..4).map(|k| 20.0 + libm::exp2(-order * f64::from(k))).collect();
            let Verdict::Converges {
                order: found,
                mesh_error,
            } = Verdict::on(&values)
            else {
                panic!("order {order}");
            };
            // Rounding of values near 20 over differences of 1/512 at least.
            assert!((found - f64::min(order, 2.0)).abs() < 1e-11, "{order} {found}");
            assert!(
                mesh_error >= (values[3] - 20.0) * (1.0 - 1e-11),
                "{order} {mesh_error}"
            );
        }
        // A small last difference is not trusted: the next mesh of this sequence gave 16.774.
        let lucky = Verdict::on(&[15.5136, 16.7511, 16.7599]);
        let Verdict::Converges { mesh_error, .. } = lucky else {
            panic!("{lucky:?}");
        };
        assert!((mesh_error - 1.2375 / 12.0).abs() < 1e-12);
        assert_eq!(Verdict::on(&[1.0, 2.0, 3.0]), Verdict::Open { spread: 2.0 });
        assert_eq!(Verdict::on(&[9.0, 1.0, 1.0, 1.0]), Verdict::Equal);
        // A slower fall than that of the square root of the mesh is taken for it.
        let slow = Verdict::on(&[0.0, 1.0, 1.9]);
        let Verdict::Converges { order, mesh_error } = slow else {
            panic!("{slow:?}");
        };
        assert_eq!(order, 0.5);
        assert!((mesh_error - 0.9 / (2.0_f64.sqrt() - 1.0)).abs() < 1e-12);
    }

    #[test]
    fn quantities_are_those_of_summaries() {
        for quantity in QUANTITIES {
            assert!(known().iter().any(|name| name == quantity), "{quantity}");
        }
    }
}
