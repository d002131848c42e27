//! Every reading by itself: what it changes, and what it leaves alone. Reference rows of the facets' are in `reference.rs`.

use crate::common::{direction, water};
use prob_water::surface::{Draws, InstanceRng};
use prob_water::table::{Grid, Plan};
use prob_water::{
    EmpiricalLobe, Engagement, Ensemble, EnsembleLobe, Exact, Parameters, Readings, RealisedSurface,
    SlopeStatistics, Surface, Water, WhitecapMode,
};
use std::f64::consts::PI;

fn sea(w: f64, change: impl FnOnce(&mut Parameters)) -> Water {
    water(w, |p| {
        (p.surface, p.instances, p.whitecaps) = (Surface::Instance, 2000, true);
        change(p);
    })
}

/// The factor of Eq. 56 by itself, in a calm with its bound and in a storm, about any normal.
#[test]
fn eq_56_is_pi_times_as_much() {
    let n = [-0.1, 0.2, 0.95f64.sqrt()];
    for w in [0.0, 2.0, 8.0, 56.0] {
        let [read, printed] = [Readings::CORRECTED, Readings::EQ_56]
            .map(|readings| water(w, |p| p.readings = readings).local_lobe());
        for theta in [0.0, 30.0, 60.0, 80.0] {
            let (i, o) = (direction(theta, 180.0), direction(theta - 9.0, 4.0));
            let ratio = printed.eval(i, o, n) / read.eval(i, o, n);
            assert!((ratio / PI - 1.0).abs() < 1e-14, "{ratio}");
        }
    }
}

/// Eq. 22 as printed: waves down to k2 whatever D, and with the facets more slopes than Cox and Munk's.
#[test]
fn eq_22_as_printed_draws_short_waves_twice() {
    for w in [16.0, 56.0] {
        let slopes_of = |readings| {
            let sea = sea(w, |p| p.readings = readings);
            let waves = sea.waves();
            let variance = |instance| {
                let surface = waves.surface(InstanceRng::new(Draws::Sobol, 1, instance), 0.0);
                surface.point([0.0; 2]).slope.map(|s| s * s).iter().sum::<f64>()
            };
            let drawn = (0..4096).map(variance).sum::<f64>() / 4096.0;
            let [_, log_max] = waves.log_range.unwrap();
            (log_max.exp() / waves.spectrum.k2, drawn + sea.variances.iter().sum::<f64>(), sea.wind)
        };
        let (read, printed) = (slopes_of(Readings::CORRECTED), slopes_of(Readings::EQ_22));
        let all: f64 = SlopeStatistics::CoxMunk.total(&read.2).iter().sum();
        assert!(read.0 < 0.1 && (printed.0 - 1.0).abs() < 1e-12, "{} {}", read.0, printed.0);
        assert!(read.1 / all < 1.3 && printed.1 / all > 1.4, "{} {}", read.1 / all, printed.1 / all);
    }
}

/// Eqs. 43-45 as printed: two waves that run against each other have steep slopes and no steepest one.
#[test]
fn eq_43_45_as_printed_cancel() {
    let waves = sea(24.0, |_| ()).waves();
    let [mut a, mut b] = [0.0, PI].map(|azimuth| waves.component(0.05, 0.3, azimuth));
    (a.amplitude, b.amplitude) = (0.1, 0.1);
    let surface = RealisedSurface::new([a, b].into_iter(), 0.0);
    assert!(surface.signed_steepest() < 1e-15 && (surface.steepest() - 1.0).abs() < 1e-12);
    // Side by side the printed sums are the bound.
    let surface = RealisedSurface::new([a, a].into_iter(), 0.0);
    assert!((surface.signed_steepest() - surface.steepest()).abs() < 1e-15);
}

/// So obscuration is missed across the wind, and never found where there is none.
#[test]
fn eq_43_45_as_printed_miss_obscuration() {
    let obscured = |readings| -> Vec<Vec<bool>> {
        let sea = across_the_wind(|p| (p.readings, p.components) = (readings, 2));
        let samples = Ensemble::new(&sea).unwrap().sample(&[view_across()], &|_| ()).unwrap();
        (0..4).map(|o| samples.of(0, o).unwrap().map(|s| s.seen.obscured).collect()).collect()
    };
    let (read, printed) = (obscured(Readings::CORRECTED), obscured(Readings::EQ_43_45));
    let mut missed = 0;
    for (read, printed) in read.iter().flatten().zip(printed.iter().flatten()) {
        assert!(*read || !printed);
        missed += usize::from(*read && !printed);
    }
    assert!(missed > 20, "{missed}");
}

/// A storm across the plane of incidence.
fn across_the_wind(change: impl FnOnce(&mut Parameters)) -> Water {
    sea(56.0, |p| {
        (p.wind_direction, p.instances) = (90.0, 5000);
        change(p);
    })
}

fn view_across() -> Engagement {
    let views = [30.0, 70.0, 80.0, 85.0].map(|a| direction(a, 0.0));
    Engagement::far(30.0, 10e3, &views, 1e5).unwrap()
}

