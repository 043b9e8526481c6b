//! Fields of a running case in SI units, as they stand in `fields.nc`.

use slipfront::Scales;
use slipfront::observe::Frame;
use slipfront_case::field_name::FieldName;

use super::frame::FieldFrame;

/// A dimensionless frame of these fields in the units of [`FieldName::unit`]. The contact stress becomes tau_c*: it is
/// divided by `contact_stress_max`, its largest value so far
/// (see [`Simulation::contact_stress_max`](slipfront::Simulation::contact_stress_max)).
pub fn in_si_units(
    frame: Frame,
    label: String,
    names: &[FieldName],
    scales: &Scales,
    contact_stress_max: f64,
) -> FieldFrame {
    let mut values = frame.values;
    for (name, values) in names.iter().zip(&mut values) {
        let unit = match name {
            // A run in which no block was ever loaded has no largest stress to divide by.
            FieldName::ContactStressStar if contact_stress_max > 0.0 => 1.0 / contact_stress_max,
            FieldName::ContactStressStar | FieldName::Sliding => 1.0,
            FieldName::Traction => scales.stress(),
            FieldName::DisplacementX | FieldName::DisplacementY => scales.displacement(),
            FieldName::VelocityX | FieldName::VelocityY => scales.speed(),
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
