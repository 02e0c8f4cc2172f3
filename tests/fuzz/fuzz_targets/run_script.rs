//! No script makes a session in a world in memory panic or hang.
#![no_main]

use gapilib::script::Session;
use gapilib::script::world::MemoryWorld;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let world = MemoryWorld::new().interrupted_after(3000);
    Session::new(Box::new(world)).run_text("fuzz.mos", text);
});
