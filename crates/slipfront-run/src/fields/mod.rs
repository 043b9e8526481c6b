//! The file `fields.nc`: fields of all blocks at a few instants of a run.
//!
//! The file is NetCDF-3 with 64-bit offsets (CDF-2), or where an array takes more than 2 GiB with 64-bit data
//! (CDF-5), and has CF-1.8 attributes, so that xarray, ParaView, Octave and MATLAB can open it. Fields have
//! the dimensions (time, y, x), and constant arrays have (y, x); row j = 0 is the smallest y. The file
//! contains no date: equal input gives equal bytes. [`write_fields`] writes the file of a run on ranks,
//! [`FieldsWriter`] writes that of any processes that share a lattice, [`read_maps`] and [`read_first_slips`]
//! serve the pictures, [`read_fields`] and [`read_rows`] read the whole content. `kymograph.nc` is a file of
//! the same format ([`kymograph_bytes`], [`read_kymograph`]).

mod definition;
mod frame;
mod kymograph;
mod netcdf3;
mod netcdf3_header;
mod netcdf3_reader;
mod read;
mod write;

pub use frame::{FieldFrame, FieldsData, FieldsError, thin};
pub use kymograph::{KymographData, kymograph_bytes, read_kymograph};
pub use read::{
    Reduction, choose_snapshots, count_snapshots, read_fields, read_first_slips, read_maps, read_rows,
};
pub use write::{FieldsWriter, write_fields};

#[cfg(test)]
mod tests;
