//! Columns of a table, and the choice of those that form a record.

use std::path::Path;

use serde::Serialize;
use slipfront_case::table::{HEAD_BYTES, TableLayout, TableOptions};

use super::column_names::{ColumnName, is_coefficient, units_of};
use super::error::MeasuredError;
use super::measure::Measure;
use super::workbook;

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct TableColumn {
    /// Name of the column without its unit; its number from 1 if the table has no names.
    pub name: String,
    /// Unit that the table gives.
    pub unit: Option<String>,
}

impl TableColumn {
    /// Whether the unit of the column is one of this quantity.
    fn has(&self, measure: Measure) -> bool {
        self.unit.as_ref().is_some_and(|unit| {
            let is_small = measure == Measure::Force && ["n", "kn"].contains(&unit.as_str());
            is_small || measure.has_unit(unit)
        })
    }

    /// Whether the column has friction, by its unit or its name.
    fn has_friction(&self) -> bool {
        self.has(Measure::Force) || self.is_coefficient()
    }

    /// Whether the column has a friction coefficient, by its name.
    pub fn is_coefficient(&self) -> bool {
        is_coefficient(&self.name)
    }

    /// Whether the column has the force along the surface rather than the load, by its name.
    fn is_tangential(&self) -> bool {
        const WORDS: [&str; 6] = ["fric", "tang", "lateral", "shear", "reib", "fx"];
        let name = self.name.to_lowercase();
        WORDS.iter().any(|word| name.contains(word))
    }
}

/// The columns of a table of text, or of the one sheet of a workbook that has numbers; messages name its
/// path.
///
/// # Errors
/// When the bytes are not a table.
pub fn columns_of(bytes: &[u8], path: &Path) -> Result<Vec<TableColumn>, MeasuredError> {
    let head = &bytes[..bytes.len().min(HEAD_BYTES as usize)];
    if workbook::is_workbook(head) {
        let sheet = workbook::sheet(bytes, path)?;
        let mut columns = columns_of(sheet.text.as_bytes(), path)?;
        for (column, [_, has_percentages]) in columns.iter_mut().zip(&sheet.shown) {
            column.unit = column.unit.take().or(has_percentages.then(|| "%".to_owned()));
        }
        return Ok(columns);
    }
    let layout = layout_of(head, path, TableOptions::default())?;
    let names = ColumnName::all(&layout);
    let units = units_of(&layout, &names);
    let column = |place: usize| TableColumn {
        name: match names.get(place) {
            Some(name) if !name.bare.is_empty() => name.bare.to_owned(),
            _ => (place + 1).to_string(),
        },
        unit: units.get(place).cloned().flatten(),
    };
    Ok((0..layout.columns).map(column).collect())
}

/// The layout of a table that begins with `head`.
pub(super) fn layout_of(
    head: &[u8],
    path: &Path,
    options: TableOptions,
) -> Result<TableLayout, MeasuredError> {
    let layout = TableLayout::find(head, options).map_err(MeasuredError::of_table(path))?;
    layout.check_names().map_err(MeasuredError::of_table(path))?;
    Ok(layout)
}

/// The columns that form a record, judged by their units and names. The first one is the first column of
/// times, or else of displacements, or else of all. The second one is, of the other columns, that of a
/// friction coefficient, or of the friction force, or else the first.
pub fn suggested(columns: &[TableColumn]) -> Option<[usize; 2]> {
    let first = |is: &dyn Fn(&TableColumn) -> bool| columns.iter().position(is);
    let x = first(&|column| column.has(Measure::Time))
        .or_else(|| first(&|column| column.has(Measure::Displacement)))
        .unwrap_or(0);
    let others = || (0..columns.len()).filter(|place| *place != x);
    let of_others = |is: &dyn Fn(&TableColumn) -> bool| others().find(|place| is(&columns[*place]));
    let y = of_others(&TableColumn::is_coefficient)
        .or_else(|| of_others(&|column| column.has_friction() && column.is_tangential()))
        .or_else(|| of_others(&TableColumn::has_friction))
        .or_else(|| others().next())?;
    Some([x, y])
}

/// Whether abscissae in this unit are displacements.
pub fn is_displacement(unit: &str) -> bool {
    Measure::Displacement.has_unit(unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn suggestion(table: &str) -> (Vec<TableColumn>, [usize; 2]) {
        let columns = columns_of(table.as_bytes(), Path::new("record.csv")).unwrap();
        let suggested = suggested(&columns).unwrap();
        (columns, suggested)
    }

    #[test]
    fn columns_are_chosen_by_their_units_and_names() {
        for (head, expected) in [
            ("t (s),F (N)", [0, 1]),
            ("Normal force [N];Friction force [N];Time [s]", [2, 1]),
            ("Time [s]\tLoad [N]\tFx [N]\tCOF", [0, 3]),
            ("index,displacement_um,force_n", [1, 2]),
            ("1,2", [0, 1]),
            ("cycle,temperature (K),Fz (N),Fx (N),time (ms)", [4, 3]),
        ] {
            let separator = head.chars().find(|sign| ",;\t".contains(*sign)).unwrap();
            let row = vec!["1.5"; head.split(separator).count()].join(&separator.to_string());
            let (columns, found) = suggestion(&format!("{head}\n{row}\n{row}\n{row}\n"));
            assert_eq!(found, expected, "{head}: {columns:?}");
        }
    }

    #[test]
    fn columns_have_names_and_units() {
        let (columns, _) = suggestion("t/ms,mu,note\n1,0.5,2\n2,0.5,2\n");
        let shown = columns
            .iter()
            .map(|column| (column.name.as_str(), column.unit.as_deref()));
        assert_eq!(
            shown.collect::<Vec<_>>(),
            [("t", Some("ms")), ("mu", None), ("note", None)]
        );
        let (columns, _) = suggestion("1 2\n2 3\n");
        assert_eq!(columns[1].name, "2");
    }
}
