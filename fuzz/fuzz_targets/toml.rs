//! A text as the sea of `--from`, and as a scenario: read or refused in words.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &[u8]| {
    if let Ok(sea) = prob_water_cli::read_sea(text.to_vec()) {
        // What is shown reads back to the same sea.
        let again =
            prob_water_cli::read_sea(sea.to_string().into_bytes()).expect("a sea shows itself as a file");
        assert_eq!(again.to_string(), sea.to_string());
    }
    let _ = prob_water_cli::check_scenario(text.to_vec());
});
