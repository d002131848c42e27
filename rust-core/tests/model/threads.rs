//! One sea, lobe or table used by many threads at once: every thread gets, bit for bit, what a single one gets.

use crate::common::{direction, water};
use prob_water::brdf::up;
use prob_water::{
    EmpiricalLobe, EnsembleLobe, FacetTable, InstanceLobe, OffPlaneModel, Parameters, Surface, Table, Water,
    Wind,
};
use rand::rngs::StdRng;
use rand::{Rng, SeedableRng};

const THREADS: usize = 8;
const ROWS: usize = 400;

type Row = ([f64; 3], [f64; 3], [f64; 3]);

/// Directions to source and observer, some of them grazing or from below, and three uniform numbers.
fn rows() -> Vec<Row> {
    let mut rng = StdRng::seed_from_u64(8);
    let any = |rng: &mut StdRng| direction(rng.random_range(0.0..91.0), rng.random_range(0.0..360.0));
    (0..ROWS).map(|_| (any(&mut rng), any(&mut rng), rng.random())).collect()
}

/// The bits that `value` makes of all rows, by one thread and by many at the same time.
#[track_caller]
fn same(value: impl Fn(&Row) -> Vec<f64> + Sync) {
    let rows = rows();
    let bits = || -> Vec<u64> { rows.iter().flat_map(&value).map(f64::to_bits).collect() };
    let expected = bits();
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..THREADS).map(|_| scope.spawn(bits)).collect();
        for thread in threads {
            assert!(thread.join().unwrap() == expected);
        }
    });
}

fn drawn(surface: Surface) -> Water {
    water(24.0, |p| (p.surface, p.footprint, p.whitecaps) = (surface, Some(0.15), true))
}

#[test]
fn lobes() {
    let sea = water(2.0, |p| p.whitecaps = true);
    let single = sea.local_lobe().cast::<f32>();
    same(|(i, o, u)| {
        let s = sea.local_lobe().sample(*i, up(), *u);
        let [i32, o32] = [i, o].map(|v| v.map(|x| x as f32));
        let f = [
            sea.local_lobe().eval(*i, *o, up()),
            sea.local_lobe().pdf(*i, *o, up()),
            single.eval(i32, o32, up()).into(),
        ];
        [&f, &s.direction, &[s.pdf, s.f][..]].concat()
    });
}

#[test]
fn configuration() {
    same(|(_, _, u)| {
        let wind = Wind::Speed { speed: 20.0 * u[0], height: 10.0 };
        let sea =
            Parameters { wind, footprint: Some(u[1] + 1e-3), ..Parameters::default() }.configure().unwrap();
        let f = &sea.local_lobe().facets;
        vec![sea.wind.friction_velocity, f.sigma_u, f.sigma_c, f.proposal[0], sea.whitecap_fraction]
    });
}

#[test]
fn facets_by_footprint() {
    let sea = water(8.0, |_| ());
    let table = FacetTable::new(&sea);
    same(|(i, o, u)| {
        let mut lobe = sea.local_lobe();
        table.set(&mut lobe.facets, 10.0 * u[0]);
        vec![lobe.eval(*i, *o, up())]
    });
}

#[test]
fn empirical() {
    let sea = Parameters { across: OffPlaneModel::Slopes, ..drawn(Surface::Empirical).parameters }
        .configure()
        .unwrap();
    let lobe = EmpiricalLobe::new(&sea, Table::standard()).unwrap();
    same(|(i, o, _)| {
        let estimate = lobe.estimate(*i, *o);
        vec![lobe.eval(*i, *o), estimate.mean, estimate.std]
    });
}

#[test]
fn ensemble_and_instance() {
    let ensemble = EnsembleLobe::new(&drawn(Surface::Ensemble)).unwrap();
    let instance = InstanceLobe::new(&drawn(Surface::Instance)).unwrap();
    same(|(i, o, u)| vec![ensemble.eval(*i, *o), instance.eval(*i, *o, [1e3 * u[0], 1e3 * u[1]])]);
}

/// Read for the first time by all of them at once.
#[test]
fn tables() {
    let bytes = Table::standard().to_bytes();
    std::thread::scope(|scope| {
        for _ in 0..THREADS {
            scope.spawn(|| assert!(Table::read(&bytes, "standard").unwrap() == *Table::standard()));
        }
    });
}
