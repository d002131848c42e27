//! Many directions at once: float64 row by row, float32 in the processor's vectors column by column, both checked.
//!
//! `cargo run --release -p prob-water --example batch`

use prob_water::batch::{Columns, Rows};
use prob_water::{Error, Parameters};

const ROWS: usize = 100_000;

fn main() -> Result<(), Error> {
    let lobe = Parameters::default().configure()?.lobe()?;

    // Observers in the plane of incidence, from one horizon to the other.
    let zenith = |row: usize| ((row as f64 + 0.5) / ROWS as f64 - 0.5) * std::f64::consts::PI;
    let to_observer: Vec<[f64; 3]> =
        (0..ROWS).map(|row| [zenith(row).sin(), 0.0, zenith(row).cos()]).collect();
    let to_source = vec![[-0.6, 0.0, 0.8]; ROWS];
    let mut f = vec![0.0; ROWS];
    Rows::new(&to_source, &to_observer, None)?.eval(&lobe, &mut f)?;

    // The same, coordinate by coordinate.
    let column = |of: &dyn Fn(usize) -> f64| (0..ROWS).map(|row| of(row) as f32).collect::<Vec<_>>();
    let [x, y, z] = [column(&|_| -0.6), column(&|_| 0.0), column(&|_| 0.8)];
    let [ox, oz] = [column(&|row| zenith(row).sin()), column(&|row| zenith(row).cos())];
    let mut single = vec![0.0f32; ROWS];
    Columns::new([&x, &y, &z], [&ox, &y, &oz], None)?.eval(&lobe.cast(), &mut single)?;

    let brightest = (0..ROWS).max_by(|a, b| f[*a].total_cmp(&f[*b])).expect("there are rows");
    let [theta, wide, narrow] = [zenith(brightest).to_degrees(), f[brightest], single[brightest].into()];
    println!("{ROWS} rows; brightest at {theta:.2} degrees: {wide:.6} 1/sr, in float32 {narrow:.6}");

    // What is not a unit vector is refused by its row.
    let long = [[0.0, 0.0, 2.0]];
    let refused = Rows::new(&long, &long, None).map(|_| ()).expect_err("its length is 2");
    println!("refused: {refused}");
    Ok(())
}
