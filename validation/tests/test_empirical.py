"""`surface = "empirical"`, the report's empirical model from a table, in the plugin: values, draws, refusals, tables."""

import drjit as dr
import numpy as np
import pytest

from validation.support.core import Core, direction
from validation.support.paths import ROOT
from validation.support.plugin_calls import (BOTH, CPU_VARIANTS, I, O, adapter, by_angle, draw, evaluate,
                                             number, operations, value)

STANDARD = ROOT / "rust-core/data/table.npz"
EMPIRICAL = {"type": "prob_water", "surface": "empirical"}
SEAS = [
    {"friction_velocity": 2.5},
    {"friction_velocity": 8.0, "wind_direction": 35.0},
    {"friction_velocity": 24.0, "footprint": 0.5, "wind_direction": -100.0},
    {"friction_velocity": 56.0, "footprint": 0.03},
    {"wind_speed": 11.0, "wind_direction": 180.0, "fresnel": "exact", "ior": 1.4},
]
SEAS = [{**sea, "across": across} for sea in SEAS for across in ("report", "slopes")]
SEA_NAMES = ["-".join(map(str, sea.values())) for sea in SEAS]


def glints(rng, count, incidence):
    """Pairs of directions in float32 whose half vectors lean up to 30 degrees, for a range of angles of incidence."""
    h = direction(30 * np.sqrt(rng.random(4 * count)), rng.uniform(0, 360, 4 * count))
    i = direction(rng.uniform(*incidence, 4 * count), rng.uniform(0, 360, 4 * count))
    o = 2 * np.sum(i * h, axis=1, keepdims=True) * h - i
    keep = np.flatnonzero(o[:, 2] > 1e-3)[:count]
    return [(v[keep] / np.linalg.norm(v[keep], axis=1, keepdims=True)).astype(np.float32) for v in (i, o)]


def expected(core, i, o):
    """f cos(theta_o) in float64."""
    i, o = i.astype(np.float64), o.astype(np.float64)
    return core.estimate(i, o)[0] * o[:, 2]


@pytest.mark.parametrize("variant", BOTH)
@pytest.mark.parametrize("sea", SEAS, ids=SEA_NAMES)
def test_follows_the_core(use, variant, sea):
    """Within 5e-5 of float64 wherever f is above 1e-6 of its largest value, 3e-6 in the median: all around, to the horizon
    and beyond the table's 85 degrees. What is left is the rounding of places in the grid, where f falls off within a step,
    and of the squares in the exponent."""
    mi, rng = use(variant), np.random.default_rng(5)
    count = 8000 if variant.startswith("llvm") else 1000
    around = [direction(np.degrees(np.arccos(rng.uniform(1e-3, 1, count))), rng.uniform(0, 360, count)) for _ in "io"]
    both = glints(rng, count, (0, 85)), glints(rng, count, (85, 89.9)), [v.astype(np.float32) for v in around]
    # Overhead the plane is the wind's.
    overhead = direction(np.zeros(count), 0.0).astype(np.float32), both[0][1]
    i, o = (np.concatenate(rows) for rows in zip(*both, overhead))
    core, bsdf = Core(surface="empirical", **sea), mi.load_dict({**EMPIRICAL, **sea})
    found, density = evaluate(mi, bsdf, i, o, "Importance")
    wanted, drawn = expected(core, i, o), core.pdf(i.astype(np.float64), o.astype(np.float64))
    counts = wanted > 1e-6 * wanted.max()
    error = np.abs(found - wanted)[counts] / wanted[counts]
    print(f"\n{variant} {sea}: {counts.sum()} pairs, median {np.median(error):.1e}, worst {error.max():.1e}")
    assert counts.sum() > 0.05 * len(i) and np.all(np.isfinite(found)) and np.all(found >= 0)
    assert error.max() < 5e-5 and np.median(error) < 3e-6
    assert np.abs(found - wanted)[~counts].max() < 1e-9 * wanted.max()
    likely = drawn > 1e-3
    np.testing.assert_allclose(density[likely], drawn[likely], rtol=1e-4)


@pytest.mark.parametrize("variant", CPU_VARIANTS)
def test_every_variant(use, variant):
    """Every CPU variant gives the core's value, at one wavelength."""
    mi = use(variant)
    wanted = Core(surface="empirical", wind_speed=7).f(O, I)[0] * O[2]
    bsdf = mi.load_dict({**EMPIRICAL, "wind_speed": 7, "wavelength": 0.55})
    assert abs(value(mi, bsdf) / wanted - 1) < 1e-4


@pytest.mark.parametrize("sea", SEAS[2:8:3], ids=SEA_NAMES[2:8:3])
@pytest.mark.parametrize("incidence", [0.0, 50.0, 80.0])
def test_chi_square(use, sea, incidence):
    """Draws follow their density over all directions."""
    mi = use("llvm_ad_rgb")
    from mitsuba.chi2 import ChiSquareTest, SphericalDomain

    sample, pdf = adapter(mi, {"surface": "empirical", **sea}, direction(incidence, 20.0), mi.BSDFContext())
    test = ChiSquareTest(SphericalDomain(), sample, pdf, sample_dim=3, sample_count=1_000_000, ires=32)
    assert test.run(0.01, test_count=6, quiet=True), test.messages


