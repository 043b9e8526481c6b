//! Meshed coverages for the levels of a coverage axis: blocks give the requested coverages only
//! approximately, and pictures show the meshed ones.

use std::collections::HashMap;

use slipfront_base::number_format::count;

use crate::axis::Spacing;
use crate::plan::Plan;

/// Meshed coverage at every point of a study with a numeric axis over the coverage of its only texture. For
/// several textures, the coverage of each is not known.
pub struct MeshedCoverage {
    /// Position of the axis.
    pub axis: usize,
    /// Percent that the shapes of the texture cover, by the levels of a point.
    percent: HashMap<Vec<usize>, f64>,
}

impl MeshedCoverage {
    /// Meshed coverages at the points of a study; none if it has no such axis.
    pub fn from_plan(plan: &Plan) -> Option<Self> {
        let is_coverage = |key: &str| {
            let texture = key.strip_prefix("texture.");
            let index = texture.and_then(|rest| rest.strip_suffix(".coverage"));
            index.is_some_and(|index| index.parse::<usize>().is_ok())
        };
        let mut axes = plan.axes.iter();
        let axis = axes.position(|axis| axis.spacing != Spacing::Named && is_coverage(axis.title()))?;
        let points = plan.points.iter().enumerate();
        let percent =
            points.map(|(position, point)| Some((plan.levels(point), plan.meshed_coverage(position)?)));
        Some(Self {
            axis,
            percent: percent.collect::<Option<_>>()?,
        })
    }

    /// Percent that the shapes of the texture cover at the point with these levels; none if it belongs to
    /// another part of the study.
    pub fn at(&self, levels: &[usize]) -> Option<f64> {
        self.percent.get(levels).copied()
    }

    /// A sentence if several levels are meshed to the same coverage, so pictures show them at one place.
    pub fn merged(&self, plan: &Plan) -> Option<String> {
        let axis = &plan.axes[self.axis];
        let mut first: HashMap<(Vec<usize>, u64), usize> = HashMap::new();
        let mut merged = Vec::new();
        for point in &plan.points {
            let mut others = plan.levels(point);
            let Some(percent) = self.at(&others) else { continue };
            let level = others.remove(self.axis);
            let earlier = *first.entry((others, percent.to_bits())).or_insert(level);
            if earlier != level {
                merged.push([earlier, level]);
            }
        }
        merged.sort_unstable();
        merged.dedup();
        let [one, other] = merged.first()?.map(|level| axis.levels[level].labels.join(" "));
        let more = match merged.len() {
            1 => String::new(),
            all => format!(", as are {}", count(all - 1, "more pair")),
        };
        Some(format!(
            "`{}` = {one} and {other} have the same coverage on this mesh{more}: use more blocks to distinguish them",
            axis.title()
        ))
    }
}
