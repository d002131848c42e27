//! Drawn surfaces: the lobe of one of them, rays cast onto them, and statistics of engagements as far off as may be.

use crate::draw::{Draw, Vec3};
use crate::means::{drawn_sea, pair};
use crate::tally::{Tally, fine, shown};
use prob_water::statistics::FARTHEST;
use prob_water::surface::InstanceRng;
use prob_water::surface::SurfaceRay;
use prob_water::{
    Aim, Draws, Engagement, Ensemble, Exact, InstanceLobe, Parameters, Proposal, Statistics, Surface,
    WhitecapMode,
};

/// One drawn sea on a level surface, at places near and far.
pub fn instance(draw: &mut Draw, tally: &mut Tally) {
    let sea = drawn_sea(draw, Surface::Instance);
    let water = sea.configure().expect("within the ranges of the vocabulary");
    let lobe = InstanceLobe::new(&water).expect("the sea has drawn waves");
    for _ in 0..1024 {
        let [i, o] = pair(draw);
        let place = place(draw);
        let (f, spot) = (lobe.eval(i, o, place), lobe.local(place, None));
        let length: f64 = spot.normal.iter().map(|x| x * x).sum();
        let whole = fine(f)
            && (length - 1.0).abs() < 1e-12
            && spot.normal[2] > 0.0
            && (0.0..=1.0).contains(&spot.whitecap);
        tally.check(whole, &sea, "instance", || {
            format!("{place:?} {spot:?} {}", shown(&[i, o, spot.normal], &[f]))
        });
        let below = i[2] <= 0.0 || o[2] <= 0.0;
        tally.check(!below || f == 0.0, &sea, "from below", || shown(&[i, o, spot.normal], &[f]));
    }
    tally.count("f at a place", 1024);
}

/// Rays onto drawn surfaces, half of them grazing: hits lie on the water, before the beam leaves it.
pub fn casts(draw: &mut Draw, tally: &mut Tally) {
    let mut sea = drawn_sea(draw, Surface::Instance);
    sea.components = draw.one_of(&[5, 20, 128, 512]);
    let sea = draw.about(sea);
    let waves = sea.configure().expect("within the ranges of the vocabulary").waves();
    let draws = draw.one_of(&[Draws::Random, Draws::Sobol, Draws::Stratified]);
    let surface = waves.surface(InstanceRng::new(draws, sea.seed, draw.bits() >> 32), sea.time);
    let mut path = SurfaceRay::default();
    let mut hits = 0;
    for _ in 0..32 {
        let incidence =
            if draw.flag() { draw.between(0.0, 85.0) } else { 90.0 - draw.log_between(2e-3, 5.0) };
        let up = draw.at(incidence);
        let [x, y] = if draw.flag() { [draw.between(-1e3, 1e3), draw.between(-1e3, 1e3)] } else { [0.0; 2] };
        let distance = draw.log_between(1e-2, 1e5);
        let origin = [x + distance * up[0], y + distance * up[1], distance * up[2]];
        let beam = up.map(|x| -x);
        let told = || format!("from {origin:?} along {beam:?}");
        let Some(hit) = path.first_hit(&surface, origin.into(), beam.into()) else {
            let under = origin[2] <= surface.height([origin[0], origin[1]]);
            tally.check(under, &sea, "no hit from above the water", told);
            continue;
        };
        hits += 1;
        let point = surface.point([hit.x, hit.y]);
        // Heights are good to rounding of the place, as steep as the water is there.
        let scale = 1.0 + hit.x.abs().max(hit.y.abs()) + surface.highest();
        let gap = (hit.z - point.height).abs();
        let allowed = 1e-9 * scale * (1.0 + surface.steepest());
        tally
            .check(gap <= allowed, &sea, "a hit off the water", || format!("{} {hit:?} gap {gap:e}", told()));
        let n: Vec3 = point.normal();
        let length: f64 = n.iter().map(|x| x * x).sum();
        tally.check((length - 1.0).abs() < 1e-12 && n[2] > 0.0, &sea, "a normal", || {
            format!("{} {n:?}", told())
        });
        let observer = draw.direction().map(|x| x * distance);
        if observer[2] > 0.0 {
            path.occludes(&surface, hit, observer.into());
        }
    }
    tally.count("rays", 32);
    tally.count("(hits)", hits);
}

