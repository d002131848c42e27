"""`surface = "ensemble"`, the sea from afar, in the plugin: values, draws and what the other surfaces share with it."""

import io
import subprocess

import numpy as np
import pytest

from validation.support.command import COMMAND, flags
from validation.support.core import direction
from validation.support.plugin_calls import adapter, draw, evaluate, glints

SEAS = [
    {"friction_velocity": 2.0},
    {"friction_velocity": 8.0, "wind_direction": 35.0},
    {"friction_velocity": 24.0, "footprint": 0.5, "slope_measure": "slope", "fresnel": "exact"},
    {"friction_velocity": 56.0, "components": 20, "shadowing": False},
    {"friction_velocity": 120.0, "wind_direction": -100.0},
    {"friction_velocity": 0.3},
    {"friction_velocity": 8.0, "wind_direction": 35.0, "average": "report"},
    {"friction_velocity": 24.0, "footprint": 0.5, "slope_measure": "slope", "average": "report"},
    {"friction_velocity": 56.0, "wind_direction": -100.0, "average": "report"},
]
SEA_NAMES = ["-".join(map(str, sea.values())) for sea in SEAS]


def expected(sea, i, o):
    """f cos(theta_o) by the command."""
    rows = "\n".join(",".join(f"{x:.17g}" for x in (*a, *b)) for a, b in zip(i, o, strict=True))
    done = subprocess.run([COMMAND, "brdf", "--surface", "ensemble", *flags(sea)],
                          input="ix,iy,iz,ox,oy,oz\n" + rows + "\n", capture_output=True, text=True, check=True)
    return np.loadtxt(io.StringIO(done.stdout), delimiter=",", skiprows=1)[:, 6] * o[:, 2]


@pytest.mark.parametrize("variant", ["scalar_rgb", "llvm_ad_rgb"])
@pytest.mark.parametrize("sea", SEAS, ids=SEA_NAMES)
def test_follows_the_core(use, variant, sea):
    """Within 1e-4 of the core, where it is above a thousandth of the largest value; scalar variants call it."""
    mi = use(variant)
    i, o = glints(np.random.default_rng(5), 1500)
    bsdf = mi.load_dict({"type": "prob_water", "surface": "ensemble", **sea})
    found, _ = evaluate(mi, bsdf, i, o, "Importance")
    wanted = expected(sea, i.astype(float), o.astype(float))
    counts = wanted > 1e-3 * wanted.max()
    error = np.abs(found - wanted)[counts] / wanted[counts]
    print(f"\n{variant} {sea}: {counts.sum()} pairs, median {np.median(error):.1e}, worst {error.max():.1e}")
    assert counts.sum() > 20
    assert error.max() < 1e-4


@pytest.mark.parametrize("sea", SEAS[:5], ids=SEA_NAMES[:5])
@pytest.mark.parametrize("incidence", [0.0, 50.0, 80.0])
def test_chi_square(use, sea, incidence):
    """Draws follow their density over all directions."""
    mi = use("llvm_ad_rgb")
    from mitsuba.chi2 import ChiSquareTest, SphericalDomain

    sample, pdf = adapter(mi, {"surface": "ensemble", **sea}, direction(incidence, 20.0), mi.BSDFContext())
    test = ChiSquareTest(SphericalDomain(), sample, pdf, sample_dim=3, sample_count=1_000_000, ires=32)
    assert test.run(0.01, test_count=15, quiet=True), test.messages


@pytest.mark.parametrize("variant", ["scalar_rgb", "llvm_ad_rgb"])
def test_draws_report_value_and_density(use, variant):
    """The weight of a draw is f cos(theta_o) over its density; weights stay small, and their mean is the albedo."""
    mi, rng = use(variant), np.random.default_rng(6)
    count = 300_000 if variant.startswith("llvm") else 2000
    for sea in SEAS:
        bsdf = mi.load_dict({"type": "prob_water", "surface": "ensemble", **sea})
        mode = "Importance" if sea == SEAS[-1] else "Radiance"
        i = direction(np.full(count, 50.0), rng.uniform(0, 360, count)).astype(np.float32)
        wo, weight = draw(mi, bsdf, i, rng.uniform(0, 1, (count, 3)).astype(np.float32), mode)
        value, density = evaluate(mi, bsdf, i, wo, mode)
        drawn = density > 1e-6
        np.testing.assert_allclose(weight[drawn], value[drawn] / density[drawn], rtol=2e-3, atol=1e-5)
        print(f"\n{variant} {sea}: mean weight {weight.mean():.4f}, largest {weight.max():.2f}")
        assert 0.015 < weight.mean() < 0.35 and weight.max() < 1


def test_other_components_add_up(use):
    """Facets and whitecaps are components; together they are the whole."""
    mi = use("llvm_ad_rgb")
    i, o = glints(np.random.default_rng(7), 500)
    bsdf = mi.load_dict({"type": "prob_water", "surface": "ensemble", "friction_velocity": 56.0})
    assert bsdf.component_count() == 2
    import drjit as dr

    si = dr.zeros(mi.SurfaceInteraction3f, len(i))
    si.wi = mi.Vector3f(i.T)
    parts = []
    for component in (0xFFFFFFFF, 0, 1):
        context = mi.BSDFContext()
        context.component = component
        parts.append(np.array(bsdf.eval(context, si, mi.Vector3f(o.T)))[0])
    np.testing.assert_allclose(parts[0], parts[1] + parts[2], rtol=1e-4, atol=1e-7)
    assert parts[2].max() > 0
