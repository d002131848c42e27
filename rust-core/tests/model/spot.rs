//! The spot of a beam: its shape, the circle that stands for it, and means over it against sums over places.

use crate::common::{dot, water};
use prob_water::{
    Aim, Beam, Engagement, Ensemble, Exact, FootprintMeasure, Parameters, Proposal, RealisedSurface, Spot,
    SpotShape, Surface, Water,
};
use std::f64::consts::{FRAC_PI_2, PI};

/// A sea without whitecaps whose waves are drawn.
fn sea(friction_velocity: f64, footprint: Option<f64>, components: u32, instances: u64) -> Water {
    water(friction_velocity, |p| {
        p.surface = Surface::Instance;
        p.footprint = footprint;
        p.components = components;
        p.instances = instances;
        p.wind_direction = 25.0;
    })
}

/// A laser so many m from the origin, at angles of incidence and azimuth in degrees, and an observer in the mirror's direction.
fn lit(range: f64, incidence: f64, azimuth: f64) -> Engagement {
    let ((sin, cos), (y, x)) = (incidence.to_radians().sin_cos(), azimuth.to_radians().sin_cos());
    let [laser, observer] = [-range, 1e5].map(|r| [r * sin * x, r * sin * y, r.abs() * cos]);
    Engagement::new(0.0, laser, Aim::Target([0.0; 3]), &[observer]).unwrap()
}

/// Places about a point with their weights: a Gaussian exp(-8 r^2/D^2) along either axis, by equal steps, which converge as
/// fast as anything.
fn places(spot: &Spot, [x, y]: [f64; 2]) -> Vec<([f64; 2], f64)> {
    const STEP: f64 = 0.08;
    let ([ex, ey], [along, across]) = (spot.axis(), spot.diameters());
    let steps: Vec<f64> = (-20..=20).map(|i| STEP * f64::from(i)).collect();
    let mut all: Vec<_> = steps
        .iter()
        .flat_map(|a| steps.iter().map(move |b| (a, b)))
        .map(|(a, b)| {
            let (u, v) = (a * along, b * across);
            ([x + u * ex - v * ey, y + u * ey + v * ex], (-8.0 * (a * a + b * b)).exp())
        })
        .collect();
    let total: f64 = all.iter().map(|(_, weight)| weight).sum();
    all.iter_mut().for_each(|(_, weight)| *weight /= total);
    all
}

#[test]
fn spots_of_beams_and_footprints() {
    let p = sea(8.0, None, 5, 1).parameters;
    let spot = |e: &Engagement, p: &Parameters, shape| Spot::new(e, p, shape).unwrap();
    let near =
        |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
    for (incidence, azimuth) in [(0.0, 0.0), (30.0, 0.0), (60.0, 140.0), (85.0, -70.0), (89.0, 10.0)] {
        let e = lit(700.0, incidence, azimuth);
        near(e.range(), 700.0);
        let beam = Beam::new(0.3, 0.1).unwrap();
        let width = (0.1f64 * 0.1 + 0.21 * 0.21).sqrt();
        let wide = e.clone().with_beam(beam);
        assert_eq!(spot(&e, &p, SpotShape::Circle).diameters(), [0.15; 2]);
        assert_eq!(spot(&e, &p, SpotShape::Circle).footprint(), 0.15);
        let round = spot(&wide, &p, SpotShape::Circle);
        near(round.footprint(), width);
        // The ellipse: cut out of the plane by the cylinder about the beam, but for its largest length.
        let ellipse = spot(&wide, &p, SpotShape::Ellipse);
        let [along, across] = ellipse.diameters();
        near(across, width);
        near(along, width * (1.0 / incidence.to_radians().cos()).min(10.0));
        let [x, y] = ellipse.axis();
        if incidence > 0.0 && incidence < 84.0 {
            let d = e.direction();
            let end = [0.5 * along * x, 0.5 * along * y, 0.0];
            let off = dot(end, d);
            let from_axis = (dot(end, end) - off * off).sqrt();
            near(from_axis, 0.5 * width);
        }
        // What the beam has, whichever width it is told by.
        let measured = Parameters { footprint_measure: FootprintMeasure::OneOverE, ..p };
        near(spot(&wide, &measured, SpotShape::Circle).footprint(), 2f64.sqrt() * width);
        let sea = round.sea(&measured).unwrap();
        assert_eq!(sea.footprint, round.footprint());
        let both = Parameters { footprint: Some(0.2), ..p };
        let error = Spot::new(&wide, &both, SpotShape::Circle).unwrap_err();
        assert_eq!(error.parameters(), ["divergence", "footprint"]);
        assert_eq!(
            error.to_string(),
            "footprint = 0.2 and divergence = 0.3 are both given: allowed is one of footprint, divergence (with aperture)"
        );
    }
    // The report's spot is the sea as it was.
    let plain = spot(&lit(1e3, 50.0, 0.0), &p, SpotShape::Circle).sea(&p).unwrap();
    let before = p.configure().unwrap();
    assert_eq!((plain.footprint, plain.variances), (before.footprint, before.variances));
    let wide = Parameters { footprint: Some(f64::INFINITY), ..p };
    let error = Ensemble::new(&wide.configure().unwrap())
        .unwrap()
        .over(spot(&lit(1e3, 50.0, 0.0), &wide, SpotShape::Circle))
        .unwrap_err();
    assert_eq!(
        error.to_string(),
        "footprint = inf is out of range: allowed is finite, for a mean over the spot"
    );
}

