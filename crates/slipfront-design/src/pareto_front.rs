//! A front: the best value of a wish for several coverages.

use slipfront_base::number_format::four_digits;
use slipfront_base::text::{COLUMNS, note};
use slipfront_plot::{Estimate, Response, Responses};

use crate::design::{Design, Outcome};
use crate::numbers::{FoundNumber, columns_of_unknowns, numbers_at, numbers_found};
use crate::report::Report;
use slipfront_study::StudyError;
use slipfront_study::text_table::table;

/// Table and pictures of a front.
const FRONT: &str = "front";

/// Columns of `front.csv` before those of the unknowns.
const COLUMNS_OF_FRONT: [&str; 7] = [
    "coverage_limit_percent",
    "coverage_percent",
    "loss",
    "loss_half_width",
    "static_friction_star",
    "static_friction_star_half_width",
    "design",
];

impl Report<'_> {
    /// Writes a front as a table and a picture, and returns it as text. A coverage that no texture satisfies
    /// has no design.
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
                    "no texture satisfies the limits at any coverage of `design.front`",
                    COLUMNS,
                )
            });
        };
        let wish = first.evaluator.wish();
        let surfaces = outcome.verdict.surfaces;
        self.batch.write(&format!("{FRONT}.csv"), |to| {
            let mut table = csv::Writer::from_writer(to);
            let header = COLUMNS_OF_FRONT.map(str::to_owned).into_iter();
            table
                .write_record(header.chain(columns_of_unknowns(first)))
                .map_err(std::io::Error::from)?;
            for (limit, (design, Outcome { verdict, shares, .. })) in &designs {
                let friction = verdict.design.cases[0].static_friction_star;
                table
                    .serialize((
                        limit,
                        verdict.design.coverage_percent,
                        verdict.design.loss,
                        verdict.design.loss_half_width,
                        friction.mean,
                        friction.half_width,
                        &verdict.design.name,
                        numbers_at(design, shares.as_deref()),
                    ))
                    .map_err(std::io::Error::from)?;
            }
            table.flush()
        })?;
        let mut curve = Response::default();
        let mut rows = Vec::new();
        for (limit, found) in front {
            let Some((searched, Outcome { verdict, shares, .. })) = found else {
                let none = ["-", "-", "no texture satisfies the limits"].map(str::to_owned);
                rows.push([vec![format!("{} %", four_digits(*limit))], none.to_vec()].concat());
                continue;
            };
            let design = &verdict.design;
            let numbers = numbers_found(searched, shares.as_deref());
            let half = design.loss_half_width.unwrap_or(f64::NAN);
            let ends = [design.loss - half, design.loss + half].map(|loss| wish.reported_loss(loss));
            let loss = Estimate::between(ends[0], wish.reported_loss(design.loss), ends[1]);
            curve.points.push((design.coverage_percent, loss));
            rows.push(vec![
                format!("{} %", four_digits(*limit)),
                format!("{} %", four_digits(design.coverage_percent)),
                format!(
                    "{}{}",
                    four_digits(wish.reported_loss(design.loss)),
                    wish.loss_unit()
                ),
                if numbers.is_empty() {
                    design.name.clone()
                } else {
                    numbers
                        .iter()
                        .map(FoundNumber::key_and_value)
                        .collect::<Vec<_>>()
                        .join(", ")
                },
            ]);
        }
        let responses = Responses {
            x_title: "textured area (%)".to_owned(),
            y_title: format!(
                "{}{}",
                wish.loss_name(),
                if wish.loss_unit().is_empty() { "" } else { " (%)" }
            ),
            note: format!("95 % of {surfaces} new surfaces"),
            curves: vec![curve],
            ..Responses::default()
        };
        self.batch
            .draw(FRONT, |size| slipfront_plot::response(&responses, size))?;
        Ok(format!(
            "\nWith less texture:\n{}",
            table(&["at most", "covers", wish.loss_name(), "texture"], &rows)
        ))
    }
}
