//! The report's empirical model: its numbers against the full model, and what is made of them.

use crate::common::worse;
use prob_water::brdf::Parts;
use prob_water::empirical::{Moments, ReferenceModel};
use prob_water::planes::Planes;
use prob_water::table::{Grid, Plan};
use prob_water::{
    EmpiricalLobe, Engagement, Ensemble, OffPlaneModel, Parameters, Surface, Table, Water, WhitecapMode, Wind,
};
use rand::rngs::StdRng;
use rand::{Rng, SeedableRng};
use std::num::NonZeroU32;

fn sea(w: f64, wind_direction: f64, instances: u64) -> Water {
    let parameters = Parameters {
        wind: Wind::FrictionVelocity(w),
        wind_direction,
        surface: Surface::Empirical,
        footprint: Some(0.15),
        instances,
        ior: Some(1.33),
        ..Parameters::default()
    };
    parameters.configure().unwrap()
}

fn with(water: &Water, change: impl FnOnce(&mut Parameters)) -> Water {
    let mut parameters = water.parameters;
    change(&mut parameters);
    parameters.configure().unwrap()
}

/// The full model under a wind from the sea's own azimuth, counted from the plane of incidence.
fn full(water: &Water) -> ReferenceModel {
    ReferenceModel::new(water).unwrap()
}

fn radians(degrees: impl Iterator<Item = f64>) -> Vec<f64> {
    degrees.map(f64::to_radians).collect()
}

fn planes(incidence: f64) -> Planes {
    Planes::new([-incidence.sin(), 0.0, incidence.cos()], 0.0)
}

fn rho(water: &Water, i: [f64; 3], o: [f64; 3]) -> f64 {
    let half = (0..3).map(|k| (i[k] + o[k]).powi(2)).sum::<f64>().sqrt() / 2.0;
    water.local_lobe().facets.reflectance.eval(half.min(1.0))
}

/// Mean and standard deviation of f by the full model.
fn brdf(water: &Water, moments: &Moments, i: [f64; 3], o: [f64; 3]) -> [f64; 2] {
    moments.brdf(rho(water, i, o), water.local_lobe().whitecap_brdf)
}

/// The direction at an angle theta_r in the plane, so far across it.
fn off_plane(planes: &Planes, theta: f64, phi: f64) -> [f64; 3] {
    let (base, specular) = (planes.in_plane(theta), planes.across(0.0));
    let along = (0..3).map(|k| base[k] * specular[k]).sum::<f64>().abs();
    let y = phi.tan() * along;
    let length = (1.0 + y * y).sqrt();
    [base[0] / length, y / length, base[2] / length]
}

/// Widths across the plane, reduced to normal incidence, as an independent implementation found them: for a wind along the
/// plane and across it.
#[test]
fn widths() {
    for (w, along, across) in [(8.0, 12.9, 15.7), (40.0, 25.0, 33.0)] {
        for (azimuth, expected) in [(0.0, along), (90.0, across)] {
            for incidence in [0.0f64, 30.0, 60.0] {
                let node = full(&sea(w, azimuth, 2000)).node(incidence.to_radians(), &[]).unwrap();
                let found = node.sigma.to_degrees();
                // Eq. 89: over the cosine of the incidence it stays nearly the same.
                // The independent values are those at 30 degrees.
                let allowed = if incidence == 30.0 { 0.02 } else { 0.05 };
                let at =
                    format!("w* {w} wind {azimuth} incidence {incidence}: {found} of {expected} degrees");
                assert!((found / expected - 1.0).abs() < allowed, "{at}");
                assert!(node.fitted > 0.97 && node.u_sigma > 0.0 && node.u_delta > node.u_sigma);
            }
        }
    }
}

