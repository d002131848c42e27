//! The water body of the open ocean: what it reflects by its chlorophyll, for `light from below`.
//!
//! Not of the report. Case-1 water, whose optics follow its phytoplankton: Morel, J. Geophys. Res. 93, 10749 (1988), with the mean
//! cosine of Morel and Maritorena, J. Geophys. Res. 106, 7163 (2001), as the code 6S combines them.

/// Wavelength in nm, attenuation of pure water k_w in 1/m, chi and e: Morel's Table 2.
const MOREL: &str = include_str!("../../data/case_1_water_morel_1988.csv");

/// First and last wavelength of the table, micrometres.
pub const CASE_1: [f64; 2] = [0.4, 0.7];
/// The most chlorophyll that is allowed, mg/m^3.
pub const MOST_CHLOROPHYLL: f64 = 30.0;

/// Irradiance reflectance just below the surface at a wavelength in micrometres, for a concentration of chlorophyll in mg/m^3; held below
/// 400 nm, and 0 beyond 700 nm, where water absorbs.
///
/// `R = 0.33 b_b/(u K)` with `K = k_w + chi C^e`, `b_b = b_w/2 + (0.002 + 0.02 (1/2 - log10(C)/4) 550/l) 0.30 C^0.62` and
/// `u = 0.90 (1 - R)/(1 + 2.25 R)`; molecules scatter by `b_w = 0.00288 (l/500)^-4.32` (Morel 1974).
pub fn case_1_reflectance(wavelength: f64, chlorophyll: f64) -> f64 {
    if wavelength > CASE_1[1] * (1.0 + f64::EPSILON) {
        return 0.0;
    }
    let nm = 1e3 * wavelength.max(CASE_1[0]);
    let [pure, chi, e] = morel(nm);
    let molecules = 0.002_88 * (nm / 500.0).powf(-4.32);
    let (mut scattered, mut attenuated) = (0.5 * molecules, pure);
    if chlorophyll > 0.0 {
        let backwards = 0.002 + 0.02 * (0.5 - 0.25 * chlorophyll.log10()) * 550.0 / nm;
        scattered += backwards * 0.30 * chlorophyll.powf(0.62);
        attenuated += chi * chlorophyll.powf(e);
    }
    let mut reflectance = 0.0;
    for _ in 0..30 {
        let u = 0.90 * (1.0 - reflectance) / (1.0 + 2.25 * reflectance);
        reflectance = 0.33 * scattered / (u * attenuated);
    }
    reflectance
}

/// The table's numbers at a wavelength in nm within it, linear between entries.
fn morel(nm: f64) -> [f64; 3] {
    let number = |x: &str| x.parse::<f64>().expect("a number in the embedded table");
    let rows: Vec<Vec<f64>> =
        MOREL.lines().skip(1).map(|line| line.split(',').map(number).collect()).collect();
    let next = rows.partition_point(|row| row[0] < nm).clamp(1, rows.len() - 1);
    let (low, high) = (&rows[next - 1], &rows[next]);
    let t = (nm - low[0]) / (high[0] - low[0]);
    std::array::from_fn(|k| low[k + 1] + t * (high[k + 1] - low[k + 1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same equations in 6S (`morcasiwat`), whose b_w has two digits, off by up to 2 %.
    #[test]
    fn agrees_with_6s() {
        for (nm, chlorophyll, expected) in [
            (440.0, 0.03, 0.056_023),
            (490.0, 0.03, 0.033_956),
            (560.0, 0.03, 0.007_726),
            (440.0, 0.3, 0.033_115),
            (490.0, 0.3, 0.030_274),
            (560.0, 0.3, 0.012_534),
            (440.0, 3.0, 0.014_669),
            (490.0, 3.0, 0.017_721),
            (560.0, 3.0, 0.016_765),
        ] {
            let found = case_1_reflectance(1e-3 * nm, chlorophyll);
            assert!((found / expected - 1.0).abs() < 0.025, "{nm} {chlorophyll}: {found} {expected}");
        }
    }

    /// Clear water is blue, fertile water green, both are dark in the red; a share of light at any concentration.
    #[test]
    fn colours() {
        let r = case_1_reflectance;
        assert!(r(0.44, 0.03) > 3.0 * r(0.55, 0.03) && r(0.44, 10.0) < r(0.56, 10.0));
        assert_eq!(r(0.701, 1.0), 0.0);
        assert_eq!(r(0.36, 1.0), r(0.4, 1.0));
        for nm in (350..=700).step_by(5) {
            for chlorophyll in [0.0, 1e-9, 1e-3, 0.1, 1.0, MOST_CHLOROPHYLL] {
                let found = r(1e-3 * f64::from(nm), chlorophyll);
                assert!(found > 0.0 && found < 0.3, "{nm} {chlorophyll}: {found}");
            }
        }
    }
}
