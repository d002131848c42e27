//! Lobes by tables: facets of any footprint, the empirical model, the mean over all waves.

use crate::draw::{Draw, Vec3};
use crate::tally::{Tally, fine, shown};
use prob_water::brdf::up;
use prob_water::whitecap::WhitecapOnset;
use prob_water::{
    Average, EmpiricalLobe, EnsembleLobe, FacetTable, Fresnel, OffPlaneModel, Parameters, SlopeBudget,
    SpectrumModel, Surface, Table, Wind,
};

/// Evaluations that the making of a lobe is worth.
const ROWS: u64 = 1024;

/// Two directions, as adversarial as those of the closed form; every other pair is specular or nearly.
pub fn pair(draw: &mut Draw) -> [Vec3; 2] {
    let i = draw.direction();
    let o = match draw.pick(8) {
        0..=3 => draw.direction(),
        4 => i,
        5 => i.map(|x| -x),
        _ => [-i[0], -i[1], i[2]],
    };
    [i, o]
}

/// Facets whose footprint is set from a table, any positive number, infinite or none.
pub fn facets_by_footprint(draw: &mut Draw, tally: &mut Tally) {
    let sea = draw.flat_sea();
    let water = sea.configure().expect("within the ranges of the vocabulary");
    let table = FacetTable::new(&water);
    let single_table: FacetTable<f32> = table.cast();
    for _ in 0..16 * ROWS {
        let footprint = match draw.pick(8) {
            0 => draw.one_of(&[0.0, 5e-324, 1e-12, f64::MAX, f64::INFINITY, f64::NAN]),
            _ => draw.log_between(1e-4, 1e7),
        };
        let mut lobe = water.local_lobe();
        table.set(&mut lobe.facets, footprint);
        let mut single = water.local_lobe().cast::<f32>();
        single_table.set(&mut single.facets, footprint as f32);
        let [i, o] = pair(draw);
        let [i32, o32] = [i, o].map(|v| v.map(|x| x as f32));
        let found = [lobe.eval(i, o, up()), single.eval(i32, o32, up()).into(), lobe.pdf(i, o, up())];
        let holds = found.into_iter().all(fine);
        tally.check(holds, &sea, "facets by footprint", || {
            format!("footprint {footprint} {}", shown(&[i, o, up()], &found))
        });
        let below = i[2] <= 0.0 || o[2] <= 0.0;
        tally.check(!below || found[0] == 0.0, &sea, "from below", || shown(&[i, o, up()], &found));
    }
    tally.count("f, both precisions", 32 * ROWS);
}

/// The empirical model's values, their spread and draws through it.
pub fn empirical(draw: &mut Draw, tally: &mut Tally) {
    let table = Table::standard();
    let ends = |axis: &[f64]| [axis[0], axis[axis.len() - 1]];
    let [w, d] = [&table.grid.friction_velocity, &table.grid.footprint].map(|axis| ends(axis));
    let sea = Parameters {
        surface: Surface::Empirical,
        wind: Wind::FrictionVelocity(draw.log_between(w[0], w[1])),
        footprint: Some(draw.log_between(d[0], d[1])),
        across: draw.one_of(&[OffPlaneModel::Report, OffPlaneModel::Slopes]),
        ..Parameters::default()
    };
    let sea = draw_optics(draw, sea);
    let lobe = match sea.configure().and_then(|water| EmpiricalLobe::new(&water, table)) {
        Ok(lobe) => lobe,
        Err(error) => return tally.violation(&sea, &error.to_string(), ""),
    };
    let draws = std::num::NonZeroU32::new(16).expect("is not 0");
    for row in 0..16 * ROWS {
        let [i, o] = pair(draw);
        let estimate = lobe.estimate(i, o);
        let single = lobe.eval(i.map(|x| x as f32), o.map(|x| x as f32));
        let mut found = vec![lobe.eval(i, o), single.into(), estimate.mean, estimate.std];
        if row % 64 == 0 {
            let drawn = lobe.monte_carlo(i, o, draws, row, &[0.0, 0.1]);
            // Of what is not f nothing is known.
            found.extend([drawn.mean, drawn.std, drawn.min, drawn.max, drawn.sem]);
            found.extend(drawn.quantiles.into_iter().chain(drawn.over));
        }
        tally.check(found.iter().all(|x| fine(*x)), &sea, "empirical", || shown(&[i, o, up()], &found));
        let below = i[2] <= 0.0 || o[2] <= 0.0;
        tally.check(!below || found[0] == 0.0, &sea, "from below", || shown(&[i, o, up()], &found));
    }
    tally.count("f, float64, float32 and with its spread", 48 * ROWS);
}

/// The mean over all waves; a sea that it refuses is refused in words.
pub fn ensemble(draw: &mut Draw, tally: &mut Tally) {
    let sea = drawn_sea(draw, Surface::Ensemble);
    let lobe = match sea.configure().and_then(|water| EnsembleLobe::new(&water)) {
        Ok(lobe) => lobe,
        Err(_) => return tally.count("(seas refused)", 1),
    };
    tally.count("(seas)", 1);
    for _ in 0..4 * ROWS {
        let [i, o] = pair(draw);
        let found = [lobe.eval(i, o), lobe.sampler.pdf(i, o, up())];
        tally.check(found.into_iter().all(fine), &sea, "ensemble", || shown(&[i, o, up()], &found));
        let below = i[2] <= 0.0 || o[2] <= 0.0;
        tally.check(!below || found[0] == 0.0, &sea, "from below", || shown(&[i, o, up()], &found));
    }
    tally.count("f", 4 * ROWS);
}

/// A sea with drawn waves: any wind, few or many components, deep and shallow, with and without a shore.
pub fn drawn_sea(draw: &mut Draw, surface: Surface) -> Parameters {
    let components = draw.one_of(&[4, 5, 5, 20, 21, 64]);
    let fetch = if draw.flag() { f64::INFINITY } else { draw.log_between(1.0, 1e6) };
    let spectrum = match draw.pick(4) {
        0 => SpectrumModel::Elfouhaily,
        1 if fetch.is_finite() => draw.one_of(&[SpectrumModel::Jonswap, SpectrumModel::Tma]),
        _ => SpectrumModel::Report,
    };
    let sea = Parameters {
        surface,
        footprint: Some(draw.log_between(0.02, 3.0)),
        average: draw.one_of(&[Average::Power, Average::Report]),
        components,
        instances: 4,
        seed: draw.bits() >> 11,
        time: match draw.pick(4) {
            0 => draw.one_of(&[0.0, 1e9, -1e9]),
            _ => draw.between(-1e4, 1e4),
        },
        depth: if draw.flag() { f64::INFINITY } else { draw.log_between(0.1, 1e3) },
        fetch,
        spectrum,
        slope_budget: draw.one_of(&[SlopeBudget::Report, SlopeBudget::Closed]),
        whitecap_onset: draw.one_of(&[WhitecapOnset::Calibrated, WhitecapOnset::Ramp, WhitecapOnset::Step]),
        ..draw.flat_sea()
    };
    draw.about(sea)
}

/// Its optics at the ends of their ranges.
fn draw_optics(draw: &mut Draw, sea: Parameters) -> Parameters {
    let sea = Parameters {
        wind_direction: draw.between(-720.0, 720.0),
        wavelength: draw.one_of(&[0.2, 0.55, 10.6, 200.0]),
        ior: draw.one_of(&[None, Some(1.0), Some(4.0)]),
        fresnel: draw.one_of(&[Fresnel::Schlick, Fresnel::Exact]),
        ..sea
    };
    draw.about(sea)
}
