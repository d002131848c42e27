//! The spectrum of a sea with a short fetch: JONSWAP's (Hasselmann et al. 1973), and TMA's of shallow water (Bouws et al. 1985),
//! cgs.

use super::bjerkaas_riedel::BjerkaasRiedel;
use super::dispersion::wave_number;
use super::whitecap::GRAVITY;
use super::wind::WindProfile;

/// Enhancement of the peak, and its width below and above.
const GAMMA: f64 = 3.3;
const WIDTHS: [f64; 2] = [0.07, 0.09];
/// The fetch, over W10^2/g, with which JONSWAP's measurements end and the sea is nearly developed: a longer one counts as this.
const LONGEST_FETCH: f64 = 1e4;
/// The spectrum starts here, in squares of the peak's frequency,
const STARTS: f64 = 0.45;
/// and JONSWAP's part ends here.
const ENDS: f64 = 9.0;

/// JONSWAP's spectrum about its peak, and the open sea's of the same wind beyond: waves much shorter than the peak's are in
/// equilibrium with the wind, whatever the fetch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Jonswap {
    alpha: f64,
    /// omega_p^2/g, rad/cm: in deep water the wave number of the peak.
    square: f64,
    /// Depth, cm, as far as it limits the waves; infinite for JONSWAP's.
    depth: f64,
    /// k_p, where the frequency is omega_p, rad/cm.
    pub(super) peak: f64,
    /// Where it starts and where JONSWAP's part ends, rad/cm.
    ends: [f64; 2],
    /// The open sea's spectrum.
    pub(super) open: BjerkaasRiedel,
}

impl Jonswap {
    /// Of a wind with a fetch in m, over the spectrum of the open sea, in water whose depth in m limits the waves.
    pub(super) fn new(wind: &WindProfile, fetch: f64, depth: f64, open: BjerkaasRiedel) -> Self {
        let (u, g) = (100.0 * wind.w10, GRAVITY);
        let fetch = (100.0 * fetch).min(LONGEST_FETCH * u * u / g);
        let frequency = 22.0 * (g * g / (u * fetch)).cbrt();
        let (square, depth) = (frequency * frequency / g, 100.0 * depth);
        Self {
            alpha: 0.076 * (u * u / (fetch * g)).powf(0.22),
            square,
            depth,
            peak: wave_number(square, depth),
            ends: [STARTS, ENDS].map(|share| wave_number(share * square, depth)),
            open,
        }
    }

    /// Smallest wave number, rad/cm; infinite in a calm.
    pub(super) fn k_min(&self) -> f64 {
        self.ends[0]
    }

    /// Where JONSWAP's part ends, rad/cm.
    pub(super) fn k1(&self) -> f64 {
        self.ends[1].min(self.open.k2)
    }

    /// S(k), cm^3; 0 beyond the open sea's end.
    pub(super) fn density(&self, k: f64) -> f64 {
        if k > self.k1() {
            return self.open.density(k);
        }
        if k < self.k_min() {
            return 0.0;
        }
        // The frequency of gravity waves; TMA's factor for S(omega) leaves alpha/(2 k^3) as it is in deep water.
        let square = k * (k * self.depth).tanh() / self.square;
        let off = square.sqrt() - 1.0;
        let width = WIDTHS[usize::from(off > 0.0)];
        let enhanced = GAMMA.powf((-0.5 * (off / width).powi(2)).exp());
        self.alpha / (2.0 * k.powi(3)) * (-1.25 / (square * square)).exp() * enhanced
    }