@pytest.mark.parametrize("variant, mode", [("scalar_rgb", "Radiance"), ("llvm_ad_rgb", "Radiance"), ("llvm_ad_rgb", "Importance")])
@pytest.mark.parametrize("sea", SEAS, ids=SEA_NAMES)
def test_draws_report_value_and_density(use, variant, mode, sea):
    """The weight of a draw is f cos(theta_o) over its density; in the mean it is the albedo. It stays below 2, and to 50
    degrees below 0.5. Not so near the horizon with the report's Gaussian: far beside the plane it is many times the facets'
    lobe, from which draws come."""
    mi, rng = use(variant), np.random.default_rng(6)
    count = 300_000 if variant.startswith("llvm") else 2000
    bsdf = mi.load_dict({**EMPIRICAL, **sea})
    for incidence in (5.0, 50.0, 80.0, 88.0):
        i = direction(np.full(count, incidence), rng.uniform(0, 360, count)).astype(np.float32)
        wo, weight = draw(mi, bsdf, i, rng.uniform(0, 1, (count, 3)).astype(np.float32), mode)
        value, density = evaluate(mi, bsdf, i, wo, mode)
        drawn = density > 1e-6
        np.testing.assert_allclose(weight[drawn], value[drawn] / density[drawn], rtol=2e-3, atol=1e-5)
        print(f"\n{variant} {mode} {incidence} {sea}: mean weight {weight.mean():.4f}, spread {weight.std():.4f}, largest {weight.max():.2f}")
        assert 0.01 < weight.mean() < 0.8
        if incidence <= 50:
            assert weight.max() < 0.5 and weight.std() < weight.mean()
        elif sea["across"] == "slopes":
            # Draws know nothing of the mode, and are a little nearer to what the light's way wants.
            assert weight.max() < 2 and weight.std() < (1.6 if mode == "Radiance" else 1.5) * weight.mean()
        else:
            assert np.quantile(weight, 0.99) < 6


@pytest.mark.parametrize("variant", BOTH)
@pytest.mark.parametrize("across", ["report", "slopes"])
def test_components_and_light_from_below(use, variant, across):
    """Facets and whitecaps are components which add up to the whole; light from below comes on top; nothing goes down."""
    mi = use(variant)
    sea = {**EMPIRICAL, "friction_velocity": 56.0, "across": across}
    bsdf = mi.load_dict(sea)
    assert bsdf.component_count() == 2
    parts = []
    for component in (0xFFFFFFFF, 0, 1):
        context = mi.BSDFContext()
        context.component = component
        parts.append(value(mi, bsdf, context))
    assert abs(parts[0] / (parts[1] + parts[2]) - 1) < 1e-5 and min(parts) > 0
    lit = mi.load_dict({**sea, "water_leaving": {"type": "uniform", "value": 0.02}})
    below = value(mi, lit) - parts[0]
    assert 0.9 * 0.02 / np.pi * O[2] < below < 0.02 / np.pi * O[2]
    for at in ({"i": -I}, {"o": -O}, {"i": -I, "o": -O}):
        assert value(mi, lit, **at) == 0


@pytest.mark.parametrize("variant", BOTH)
def test_changes(use, variant):
    """A changed wind gives what a new BSDF of that wind does, without reading the table again; a refused one nothing."""
    mi = use(variant)
    bsdf = mi.load_dict({**EMPIRICAL, "friction_velocity": 8.0})
    parameters = mi.traverse(bsdf)
    assert set(parameters.keys()) == {"friction_velocity", "wind_direction", "footprint", "wavelength"}
    parameters["friction_velocity"] = 24.0
    parameters["wind_direction"] = 70.0
    parameters.update()
    fresh = mi.load_dict({**EMPIRICAL, "friction_velocity": 24.0, "wind_direction": 70.0})
    before = value(mi, bsdf)
    assert before == value(mi, fresh) and str(bsdf) == str(fresh)
    with pytest.raises(RuntimeError, match="friction_velocity = 100"):
        parameters["friction_velocity"] = 100.0
        parameters.update()
    assert value(mi, bsdf) == before and parameters["friction_velocity"] == 24.0


def saved(path, **changes):
    """The standard table with other arrays, as NumPy writes it."""
    with np.load(STANDARD) as table:
        np.savez(path, **{**dict(table), **changes})
    return str(path)