/// Height, slope and acceleration over a spot, against sums over 1681 places in it.
#[test]
fn means_are_sums_over_places() {
    let mut worst = 0.0f64;
    for (w, footprint, components) in [(8.0, 0.15, 5), (24.0, 0.05, 40), (56.0, 1.0, 9)] {
        let ensemble = Ensemble::new(&sea(w, Some(footprint), components, 1)).unwrap();
        for (incidence, azimuth) in [(0.0, 0.0), (60.0, 0.0), (50.0, 110.0), (75.0, -30.0)] {
            let engagement = lit(1e3, incidence, azimuth);
            for shape in [SpotShape::Circle, SpotShape::Ellipse] {
                let spot = Spot::new(&engagement, &ensemble.water.parameters, shape).unwrap();
                for instance in 0..5 {
                    let surface = RealisedSurface::new(ensemble.components(instance).1, 1.7);
                    let at = [0.3, -2.0];
                    let mut sums = [0.0; 4];
                    for (place, weight) in places(&spot, at) {
                        let p = surface.point(place);
                        for (sum, x) in
                            sums.iter_mut().zip([p.height, p.slope[0], p.slope[1], p.acceleration])
                        {
                            *sum += weight * x;
                        }
                    }
                    let p = spot.mean(&surface, at);
                    let scales = [surface.highest(), surface.steepest(), surface.steepest(), 1.0];
                    let found = [p.height, p.slope[0], p.slope[1], p.acceleration];
                    for ((found, sum), scale) in found.into_iter().zip(sums).zip(scales) {
                        worst = worst.max((found - sum).abs() / scale);
                    }
                }
            }
        }
    }
    println!("worst difference {worst:.1e} of the largest height and slope, and of 1 m/s^2");
    assert!(worst < 1e-9, "{worst}");
}

/// The facets' share of the slopes within a spot, against what a mean over it takes from 20,000 drawn seas, within 4 standard
/// errors.
#[test]
fn facets_get_the_slopes_within() {
    for (w, footprint) in [(4.0, 0.15), (8.0, 0.15), (24.0, 0.05), (56.0, 0.5)] {
        for (shape, incidence, azimuth) in [
            (SpotShape::Circle, 60.0, 0.0),
            (SpotShape::Ellipse, 60.0, 25.0),
            (SpotShape::Ellipse, 75.0, 115.0),
        ] {
            let water = sea(w, Some(footprint), 5, 1);
            let ensemble = Ensemble::new(&water).unwrap();
            let spot = Spot::new(&lit(1e3, incidence, azimuth), &water.parameters, shape).unwrap();
            let after = ensemble.over(spot).unwrap();
            let again = after.over(spot).unwrap();
            assert_eq!(again.water.variances, after.water.variances);
            let ([ex, ey], [along, across]) = (spot.axis(), spot.diameters());
            let count = 20_000;
            let (mut sums, mut squares) = ([0.0; 2], [0.0; 2]);
            for instance in 0..count {
                let mut lost = [0.0; 2];
                for c in ensemble.components(instance).1 {
                    let (sin, cos) = c.azimuth.sin_cos();
                    let (a, b) = (along * (cos * ex + sin * ey), across * (sin * ex - cos * ey));
                    // The mean's amplitude over the wave's own.
                    let left = (-c.wave_number.powi(2) * (a * a + b * b) / 32.0).exp();
                    let variance = 0.5 * (c.amplitude * c.wave_number).powi(2) * (1.0 - left * left);
                    let from_wind = c.azimuth - 25f64.to_radians();
                    lost[0] += variance * from_wind.cos().powi(2);
                    lost[1] += variance * from_wind.sin().powi(2);
                }
                for axis in 0..2 {
                    sums[axis] += lost[axis];
                    squares[axis] += lost[axis] * lost[axis];
                }
            }
            for axis in 0..2 {
                let mean = sums[axis] / count as f64;
                let error = ((squares[axis] / count as f64 - mean * mean) / count as f64).sqrt();
                let found = after.water.variances[axis] - water.variances[axis];
                println!(
                    "w* {w} D {footprint} {shape:?} {incidence} axis {axis}: {found:.3e}, drawn {mean:.3e} +- {error:.0e}"
                );
                assert!((found - mean).abs() < 4.0 * error && error < 0.02 * mean, "{found} {mean} {error}");
            }
        }
    }
}