/// Exact means, and what waves leave visible of them, are the ray cast's means: also at grazing incidences and views. The
/// standard error is that of the ray cast and, where surfaces are drawn for the node, the node's own, over eight seeds.
#[test]
fn nodes_follow_the_ray_cast() {
    for (w, footprint, azimuth, incidence) in [
        (8.0, 0.15, 0.0, 30.0f64),
        (24.0, 0.05, 60.0, 70.0),
        (40.0, 0.15, 150.0, 50.0),
        (56.0, 0.15, 30.0, 80.0),
        (4.0, 0.5, 90.0, 85.0),
    ] {
        let water = with(&sea(w, azimuth, 8192), |p| p.footprint = Some(footprint));
        let planes = planes(incidence.to_radians());
        let thetas = radians((-7..=7).map(|k| 12.5 * f64::from(k)));
        let directions: Vec<_> = thetas.iter().map(|t| planes.in_plane(*t)).collect();
        let nodes: Vec<_> = (0..8)
            .map(|seed| full(&with(&water, |p| p.seed = seed)).moments(&planes, &directions).unwrap())
            .collect();
        let cast = with(&water, |p| (p.instances, p.seed) = (40_000, 7));
        let engagement = Engagement::far(incidence, 10e3, &directions, 100e3).unwrap();
        let ensemble = Ensemble { presence: WhitecapMode::Drawn, ..Ensemble::new(&cast).unwrap() };
        let samples = ensemble.sample(&[engagement], &|_| ()).unwrap();
        let peak = nodes[0].iter().map(|m| m.facets).fold(0.0, f64::max);
        let mut count = 0;
        for (k, o) in directions.iter().enumerate().filter(|(k, _)| nodes[0][*k].facets > 1e-3 * peak) {
            let found: Vec<_> =
                nodes.iter().map(|node| brdf(&water, &node[k], planes.source(), *o)).collect();
            let average = found.iter().map(|f| f[0]).sum::<f64>() / 8.0;
            let own = (found.iter().map(|f| (f[0] - average).powi(2)).sum::<f64>() / 7.0).sqrt();
            let [mean, spread] = found[0];
            let wanted = samples.statistics(0, k, &[]).unwrap();
            let off = (mean - wanted.mean) / wanted.sem.hypot(own);
            let at = format!("w* {w} incidence {incidence} theta_r {:+.1}", thetas[k].to_degrees());
            assert!(off.abs() < 4.0, "{at}: {mean} of {}, {off} standard errors", wanted.mean);
            // The spread of a far flank takes more draws than there are.
            if nodes[0][k].facets > 0.05 * peak {
                assert!((spread / wanted.std - 1.0).abs() < 0.1, "{at}: {spread} of {}", wanted.std);
            }
            count += 1;
        }
        assert!(count >= 2);
    }
}

/// The share of whitecaps is Eq. 51's whatever the footprint, as wherever they are calibrated.
#[test]
fn whitecaps_cover_the_fraction_at_every_footprint() {
    for (w, footprint) in [(12.0, 0.02), (24.0, 0.3), (40.0, 0.05), (56.0, 0.15), (62.9, 1.0)] {
        let water = with(&sea(w, 20.0, 100), |p| p.footprint = Some(footprint));
        let lobe = EmpiricalLobe::new(&water, Table::standard()).unwrap();
        let whitecaps = Parts::WHITECAPS;
        let f = lobe.eval_parts([0.0, 0.0, 1.0], [0.28, 0.0, 0.96], whitecaps);
        let share = f / water.local_lobe().whitecap_brdf;
        assert!((share / water.whitecap_fraction - 1.0).abs() < 0.01, "{w} {footprint}: {share}");
    }
}

/// A sea of three components has no exact statistics, and no table.
#[test]
fn few_components_are_refused() {
    let water = with(&sea(24.0, 20.0, 100), |p| p.components = 3);
    assert_eq!(ReferenceModel::new(&water).unwrap_err().parameters(), ["components"]);
    assert_eq!(Plan::new(&water.parameters, &Grid::default()).unwrap_err().parameters(), ["components"]);
}

/// What the empirical model is off the full one at points at random: in the plane where that is above 1 % of its peak, the
/// largest of each point; and across it to 1.5 sigma within 15 degrees of the specular direction.
#[derive(Default)]
struct HeldOut {
    in_plane: Vec<f64>,
    /// Wherever that is, and where f is above 1 % of its peak.
    report: [Vec<f64>; 2],
    slopes: [Vec<f64>; 2],
}

