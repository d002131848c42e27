//! One evaluation of f: number types, and the empirical model.

use crate::{point, rms, seconds, write};
use prob_water::batch::Columns;
use prob_water::real::Vec3;
use prob_water::simd::SimdLevel;
use prob_water::{Aim, EmpiricalLobe, Engagement, Ensemble, Exact, Parameters, Scalar, Surface, Table, Wind};
use rand::{Rng, SeedableRng, rngs::StdRng};
use std::hint::black_box;
use std::path::Path;

/// Pairs of directions, uniform over the hemisphere down to an elevation of a degree.
const PAIRS: usize = 1 << 18;
/// Pairs with which a mean over surfaces is compared.
const MEANS: usize = 400;

/// The fronts `brdf`, of the flat sea, and `wavy`, of one with drawn waves.
pub fn front(repeats: usize, directory: &Path) {
    let mut rng = StdRng::seed_from_u64(1);
    // Float32 numbers for everyone: what is compared is the evaluation.
    let pairs: Vec<[Vec3<f32>; 2]> =
        (0..PAIRS).map(|_| [direction(&mut rng, 0.02), direction(&mut rng, 0.02)]).collect();
    flat(repeats, &pairs, directory);
    wavy(repeats, &pairs, &mut rng);
}

fn direction(rng: &mut StdRng, least: f64) -> Vec3<f32> {
    let (z, phi): (f64, f64) = (rng.random_range(least..1.0), rng.random_range(0.0..std::f64::consts::TAU));
    let s = (1.0 - z * z).sqrt();
    [s * phi.cos(), s * phi.sin(), z].map(|x| x as f32)
}

/// The flat sea, 5 m/s: errors are those of rounding, against float64.
fn flat(repeats: usize, pairs: &[[Vec3<f32>; 2]], directory: &Path) {
    let lobe = Parameters::default().configure().expect("the parameters are valid").local_lobe();
    let wide: Vec<_> = pairs.iter().map(|pair| pair.map(|v| v.map(f64::from))).collect();
    let reference: Vec<f64> = wide.iter().map(|[i, o]| lobe.eval(*i, *o, None)).collect();
    write(&directory.join("pairs.f32"), pairs.iter().flatten().flatten().map(|x| x.to_le_bytes()));
    write(&directory.join("brdf.f64"), reference.iter().map(|x| x.to_le_bytes()));

    let single = lobe.cast::<f32>();
    let mut out = vec![0.0f32; PAIRS];
    let mut out_wide = vec![0.0f64; PAIRS];
    let mut times = [(); 2].map(|()| vec![]);
    for _ in 0..=repeats {
        times[0].push(seconds(|| evaluate(&wide, &mut out_wide, |i, o| lobe.eval(i, o, None))));
        times[1].push(seconds(|| evaluate(pairs, &mut out, |i, o| single.eval(i, o, None))));
    }
    let per_pair = |times: &[f64]| times[1..].iter().map(|s| s / PAIRS as f64).collect::<Vec<_>>();
    point("brdf", "float64, scalar", "", 0.0, &per_pair(&times[0]));
    point("brdf", "float32, scalar", "", error(&out, &reference), &per_pair(&times[1]));

    let coordinates =
        |side: usize| [0, 1, 2].map(|k| pairs.iter().map(|pair| pair[side][k]).collect::<Vec<_>>());
    let (i, o) = (coordinates(0), coordinates(1));
    let [i, o] = [&i, &o].map(|v| v.each_ref().map(Vec::as_slice));
    let columns = Columns::new(i, o, None).expect("they are unit vectors");
    // One thread, as the others.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    for level in SimdLevel::ALL.into_iter().filter(|level| level.is_available()) {
        let mut eval = || columns.eval_on(level, &single, &mut out).expect("as many rows");
        let times: Vec<_> = (0..=repeats).map(|_| pool.install(|| seconds(&mut eval))).collect();
        point("brdf", "lanes", level.name(), error(&out, &reference), &per_pair(&times));
    }
}

fn evaluate<T: Scalar>(pairs: &[[Vec3<T>; 2]], out: &mut [T], f: impl Fn(Vec3<T>, Vec3<T>) -> T) {
    pairs.iter().zip(&mut *out).for_each(|([i, o], out)| *out = f(*i, *o));
    black_box(out);
}

/// Root mean square of the differences over that of the values.
fn error(found: &[f32], reference: &[f64]) -> f64 {
    rms(found.iter().zip(reference).map(|(a, b)| f64::from(*a) - b)) / rms(reference.iter().copied())
}

/// Drawn waves, w* = 8 cm/s, D = 0.15 m, within the table's angles: the empirical model and 50 draws against exact means.
/// The table's time is that of `many` pairs, all over it: of few it would stay in the cache.
fn wavy(repeats: usize, many: &[[Vec3<f32>; 2]], rng: &mut StdRng) {
    let parameters = Parameters {
        wind: Wind::FrictionVelocity(8.0),
        surface: Surface::Empirical,
        footprint: Some(0.15),
        instances: 50,
        ..Parameters::default()
    };
    let water = parameters.configure().expect("the parameters are valid");
    let lobe = EmpiricalLobe::new(&water, Table::standard()).expect("the table knows this sea");
    let exact = Exact::new(&water).expect("enough components");
    let pairs: Vec<[Vec3<f32>; 2]> = (0..MEANS).map(|_| [direction(rng, 0.1), direction(rng, 0.1)]).collect();
    let looks: Vec<_> = pairs
        .iter()
        .map(|[i, o]| {
            let far = |v: &Vec3<f32>, length: f64| v.map(|x| length * f64::from(x));
            Engagement::new(0.0, far(i, 10e3), Aim::Target([0.0; 3]), &[far(o, 100e3)]).expect("it is valid")
        })
        .collect();
    let means = |to: &mut Vec<f64>| *to = looks.iter().map(|look| exact.means(look)[0].f).collect();
    let mut reference = vec![];
    let ensemble = Ensemble::new(&water).expect("the sea has drawn waves");
    let mut drawn = vec![];
    let mut out = vec![0.0f32; MEANS];
    let mut out_of_many = vec![0.0f32; many.len()];
    let mut times = [(); 3].map(|()| vec![]);
    for _ in 0..=repeats {
        let all = seconds(|| evaluate(many, &mut out_of_many, |i, o| lobe.eval(i, o)));
        times[0].push(all * MEANS as f64 / many.len() as f64);
        evaluate(&pairs, &mut out, |i, o| lobe.eval(i, o));
        times[1].push(seconds(|| {
            drawn = looks
                .iter()
                .map(|look| {
                    let samples = ensemble.sample(std::slice::from_ref(look), &|_| ()).expect("it fits");
                    samples.statistics(0, 0, &[]).expect("they are there").mean as f32
                })
                .collect();
        }));
        times[2].push(seconds(|| means(&mut reference)));
    }
    let per_pair = |times: &[f64]| times[1..].iter().map(|s| s / MEANS as f64).collect::<Vec<_>>();
    point("wavy", "empirical table", "float32", error(&out, &reference), &per_pair(&times[0]));
    point("wavy", "drawn surfaces", "50", error(&drawn, &reference), &per_pair(&times[1]));
    point("wavy", "exact means", "", 0.0, &per_pair(&times[2]));
}
