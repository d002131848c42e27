//! A coordinate that is not a number: what is evaluated is none either, and batches refuse it.

use prob_water::batch::{Columns, Rows};
use prob_water::brdf::Parts;
use prob_water::real::Vec3;
use prob_water::{
    Average, EmpiricalLobe, EnsembleLobe, Fresnel, InstanceLobe, Lobe, OffPlaneModel, Parameters, Readings,
    Scalar, SlopeMeasure, Surface, Table, Water,
};

const UP: Vec3<f64> = [0.0, 0.0, 1.0];
const SOURCE: Vec3<f64> = [0.6, 0.0, 0.8];
/// Towards the mirror, elsewhere, level with the horizon and below it.
const OBSERVERS: [Vec3<f64>; 4] = [[-0.6, 0.0, 0.8], [0.0, 0.6, 0.8], [1.0, 0.0, 0.0], [0.6, 0.0, -0.8]];
const PARTS: [Parts; 3] = [Parts::ALL, Parts::FACETS, Parts::WHITECAPS];

/// A vector with one or all of its coordinates not a number.
fn broken(v: Vec3<f64>) -> [Vec3<f64>; 4] {
    [0, 1, 2, 3].map(|at| std::array::from_fn(|k| if k == at || at == 3 { f64::NAN } else { v[k] }))
}

fn seas() -> Vec<Parameters> {
    let defaults = Parameters::default();
    vec![
        defaults,
        Parameters { wind_direction: 30.0, slope_measure: SlopeMeasure::Slope, ..defaults },
        Parameters { fresnel: Fresnel::Exact, shadowing: false, gram_charlier: false, ..defaults },
        Parameters { readings: Readings::AS_PRINTED, whitecaps: false, ..defaults },
        // With the bound of a calm sea.
        Parameters { wind: prob_water::Wind::FrictionVelocity(2.0), ..defaults },
    ]
}

fn sea(surface: Surface, change: impl FnOnce(&mut Parameters)) -> Water {
    let mut p =
        Parameters { surface, wind: prob_water::Wind::FrictionVelocity(8.0), ..Parameters::default() };
    change(&mut p);
    p.configure().unwrap()
}

/// Every pair of directions of which one is broken, to source and observer.
fn pairs() -> Vec<[Vec3<f64>; 2]> {
    let sources = OBSERVERS.map(|o| broken(SOURCE).map(|i| [i, o]));
    let observers = OBSERVERS.map(|o| broken(o).map(|o| [SOURCE, o]));
    sources.into_iter().chain(observers).flatten().collect()
}

fn lobe<T: Scalar>(lobe: &Lobe<T>) {
    let of = |v: Vec3<f64>| v.map(T::of);
    for parts in PARTS {
        let nothing = |i: Vec3<f64>, o: Vec3<f64>, n: Option<Vec3<f64>>| {
            let (i, o, n) = (of(i), of(o), n.map(of));
            let found = [
                lobe.eval_parts(i, o, n, parts),
                lobe.pdf_parts(i, o, n, parts),
                lobe.on_wave(i, o, n, parts),
            ];
            for x in found {
                assert!(x.to_f64().is_nan(), "{i:?} {o:?} {n:?} {parts:?}: {found:?}");
            }
        };
        for [i, o] in pairs() {
            nothing(i, o, None);
            nothing(i, o, Some(UP));
        }
        for o in OBSERVERS {
            broken(UP).into_iter().for_each(|n| nothing(SOURCE, o, Some(n)));
        }
        for i in broken(SOURCE) {
            for n in [None, Some(of(UP))] {
                let s = lobe.sample_parts(of(i), n, [0.3, 0.7, 0.2].map(T::of), parts);
                assert!(s.pdf.to_f64().is_nan() && s.f.to_f64().is_nan(), "{s:?}");
            }
        }
    }
    for i in broken(SOURCE) {
        for o in OBSERVERS {
            assert!(lobe.facets.eval(of(i), of(o), None).to_f64().is_nan());
        }
    }
}