fn held_out(points: usize, seed: u64) -> HeldOut {
    let table = Table::standard();
    let mut rng = StdRng::seed_from_u64(seed);
    let mut found = HeldOut::default();
    let geometric = |t: f64, [low, high]: [f64; 2]| low * f64::powf(high / low, t);
    for _ in 0..points {
        let w = geometric(rng.random(), [2.0, 62.9]);
        let footprint = geometric(rng.random(), [0.02, 1.0]);
        let (incidence, azimuth) = (85.0 * rng.random::<f64>(), 360.0 * rng.random::<f64>());
        let wavelength = geometric(rng.random(), [0.3, 12.0]);
        let water = with(&sea(w, azimuth, 65_536), |p| {
            (p.footprint, p.wavelength, p.ior, p.seed) = (Some(footprint), wavelength, None, 12_345);
        });
        let full = full(&water);
        let planes = planes(incidence.to_radians());
        let source = planes.source();
        let lobes = [OffPlaneModel::Report, OffPlaneModel::Slopes]
            .map(|across| EmpiricalLobe::new(&with(&water, |p| p.across = across), table).unwrap());
        let off = |lobe: &EmpiricalLobe, o: [f64; 3], m: &Moments| {
            lobe.estimate(source, o).mean / brdf(&water, m, source, o)[0] - 1.0
        };
        let directions: Vec<_> =
            radians((-29..=29).map(|k| 3.0 * f64::from(k))).into_iter().map(|t| planes.in_plane(t)).collect();
        let moments = full.moments(&planes, &directions).unwrap();
        let values: Vec<f64> =
            directions.iter().zip(&moments).map(|(o, m)| brdf(&water, m, source, *o)[0]).collect();
        let peak = values.iter().copied().fold(0.0, f64::max);
        let worst = |errors: Vec<f64>| {
            errors.into_iter().fold(0.0, |a: f64, b| if b.is_nan() || b.abs() > a.abs() { b } else { a })
        };
        let seen = (0..directions.len()).filter(|k| values[*k] > 0.01 * peak);
        found.in_plane.push(worst(seen.map(|k| off(&lobes[0], directions[k], &moments[k])).collect()));

        let node = full.node(incidence.to_radians(), &[]).unwrap();
        let mut around = vec![];
        for theta in [-15.0f64, -7.5, 0.0, 7.5, 15.0].map(|t| (incidence + t).to_radians()) {
            let sigma = prob_water::planes::width(node.sigma, planes.incidence, theta);
            for x in [-1.5, -0.75, 0.0, 0.75, 1.5] {
                if theta < 88f64.to_radians() {
                    around.push(off_plane(&planes, theta, node.delta + x * sigma));
                }
            }
        }
        let moments = full.moments(&planes, &around).unwrap();
        for (lobe, errors) in lobes.iter().zip([&mut found.report, &mut found.slopes]) {
            let all = around.iter().zip(&moments);
            for (o, m) in all.filter(|(_, m)| m.facets > 0.0) {
                let error = off(lobe, *o, m);
                errors[0].push(error);
                if brdf(&water, m, source, *o)[0] > 0.01 * peak {
                    errors[1].push(error);
                }
            }
        }
        println!(
            "w* {w:6.2} D {footprint:.3} incidence {incidence:4.1} wind {azimuth:5.1} wavelength {wavelength:5.2}: {:+.2} %",
            100.0 * found.in_plane[found.in_plane.len() - 1]
        );
    }
    found
}

fn share(errors: &[f64], limit: f64) -> f64 {
    errors.iter().filter(|e| e.abs() <= limit).count() as f64 / errors.len() as f64
}

