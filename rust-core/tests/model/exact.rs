//! Exact statistics against draws: of slopes alone, where nothing is obscured, and of the full ray cast.

use crate::common::{direction, dot, water};
use prob_water::surface::{Draws, InstanceRng};
use prob_water::whitecap::WhitecapOnset;
use prob_water::{Engagement, Ensemble, Exact, Parameters, SlopeBudget, SpectrumModel, Surface, Water};
use rayon::prelude::*;

fn sea(friction_velocity: f64, footprint: f64, components: u32) -> Water {
    water(friction_velocity, |p| {
        p.surface = Surface::Instance;
        p.footprint = Some(footprint);
        p.components = components;
        p.wind_direction = 20.0;
        p.whitecaps = true;
    })
}

/// Views in the plane of incidence and out of it (Eq. 82).
fn views(incidence: f64, highest: f64) -> Vec<[f64; 3]> {
    let steps = (highest / 5.0) as i32;
    let in_plane = (-steps..=steps).map(|a| direction(5.0 * f64::from(a), 0.0));
    let (s, c) = incidence.to_radians().sin_cos();
    let out_of_plane = (1..=steps).map(|a| {
        let (sp, cp) = (5.0 * f64::from(a)).to_radians().sin_cos();
        [s * cp, sp, c * cp]
    });
    in_plane.chain(out_of_plane).filter(|v| v[2] > (highest + 0.1).to_radians().cos()).collect()
}

/// Sums over draws of A, A f, A f^2, A f cos and of the squares that the errors need.
#[derive(Clone, Default)]
struct Sums {
    area: f64,
    area2: f64,
    /// f, f^2, f cos.
    values: Vec<[f64; 3]>,
    squares: Vec<[f64; 3]>,
    products: Vec<[f64; 3]>,
}

/// Draws that are summed by themselves, so that sums do not depend on threads.
const BATCH: u64 = 2000;

/// Weighted mean and its standard error, of f, f^2 and f cos, for every view.
fn drawn(water: &Water, source: [f64; 3], views: &[[f64; 3]], draws: u64) -> Vec<[(f64, f64); 3]> {
    let waves = water.waves();
    let onset = water.whitecap_onset();
    let zero = || Sums {
        values: vec![[0.0; 3]; views.len()],
        squares: vec![[0.0; 3]; views.len()],
        products: vec![[0.0; 3]; views.len()],
        ..Sums::default()
    };
    let batch = |b: u64| {
        let mut sums = zero();
        for instance in b * BATCH..(b + 1) * BATCH {
            let mut numbers = InstanceRng::new(Draws::Random, 1, instance);
            let chance = numbers.next();
            let point = waves.surface(numbers, 0.0).point([0.0; 2]);
            let n = point.normal();
            let area = (dot(n, source) / n[2]).max(0.0);
            let foam = onset.is_some_and(|onset| chance < onset.probability(point.acceleration));
            sums.area += area;
            sums.area2 += area * area;
            if area <= 0.0 {
                continue;
            }
            for (v, view) in views.iter().enumerate() {
                let cos = dot(n, *view);
                let f = match (cos > 0.0, foam) {
                    (false, _) => 0.0,
                    (true, true) => water.local_lobe().whitecap_brdf,
                    (true, false) => water.local_lobe().facets.eval(source, *view, n),
                };
                for (m, value) in [f, f * f, f * cos].into_iter().enumerate() {
                    sums.values[v][m] += area * value;
                    sums.squares[v][m] += (area * value).powi(2);
                    sums.products[v][m] += area * area * value;
                }
            }
        }
        sums
    };
    let add = |mut a: Sums, b: Sums| {
        a.area += b.area;
        a.area2 += b.area2;
        for (to, from) in
            [(&mut a.values, b.values), (&mut a.squares, b.squares), (&mut a.products, b.products)]
        {
            for (to, from) in to.iter_mut().zip(from) {
                to.iter_mut().zip(from).for_each(|(to, from)| *to += from);
            }
        }
        a
    };
    let all = (0..draws / BATCH).into_par_iter().map(batch).reduce(zero, add);
    (0..views.len())
        .map(|v| {
            std::array::from_fn(|m| {
                let mean = all.values[v][m] / all.area;
                let spread = all.squares[v][m] - 2.0 * mean * all.products[v][m] + mean * mean * all.area2;
                (mean, spread.max(0.0).sqrt() / all.area)
            })
        })
        .collect()
}