/// The slow twin: f about the normal at every place of a spot, by its weight, in 1000 seas. The fast way has its mean and its
/// spread over the seas, and follows each.
#[test]
fn f_is_the_mean_over_places() {
    for (w, footprint, shape, incidence) in [
        (8.0, 0.15, SpotShape::Circle, 30.0),
        (8.0, 0.15, SpotShape::Ellipse, 60.0),
        (24.0, 0.05, SpotShape::Circle, 0.0),
        (24.0, 0.3, SpotShape::Ellipse, 45.0),
    ] {
        let engagement = lit(1e4, incidence, 0.0);
        let parameters = sea(w, Some(footprint), 20, 1000).parameters;
        let spot = Spot::new(&engagement, &parameters, shape).unwrap();
        let water = spot.sea(&parameters).unwrap();
        let ensemble = Ensemble::new(&water).unwrap();
        let means = ensemble.over(spot).unwrap();
        let one = |ensemble: &Ensemble| ensemble.sample(std::slice::from_ref(&engagement), &|_| ()).unwrap();
        let (hits, fast) = (one(&ensemble), one(&means));
        let lobe = water.local_lobe().facets;
        let [i, o] = engagement.ways().next().unwrap();
        let mut all = vec![];
        for (hit, fast) in hits.of(0, 0).unwrap().zip(fast.of(0, 0).unwrap()) {
            assert_eq!(hit.hit.position, fast.hit.position);
            let surface = RealisedSurface::new(ensemble.components(hit.instance).1, 0.0);
            let [x, y, _] = hit.hit.position;
            let slow = places(&spot, [x, y])
                .into_iter()
                .map(|(at, weight)| weight * lobe.eval(i, o, surface.point(at).normal()));
            all.push([slow.sum::<f64>(), fast.seen.f, hit.seen.f]);
        }
        let n = all.len() as f64;
        let mean = |k: usize| all.iter().map(|f| f[k]).sum::<f64>() / n;
        let std = |k: usize| (all.iter().map(|f| (f[k] - mean(k)).powi(2)).sum::<f64>() / n).sqrt();
        let off = |k: usize| (all.iter().map(|f| (f[k] - f[0]).powi(2)).sum::<f64>() / n).sqrt() / std(0);
        println!(
            "w* {w} D {footprint} {shape:?} {incidence}: mean over places {:.5}, fast {:.5}, hit {:.5}; std {:.5}, {:.5}, {:.5}; off {:.3}, {:.3}",
            mean(0),
            mean(1),
            mean(2),
            std(0),
            std(1),
            std(2),
            off(1),
            off(2)
        );
        // One Gaussian stands for the slopes within every spot, of crests and of slopes between them alike.
        assert!((mean(1) / mean(0) - 1.0).abs() < 0.01, "{} {}", mean(1), mean(0));
        assert!((std(1) / std(0) - 1.0).abs() < 0.06, "{} {}", std(1), std(0));
        assert!(off(1) < 0.75 * off(2), "{} {}", off(1), off(2));
    }
}

/// Exact means, which know nothing of a spot, hold: what the mean normal does not turn, the wider facets do. The spread is less.
#[test]
fn means_are_kept_and_spread_is_less() {
    for (w, footprint, incidence, proposal) in [
        (8.0, 0.15, 30.0, Proposal::Plain),
        (24.0, 0.15, 60.0, Proposal::Plain),
        (8.0, 0.01, 30.0, Proposal::Slopes),
    ] {
        let water = sea(w, Some(footprint), 8, 40_000);
        let engagement = lit(1e4, incidence, 40.0);
        let exact = Exact::new(&water).unwrap().means(&engagement)[0].f;
        let hit = Ensemble { proposal, ..Ensemble::new(&water).unwrap() };
        for shape in [SpotShape::Circle, SpotShape::Ellipse] {
            let spot = Spot::new(&engagement, &water.parameters, shape).unwrap();
            let of = |e: Ensemble| {
                e.sample(std::slice::from_ref(&engagement), &|_| ()).unwrap().statistics(0, 0, &[]).unwrap()
            };
            let (plain, mean) = (of(hit), of(hit.over(spot).unwrap()));
            println!(
                "w* {w} D {footprint} theta {incidence} {shape:?}: exact {exact:.5}, hit {:.5} +- {:.5}, std {:.5}, mean {:.5} +- {:.5}, std {:.5}",
                plain.mean, plain.sem, plain.std, mean.mean, mean.sem, mean.std
            );
            assert!((mean.mean - exact).abs() < 0.02 * exact + 4.0 * mean.sem, "{} {exact}", mean.mean);
            assert!(mean.std < 0.98 * plain.std, "{} {}", mean.std, plain.std);
        }
    }
}