fn quantile(errors: &[f64], level: f64) -> f64 {
    let mut sizes: Vec<f64> = errors.iter().map(|e| e.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    sizes[((sizes.len() - 1) as f64 * level).round() as usize]
}

fn show(found: &HeldOut) {
    let [report, slopes] = [&found.report, &found.slopes];
    for (name, errors, limit) in [
        ("in plane, worst of a point", &found.in_plane, 0.05),
        ("across it, report", &report[0], 0.1),
        ("  above 1 % of the peak", &report[1], 0.1),
        ("across it, slopes", &slopes[0], 0.1),
        ("  above 1 % of the peak", &slopes[1], 0.1),
    ] {
        println!(
            "{name}: {} within {:.0} %: {:.1} %; median {:.2} %, 95 of 100 {:.2} %, largest {:.2} %",
            errors.len(),
            100.0 * limit,
            100.0 * share(errors, limit),
            100.0 * quantile(errors, 0.5),
            100.0 * quantile(errors, 0.95),
            100.0 * quantile(errors, 1.0)
        );
    }
}

/// Between nodes; `cargo xtask verify` takes 240 points.
#[test]
fn between_nodes() {
    let found = held_out(6, 1);
    show(&found);
    assert!(quantile(&found.in_plane, 1.0) < 0.05);
    assert!(share(&found.slopes[0], 0.1) > 0.98 && share(&found.slopes[1], 0.1) > 0.98);
}

#[test]
#[ignore = "minutes: run by cargo xtask verify"]
fn between_many_nodes() {
    let found = held_out(240, 2);
    show(&found);
    // What is left are flanks a few degrees above the horizon, where nodes and reference are drawn.
    assert!(share(&found.in_plane, 0.05) > 0.99 && quantile(&found.in_plane, 1.0) < 0.15);
    assert!(share(&found.slopes[0], 0.1) > 0.99 && share(&found.slopes[1], 0.1) > 0.99);
}

/// Across the plane through the specular direction, against the full model to 1.5 sigma: Eq. 91 within 18 % of its relative
/// spread, and Eq. 90 within 7 % of its mean, at 20 points where the wind lies along the plane.
#[test]
fn across_the_plane() {
    let mut worst = [0.0f64; 2];
    for (w, incidence) in [(8.0, 30.0f64), (24.0, 30.0), (24.0, 50.0), (40.0, 10.0), (16.0, 60.0)] {
        let water = with(&sea(w, 0.0, 16_384), |p| p.seed = 4);
        let lobe = EmpiricalLobe::new(&water, Table::standard()).unwrap();
        let planes = planes(incidence.to_radians());
        let full = full(&water);
        let node = full.node(planes.incidence, &[]).unwrap();
        let sigma = node.sigma * planes.incidence.cos();
        for step in [0.0, 0.5, 1.0, 1.5] {
            let o = planes.across(node.delta + step * sigma);
            let moments = full.moments(&planes, &[o]).unwrap()[0];
            let [mean, spread] = brdf(&water, &moments, planes.source(), o);
            let found = lobe.estimate(planes.source(), o);
            let relative = [found.std / found.mean, spread / mean];
            let off = [found.mean / mean - 1.0, relative[0] / relative[1] - 1.0];
            worst = [0, 1].map(|m| worse(worst[m], off[m].abs()));
        }
    }
    let [mean, spread] = worst;
    assert!(mean < 0.07 && spread < 0.18, "regression pins, of 0.060 and 0.164 measured: {mean} {spread}");
}

/// Draws through the spreads have Eq. 90's mean, whatever the spread of the offsets, and a spread near the full model's.
#[test]
fn monte_carlo_dilutes_nothing_twice() {
    let draws = NonZeroU32::new(1 << 16).unwrap();
    for (w, azimuth, incidence) in [(8.0, 0.0, 30.0f64), (40.0, 90.0, 10.0), (24.0, 0.0, 50.0)] {
        let water = with(&sea(w, azimuth, 16_384), |p| p.whitecaps = true);
        let lobe = EmpiricalLobe::new(&water, Table::standard()).unwrap();
        let planes = planes(incidence.to_radians());
        let full = full(&water);
        let sigma = full.node(planes.incidence, &[]).unwrap().sigma * planes.incidence.cos();
        for step in [0.0, 0.5, 1.0, 1.5] {
            let o = planes.across(step * sigma);
            let drawn = lobe.monte_carlo(planes.source(), o, draws, 1, &[0.01]);
            let formula = lobe.estimate(planes.source(), o);
            let moments = full.moments(&planes, &[o]).unwrap()[0];
            let [_, spread] = brdf(&water, &moments, planes.source(), o);
            let at =
                format!("w* {w} at {step} sigma: {drawn:?}, Eqs. 90-91 {formula:?}, full spread {spread}");
            assert!((drawn.mean / formula.mean - 1.0).abs() < 0.05, "{at}");
            assert!((drawn.std / spread - 1.0).abs() < 0.35, "{at}");
            assert!(drawn.quantiles.windows(2).all(|q| q[0] <= q[1]) && drawn.min >= 0.0);
            assert!((0.0..=1.0).contains(&drawn.over[0]) && drawn.mean_f_cos.is_nan());
        }
        let slopes =
            EmpiricalLobe::new(&with(&water, |p| p.across = OffPlaneModel::Slopes), Table::standard())
                .unwrap();
        let o = planes.across(sigma);
        let (drawn, formula) =
            (slopes.monte_carlo(planes.source(), o, draws, 1, &[]), slopes.estimate(planes.source(), o));
        assert!(
            (drawn.mean / formula.mean - 1.0).abs() < 0.02 && (drawn.std / formula.std - 1.0).abs() < 0.1
        );
    }
}

/// Float32 follows float64; nothing is negative or not a number, above and below the horizon.
#[test]
fn evaluation_holds_everywhere() {
    let mut rng = StdRng::seed_from_u64(5);
    for (w, footprint, across) in [
        (2.0, 0.02, OffPlaneModel::Report),
        (8.0, 0.15, OffPlaneModel::Report),
        (62.9, 1.0, OffPlaneModel::Report),
        (24.0, 0.3, OffPlaneModel::Slopes),
    ] {
        let water = with(&sea(w, 37.0, 1), |p| (p.footprint, p.across) = (Some(footprint), across));
        let lobe = EmpiricalLobe::new(&water, Table::standard()).unwrap();
        let mut direction = |low: f64| {
            let (z, phi): (f64, f64) =
                (rng.random_range(low..=1.0), rng.random_range(0.0..std::f64::consts::TAU));
            let r = (1.0 - z * z).sqrt();
            [r * phi.cos(), r * phi.sin(), z]
        };
        let mut peak = 0.0f64;
        for _ in 0..20_000 {
            let [i, o] = [direction(-0.2), direction(-0.2)];
            let [i32, o32] = [i, o].map(|v| v.map(|x| x as f32));
            let f = lobe.eval(i, o);
            let single = f64::from(lobe.eval(i32, o32));
            let estimate = lobe.estimate(i, o);
            assert!(
                f.is_finite()
                    && f >= 0.0
                    && single.is_finite()
                    && estimate.std.is_finite()
                    && estimate.std >= 0.0
            );
            assert!(f == 0.0 || (i[2] > 0.0 && o[2] > 0.0));
            assert!((estimate.mean - f).abs() <= 1e-9 * f + 1e-200);
            peak = peak.max(f);
            assert!((single - f).abs() < 2e-4 * f + 1e-6 * peak.max(1e-30), "{single} {f} {i:?} {o:?}");
        }
        for (i, o) in [
            ([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]),
            ([1.0, 0.0, 1e-9], [-1.0, 0.0, 1e-9]),
            ([0.0, 0.0, 1.0], [1.0, 0.0, 1e-12]),
            ([1e-9, 0.0, 1.0], [0.0, 1.0, 1e-300]),
        ] {
            let f: f64 = lobe.eval(i, o);
            assert!(f.is_finite() && f >= 0.0, "{i:?} {o:?}: {f}");
            assert!(lobe.eval(i.map(|x| x as f32), o.map(|x| x as f32)).is_finite());
        }
    }
}

/// The wind's azimuth counts from the plane of incidence: the whole turned gives the same, and so does its mirror image.
#[test]
fn only_the_angle_to_the_wind_counts() {
    for across in [OffPlaneModel::Report, OffPlaneModel::Slopes] {
        let lobe = |direction: f64| {
            let water = with(&sea(16.0, direction, 1), |p| p.across = across);
            EmpiricalLobe::new(&water, Table::standard()).unwrap()
        };
        let at = |theta: f64, phi: f64| [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()];
        let (one, turned, mirrored) = (lobe(20.0), lobe(75.0), lobe(-20.0));
        let turn = 55f64.to_radians();
        for (ti, pi, to, po) in [(0.5, 0.3, 0.7, 3.0), (1.2, -2.0, 1.1, 1.5), (0.2, 3.0, 0.9, 0.1)] {
            let f = one.eval(at(ti, pi), at(to, po));
            assert!((turned.eval(at(ti, pi + turn), at(to, po + turn)) / f - 1.0).abs() < 1e-9);
            assert!((mirrored.eval(at(ti, -pi), at(to, -po)) / f - 1.0).abs() < 1e-9);
        }
    }
}

/// Whatever lies outside of the table is refused once, or told of every time.
#[test]
fn what_the_table_does_not_know() {
    let water = sea(8.0, 0.0, 1);
    let table = Table::standard();
    type Change = fn(&mut Parameters);
    let refused: [(&str, Change); 14] = [
        ("components", |p| p.components = 6),
        ("depth", |p| p.depth = 10.0),
        ("fetch", |p| p.fetch = 1e4),
        ("water", |p| p.water = prob_water::Salinity::Fresh),
        ("slope_measure", |p| p.slope_measure = prob_water::SlopeMeasure::Slope),
        ("readings", |p| p.readings = prob_water::Readings::AS_PRINTED),
        ("whitecaps", |p| p.whitecaps = false),
        ("shadowing", |p| p.shadowing = false),
        ("hiding", |p| p.hiding = prob_water::Hiding::Once),
        ("gram_charlier", |p| p.gram_charlier = false),
        ("friction_velocity", |p| p.wind = Wind::FrictionVelocity(1.9)),
        ("wind_speed", |p| p.wind = Wind::Speed { speed: 30.0, height: 10.0 }),
        ("beaufort", |p| p.wind = Wind::Beaufort(9)),
        ("footprint", |p| p.footprint = Some(f64::INFINITY)),
    ];
    for (name, change) in refused {
        let error = EmpiricalLobe::new(&with(&water, change), table).unwrap_err();
        assert_eq!(error.parameters(), [name]);
        assert!(error.to_string().contains("table"), "{error}");
    }
    // These do not matter to it.
    let free = with(&water, |p| {
        (p.instances, p.seed, p.time, p.wavelength) = (7, 8, 9.0, 1.5);
        p.fresnel = prob_water::Fresnel::Exact;
    });
    assert!(EmpiricalLobe::new(&free, table).is_ok());

    let lobe = EmpiricalLobe::new(&water, table).unwrap();
    let at = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        [sin, 0.0, cos]
    };
    assert!(!lobe.estimate(at(-85.0), at(80.0)).outside);
    assert!(lobe.estimate(at(-85.1), at(80.0)).outside);
    assert!(!lobe.estimate(at(-30.0), at(88.0)).outside);
    assert!(lobe.estimate(at(-30.0), at(88.1)).outside);
    assert!(lobe.estimate(at(-30.0), at(-89.0)).outside);
}