@pytest.mark.parametrize("variant", BOTH)
def test_tables_of_files(use, variant, tmp_path):
    """Another table, by its path or by its name on Mitsuba's search path, gives what the core reads from it; it is read
    once."""
    mi = use(variant)
    with np.load(STANDARD) as table:
        path = saved(tmp_path / "twice.npz", mean=2 * table["mean"], std=2 * table["std"])
    sea = {"friction_velocity": 8.0, "across": "report"}
    wanted = Core(surface="empirical", table=path, **sea).f(O, I)[0] * O[2]
    bsdf = mi.load_dict({**EMPIRICAL, "table": path, **sea})
    assert abs(value(mi, bsdf) / wanted - 1) < 1e-4
    assert abs(value(mi, bsdf) / value(mi, mi.load_dict({**EMPIRICAL, **sea})) - 2) < 1e-3
    assert f"# table = {path}" in str(bsdf) and "# table = the standard one" in str(mi.load_dict({**EMPIRICAL, **sea}))
    mi.file_resolver().append(str(tmp_path))
    assert value(mi, mi.load_dict({**EMPIRICAL, "table": "twice.npz", **sea})) == value(mi, bsdf)
    (tmp_path / "twice.npz").unlink()
    parameters = mi.traverse(bsdf)
    parameters["wind_direction"] = 40.0
    parameters.update()
    assert value(mi, bsdf) > 0


@pytest.mark.parametrize("variant", BOTH)
@pytest.mark.parametrize(
    "parameters, words",
    [
        ({"friction_velocity": 70.0}, ["friction_velocity = 70", "2 to 62.9 cm/s, the table's"]),
        ({"wind_speed": 0.0}, ["wind_speed = 0", "2 to 62.9 cm/s"]),
        ({"footprint": 2.0}, ["footprint = 2 ", "0.02 to 1 m"]),
        ({"footprint": "inf"}, ["footprint = inf", "0.02 to 1 m"]),
        ({"footprint": {"type": "uniform", "value": 0.3}}, ["footprint", "a texture", "a number", "empirical"]),
        ({"footprint": "pixel"}, ["footprint", "pixel", "a number", "empirical"]),
        ({"whitecaps": {"type": "uniform", "value": 0.1}}, ["whitecaps", "a texture", "empirical"]),
        ({"whitecaps": False}, ["whitecaps = false", "true, what the table was made with"]),
        ({"slope_measure": "slope"}, ["slope_measure = slope", "angle, what the table was made with"]),
        ({"components": 20}, ["components = 20", "5, what the table was made with"]),
        ({"across": "plane"}, ["across = plane", "report, slopes"]),
        ({"table": "no/such.npz"}, ["table = no/such.npz", "cannot be read"]),
        ({"table": "Cargo.toml"}, ["table = ", "Cargo.toml", "npz"]),
        ({"table": str(STANDARD), "surface": "flat"}, ["table = ", "has no meaning but with surface = empirical"]),
        ({"table": 5.0}, ["table"]),
    ],
    ids=lambda p: "-".join(p) if isinstance(p, dict) else "",
)
def test_bad_input(use, variant, parameters, words, monkeypatch):
    """A Mitsuba exception that names parameter and value."""
    monkeypatch.chdir(ROOT)
    mi = use(variant)
    with pytest.raises(RuntimeError) as error:
        mi.load_dict({**EMPIRICAL, **parameters})
    for word in words:
        assert word in str(error.value), str(error.value)


def test_has_no_meaning_on_the_shape(use):
    """A mesh is one drawn sea: it has no table, and its BSDF none either."""
    mi = use("scalar_rgb")
    mesh = {"type": "prob_water_surface", "radius": 30.0, "vertices": 4000}
    for refused in ({"across": "slopes"}, {"surface": "empirical"}):
        with pytest.raises(RuntimeError, match="has no meaning here"):
            mi.load_dict({**mesh, **refused})
    with pytest.raises(RuntimeError, match="on the BSDF of a prob_water_surface"):
        mi.load_dict({**mesh, "bsdf": EMPIRICAL})


def test_numbers_are_data(use):
    """Another wind, azimuth or footprint changes nothing of a kernel; its density is the same however f falls off."""
    use("llvm_ad_rgb")
    plain = {"surface": "empirical", "friction_velocity": 24.0}
    assert operations(plain) == operations({**plain, "friction_velocity": 40.0, "footprint": 0.5, "wind_direction": 30.0})
    slopes = operations({**plain, "across": "slopes"})
    assert slopes["eval"] != operations(plain)["eval"] and slopes["pdf"] == operations(plain)["pdf"]


@pytest.mark.parametrize("across", ["report", "slopes"])
def test_gradients_flow_through_directions(use, across):
    """Against finite differences, within an interval of the grid."""
    mi = use("llvm_ad_rgb")
    bsdf = mi.load_dict({**EMPIRICAL, "friction_velocity": 24.0, "across": across})

    f = by_angle(mi, bsdf)
    angle = mi.Float(0.5)
    dr.enable_grad(angle)
    dr.backward(f(angle))
    difference = (number(f(mi.Float(0.503))) - number(f(mi.Float(0.497)))) / 0.006
    assert abs(number(dr.grad(angle)) / difference - 1) < 0.05
