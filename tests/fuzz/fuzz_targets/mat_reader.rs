//! No bytes make the reader of MAT files panic or take memory that they do not pay for. Seeds:
//! `tests/data/mat`.
#![no_main]

use gapilib::mat;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(file) = mat::read(bytes) {
        for matrix in file.arrays.values() {
            assert_eq!(matrix.values.len(), matrix.rows * matrix.columns);
            matrix.text_rows();
        }
    }
});
