//! Rows of any bytes: written with their f, or refused in one line, and never anything else.

use super::run;
use proptest::prelude::*;

/// Pieces that rows are made of, and any bytes.
fn piece() -> impl Strategy<Value = Vec<u8>> {
    let known = [
        "ix,iy,iz,ox,oy,oz",
        "nx,ny,nz",
        "\n",
        "\r\n",
        ",",
        "\"",
        "0",
        "1",
        "-0",
        "0.6",
        "0.8",
        "NaN",
        "inf",
        "1e400",
        " ",
        "0,0,1",
        "0,0,1,0,0,1",
        "0.6,0,0.8,-0.6,0,0.8",
        "0,0,1,0,0,1,0,0,1",
        "\u{feff}",
        "\0",
    ];
    prop_oneof![
        6 => prop::sample::select(known.to_vec()).prop_map(|text| text.as_bytes().to_vec()),
        1 => prop::collection::vec(any::<u8>(), 0..20),
    ]
}

/// A header more often than not, then anything.
fn rows() -> impl Strategy<Value = Vec<u8>> {
    let header = prop::sample::select(vec![
        "",
        "ix,iy,iz,ox,oy,oz\n",
        "ix,iy,iz,ox,oy,oz\n",
        "nx,ny,nz,ix,iy,iz,ox,oy,oz\n",
    ]);
    (header, prop::collection::vec(piece(), 0..12))
        .prop_map(|(header, pieces)| [header.as_bytes().to_vec(), pieces.concat()].concat())
}

proptest! {
    // Each case starts a process.
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(150) })]

    #[test]
    fn are_rows_or_refused_in_one_line(rows in rows(), json in any::<bool>()) {
        let output = run(if json { "brdf --json" } else { "brdf" }, &rows);
        let message = String::from_utf8(output.stderr).unwrap();
        match output.status.code() {
            Some(0) => prop_assert!(message.is_empty(), "{}", message),
            Some(2) => {
                prop_assert!(output.stdout.is_empty());
                prop_assert!(message.starts_with("prob-water: ") && message.lines().count() == 1, "{}", message);
            }
            other => prop_assert!(false, "{:?}: {}", other, message),
        }
    }
}
