//! The fields of a run, `fields.nc`.

use slipfront::communicator::Alone;
use slipfront::observe::Field;
use slipfront_run::fields::{
    FieldFrame, FieldsData, choose_snapshots, read_fields, read_maps, thin, write_fields,
};

use crate::checks::readable;
use crate::long::LONG_BYTES;
use crate::scratch;
use crate::target::{Memory, Target, Time};

/// Reads the whole file, then the maps of single fields.
pub(crate) const FIELDS: Target = Target {
    name: "fields",
    check: fields,
    generated: || {
        vec![
            file([4, 3], 1, 2, 1e-6),
            file([5, 4], 2, 1, 5e-324),
            file([3, 2], 1, 0, 1e8),
        ]
    },
    // Of 64-bit data, which no lattice this small is written with.
    files: &["tests/fields/netcdf-c-64-bit-data.nc"],
    dictionary: Some("netcdf.dict"),
    max_bytes: 8192,
    // A value of one byte becomes one of eight, and all frames are read.
    memory: Memory {
        bytes: 1 << 20,
        per_byte: 128,
    },
    time: Time::READING,
    mutations: 2000,
    repetitions: 15,
    long: || {
        let mut files = long_headers();
        // Many instants of one block.
        files.push(file([1, 1], 1, 4000, 1e-6));
        files
    },
};

/// The bytes of a file for a small lattice.
pub(crate) fn file([nx, ny]: [usize; 2], stride: usize, frames: usize, block_size: f64) -> Vec<u8> {
    let blocks = nx * ny;
    let names = [Field::ContactStress, Field::Sliding];
    let number = |block: usize| 0.1 * block as f64;
    let frames: Vec<FieldFrame> = (0..frames)
        .map(|k| {
            let field = |value: f32| thin(&vec![value; blocks], nx, stride).collect();
            FieldFrame {
                time_star: 16.0 * (k + 1) as f64,
                label: ["A", "BC"][k % 2].to_owned(),
                step: 160 * (k as u64 + 1),
                values: vec![field(0.5 * k as f32), field(f32::NAN)],
            }
        })
        .collect();
    let textured: Vec<bool> = (0..blocks).map(|block| block % 5 == 0).collect();
    let values: Vec<f64> = (0..blocks).map(number).collect();
    let thinned: Vec<f64> = thin(&values, nx, stride).collect();
    let data = FieldsData {
        nx,
        ny,
        stride,
        first_row: 0,
        block_size,
        time_unit_s: 3e-10,
        names: names.to_vec(),
        textured: thin(&textured, nx, stride).collect(),
        mu_static: thinned.clone(),
        mu_kinetic: thinned.clone(),
        first_slip_time_star: thinned,
        frames,
    };
    let path = scratch::file("made.nc", b"");
    write_fields(path.parent().unwrap(), &path, &data, &Alone)
        .unwrap()
        .unwrap()
        .persist(&path)
        .unwrap();
    std::fs::read(path).unwrap()
}

/// Headers of NetCDF with many dimensions, attributes and variables, and with a variable of many of either.
pub(crate) fn long_headers() -> Vec<Vec<u8>> {
    /// Tags of lists.
    const DIMENSIONS: u32 = 10;
    const VARIABLES: u32 = 11;
    const ATTRIBUTES: u32 = 12;
    let number = |number: u32| number.to_be_bytes().to_vec();
    let list = |tag: u32, elements: &[Vec<u8>]| {
        [number(tag), number(elements.len() as u32), elements.concat()].concat()
    };
    let name = |name: String| {
        let mut bytes = [number(name.len() as u32), name.into_bytes()].concat();
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        bytes
    };
    let many = |element: &dyn Fn(usize) -> Vec<u8>| -> Vec<Vec<u8>> {
        (0..LONG_BYTES / element(LONG_BYTES).len()).map(element).collect()
    };
    let dimension = |k: usize| [name(format!("d{k}")), number(1)].concat();
    // Of one byte.
    let attribute = |k: usize| [name(format!("a{k}")), number(1), number(1), vec![0; 4]].concat();
    // The dimensions, and a list of attributes; then a type, a size and a place.
    let variable = |k: usize, dimensions: &[Vec<u8>], attributes: &[Vec<u8>]| {
        let dimensions = [number(dimensions.len() as u32), dimensions.concat()].concat();
        let rest = [number(1), number(4), vec![0; 8]].concat();
        [
            name(format!("v{k}")),
            dimensions,
            list(ATTRIBUTES, attributes),
            rest,
        ]
        .concat()
    };
    let (dimensions, attributes) = (many(&dimension), many(&attribute));
    let first = vec![number(0); dimensions.len()];
    let file = |dimensions: &[Vec<u8>], attributes: &[Vec<u8>], variables: &[Vec<u8>]| {
        [
            b"CDF\x02\0\0\0\0".to_vec(),
            list(DIMENSIONS, dimensions),
            list(ATTRIBUTES, attributes),
            list(VARIABLES, variables),
        ]
        .concat()
    };
    vec![
        file(&dimensions, &[], &[]),
        file(&[], &attributes, &[]),
        file(&dimensions[..1], &[], &many(&|k| variable(k, &first[..1], &[]))),
        file(&dimensions, &[], &[variable(0, &first, &attributes)]),
        // Each over all dimensions.
        file(
            &dimensions[..500],
            &[],
            &vec![variable(0, &first[..500], &[]); 140],
        ),
    ]
}

fn fields(input: &[u8]) {
    let path = scratch::file("run/fields.nc", input);
    match read_fields(&path) {
        Err(error) => readable(&error),
        Ok(data) => {
            expect_consistent(&data);
            let blocks = data.columns() * data.rows();
            for values in [&data.mu_static, &data.mu_kinetic, &data.first_slip_time_star] {
                assert_eq!(values.len(), blocks);
            }
            expect_round_trip(&data);
        }
    }
    for name in [Field::ContactStress, Field::VelocityX] {
        match read_maps::<Vec<f32>>(&path, name, |labels| choose_snapshots(labels, 6)) {
            Err(error) => readable(&error),
            Ok(maps) => {
                assert!(maps.frames.len() <= 6 && maps.names.iter().all(|found| *found == name));
                expect_consistent(&maps);
            }
        }
    }
}

/// Demands that every array has a value for every block that was kept, and that no field occurs twice.
fn expect_consistent(data: &FieldsData) {
    let blocks = data.columns() * data.rows();
    assert_eq!(data.textured.len(), blocks);
    let mut names = data.names.clone();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), data.names.len(), "a field twice");
    for frame in &data.frames {
        assert_eq!(frame.values.len(), data.names.len());
        assert!(frame.values.iter().all(|values| values.len() == blocks));
    }
}

/// Demands that the fields are equal when written and read again.
fn expect_round_trip(data: &FieldsData) {
    let path = scratch::file("again.nc", b"");
    write_fields(path.parent().unwrap(), &path, data, &Alone)
        .unwrap()
        .unwrap()
        .persist(&path)
        .unwrap();
    let again = read_fields(&path).unwrap();
    assert_eq!(format!("{again:?}"), format!("{data:?}"));
}
