//! Comparison of several meshes of one slider: the values on each, and the verdict on them.

use std::path::Path;

use serde::Serialize;
use slipfront_case::case_file::CaseError;

use crate::axis::Axis;
use crate::error::StudyError;
use crate::plan::Plan;
use crate::statistics::Sample;
use crate::study_results::StudyResults;
use crate::summary_values::REDUCTION;

/// Quantities that are compared.
const QUANTITIES: [&str; 4] = [
    REDUCTION,
    "static_friction_star",
    "kinetic_friction_star",
    FRONT_SPEED,
];

/// Smallest number of meshes: differences of two meshes show no order.
pub const MIN_LEVELS: u8 = 3;

/// The mean speed of the front, m/s.
const FRONT_SPEED: &str = "front_speed_m_s";

/// The keys in which meshes differ.
const KEYS_OF_MESHES: [&str; 2] = ["slider.block_size", "slider.blocks"];

/// Whether the only axis of a study is the size of the blocks, on enough meshes.
pub(crate) fn is_over_meshes(axes: &[Axis]) -> bool {
    let [axis] = axes else { return false };
    let has_column = |key: &&str| axis.columns.iter().any(|column| column == key);
    KEYS_OF_MESHES.iter().all(has_column) && axis.levels.len() >= usize::from(MIN_LEVELS)
}

/// A mesh, with the textured area on it.
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
    /// Name of the quantity in summaries.
    pub quantity: String,
    /// Mean over the seeds on each mesh, the coarsest first.
    pub means: Vec<f64>,
    /// Half width of the interval of each mean, due to the scatter over surfaces; none for one seed.
    pub half_widths: Vec<Option<f64>>,
    /// Verdict on the means.
    pub verdict: MeshVerdict,
}

/// Verdict on the differences between meshes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum MeshVerdict {
    /// Differences decrease.
    Converges {
        /// Order of convergence, 1/2 to 2.
        order: f64,
        /// Remaining error on the finest mesh.
        mesh_error: f64,
    },
    /// All meshes give the same value.
    Equal,
    /// Differences do not decrease; the values on the meshes differ by up to `spread`.
    Open {
        /// Difference of the largest and smallest value on the last three meshes.
        spread: f64,
    },
}

impl MeshVerdict {
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
        // The order is limited to 2.
        let richardson = last.max(0.25 * before) / (libm::exp2(order) - 1.0);
        Self::Converges {
            order,
            mesh_error: last.max(richardson),
        }
    }
}

/// The meshes of a study over the size of the blocks.
pub(super) fn meshes(plan: &Plan) -> Vec<Mesh> {
    let [size, _] = KEYS_OF_MESHES;
    let points = plan.points.iter().enumerate();
    let mesh = |(position, point)| {
        let columns = plan.columns(point);
        let size = columns.iter().find(|(key, _)| *key == size);
        Mesh {
            block_size: size.map_or_else(String::new, |(_, size)| (*size).to_owned()),
            coverage_percent: plan.texture_percent(position),
        }
    };
    points.map(mesh).collect()
}

/// Comparisons of every quantity that has a value on all meshes.
fn convergences(plan: &Plan, results: &StudyResults) -> Vec<Convergence> {
    let of = |name: &&str| {
        let samples = (0..plan.points.len()).map(|position| results.sample(plan, position, name));
        let samples: Vec<Sample> = samples.collect::<Option<_>>()?;
        let means: Vec<f64> = samples.iter().map(|sample| sample.mean).collect();
        let verdict = MeshVerdict::on(&means);
        Some(Convergence {
            quantity: (*name).to_owned(),
            means,
            half_widths: samples.iter().map(|sample| sample.half_width).collect(),
            verdict,
        })
    };
    QUANTITIES.iter().filter_map(of).collect()
}

impl Convergence {
    /// The mean on the finest mesh and its total error, from the mesh and from the scatter over surfaces;
    /// none if no limit is given.
    pub(crate) fn result(&self) -> Option<[f64; 2]> {
        let (mean, half) = (*self.means.last()?, self.half_widths.last()?.unwrap_or(0.0));
        match self.verdict {
            MeshVerdict::Converges { mesh_error, .. } => Some([mean, mesh_error + half]),
            MeshVerdict::Open { spread } if spread <= half => Some([mean, spread + half]),
            MeshVerdict::Equal | MeshVerdict::Open { .. } => None,
        }
    }
}

/// Comparison of several meshes of one slider.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OnMeshes {
    /// The meshes, the coarsest first.
    pub meshes: Vec<Mesh>,
    /// The quantities that have a value on all meshes.
    pub quantities: Vec<Convergence>,
    /// Lengths of the material that equal the length of a block. With any of them, every mesh is a different
    /// material, and a limit would not belong to this slider.
    pub lengths_of_a_block: Vec<String>,
}

impl OnMeshes {
    /// The comparison from the runs of a study over meshes.
    ///
    /// # Errors
    /// When the case is no longer valid.
    pub(crate) fn new(plan: &Plan, results: &StudyResults) -> Result<Self, CaseError> {
        let of_a_block = plan.first_case_file()?.lengths_of_a_block();
        Ok(Self {
            meshes: meshes(plan),
            quantities: convergences(plan, results),
            lengths_of_a_block: of_a_block.iter().map(ToString::to_string).collect(),
        })
    }

    /// The value of a quantity on the finest mesh and its error; none if no limit is given.
    pub(crate) fn result_of(&self, quantity: &str) -> Option<[f64; 2]> {
        let found = self.quantities.iter().find(|found| found.quantity == quantity);
        found.filter(|_| self.lengths_of_a_block.is_empty())?.result()
    }

    /// Refuses a comparison in the folder of a study if no quantity has a value on every mesh.
    ///
    /// # Errors
    /// A sentence with the name of the table of runs.
    pub fn expect_values(&self, folder: &Path) -> Result<(), StudyError> {
        if self.quantities.is_empty() {
            let path = folder.join("runs.csv");
            return Err(StudyError::NotOnMeshes { path });
        }
        Ok(())
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
            let MeshVerdict::Converges {
                order: found,
                mesh_error,
            } = MeshVerdict::on(&values)
            else {
                panic!("order {order}");
            };
            // The bound allows for rounding of values near 20, over differences of at least 1/512.
            assert!((found - f64::min(order, 2.0)).abs() < 1e-11, "{order} {found}");
            assert!(
                mesh_error >= (values[3] - 20.0) * (1.0 - 1e-11),
                "{order} {mesh_error}"
            );
        }
        // A small last difference is not trusted: the next mesh of this sequence gave 16.774.
        let lucky = MeshVerdict::on(&[15.5136, 16.7511, 16.7599]);
        let MeshVerdict::Converges { mesh_error, .. } = lucky else {
            panic!("{lucky:?}");
        };
        assert!((mesh_error - 1.2375 / 12.0).abs() < 1e-12);
        assert_eq!(
            MeshVerdict::on(&[1.0, 2.0, 3.0]),
            MeshVerdict::Open { spread: 2.0 }
        );
        assert_eq!(MeshVerdict::on(&[9.0, 1.0, 1.0, 1.0]), MeshVerdict::Equal);
        // Convergence of an order below 1/2 is treated as order 1/2.
        let slow = MeshVerdict::on(&[0.0, 1.0, 1.9]);
        let MeshVerdict::Converges { order, mesh_error } = slow else {
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