#[test]
fn closed_form() {
    for parameters in seas() {
        let water = parameters.configure().unwrap();
        lobe::<f64>(&water.lobe().unwrap());
        lobe::<f32>(&water.lobe().unwrap().cast());
    }
}

#[test]
fn seas_from_afar() {
    for average in [Average::Power, Average::Report] {
        // Winds with and without whitecaps, and a calm without waves.
        for w in [24.0, 8.0, 0.0] {
            let wind = prob_water::Wind::FrictionVelocity(w);
            let lobe = EnsembleLobe::new(&sea(Surface::Ensemble, |p| (p.average, p.wind) = (average, wind)))
                .unwrap();
            for parts in PARTS {
                for [i, o] in pairs() {
                    let f = lobe.eval_parts(i, o, parts);
                    assert!(f.is_nan(), "{average:?} {parts:?} {i:?} {o:?}: {f}");
                }
            }
        }
    }
    for across in [OffPlaneModel::Report, OffPlaneModel::Slopes] {
        let lobe =
            EmpiricalLobe::new(&sea(Surface::Empirical, |p| p.across = across), Table::standard()).unwrap();
        for [i, o] in pairs() {
            let [i32, o32] = [i, o].map(|v| v.map(|x| x as f32));
            for parts in PARTS {
                let found = [lobe.eval_parts(i, o, parts), lobe.eval_parts(i32, o32, parts).into()];
                assert!(found.iter().all(|f| f.is_nan()), "{across:?} {parts:?} {i:?} {o:?}: {found:?}");
            }
            let estimate = lobe.estimate(i, o);
            assert!(estimate.mean.is_nan() && estimate.std.is_nan(), "{i:?} {o:?}: {estimate:?}");
        }
    }
}

#[test]
fn drawn_seas() {
    for whitecaps in [true, false] {
        let lobe = InstanceLobe::new(&sea(Surface::Instance, |p| p.whitecaps = whitecaps)).unwrap();
        for [i, o] in pairs() {
            assert!(lobe.eval(i, o, [3.0, 4.0]).is_nan(), "{i:?} {o:?}");
        }
        for place in [[f64::NAN, 0.0], [0.0, f64::NAN]] {
            for o in OBSERVERS {
                assert!(lobe.eval(SOURCE, o, place).is_nan(), "{place:?} {o:?}");
            }
        }
    }
}

/// The row is named, whichever of its vectors and coordinates it is, and nothing is written.
#[test]
fn batches_refuse() {
    let water = Parameters::default().configure().unwrap();
    let wide = water.lobe().unwrap();
    let single: Lobe<f32> = wide.cast();
    for (vector, name) in ["to_source", "to_observer", "normals"].into_iter().enumerate() {
        for bad in broken(UP) {
            let mut rows = [[SOURCE, OBSERVERS[0], UP]; 40];
            rows[17][vector] = bad;
            let column = |v: usize| rows.map(|row| row[v]);
            let [i, o, n] = [column(0), column(1), column(2)];
            let error = Rows::new(&i, &o, Some(&n)).unwrap_err().to_string();
            assert!(error.starts_with(&format!("row 18: {name} = (")), "{error}");
            let [i, o, n] = [i, o, n].map(|v| v.map(|v| v.map(|x| x as f32)));
            assert!(Rows::new(&i, &o, Some(&n)).unwrap_err().to_string().starts_with("row 18"));
            let [i, o, n] = [i, o, n].map(|v| [0, 1, 2].map(|k| v.map(|v| v[k])));
            let [i, o, n] = [&i, &o, &n].map(|v| v.each_ref().map(|x| &x[..]));
            let error = Columns::new(i, o, Some(n)).unwrap_err().to_string();
            assert!(error.starts_with(&format!("row 18: {name} = (")), "{error}");
        }
    }
    let mut f = [0.0; 1];
    Rows::new(&[SOURCE.map(|x| x as f32)], &[UP.map(|x| x as f32)], None)
        .unwrap()
        .eval(&single, &mut f)
        .unwrap();
    assert!(f[0] > 0.0);
}
