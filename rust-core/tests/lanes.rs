//! Lanes against the scalar text.

use prob_water::batch::Columns;
use prob_water::lanes::Level;
use prob_water::{Fresnel, Parameters, Readings, SlopeMeasure, Wind};
use rand::{Rng, SeedableRng, rngs::StdRng};
use std::time::Instant;

#[test]
fn quick_look() {
    let mut rng = StdRng::seed_from_u64(1);
    let n = 100_003;
    let mut dir = || {
        let (z, phi) = (rng.random_range(0.02..1.0f64), rng.random_range(0.0..std::f64::consts::TAU));
        let s = (1.0 - z * z).sqrt();
        [s * phi.cos(), s * phi.sin(), z].map(|x| x as f32)
    };
    let i: Vec<_> = (0..n).map(|_| dir()).collect();
    let o: Vec<_> = (0..n).map(|_| dir()).collect();
    let col = |v: &[[f32; 3]]| [0, 1, 2].map(|k| v.iter().map(|x| x[k]).collect::<Vec<_>>());
    let (ic, oc) = (col(&i), col(&o));
    let r = |v: &'static [Vec<f32>; 3]| v.each_ref().map(|x| &x[..]);
    let (ic, oc): (&'static _, &'static _) = (Box::leak(Box::new(ic)), Box::leak(Box::new(oc)));
    let columns = Columns::new(r(ic), r(oc), None).unwrap();
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().unwrap();
    for (w, angle, dirn, slope, exact) in [(24.0, true, 0.0, false, false), (24.0, true, 33.0, false, false), (8.0, false, 0.0, true, true), (56.0, false, 10.0, true, false), (3.0, true, 0.0, false, false)] {
        let _ = angle;
        let p = Parameters {
            wind: Wind::FrictionVelocity(w),
            wind_direction: dirn,
            slope_measure: if slope { SlopeMeasure::Slope } else { SlopeMeasure::Angle },
            fresnel: if exact { Fresnel::Exact } else { Fresnel::Schlick },
            readings: Readings::Corrected,
            ..Parameters::default()
        };
        let plain = Parameters { gram_charlier: false, ..p };
        let lobe = p.configure().unwrap().lobe;
        let plain = plain.configure().unwrap().lobe;
        let start = Instant::now();
        let wide = |v: [f32; 3]| v.map(f64::from);
        let f64s: Vec<f64> = (0..n).map(|k| lobe.eval(wide(i[k]), wide(o[k]), None)).collect();
        let t64 = start.elapsed().as_secs_f64() / n as f64 * 1e9;
        let size: Vec<f64> = (0..n).map(|k| plain.eval(wide(i[k]), wide(o[k]), None)).collect();
        let l32 = lobe.cast::<f32>();
        let start = Instant::now();
        let f32s: Vec<f32> = (0..n).map(|k| l32.eval(i[k], o[k], None)).collect();
        let t32 = start.elapsed().as_secs_f64() / n as f64 * 1e9;
        let err = |f: &[f32]| {
            f.iter().zip(&f64s).zip(&size).map(|((a, b), s)| (f64::from(*a) - b).abs() / s.max(1e-12)).fold(0.0, f64::max)
        };
        print!("w {w} f64 {t64:.1} ns, f32 {t32:.1} ns err {:.1e}", err(&f32s));
        for level in Level::ALL {
            let mut f = vec![0.0; n];
            columns.eval_on(level, &l32, &mut f).unwrap();
            let start = Instant::now();
            for _ in 0..20 {
                columns.eval_on(level, &l32, &mut f).unwrap();
            }
            let t = start.elapsed().as_secs_f64() / n as f64 / 20.0 * 1e9;
            print!("; {} {t:.2} ns err {:.1e}", level.name(), err(&f));
        }
        println!();
    }
}
