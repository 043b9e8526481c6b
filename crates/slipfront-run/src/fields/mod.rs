//! `fields.nc`: what happens block by block, at a few instants of a run.
//!
//! The file is NetCDF-3 with 64-bit offsets and CF-1.8 attributes, so that xarray, ParaView, Octave and MATLAB
//! open it as it is. Fields have the dimensions (time, y, x), what never changes has (y, x); row j = 0 is the
//! smallest y. The file carries no date: equal input gives equal bytes. [`write_fields`] ends a run,
//! [`read_maps`] serves the pictures, [`read_fields`] whoever wants it all.

mod frame;
mod netcdf3_reader;
mod read;
mod write;

pub use frame::{FieldFrame, FieldsData, FieldsError, FieldsFile, StaticFields, thin};
pub use read::{count_maps, read_fields, read_maps};
pub use write::write_fields;

#[cfg(test)]
mod tests;
