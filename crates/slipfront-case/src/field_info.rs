//! Names and units of the fields that a run records.

use slipfront::observe::Field;

/// Names of a field in case files, result files and pictures.
#[derive(Debug)]
pub struct FieldInfo {
    /// The field.
    pub field: Field,
    /// Name of the field in `output.fields` of a case file and in `fields.nc`.
    pub name: &'static str,
    /// Unit of the field's values in `fields.nc` in the form of the CF conventions; `1` for a number without
    /// a unit.
    pub unit: &'static str,
    /// A description for the axis of a picture.
    pub long_name: &'static str,
}

/// Every field, in the order of the documentation.
#[rustfmt::skip]
pub const FIELDS: [FieldInfo; 7] = [
    // Divided by its maximum over the run.
    info(Field::ContactStress, "contact_stress_star", "1", "contact stress over its maximum"),
    // NaN over a texture.
    info(Field::Traction, "traction", "Pa", "friction force over block area"),
    info(Field::DisplacementX, "displacement_x", "m", "displacement along x from rest"),
    info(Field::DisplacementY, "displacement_y", "m", "displacement along y from rest"),
    info(Field::VelocityX, "velocity_x", "m s-1", "velocity along x"),
    info(Field::VelocityY, "velocity_y", "m s-1", "velocity along y"),
    info(Field::Sliding, "sliding", "1", "state of the block"),
];

const fn info(field: Field, name: &'static str, unit: &'static str, long_name: &'static str) -> FieldInfo {
    FieldInfo {
        field,
        name,
        unit,
        long_name,
    }
}

/// The names and unit of a field.
pub fn field_info(field: Field) -> &'static FieldInfo {
    // The table has the order of the variants, which a test checks.
    &FIELDS[field as usize]
}

/// The field with this name, if there is one.
pub fn field_named(name: &str) -> Option<Field> {
    FIELDS
        .iter()
        .find(|info| info.name == name)
        .map(|info| info.field)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_has_its_row_and_the_name_of_the_case_file() {
        for info in &FIELDS {
            assert_eq!(field_info(info.field).name, info.name);
            let read: Field = serde_json::from_value(info.name.into()).unwrap();
            assert_eq!(read, info.field);
        }
    }
}