    /// Wave numbers between two between which it is as flat as a few polynomials.
    pub(super) fn breaks(&self, low: f64, high: f64) -> Vec<f64> {
        let mut breaks = vec![self.k1()];
        breaks
            .extend([0.56, 0.77, 1.0, 1.32, 1.74, 3.0].map(|off| wave_number(off * self.square, self.depth)));
        if high > self.k1() {
            breaks.extend(self.open.breaks(low.max(self.k1()), high));
        }
        breaks
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sea::dispersion::Dispersion;
    use crate::sea::{Salinity, Wind};

    fn spectrum(speed: f64, fetch: f64) -> Jonswap {
        shallow(speed, fetch, f64::INFINITY)
    }

    fn shallow(speed: f64, fetch: f64, depth: f64) -> Jonswap {
        let wind = Wind::Speed { speed, height: 10.0 }.profile().unwrap();
        let dispersion = Dispersion::new(Salinity::Ocean, f64::INFINITY);
        Jonswap::new(&wind, fetch, depth, BjerkaasRiedel::new(&wind, dispersion, f64::INFINITY))
    }

    /// Significant wave height, m.
    fn height(s: &Jonswap) -> f64 {
        let step = (s.open.k2 / s.k_min()).ln() / 20_000.0;
        let k = |i: i32| s.k_min() * ((f64::from(i) + 0.5) * step).exp();
        0.04 * (0..20_000).map(|i| s.density(k(i)) * k(i) * step).sum::<f64>().sqrt()
    }

    /// S(k), cm^3, as another program has it from S(omega), in SI.
    #[test]
    fn an_independent_implementation() {
        for (speed, fetch, rows) in [
            (
                6.0,
                800.0,
                [
                    (2.548_818_510_810_534, 59.222_394_029_598_6),
                    (3.641_169_301_157_906, 227.638_852_628_369),
                    (4.733_520_091_505_28, 74.596_224_573_899),
                    (14.564_677_204_631_6, 3.479_295_537_703_93),
                ],
            ),
            (
                10.0,
                2e4,
                [
                    (0.212_070_246_089_289, 63_405.966_075_960_2),
                    (0.302_957_494_413_271, 243_719.653_753_125),
                    (0.393_844_742_737_252, 79_865.830_522_883_7),
                    (1.211_829_977_653_08, 3_725.078_974_714_16),
                ],
            ),
        ] {
            let s = spectrum(speed, fetch);
            for (k, expected) in rows {
                assert!((s.density(0.01 * k) / expected - 1.0).abs() < 1e-9, "{speed} {fetch} {k}");
            }
        }
    }

    /// Waves of 0.09 m after 800 m in 6 m/s, where the open sea has 0.85 m: within 10 % of JONSWAP's growth law, `Hs = 0.0016 sqrt(X)
    /// U^2/g` of the dimensionless fetch X. From there they grow as `sqrt(alpha)/omega_p^2`, X to the power 0.557 and not 0.5, up to
    /// 0.21 U^2/g, and no longer.
    #[test]
    fn growth() {
        let over_law = |speed: f64, x: f64| {
            let fetch = x * speed * speed / 9.81;
            height(&spectrum(speed, fetch)) / (0.0016 * x.sqrt() * speed * speed / 9.81)
        };
        let first = over_law(6.0, 218.0);
        assert!((first - 1.0).abs() < 0.1, "{first}");
        let short = height(&spectrum(6.0, 800.0));
        assert!((short - 0.09).abs() < 0.005, "{short}");
        for (speed, x) in [(6.0, 1e3), (10.0, 200.0), (10.0, 3e3), (15.0, 2e3), (15.0, 1e4)] {
            let expected = first * (x / 218.0f64).powf(-0.11 + 2.0 / 3.0 - 0.5);
            assert!((over_law(speed, x) / expected - 1.0).abs() < 0.02, "{speed} m/s, X = {x}");
        }
        let [last, longer] =
            [1e4 * 36.0 / 9.81, 1e6].map(|fetch| height(&spectrum(6.0, fetch)) * 9.81 / 36.0);
        assert!((last / longer - 1.0).abs() < 1e-3 && (last - 0.21).abs() < 0.01, "{last} {longer}");
    }

    /// TMA's spectrum is JONSWAP's S(omega) times `phi = tanh^2(k d)/(1 + 2 k d/sinh(2 k d))` of the wave number with that frequency, turned
    /// into S(k) by the group velocity; a large depth does not limit. In shallow water waves are lower, and shorter at the peak.
    #[test]
    fn depth_limits_as_tma() {
        let (deep, g, d) = (spectrum(10.0, 1e4), GRAVITY, 150.0);
        let s = shallow(10.0, 1e4, 0.01 * d);
        for i in 1..60 {
            let k = s.k_min() * 1.03f64.powi(i);
            let omega = (g * k * (k * d).tanh()).sqrt();
            let group = 0.5 * omega / k * (1.0 + 2.0 * k * d / (2.0 * k * d).sinh());
            let phi = (k * d).tanh().powi(2) / (1.0 + 2.0 * k * d / (2.0 * k * d).sinh());
            // JONSWAP's S(omega) from its S(k) in deep water.
            let there = omega * omega / g;
            let jonswap = deep.density(there) * 2.0 * omega / g;
            assert!((s.density(k) / (jonswap * phi * group) - 1.0).abs() < 1e-9, "{k}");
        }
        let ratio = height(&s) / height(&deep);
        assert!(ratio < 0.8 && s.peak > deep.peak, "{ratio}");
        let far = shallow(10.0, 1e4, 1e3);
        assert!((height(&far) / height(&deep) - 1.0).abs() < 1e-9);
    }

    /// The range leaves out less than 0.2 % of the height's variance, and beyond three times the peak's frequency waves are the
    /// open sea's.
    #[test]
    fn range_holds_the_waves() {
        let s = spectrum(10.0, 1e4);
        let below = |k: f64| s.alpha / (2.0 * k.powi(3)) * (-1.25 * (s.square / k).powi(2)).exp();
        let step = 1e-3f64;
        let lost: f64 = (0..3000)
            .map(|i| s.k_min() * (-(f64::from(i) + 0.5) * step).exp())
            .map(|k| below(k) * k * step)
            .sum();
        assert!(lost < 2e-3 * (height(&s) / 0.04).powi(2));
        assert_eq!(s.density(s.k1() * 1.001), s.open.density(s.k1() * 1.001));
        assert_eq!(s.density(s.k_min() * 0.999), 0.0);
    }
}