/// A table of other switches, on a grid of one wind, one footprint and one azimuth.
#[test]
fn tables_of_ones_own() {
    let water = with(&sea(24.0, 0.0, 500), |p| {
        (p.whitecaps, p.hiding) = (false, prob_water::Hiding::Once);
        p.readings = prob_water::Readings::EQ_71_73;
    });
    let grid = Grid {
        friction_velocity: vec![24.0],
        footprint: vec![0.15],
        incidence: vec![30.0],
        wind_azimuth: vec![0.0],
        ..Grid::default()
    };
    let plan = Plan::new(&water.parameters, &grid).unwrap();
    assert_eq!((plan.rows(), plan.row_len()), (1, 5 + 4 * 47));
    let table = plan.table().unwrap();
    let lobe = EmpiricalLobe::new(&water, &table).unwrap();
    let node = table.node([0, 0, 0, 0]);
    let planes = planes(30f64.to_radians());
    // At a node the lobe is the node's.
    for k in [16, 22, 28, 36] {
        let o = planes.in_plane(grid.theta_r[k].to_radians());
        let [mean, _] = brdf(&water, &node.in_plane[k], planes.source(), o);
        let off = (node.delta / (node.sigma * planes.incidence.cos())).powi(2);
        let found = lobe.estimate(planes.source(), o).mean;
        assert!((found / mean - 1.0).abs() < 0.02 + off, "{found} {mean}");
    }
    assert!(Table::read(&table.to_bytes(), "").unwrap() == table);
}