/// The largest of some deviations, each over what is allowed.
#[derive(Default)]
struct Worst {
    deviation: f64,
    text: String,
}

impl Worst {
    /// Allowed is a share of the expected value and 4 standard errors.
    fn add(&mut self, found: f64, expected: f64, share: f64, error: f64, what: impl Fn() -> String) {
        let deviation = (found - expected).abs() / (share * expected + 4.0 * error);
        if deviation.is_nan() || deviation > self.deviation {
            let percent = 100.0 * (found / expected - 1.0);
            let (deviation, text) = (deviation, format!("{}: {percent:+.2} %", what()));
            *self = Self { deviation, text };
        }
    }
}

/// Means within 0.2 % and standard deviations within 1 %, plus 4 standard errors, wherever the mean exceeds 1 % of its
/// peak.
fn compare_without_obscuration(water: &Water, incidence: f64, draws: u64) -> Worst {
    let views = views(incidence, 85.0);
    let engagement = Engagement::far(incidence, 1e6, &views, 1e8).unwrap();
    let mut exact = Exact::new(water).unwrap();
    exact.obscuration = false;
    let means = exact.means(&engagement);
    let drawn = drawn(water, engagement.direction().map(|x| -x), &views, draws);
    let peak = drawn.iter().map(|d| d[0].0).fold(0.0, f64::max);
    let mut worst = Worst::default();
    for (view, (exact, drawn)) in views.iter().zip(means.iter().zip(drawn)) {
        let [(mean, sem), (square, square_error), (cos, cos_error)] = drawn;
        if mean < 0.01 * peak {
            continue;
        }
        let std = (square - mean * mean).sqrt();
        let std_error = square_error.hypot(2.0 * mean * sem) / (2.0 * std);
        let exact_std = (exact.f_squared - exact.f * exact.f).sqrt();
        let at = |what| move || format!("{what} towards {view:.2?}");
        worst.add(exact.f, mean, 0.002, sem, at("mean"));
        worst.add(exact.f_cos, cos, 0.002, cos_error, at("mean_f_cos"));
        worst.add(exact_std, std, 0.01, std_error, at("std"));
    }
    worst
}

/// Means within 2 % plus 4 standard errors of the ray cast, for views to 70 degrees, wherever the mean exceeds 1 % of its
/// peak.
fn compare_with_the_ray_cast(water: &Water, incidence: f64) -> Worst {
    let views = views(incidence, 70.0);
    let engagement = Engagement::far(incidence, 10e3, &views, 1e6).unwrap();
    let exact = Exact::new(water).unwrap().means(&engagement);
    let samples = Ensemble::new(water).unwrap().sample(std::slice::from_ref(&engagement), &|_| ()).unwrap();
    let drawn: Vec<_> = (0..views.len()).map(|o| samples.statistics(0, o, &[]).unwrap()).collect();
    let peak = drawn.iter().map(|d| d.mean).fold(0.0, f64::max);
    let mut worst = Worst::default();
    for (view, (exact, drawn)) in views.iter().zip(exact.iter().zip(drawn)) {
        if drawn.mean > 0.01 * peak {
            worst.add(exact.f, drawn.mean, 0.02, drawn.sem, || format!("mean towards {view:.2?}"));
        }
    }
    worst
}

