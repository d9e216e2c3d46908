#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| sdfc_bytes::imports(bytes));
