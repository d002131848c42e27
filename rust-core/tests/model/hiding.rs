//! What waves hide: once by rays cast onto drawn waves, and again by the facets' shadowing where that has the slopes of the
//! whole sea.

use crate::common::{HURRICANES, UP, WINDS, direction, integrate, water};
use prob_water::shadowing::cos_lambda;
use prob_water::surface::{Draws, InstanceRng, SurfaceRay};
use prob_water::{Hiding, Lobe, Surface, Water};
use std::f64::consts::{PI, SQRT_2};

/// Facets about a normal show a direction the area `cos + cos Lambda`, Lambda being Smith's of their own slopes, and leave
/// of it what shadowing by some slopes does. Both by their standard deviation along the direction; over the cosine.
fn shown(cos: f64, own: f64, shadowing: f64) -> f64 {
    let sin = (1.0 - cos * cos).sqrt();
    let area = |sigma: f64| cos + cos_lambda(cos, SQRT_2 * sigma * sin);
    area(own) / area(shadowing)
}

/// The standard deviation along a direction of the slopes that a lobe's shadowing has, by what it does to f near the horizon
/// for a source at the zenith.
fn of_shadowing(sea: &Water, o: [f64; 3]) -> f64 {
    let mut free = sea.local_lobe();
    (free.facets.shadowing, free.facets.bounded) = (false, false);
    let masking = free.eval(UP, o, None) / sea.local_lobe().eval(UP, o, None);
    let (mut low, mut high) = (0.0, 2.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let sin = (1.0 - o[2] * o[2]).sqrt();
        let more = 1.0 + cos_lambda(o[2], SQRT_2 * middle * sin) / o[2] > masking;
        if more { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

/// The area of facets that an observer sees of drawn waves, with all that hides it, over the area of level water. Smith's
/// masking of the whole sea, by which facets of every slope leave what level water shows, makes it 1.
fn seen(w: f64, elevation: f64, azimuth: f64, hiding: Hiding) -> f64 {
    let sea = water(w, |p| {
        (p.surface, p.footprint, p.components) = (Surface::Instance, Some(0.15), 20);
        (p.hiding, p.gram_charlier) = (hiding, false);
    });
    let (waves, lobe) = (sea.waves(), sea.local_lobe());
    let o = direction(90.0 - elevation, azimuth);
    let shadowing = of_shadowing(&sea, direction(88.0, azimuth));
    let (sin, cos) = azimuth.to_radians().sin_cos();
    let own = (lobe.facets.sigma_u * cos).hypot(lobe.facets.sigma_c * sin);
    let mut sum = 0.0;
    const INSTANCES: u64 = 8192;
    for instance in 0..INSTANCES {
        let surface = waves.surface(InstanceRng::new(Draws::Sobol, 3, instance), 0.0);
        let point = surface.point([0.0; 2]);
        let n = point.normal();
        let toward = (0..3).map(|k| n[k] * o[k]).sum::<f64>();
        let from = glam::DVec3::new(0.0, 0.0, point.height);
        if toward > 0.0 && !SurfaceRay::default().occludes(&surface, from, from + 1e5 * glam::DVec3::from(o))
        {
            sum += toward / n[2] * shown(toward, own, shadowing);
        }
    }
    sum / INSTANCES as f64 / o[2]
}

/// With the facets' own slopes obscuration and shadowing together leave what Smith's masking of the whole sea does, within
/// a percent; with the whole sea's up to 6 % less.
#[test]
fn once_is_smiths_masking_of_the_whole_sea() {
    let mut worst = [0.0f64; 2];
    for w in [8.0, 24.0, 56.0] {
        for azimuth in [0.0, 90.0] {
            for elevation in [30.0, 15.0, 10.0, 5.0] {
                let off =
                    [Hiding::Once, Hiding::Report].map(|h| (seen(w, elevation, azimuth, h) - 1.0).abs());
                println!("w* {w} azimuth {azimuth} elevation {elevation}: {off:?}");
                worst = [worst[0].max(off[0]), worst[1].max(off[1])];
            }
        }
    }
    assert!(worst[0] < 0.01 && worst[1] > 0.05, "{worst:?}");
}

/// Facets of an infinite footprint are the whole sea: nothing changes, to the last bit.
#[test]
fn once_is_the_report_where_facets_are_the_sea() {
    for w in WINDS.into_iter().chain(HURRICANES) {
        let [report, once] =
            [Hiding::Report, Hiding::Once].map(|hiding| water(w, |p| p.hiding = hiding).lobe().unwrap());
        for (theta, phi) in [(0.0, 0.0), (60.0, 20.0), (85.0, 170.0)] {
            let (i, o) = (direction(70.0, 180.0), direction(theta, phi));
            assert_eq!(report.eval(i, o, None), once.eval(i, o, None));
        }
    }
}

/// The albedo for a source near the horizon, at an elevation in degrees: sums even in the logarithms of the observer's
/// elevation and of its azimuth from the forward direction.
fn albedo_of_grazing(lobe: &Lobe<f64>, elevation: f64, azimuth: f64) -> f64 {
    const STEPS: [i32; 2] = [250, 125];
    let i = direction(90.0 - elevation, azimuth + 180.0);
    let nodes = |k: usize, from: f64, to: f64| {
        let step = (to / from).ln() / f64::from(STEPS[k]);
        (0..STEPS[k]).map(move |n| from * ((f64::from(n) + 0.5) * step).exp()).map(move |x| (x, x * step))
    };
    let mut sum = 0.0;
    for (e, width) in nodes(0, 1e-9, 0.5 * PI) {
        for (phi, turn) in nodes(1, 1e-8, PI) {
            let f = [phi, -phi]
                .map(|phi| lobe.eval(i, direction(90.0 - e.to_degrees(), azimuth + phi.to_degrees()), None));
            sum += (f[0] + f[1]) * e.sin() * e.cos() * width * turn;
        }
    }
    sum
}

/// Facets of any footprint reflect at most what comes in with the shadowing of their own slopes too.
#[test]
fn once_conserves_energy() {
    for w in [0.0, 1.31, 8.0, 24.0, 97.0, 238.65] {
        for footprint in [1e-3, 0.15, 50.0] {
            let [report, once] = [Hiding::Report, Hiding::Once]
                .map(|hiding| water(w, |p| (p.footprint, p.hiding) = (Some(footprint), hiding)).local_lobe());
            for azimuth in [0.0, 90.0] {
                let at = |theta: f64| format!("w* {w}, D {footprint}, {theta} deg, azimuth {azimuth}");
                for theta in [0.0, 60.0, 80.0] {
                    let i = direction(theta, azimuth);
                    let found = integrate(&once, i, UP, 120, |o| once.eval(i, o, UP) * o[2]);
                    assert!(found <= 1.0, "{found}: {}", at(theta));
                }
                for elevation in [3.0, 0.3, 1e-3] {
                    let found = albedo_of_grazing(&once, elevation, azimuth);
                    assert!(found <= 1.0, "{found}: {}", at(90.0 - elevation));
                    // The whole sea's slopes all but black out facets that are smooth beside it.
                    if w > 4.0 && footprint < 0.01 && elevation < 1.0 {
                        let dark = albedo_of_grazing(&report, elevation, azimuth);
                        assert!(dark < 0.5 * found, "{dark} {found}: {}", at(90.0 - elevation));
                    }
                }
            }
        }
    }
}