/// Engagements with lasers and observers from a hair above the water to as far as they may be.
pub fn statistics(draw: &mut Draw, tally: &mut Tally) {
    let sea = drawn_sea(draw, Surface::Instance);
    let water = sea.configure().expect("within the ranges of the vocabulary");
    let (laser, aim) = (position(draw), position(draw));
    let observers: Vec<Vec3> = (0..4).map(|_| position(draw)).collect();
    let told = || format!("laser {laser:?}, aim {aim:?}, observers {observers:?}");
    let aim = if draw.flag() {
        Aim::Target([aim[0], aim[1], 0.0])
    } else {
        Aim::Direction([aim[0], aim[1], -aim[2]])
    };
    let Ok(engagement) = Engagement::new(sea.time, laser, aim, &observers) else {
        return tally.count("(engagements refused)", 1);
    };
    let ensemble = Ensemble::new(&water).expect("the sea has drawn waves");
    let ensemble = if draw.flag() { ensemble.around(&engagement) } else { ensemble };
    let few = sea.components < 4;
    let proposal = if few { Proposal::Auto } else { draw.one_of(&[Proposal::Plain, Proposal::Slopes]) };
    let presence = draw.one_of(&[WhitecapMode::Drawn, WhitecapMode::Expected]);
    let ensemble = Ensemble { presence, proposal, ..ensemble };
    match ensemble.sample(std::slice::from_ref(&engagement), &|_| ()) {
        Ok(samples) => {
            for observer in 0..observers.len() {
                let found = samples.statistics(0, observer, &[0.0, 1e-3, 1e3]).expect("they are there");
                tally.check(whole(&found, true), &sea, "statistics of draws", || {
                    format!("{} {found:?}", told())
                });
            }
        }
        Err(error) => tally.violation(&sea, &error.to_string(), &told()),
    }
    tally.count("observations of drawn surfaces", observers.len() as u64 * sea.instances);
    exact(tally, &sea, &engagement, told);
}

/// The same engagement by integrals, where the sea allows it.
fn exact(tally: &mut Tally, sea: &Parameters, engagement: &Engagement, told: impl Fn() -> String) {
    let water = sea.configure().expect("is drawn already");
    // Tables of fine facets are slow to make; coarser ones say as much about extremes.
    let Ok(exact) = Exact::new(&water) else { return tally.count("(exact refused)", 1) };
    for found in exact.statistics(engagement, &[0.0, 1e-3, 1e3]) {
        tally.check(whole(&found, false), sea, "exact statistics", || format!("{} {found:?}", told()));
    }
    tally.count("(exact statistics)", engagement.observers().len() as u64);
}

/// Finite, not negative, shares at most 1; the extremes only where there are any.
fn whole(s: &Statistics, extremes: bool) -> bool {
    let share = |x: f64| (0.0..=1.0).contains(&x);
    // A single draw has no standard error.
    let sem = if s.sem.is_nan() { 0.0 } else { s.sem };
    let values = [s.mean, s.std, sem, s.mean_f_cos, s.mean_upper, s.mean_error];
    values.into_iter().chain(s.quantiles).all(fine)
        && (!extremes || fine(s.min) && fine(s.max))
        && share(s.obscured)
        && share(s.whitecap)
        && s.over.iter().chain(&s.over_upper).all(|x| share(*x))
        && share(s.share_error)
        && s.mean_upper >= s.mean * (1.0 - 1e-9)
}

/// m; near the origin, in the distance, on a coordinate axis.
fn place(draw: &mut Draw) -> [f64; 2] {
    let reach = draw.one_of(&[0.0, 1.0, 1e3, 1e6, FARTHEST]);
    [draw.between(-reach, reach), draw.between(-reach, reach)]
}

/// Above the mean surface: from a nanometre to the end of coordinates.
fn position(draw: &mut Draw) -> Vec3 {
    let [x, y] = place(draw);
    [x, y, draw.log_between(1e-9, FARTHEST)]
}
