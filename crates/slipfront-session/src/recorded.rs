//! A recorded run: its curve and its snapshots.

use slipfront::observe::Field;
use slipfront_run::fields::FieldsData;

use crate::picture::{DisplayedField, SLIDING_NOW, lengths};

/// A recorded run.
pub struct RecordedRun {
    /// t* of the drive at the points of the recorded curve.
    pub time_star: Vec<f64>,
    /// mu* at the points of the recorded curve.
    pub mu_star: Vec<f64>,
    /// The snapshots of the run; none if they are too large, or contain fewer blocks than the lattice.
    pub snapshots: Option<FieldsData>,
    /// Largest contact stress, Pa, by which the recorded stress is divided; NaN if unknown.
    pub contact_stress_max_pa: f32,
}

impl RecordedRun {
    /// Values of a recorded field in its unit on the page; none if it was not recorded.
    pub(crate) fn values(&self, index: usize, shown: DisplayedField) -> Option<Vec<f32>> {
        let of = self.snapshots.as_ref()?;
        let frame = of.frames.get(index)?;
        let recorded = |field: Field| {
            let place = of.names.iter().position(|name| *name == field)?;
            Some(frame.values[place].clone())
        };
        let length = |x: Field, y: Field| {
            let (mut x, y) = (recorded(x)?, recorded(y)?);
            lengths(&mut x, &y);
            Some(x)
        };
        match shown {
            // The stress is recorded relative to its largest value.
            DisplayedField::ContactStress => {
                let mut stress = recorded(Field::ContactStress)?;
                stress
                    .iter_mut()
                    .for_each(|star| *star *= self.contact_stress_max_pa);
                Some(stress)
            }
            DisplayedField::Traction => recorded(Field::Traction),
            DisplayedField::Sliding => recorded(Field::Sliding),
            DisplayedField::Displacement => length(Field::DisplacementX, Field::DisplacementY),
            DisplayedField::Speed => length(Field::VelocityX, Field::VelocityY),
            DisplayedField::FirstSlip => {
                Some(of.first_slip_time_star.iter().map(|time| *time as f32).collect())
            }
            DisplayedField::Front => {
                let sliding = recorded(Field::Sliding).unwrap_or_default();
                let slides = sliding
                    .iter()
                    .map(|slides| *slides > 0.0)
                    .chain(std::iter::repeat(false));
                let times = of.first_slip_time_star.iter().zip(slides);
                let value = |(time, slides): (&f64, bool)| match slides {
                    true => SLIDING_NOW,
                    // Slips after this instant are not known yet.
                    false if *time > frame.time_star => f32::NAN,
                    false => *time as f32,
                };
                Some(times.map(value).collect())
            }
        }
    }
}