/// Other spectra, whose waves may spread each in its own way, and a closed slope budget.
#[test]
fn other_spectra_and_budgets() {
    let other = |w, footprint, change: fn(&mut Parameters)| {
        water(w, |p| {
            *p = Parameters { ..sea(w, footprint, 8).parameters };
            change(p);
        })
    };
    for water in [
        other(24.0, 0.15, |p| p.spectrum = SpectrumModel::Elfouhaily),
        other(8.0, 0.1, |p| (p.spectrum, p.fetch) = (SpectrumModel::Jonswap, 2e3)),
        other(4.0, 0.15, |p| p.slope_budget = SlopeBudget::Closed),
        other(40.0, 0.05, |p| {
            (p.spectrum, p.slope_budget) = (SpectrumModel::Elfouhaily, SlopeBudget::Closed);
        }),
    ] {
        let worst = compare_without_obscuration(&water, 40.0, 60_000);
        assert!(worst.deviation < 1.0, "{}: {}", water, worst.text);
    }
}

fn campaign(seas: impl Iterator<Item = (f64, f64, u32, f64)>, compare: impl Fn(f64, f64, u32, f64) -> Worst) {
    let mut worst = Worst::default();
    for (w, footprint, components, incidence) in seas {
        let here = compare(w, footprint, components, incidence);
        let sea = format!("w* {w} D {footprint} M {components} theta_i {incidence}");
        println!("{sea}: {:.2} of what is allowed, {}", here.deviation, here.text);
        if here.deviation.is_nan() || here.deviation > worst.deviation {
            worst = Worst { deviation: here.deviation, text: format!("{sea}: {}", here.text) };
        }
    }
    println!("worst: {:.2} of what is allowed, {}", worst.deviation, worst.text);
    assert!(worst.deviation < 1.0, "{}", worst.text);
}

/// Every wind, footprint, number of components and incidence.
fn all(winds: &[f64]) -> impl Iterator<Item = (f64, f64, u32, f64)> {
    let pairs = winds.iter().flat_map(|w| [0.05, 0.15, 0.5].map(|d| (*w, d)));
    let triples = pairs.flat_map(|(w, d)| [5, 20].map(|m| (w, d, m)));
    triples.flat_map(|(w, d, m)| [0.0, 30.0, 60.0, 75.0].map(|i| (w, d, m, i)))
}

const SLICE: [(f64, f64, u32, f64); 6] = [
    (2.0, 0.05, 5, 30.0),
    (2.0, 0.5, 20, 75.0),
    (8.0, 0.15, 5, 30.0),
    (24.0, 0.5, 10, 0.0),
    (24.0, 0.15, 20, 60.0),
    (56.0, 0.05, 5, 75.0),
];

#[test]
fn without_obscuration() {
    campaign(SLICE.into_iter(), |w, d, m, i| compare_without_obscuration(&sea(w, d, m), i, 100_000));
}

#[test]
#[ignore = "long: `cargo xtask verify` runs it"]
fn without_obscuration_everywhere() {
    let seas = all(&[2.0, 8.0, 24.0, 56.0]);
    campaign(seas, |w, d, m, i| compare_without_obscuration(&sea(w, d, m), i, 1_000_000));
}

fn with_instances(mut water: Water, instances: u64) -> Water {
    water.parameters.instances = instances;
    water
}

#[test]
fn with_obscuration() {
    let seas = SLICE.into_iter().filter(|sea| sea.0 > 2.0);
    campaign(seas, |w, d, m, i| compare_with_the_ray_cast(&with_instances(sea(w, d, m), 30_000), i));
}

#[test]
#[ignore = "long: `cargo xtask verify` runs it"]
fn with_obscuration_everywhere() {
    let seas = all(&[4.0, 8.0, 24.0, 56.0]);
    campaign(seas, |w, d, m, i| compare_with_the_ray_cast(&with_instances(sea(w, d, m), 200_000), i));
}

