//! Positions of the numbers of blocks in a checkpoint.

use serde::{Deserialize, Serialize};

/// Arrays of the same shape, one after the other, each with the numbers of all rows of the lattice. Processes
/// that hold some rows can compute the positions of their own numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Columns {
    /// Number of arrays.
    pub count: u64,
    /// Rows of each array.
    pub rows: u64,
    /// Numbers of a row.
    pub row_length: u64,
    /// Bytes of a number.
    pub number_bytes: u64,
}

impl Columns {
    /// Bytes of all arrays; none if there are more than can be counted.
    pub fn bytes(&self) -> Option<u64> {
        let numbers = self.count.checked_mul(self.rows)?.checked_mul(self.row_length)?;
        numbers.checked_mul(self.number_bytes)
    }

    /// Byte offset of a number in the array `column`: the number with index `number` from the beginning of
    /// row `row`.
    pub(crate) fn offset(&self, column: usize, row: usize, number: usize) -> u64 {
        let [column, row, number] = [column, row, number].map(|index| index as u64);
        ((column * self.rows + row) * self.row_length + number) * self.number_bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rows_of_all_ranks_take_every_byte_once() {
        let columns = Columns {
            count: 3,
            rows: 5,
            row_length: 4,
            number_bytes: 8,
        };
        let mut end = 0;
        for column in 0..3 {
            for rows in [0..2, 2..2, 2..5] {
                assert_eq!(columns.offset(column, rows.start, 0), end);
                end += rows.len() as u64 * 4 * 8;
                assert_eq!(columns.offset(column, rows.start, rows.len() * 4), end);
            }
        }
        assert_eq!(columns.bytes(), Some(end));
        let many = Columns {
            count: 1 << 40,
            rows: 1 << 40,
            ..columns
        };
        assert_eq!(many.bytes(), None);
    }
}
