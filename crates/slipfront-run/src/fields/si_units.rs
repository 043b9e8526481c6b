//! Fields of a running case in SI units, as they stand in `fields.nc`.

use slipfront::Scales;
use slipfront::observe::Field;
use slipfront::observe::Frame;

use super::frame::FieldFrame;

/// A dimensionless frame of these fields in the units of [`FieldInfo::unit`](slipfront_case::field_info::FieldInfo::unit). The contact stress becomes tau_c*: it is
/// divided by `contact_stress_max`, its largest value so far
/// (see [`Simulation::contact_stress_max`](slipfront::Simulation::contact_stress_max)).
pub fn in_si_units(
    frame: Frame,
    label: String,
    names: &[Field],
    scales: &Scales,
    contact_stress_max: f64,
) -> FieldFrame {
    let mut values = frame.values;
    for (field, values) in names.iter().zip(&mut values) {
        let unit = match field {
            // A run in which no block was ever loaded has no largest stress to divide by.
            Field::ContactStress if contact_stress_max > 0.0 => 1.0 / contact_stress_max,
            Field::ContactStress | Field::Sliding => 1.0,
            Field::Traction => scales.stress(),
            Field::DisplacementX | Field::DisplacementY => scales.displacement(),
            Field::VelocityX | Field::VelocityY => scales.speed(),
        };
        for value in values {
            *value = (f64::from(*value) * unit) as f32;
        }
    }
    FieldFrame {
        time_star: frame.time_star,
        label,
        step: frame.step,
        values,
    }
}