/// How far off obscuration by Smith's share is for low forward views: 2 % to 70 degrees; below, a regression pin of 25 %, of
/// 21 % measured. The table is that of docs/model.md.
#[test]
#[ignore = "long: `cargo xtask verify` runs it"]
fn low_views() {
    let angles = [60.0, 65.0, 70.0, 75.0, 80.0, 85.0, 88.0];
    println!("exact over drawn mean - 1 +- 1 standard error, %, and share obscured, at views {angles:?}");
    for w in [4.0, 8.0, 24.0, 56.0] {
        for incidence in [30.0, 60.0, 75.0] {
            let water = with_instances(sea(w, 0.15, 5), 400_000);
            let views: Vec<_> = angles.iter().map(|a| direction(*a, 0.0)).collect();
            let engagement = Engagement::far(incidence, 10e3, &views, 1e6).unwrap();
            let exact = Exact::new(&water).unwrap().statistics(&engagement, &[]);
            let samples =
                Ensemble::new(&water).unwrap().sample(std::slice::from_ref(&engagement), &|_| ()).unwrap();
            print!("w* {w:2} theta_i {incidence}:");
            for (o, exact) in exact.iter().enumerate() {
                let drawn = samples.statistics(0, o, &[]).unwrap();
                let off = 100.0 * (exact.mean / drawn.mean - 1.0);
                let error = 100.0 * drawn.sem / drawn.mean;
                print!("  {off:+.1} +- {error:.1} ({:.3} {:.3})", exact.obscured, drawn.obscured);
                let allowed = if angles[o] <= 70.0 { 2.0 } else { 25.0 };
                assert!(off.abs() < allowed + 4.0 * error, "w* {w} theta_i {incidence} {}: {off}", angles[o]);
            }
            println!();
        }
    }
}

