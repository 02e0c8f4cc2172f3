//! No bytes make the readers of results panic; what they return can be written. Seeds:
//! `tests/data/mat/result_*.mat`.
#![no_main]

use gapilib::results;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    for entry in results::FORMATS {
        let format = results::format(entry.name).expect("the table holds its own names");
        if let Ok(table) = format.read(bytes) {
            let _ = format.write(&table);
        }
    }
});
