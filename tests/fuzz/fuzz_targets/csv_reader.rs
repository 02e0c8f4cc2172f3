//! No bytes make the reader of tables panic, and all columns it returns are equally long.
#![no_main]

use gapilib::mat;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(table) = mat::read_csv(bytes) {
        let mut lengths = table.arrays.values().map(|column| column.rows);
        let first = lengths.next();
        assert!(lengths.all(|length| Some(length) == first));
    }
});