/// Quantiles, exceedances and whitecaps of seas of every kind against 40,000 instances: the probability of what lies
/// above an exact quantile is off by at most 0.006 and 4 standard errors, or the quantile itself by at most 0.1 %.
#[test]
fn distributions() {
    let sea = |w: f64, change: &dyn Fn(&mut prob_water::Parameters)| {
        with_instances(
            water(w, |p| {
                p.surface = Surface::Instance;
                p.footprint = Some(0.15);
                p.whitecaps = true;
                change(p);
            }),
            40_000,
        )
    };
    let seas = [
        ("base", 30.0, sea(8.0, &|_| ())),
        ("light air", 30.0, sea(0.6, &|_| ())),
        ("footprint 5", 30.0, sea(8.0, &|p| p.footprint = Some(5.0))),
        ("steep", 60.0, sea(56.0, &|p| p.components = 20)),
        ("fetch 800", 40.0, sea(24.0, &|p| p.fetch = 800.0)),
        ("fetch 5000, shallow", 40.0, sea(24.0, &|p| (p.fetch, p.depth) = (5e3, 0.5))),
        ("hurricane", 20.0, sea(238.0, &|p| p.footprint = Some(f64::INFINITY))),
        ("hurricane, shallow", 20.0, sea(200.0, &|p| (p.footprint, p.depth) = (Some(5.0), 0.2))),
        // Without Eq. 51's fraction, which is 1: there would be nothing but whitecaps.
        (
            "hurricane, no depth",
            20.0,
            sea(238.0, &|p| {
                (p.footprint, p.depth, p.whitecap_onset) = (Some(5.0), 1e-200, WhitecapOnset::Ramp);
            }),
        ),
        ("slopes", 10.0, sea(40.0, &|p| p.slope_measure = prob_water::SlopeMeasure::Slope)),
        ("as printed", 30.0, sea(16.0, &|p| p.readings = prob_water::Readings::AS_PRINTED)),
        ("calm", 30.0, sea(0.0, &|_| ())),
        ("next to calm", 30.0, sea(0.4, &|p| p.components = 1)),
    ];
    for (name, incidence, water) in seas {
        let views: Vec<_> = [0.0, 30.0, 45.0, 60.0].map(|a| direction(a, 0.0)).to_vec();
        let engagement = Engagement::far(incidence, 10e3, &views, 1e6).unwrap();
        let exact = Exact::new(&water).unwrap().statistics(&engagement, &[]);
        let samples =
            Ensemble::new(&water).unwrap().sample(std::slice::from_ref(&engagement), &|_| ()).unwrap();
        let n = samples.instances() as f64;
        let mut compared = 0;
        for (o, exact) in exact.iter().enumerate() {
            // From just below each quantile and above it: a whitecap's f is a lump, and so is 0.
            let below = |q: f64| if q > 0.0 { q * (1.0 - 1e-9) } else { -1.0 };
            let limits: Vec<_> = exact.quantiles.iter().flat_map(|q| [below(*q), *q]).collect();
            let drawn = samples.statistics(0, o, &limits).unwrap();
            let off = (exact.mean - drawn.mean).abs();
            assert!(off <= 0.01 * drawn.mean + 4.0 * drawn.sem + 1e-6, "{name} {o}: {off} of {}", drawn.mean);
            for (q, level) in prob_water::statistics::QUANTILES.iter().enumerate() {
                let over = &drawn.over[2 * q..];
                let error = (level * (1.0 - level) / n).sqrt();
                let off = (1.0 - level - over[0]).max(over[1] - (1.0 - level)).max(0.0);
                // Where waves hardly tilt the surface all f are alike.
                let alike = (exact.quantiles[q] / drawn.quantiles[q] - 1.0).abs() < 1e-3;
                if drawn.std > 0.0 && !alike {
                    compared += 1;
                    assert!(off < 0.006 + 4.0 * error, "{name} {o} {level}: {:?}", &over[..2]);
                }
            }
            let error = 4.0 * (drawn.whitecap / n).sqrt();
            assert!(
                (exact.whitecap - drawn.whitecap).abs() < 0.03 * drawn.whitecap + error + 1e-4,
                "{name}: {} against {}",
                exact.whitecap,
                drawn.whitecap
            );
            assert!(
                (exact.obscured - drawn.obscured).abs() < 0.01,
                "{name}: {} {}",
                exact.obscured,
                drawn.obscured
            );
            if water.wind.friction_velocity < 0.47 {
                assert_eq!(exact.quantiles, drawn.quantiles, "{name}");
            }
            // Exceedance is the other way round.
            let half = exact.quantiles[1];
            let again = Exact::new(&water).unwrap().statistics(&engagement, &[half])[o].over[0];
            let lump =
                exact.quantiles[0] > 0.999 * half || half == water.local_lobe().whitecap_brdf || half == 0.0;
            assert!(lump || (again - 0.5).abs() < 0.01, "{name} {o}: {again}");
        }
        // In the others waves hardly tilt the surface: all f are alike.
        assert_eq!(compared > 0, !["hurricane", "calm", "next to calm"].contains(&name), "{name}");
    }
}

/// A share is at most 1, also where sums of probabilities are more by rounding.
#[test]
fn shares_are_at_most_one() {
    for w in [2.0, 8.0, 24.0, 56.0] {
        let exact = Exact::new(&sea(w, 0.15, 5)).unwrap();
        for theta in [0.0f64, 20.0, 45.0, 70.0] {
            let (sin, cos) = theta.to_radians().sin_cos();
            let engagement = Engagement::far(30.0, 1e6, &[[sin, 0.0, cos], [0.0, sin, cos]], 1e6).unwrap();
            for s in exact.statistics(&engagement, &[0.0, 1e-9]) {
                assert!(s.over.iter().all(|x| (0.0..=1.0).contains(x)), "{w} {theta}: {s:?}");
            }
        }
    }
}

