//! Any bytes as the input of `entry::scenario`.

#![no_main]

#[allow(dead_code)] // every target uses its own part
mod entry;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    entry::scenario(bytes);
});