/// Eq. 70 as printed: the facets' density is about the vertical, whatever the wave's normal. Where that is not asked wave
/// by wave it is refused.
#[test]
fn eq_70_as_printed_leaves_facets_upright() {
    let lobe = water(8.0, |p| (p.readings, p.footprint, p.shadowing) = (Readings::EQ_70, Some(0.15), false));
    let lobe = lobe.local_lobe();
    let (i, o) = (direction(30.0, 180.0), direction(28.0, 3.0));
    let h: [f64; 3] = std::array::from_fn(|k| i[k] + o[k]);
    let length = h.iter().map(|x| x * x).sum::<f64>().sqrt();
    // f times the cosines and cos^4 xi is rho p/4.
    let density = |n: [f64; 3]| {
        let dot = |v: [f64; 3]| (0..3).map(|k| v[k] * n[k]).sum::<f64>();
        lobe.eval(i, o, n) * dot(i) * dot(o) * (dot(h) / length).powi(4)
    };
    let upright = density([0.0, 0.0, 1.0]);
    for (theta, phi) in [(5.0, 0.0), (20.0, 70.0), (30.0, 200.0)] {
        let tilted = density(direction(theta, phi));
        assert!((tilted / upright - 1.0).abs() < 1e-12, "{tilted} {upright}");
    }
    let refused = sea(8.0, |p| p.readings = Readings::EQ_70 | Readings::EQ_56);
    let error = Exact::new(&refused).unwrap_err();
    assert_eq!(error.parameters(), ["readings"]);
    assert!(error.to_string().contains("readings = 56, 70 is out of range"), "{error}");
    let refused = sea(8.0, |p| (p.surface, p.readings) = (Surface::Ensemble, Readings::EQ_70));
    assert!(EnsembleLobe::new(&refused).is_err());
}

fn table_of(readings: Readings, incidence: f64) -> (EmpiricalLobe, [f64; 2]) {
    let water = sea(16.0, |p| {
        (p.surface, p.instances, p.whitecaps, p.readings) = (Surface::Empirical, 500, false, readings);
    });
    let grid = Grid {
        friction_velocity: vec![16.0],
        footprint: vec![0.15],
        incidence: vec![incidence],
        wind_azimuth: vec![0.0],
        ..Grid::default()
    };
    let table = Plan::new(&water.parameters, &grid).unwrap().table().unwrap();
    let node = table.node([0, 0, 0, 0]);
    (EmpiricalLobe::new(&water, &table).unwrap(), [node.sigma, node.delta])
}

/// Eq. 88 as printed: unsigned, so that the table does not know the source's side from the specular one, nor a direction
/// aside from its mirror image.
#[test]
fn eq_88_as_printed_does_not_know_the_sides() {
    let [(read, _), (printed, _)] = [Readings::CORRECTED, Readings::EQ_88].map(|r| table_of(r, 30.0));
    let i = direction(30.0, 180.0);
    for theta in [10.0, 30.0, 50.0] {
        let [toward, back] = [direction(theta, 0.0), direction(theta, 180.0)];
        let (toward, back) =
            (|lobe: &EmpiricalLobe| lobe.eval(i, toward), |lobe: &EmpiricalLobe| lobe.eval(i, back));
        // rho differs between the two, little.
        assert!((back(&printed) / toward(&printed) - 1.0).abs() < 0.1, "{theta}");
        assert!((toward(&printed) / toward(&read) - 1.0).abs() < 1e-6, "{theta}");
        assert!(back(&read) < 0.8 * toward(&read), "{theta}");
    }
    let aside = |lobe: &EmpiricalLobe, y: f64| lobe.eval(i, direction(30.0, y));
    assert!((aside(&printed, 20.0) / aside(&printed, -20.0) - 1.0).abs() < 1e-12);
}

/// Eq. 82 as printed: angles out of plane scale with cos theta_i, which Eq. 89 takes back: the table's widths hardly change.
#[test]
fn eq_82_as_printed_has_the_widths_of_eq_89() {
    for incidence in [0.0, 30.0, 60.0] {
        let [(_, [read, _]), (_, [printed, _])] =
            [Readings::CORRECTED, Readings::EQ_82].map(|r| table_of(r, incidence));
        assert!((printed / read - 1.0).abs() < 0.05, "{incidence}: {printed} {read}");
        assert!(incidence == 0.0 || printed != read);
    }
}

/// Every reading changes a scenario of a storm or its table; none but 22 draws other waves.
#[test]
fn every_reading_matters() {
    let means = |readings| {
        let sea = across_the_wind(|p| {
            (p.readings, p.components, p.ior, p.wavelength) = (readings, 2, None, 12.5);
        });
        let mut ensemble = Ensemble::new(&sea).unwrap();
        ensemble.presence = WhitecapMode::Expected;
        let samples = ensemble.sample(&[view_across()], &|_| ()).unwrap();
        let hit = samples.of(0, 0).unwrap().map(|s| s.hit.position[2]).sum::<f64>();
        (hit, [0, 1, 2, 3].map(|o| samples.statistics(0, o, &[]).unwrap().mean))
    };
    let read = means(Readings::CORRECTED);
    for (name, readings) in Readings::equations() {
        let printed = means(readings);
        assert_eq!(printed.0 == read.0, name != "22", "{name}");
        // Eqs. 82 and 88 are those of the table.
        assert_eq!(printed.1 == read.1, ["82", "88"].contains(&name), "{name}");
    }
}