/// Seas whose tables would have no end are refused, in no time, by the parameter that is to blame.
#[test]
fn far_finer_facets_are_refused() {
    let refused =
        |w, footprint, components| Exact::new(&sea(w, footprint, components)).unwrap_err().parameters();
    for (w, footprint) in [(238.0, 1e-3), (100.0, 1e-3), (150.0, 1e-6), (1.0, 1e-4)] {
        assert_eq!(refused(w, footprint, 5), ["footprint"], "w* {w} D {footprint}");
    }
    assert_eq!(refused(8.0, 0.15, 3), ["components"]);
}

/// What an exact statistic says of its own error covers it: against ray casts, views to 2 degrees above the horizon and
/// sources to 7, wherever the mean is known to 3 %.
fn compare_errors(water: &Water, incidence: f64) -> [f64; 2] {
    let angles = [50.0, 65.0, 75.0, 80.0, 84.0, 88.0];
    let views: Vec<_> = angles.iter().flat_map(|a| [direction(*a, 0.0), direction(*a, 40.0)]).collect();
    let engagement = Engagement::far(incidence, 10e3, &views, 1e6).unwrap();
    let limits = [0.02, 0.5, 5.0];
    let exact = Exact::new(water).unwrap().statistics(&engagement, &limits);
    let samples = Ensemble::new(water).unwrap().sample(std::slice::from_ref(&engagement), &|_| ()).unwrap();
    let mut worst = [0.0f64; 2];
    for (o, exact) in exact.iter().enumerate() {
        let drawn = samples.statistics(0, o, &limits).unwrap();
        if drawn.sem > 0.03 * drawn.mean || drawn.effective < 100.0 {
            continue;
        }
        // The 2 % that exact means are off where nothing is hidden (`with_obscuration_everywhere`) stand beside.
        let off = (exact.mean - drawn.mean).abs();
        let mean = off / ((0.02 + exact.mean_error) * drawn.mean + 4.0 * drawn.sem);
        let n = water.parameters.instances as f64;
        let shares = exact.over.iter().zip(&drawn.over).chain([(&exact.obscured, &drawn.obscured)]);
        let share =
            shares.map(|(a, b)| (a - b).abs() / (exact.share_error + 4.0 * (b * (1.0 - b) / n).sqrt()));
        let at = format!(
            "w* {} incidence {incidence} observer {o}: {exact:?} against {drawn:?}",
            water.wind.friction_velocity
        );
        let share = share.fold(0.0, f64::max);
        assert!(mean < 1.0 && share < 1.0, "{mean} {share} of what is allowed, {at}");
        worst = [worst[0].max(mean), worst[1].max(share)];
    }
    worst
}

#[test]
fn errors_are_bounded() {
    let mut worst = [0.0f64; 2];
    for (w, footprint, components, incidence) in [
        (8.0, 0.15, 5, 83.0),
        (24.0, 0.05, 8, 75.0),
        (40.0, 0.15, 5, 30.0),
        (56.0, 0.5, 5, 83.0),
        (24.0, 0.15, 20, 60.0),
    ] {
        let mut water = sea(w, footprint, components);
        water.parameters.instances = 10_000;
        let here = compare_errors(&water, incidence);
        worst = [worst[0].max(here[0]), worst[1].max(here[1])];
    }
    assert!(worst[0] > 0.2 && worst[1] > 0.2, "bounds that nothing comes near: {worst:?}");
}

#[test]
#[ignore = "long: `cargo xtask verify` runs it"]
fn errors_are_bounded_everywhere() {
    for w in [4.0, 8.0, 16.0, 24.0, 40.0, 56.0, 120.0] {
        for footprint in [0.04, 0.15, 0.5] {
            for (components, incidence) in
                [(5, 0.0), (20, 30.0), (5, 60.0), (20, 75.0), (5, 83.0), (20, 83.0)]
            {
                let mut water = sea(w, footprint, components);
                water.parameters.instances = 40_000;
                let worst = compare_errors(&water, incidence);
                println!(
                    "w* {w} D {footprint} M {components} theta_i {incidence}: {worst:.2?} of what is allowed"
                );
            }
        }
    }
}
