//! A front: the best value of a wish for several coverages.

use serde::Serialize;
use slipfront_base::number_format::four_digits;
use slipfront_base::text::{COLUMNS, note};
use slipfront_plot::{Response, Responses};

use crate::design::{Design, Outcome};
use crate::report::Report;
use slipfront_study::StudyError;
use slipfront_study::text_table::table;

/// Table and pictures of a front.
const FRONT: &str = "front";

/// A row of `front.csv`.
#[derive(Serialize)]
struct Row<'a> {
    coverage_limit_percent: f64,
    coverage_percent: f64,
    loss: f64,
    loss_half_width: Option<f64>,
    static_friction_star: f64,
    static_friction_star_half_width: Option<f64>,
    design: &'a str,
}

impl Report<'_> {
    /// Writes a front as a table and a picture, and returns it as a text; of a coverage that no texture keeps
    /// there is no design.
    ///
    /// # Errors
    /// When the system refuses to write, or the picture cannot be drawn.
    pub(crate) fn write_front(
        &mut self,
        front: &[(f64, Option<(Design, Outcome)>)],
    ) -> Result<String, StudyError> {
        let designs: Vec<_> = front
            .iter()
            .filter_map(|(limit, found)| Some((limit, found.as_ref()?)))
            .collect();
        let Some((_, (first, outcome))) = designs.first() else {
            return Ok(if front.is_empty() {
                String::new()
            } else {
                note(
                    "no texture keeps the limits at any coverage of `design.front`",
                    COLUMNS,
                )
            });
        };
        let wish = first.evaluator.wish();
        let surfaces = outcome.verdict.surfaces;
        self.batch.write(&format!("{FRONT}.csv"), |to| {
            let mut table = csv::Writer::from_writer(to);
            for (limit, (_, Outcome { verdict, .. })) in &designs {
                let friction = verdict.design.cases[0].static_friction_star;
                table
                    .serialize(Row {
                        coverage_limit_percent: **limit,
                        coverage_percent: verdict.design.coverage_percent,
                        loss: verdict.design.loss,
                        loss_half_width: verdict.design.loss_half_width,
                        static_friction_star: friction.mean,
                        static_friction_star_half_width: friction.half_width,
                        design: &verdict.design.name,
                    })
                    .map_err(std::io::Error::from)?;
            }
            table.flush()
        })?;
        let mut curve = Response::default();
        let mut rows = Vec::new();
        for (limit, found) in front {
            let Some((_, Outcome { verdict, .. })) = found else {
                let none = ["-", "-", "no texture keeps the limits"].map(str::to_owned);
                rows.push([vec![format!("{} %", four_digits(*limit))], none.to_vec()].concat());
                continue;
            };
            let design = &verdict.design;
            let half = design.loss_half_width.unwrap_or(f64::NAN);
            let ends = [design.loss - half, design.loss + half].map(|loss| wish.told(loss));
            curve.x.push(design.coverage_percent);
            curve.mean.push(wish.told(design.loss));
            curve.low.push(ends[0].min(ends[1]));
            curve.high.push(ends[0].max(ends[1]));
            rows.push(vec![
                format!("{} %", four_digits(*limit)),
                format!("{} %", four_digits(design.coverage_percent)),
                format!("{}{}", four_digits(wish.told(design.loss)), wish.loss_unit()),
                design.name.clone(),
            ]);
        }
        let picture = slipfront_plot::response(&Responses {
            x_title: "textured area (%)".to_owned(),
            y_title: format!(
                "{}{}",
                wish.loss_name(),
                if wish.loss_unit().is_empty() { "" } else { " (%)" }
            ),
            note: format!("95 % of {surfaces} fresh surfaces"),
            curves: vec![curve],
            ..Responses::default()
        });
        self.batch
            .write_picture(FRONT, &picture.map_err(StudyError::picture(FRONT))?)?;
        Ok(format!(
            "\nWith less texture:\n{}",
            table(&["at most", "covers", wish.loss_name(), "texture"], &rows)
        ))
    }
}