/// Far from the mirror in a light wind, where the mean square of Gaussian slopes is beyond any number.
#[test]
fn uncertainties_are_finite_far_from_the_mirror() {
    for across in [OffPlaneModel::Report, OffPlaneModel::Slopes] {
        let water = with(&sea(2.0, 0.0, 50), |p| (p.ior, p.footprint, p.across) = (None, Some(0.02), across));
        let lobe = EmpiricalLobe::new(&water, Table::standard()).unwrap();
        for source in 0..36 {
            for observer in 0..36 {
                let [i, o] = [source, observer].map(|azimuth| {
                    let (sin, cos) = (f64::from(azimuth) * 10.0).to_radians().sin_cos();
                    [0.9999 * cos, 0.9999 * sin, 0.014]
                });
                let estimate = lobe.estimate(i, o);
                assert!(estimate.mean.is_finite() && estimate.std.is_finite(), "{i:?} {o:?}: {estimate:?}");
            }
        }
    }
}

/// Draws by the table place quantiles at levels that are off by no more than `share_error`, against drawn surfaces: in nine
/// rows of ten, and low views are seen as often as they are.
#[test]
fn quantiles_by_the_table() {
    let (mut rows, mut wrong, mut largest) = (0, 0, 0.0f64);
    for (w, footprint, incidence) in
        [(8.0, 0.15, 30.0), (24.0, 0.15, 75.0), (40.0, 0.5, 60.0), (16.0, 0.1, 80.0)]
    {
        let water = Parameters {
            wind: Wind::FrictionVelocity(w),
            surface: Surface::Empirical,
            footprint: Some(footprint),
            instances: 4000,
            across: OffPlaneModel::Slopes,
            ..Parameters::default()
        }
        .configure()
        .unwrap();
        let lobe = EmpiricalLobe::new(&water, Table::standard()).unwrap();
        let views: Vec<_> = [0.0, 20.0, 40.0, 60.0, 75.0, 80.0, 85.0]
            .iter()
            .map(|a: &f64| [a.to_radians().sin(), 0.0, a.to_radians().cos()])
            .collect();
        let engagement = Engagement::far(incidence, 10e3, &views, 1e5).unwrap();
        let samples =
            Ensemble::new(&water).unwrap().sample(std::slice::from_ref(&engagement), &|_| ()).unwrap();
        for (o, [i, view]) in engagement.ways().enumerate() {
            let (found, _) = lobe.statistics(i, view, NonZeroU32::new(4000).unwrap(), 1, &[0.0]);
            let drawn: Vec<f64> = samples.of(0, o).unwrap().map(|s| s.seen.f).collect();
            let share = |of: &dyn Fn(f64) -> bool| {
                drawn.iter().filter(|f| of(**f)).count() as f64 / drawn.len() as f64
            };
            for (quantile, level) in found.quantiles.iter().zip(prob_water::statistics::QUANTILES) {
                // A quantile stands for every level between the shares below it and not above it.
                let (below, up_to) = (share(&|f| f < *quantile), share(&|f| f <= *quantile));
                let off = (below - level).max(level - up_to).max(0.0);
                rows += 1;
                wrong += i32::from(off > found.share_error);
                largest = largest.max(off / found.share_error);
            }
            let (seen, expected) = (found.over[0], share(&|f| f > 0.0));
            assert!(
                (seen - expected).abs() < 0.15,
                "w* {w} view {o}: seen {seen}, by the ray cast {expected}"
            );
        }
    }
    assert!(10 * wrong <= rows && largest > 0.3, "{wrong} of {rows}, {largest}");
}
