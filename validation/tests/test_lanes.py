"""Scalar variants (Rust, float32) and traced ones (Dr.Jit) against the core in float64, lane by lane."""

import itertools

import numpy as np
import pytest

from validation.error_budget.float32 import BOUND, FOOTPRINTS, MEDIAN, SCALAR_BOUND, WINDS, errors, table
from validation.support.core import Core, direction, pairs
from validation.support.plugin_calls import draw, evaluate

SWITCHES = [
    {},
    {"slope_measure": "slope", "fresnel": "exact"},
    {"shadowing": False, "gram_charlier": False},
    {"readings": "as_printed"},
    {"whitecaps": True, "ior": 1.1, "wind_direction": -140.0},
    {"wavelength": 12.5, "fresnel": "exact"},  # Water absorbs there.
]


#: Winds by which traced code turns tilts: with care, or by a quarter turn.
WINDS_FROM = [
    {"wind_direction": 37.0},
    {"wind_direction": 37.0, "slope_measure": "slope", "fresnel": "exact"},
    {"wind_direction": 37.0, "gram_charlier": False},
    {"wind_direction": 90.0, "readings": "as_printed"},
    {"wind_direction": 180.0, "slope_measure": "slope"},
    {"wind_direction": -90.0},
]


@pytest.mark.parametrize(
    "variant, switches",
    [(variant, s) for variant in ("scalar_rgb", "llvm_ad_rgb") for s in SWITCHES]
    + [("llvm_ad_rgb", s) for s in WINDS_FROM],
    ids=lambda s: s if isinstance(s, str) else "-".join(s) or "default",
)
def test_float32_error(use, variant, switches, full):
    """f and its density are within 1e-4 of float64 (scalar 5e-5), 1e-5 in the median."""
    mi, rng = use(variant), np.random.default_rng(2)
    traced = variant.startswith("llvm")
    count = (200_000 if full else 20_000) if traced else 1500
    for wind, footprint in itertools.product(WINDS, FOOTPRINTS):
        parameters = {"friction_velocity": wind, "footprint": footprint, "whitecaps": False, **switches}
        error, density, _ = errors(mi, parameters, count, rng)
        assert np.median(error) < MEDIAN and np.median(density) < MEDIAN, (parameters, np.median(error))
        assert error.max() < (BOUND if traced else SCALAR_BOUND), (parameters, error.max())
        assert density.max() < BOUND, (parameters, density.max())


def test_table_by_wind_footprint_and_angle(use):
    """The table that docs/float32.md shows at length (`-s` prints it)."""
    print()
    for wind, footprint, cells in table(use("llvm_ad_rgb"), 20_000, np.random.default_rng(3)):
        print(f"w* {wind:6.1f} D {footprint:5}  " + "  ".join(f"{m:.0e}/{w:.0e}" for m, w in cells))
        assert np.all(np.array(cells) < [MEDIAN, BOUND])


@pytest.mark.parametrize("switches", SWITCHES, ids=lambda s: "-".join(s) or "default")
def test_scalar_and_traced_agree(use, switches):
    """The same float32 directions, lane by lane: values, densities and draws."""
    rng = np.random.default_rng(4)
    parameters = {"friction_velocity": 24.0, **switches}
    i, o = pairs(Core(**parameters), 2000, rng, switches.get("wind_direction", 0.0))
    uniform = rng.uniform(0, 1, (len(i), 3)).astype(np.float32)
    results = {}
    for variant in ("scalar_rgb", "llvm_ad_rgb"):
        mi = use(variant)
        bsdf = mi.load_dict({"type": "prob_water", **parameters})
        results[variant] = (*evaluate(mi, bsdf, i, o), *draw(mi, bsdf, i, uniform))
    (f, pdf, wo, weight), (f2, pdf2, wo2, weight2) = results.values()
    gaussian = Core(**{**parameters, "gram_charlier": False})
    size = gaussian.f(i, o) * o[:, 2]
    assert np.max(np.abs(f - f2) / size) < BOUND and np.max(np.abs(pdf - pdf2) / pdf) < BOUND
    # A draw on the edge of a decision may fall on its other side.
    same = np.max(np.abs(wo - wo2), axis=1) < 1e-4
    assert same.mean() > 0.995
    assert np.max(np.abs(weight - weight2)[same]) < 2e-3


def test_finite_and_non_negative_everywhere(use):
    """Adversarial directions: grazing to 89.9999 degrees and below, denormals, signed zeros, overhead."""
    mi, rng = use("llvm_ad_rgb"), np.random.default_rng(5)
    theta = np.concatenate([90 - 10.0 ** rng.uniform(-5, 2, 40_000), 90 + rng.uniform(-1, 20, 5000), np.zeros(100)])
    i = direction(theta, rng.uniform(0, 360, len(theta))).astype(np.float32)
    i[:200, 2] = rng.choice(np.array([0.0, -0.0, 1e-45, 1e-40, 1e-38, -1e-38, 1e-20], np.float32), 200)
    o = i[rng.permutation(len(i))]
    o[::3, :2] = -i[::3, :2]
    for wind, footprint, shadowing in itertools.product((0.0, 0.01, 2.0, 24.0, 238.65), (0.001, float("inf")), (True, False)):
        bsdf = mi.load_dict(
            {"type": "prob_water", "friction_velocity": wind, "footprint": footprint, "shadowing": shadowing}
        )
        value, pdf = evaluate(mi, bsdf, i, o)
        assert np.isfinite(value).all() and np.isfinite(pdf).all()
        assert (value >= 0).all() and (pdf >= 0).all()
        below = (i[:, 2] <= 0) | (o[:, 2] <= 0)
        assert (value[below] == 0).all() and (pdf[below] == 0).all()
        wo, weight = draw(mi, bsdf, i, rng.uniform(0, 1, (len(i), 3)).astype(np.float32))
        assert np.isfinite(wo).all() and np.isfinite(weight).all() and (weight >= 0).all()