/// The mean is that of the hit's own surroundings, also where a sea drawn by importance has its origin at the hit: normals differ
/// from the hit's by much less than the slopes within the spot.
#[test]
fn means_are_about_the_hit() {
    let water = sea(8.0, Some(0.02), 8, 2000);
    let laser = [200.0, 700.0, 900.0];
    let engagement =
        Engagement::new(0.0, laser, Aim::Target([300.0, -200.0, 0.0]), &[[500.0, -900.0, 700.0]]).unwrap();
    let spot = Spot::new(&engagement, &water.parameters, SpotShape::Ellipse).unwrap();
    for proposal in [Proposal::Plain, Proposal::Slopes] {
        let hit = Ensemble { proposal, ..Ensemble::new(&water).unwrap() };
        let mean = hit.over(spot).unwrap();
        let [hits, means] =
            [&hit, &mean].map(|e| e.sample(std::slice::from_ref(&engagement), &|_| ()).unwrap());
        // Every other sea is drawn plainly, and is then the same for both.
        let pairs = hits.of(0, 0).unwrap().zip(means.of(0, 0).unwrap()).step_by(2);
        let (mut sum, mut count) = (0.0, 0.0);
        for (hit, mean) in pairs {
            let [a, b] = [hit.hit, mean.hit].map(|hit| hit.normal.map(|n| n / hit.normal[2]));
            sum += (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2);
            count += 1.0;
        }
        let within: f64 =
            mean.water.variances.iter().zip(water.variances).map(|(after, before)| after - before).sum();
        println!("{proposal:?}: {:.2e} between normals, {within:.2e} within", sum / count);
        assert!((0.01..0.5).contains(&(sum / count / within)), "{} {within}", sum / count);
    }
}

/// The slope variance of waves that are longer than two spots in their own direction, over that of waves drawn for the circle
/// that stands for the ellipse. Bounds are regression pins: the spectrum's slope variance is not the same in every octave, and
/// waves run along the wind. The circle of the same area is off by 0.40 at most, the beam's own diameter by 1.03.
#[test]
fn circles_stand_for_ellipses() {
    for (incidence, bound) in [(30.0, 0.016), (60.0, 0.085), (75.0, 0.21)] {
        let mut sums = [0.0; 3];
        for w in [8.0, 24.0, 56.0] {
            for from_wind in [0.0, 45.0, 90.0] {
                let water = sea(w, Some(0.15), 5, 1);
                let engagement = lit(1e3, incidence, 25.0 + from_wind);
                let spot = Spot::new(&engagement, &water.parameters, SpotShape::Ellipse).unwrap();
                let [along, across] = spot.diameters();
                let directional = drawn(&water, |azimuth| {
                    let (sin, cos) = (azimuth - f64::to_radians(from_wind)).sin_cos();
                    (along * cos).hypot(across * sin)
                });
                let circles = [spot.footprint(), (along * across).sqrt(), across];
                let off = circles.map(|d| drawn(&water, |_| d) / directional - 1.0);
                println!("w* {w} theta {incidence} from the wind {from_wind}: {off:.4?}");
                assert!(off[0].abs() < bound && off[0] < off[2], "{off:?}");
                sums.iter_mut().zip(off).for_each(|(sum, off)| *sum += off.abs());
            }
        }
        assert!(sums[0] < sums[1] && sums[1] < sums[2], "{sums:?}");
    }
}

/// Variance of the slopes of waves longer than two footprints, which depend on their azimuth from the wind.
fn drawn(water: &Water, footprint: impl Fn(f64) -> f64) -> f64 {
    let spectrum = water.waves().spectrum;
    let (n, m) = (4000, 90);
    let step = (spectrum.k2 / spectrum.k_min).ln() / f64::from(n);
    let mut sum = 0.0;
    for j in 0..m {
        let azimuth = PI * (f64::from(j) + 0.5) / f64::from(m) - FRAC_PI_2;
        let k_max = 0.01 * PI / footprint(azimuth);
        let waves = (0..n).map(|i| spectrum.k_min * ((f64::from(i) + 0.5) * step).exp());
        sum += waves
            .take_while(|k| *k < k_max)
            .map(|k| k.powi(3) * spectrum.density(k) * spectrum.spreading(k, azimuth))
            .sum::<f64>();
    }
    sum * step * PI / f64::from(m)
}
