"""Spectral variants: index and whitecaps of every lane, against seas of one wavelength."""

import numpy as np
import pytest

from validation.support.core import direction
from validation.support.plugin_calls import CPU_VARIANTS, draw_one, interaction, matrix

SURFACES = ["flat", "instance", "ensemble", "empirical"]
LANES = [[381.0, 423.0, 468.0, 507.0], [550.0, 596.0, 647.0, 792.0]]
PAIRS = [(direction(50, 20), direction(45, 190)), (direction(10, 300), direction(70, 90)), (direction(82, 0), direction(84, 178))]


def by_one_wavelength(mi, parameters, i, o, wavelengths):
    """A sea for every lane."""
    one = []
    for k, wavelength in enumerate(wavelengths):
        bsdf = mi.load_dict({"type": "prob_water", **parameters, "wavelength": 1e-3 * wavelength})
        one.append(matrix(mi, bsdf, i, o, mi.BSDFContext(), wavelengths)[..., k])
    return np.stack(one, axis=-1)


@pytest.mark.parametrize("variant", ["scalar_spectral", "llvm_ad_spectral", "llvm_ad_spectral_polarized"])
@pytest.mark.parametrize("surface", SURFACES)
@pytest.mark.parametrize(
    "parameters",
    [
        {"wind_speed": 13.0},
        {"wind_speed": 7.0, "fresnel": "exact"},
        {"wind_speed": 3.0, "water_leaving": {"type": "uniform", "value": 0.05}},
    ],
    ids=["schlick", "exact", "water"],
)
def test_lanes_are_seas_of_one_wavelength(use, variant, surface, parameters):
    """1e-4, whitecaps and light from below included."""
    mi = use(variant)
    parameters = {**parameters, "surface": surface}
    bsdf = mi.load_dict({"type": "prob_water", **parameters})
    # Tables of slopes take a second each: one row of lanes where there are any.
    for wavelengths in LANES if surface in ("flat", "instance") else LANES[1:]:
        for i, o in PAIRS if surface == "flat" else PAIRS[:1]:
            lanes = matrix(mi, bsdf, i, o, mi.BSDFContext(), wavelengths)
            one = by_one_wavelength(mi, parameters, i, o, wavelengths)
            size = np.abs(one).max(axis=tuple(range(one.ndim - 1)))
            worst = np.max(np.abs(lanes - one) / size)
            assert worst < 1e-4, (wavelengths, worst)
            print(f"{variant} {surface} {worst:.1e}")
            assert lanes.ravel()[0] != lanes.ravel()[1]


@pytest.mark.parametrize("parameters", [{"temperature": 12.0, "salinity": 30.0}, {"water": "fresh"}, {"wind_speed": 0.5}])
def test_other_indices(use, parameters):
    """Quan and Fry's, within its range; of fresh water; and a calm sea, whose bound has rho as well."""
    mi = use("scalar_spectral")
    bsdf = mi.load_dict({"type": "prob_water", **parameters})
    wavelengths = [402.0, 450.0, 550.0, 698.0]
    for i, o in PAIRS:
        lanes = matrix(mi, bsdf, i, o, mi.BSDFContext(), wavelengths)
        one = by_one_wavelength(mi, parameters, i, o, wavelengths)
        assert np.allclose(lanes, one, rtol=1e-4, atol=1e-7)


def test_one_wavelength_or_index_is_that_of_all(use):
    """A `wavelength` that is given stays alone; an `ior` that is, is the index of all lanes, under whitecaps that follow them."""
    mi = use("llvm_ad_spectral")
    i, o, wavelengths = *PAIRS[0], [420.0, 500.0, 650.0, 800.0]
    value = lambda **given: matrix(mi, mi.load_dict({"type": "prob_water", **given}), i, o, mi.BSDFContext(), wavelengths)
    assert np.ptp(value(wavelength=0.55)) == 0.0
    assert np.ptp(value(ior=1.34, whitecaps=False)) < 1e-7 * value(ior=1.34)[0]
    far = value(ior=1.34, wind_speed=25.0)
    assert far[0] == far[1] > far[2] > far[3]


@pytest.mark.parametrize("variant", ["scalar_spectral", "llvm_ad_spectral"])
def test_index_as_a_spectrum(use, variant):
    """Lane by lane as the numbers; also with one wavelength, and in variants of three colours, one of each."""
    mi = use(variant)
    i, o, wavelengths = *PAIRS[0], [400.0, 500.0, 600.0, 700.0]
    spectrum = {"type": "spectrum", "value": [(400.0, 1.36), (700.0, 1.33)]}
    for more in ({}, {"wavelength": 0.6}):
        sea = {"wind_speed": 11.0, "fresnel": "exact", **more}
        lanes = matrix(mi, mi.load_dict({"type": "prob_water", "ior": spectrum, **sea}), i, o, mi.BSDFContext(), wavelengths)
        for k, n in enumerate([1.36, 1.35, 1.34, 1.33]):
            one = matrix(mi, mi.load_dict({"type": "prob_water", "ior": n, **sea}), i, o, mi.BSDFContext(), wavelengths)
            assert abs(lanes[k] / one[k] - 1) < 1e-4
    mi = use("llvm_ad_rgb")
    water = lambda ior: colours(mi, mi.load_dict({"type": "prob_water", "ior": ior}), i, o)
    found = water({"type": "rgb", "value": [1.33, 1.34, 1.35]})
    assert np.allclose(found, [water(n)[k] for k, n in enumerate([1.33, 1.34, 1.35])], rtol=1e-4)


def colours(mi, bsdf, i, o):
    """Three colours of a value."""
    return np.array(bsdf.eval(mi.BSDFContext(), interaction(mi, i), mi.Vector3f([float(x) for x in o]))).ravel()


@pytest.mark.parametrize("variant", ["scalar_spectral", "scalar_spectral_polarized", "llvm_ad_spectral", "llvm_ad_spectral_polarized"])
def test_weights_are_values_over_densities(use, variant):
    """Lane by lane."""
    mi, rng = use(variant), np.random.default_rng(2)
    bsdf = mi.load_dict({"type": "prob_water", "wind_speed": 14.0, "chlorophyll": 0.5})
    for u in rng.random((40, 3)):
        wo, pdf, weight = draw_one(mi, bsdf, PAIRS[0][0], u, mi.BSDFContext())
        if pdf > 0:
            value = matrix(mi, bsdf, PAIRS[0][0], wo, mi.BSDFContext())
            assert np.allclose(weight * pdf, value, rtol=2e-3, atol=1e-3 * np.abs(value).max())


def test_case_1_water(use):
    """Chlorophyll is a water body's spectrum: blue where it is rare, green where there is much; in every variant."""
    mi = use("llvm_ad_spectral")
    i, o, wavelengths = direction(30, 0), direction(50, 60), [440.0, 490.0, 560.0, 720.0]
    body = [0.033115, 0.030274, 0.012534, 0.0]  # 6S for 0.3 mg/m^3, its scattering by molecules in two digits
    sea = {"type": "prob_water", "wind_speed": 3.0}
    black, clear = (matrix(mi, mi.load_dict({**sea, **more}), i, o, mi.BSDFContext(), wavelengths) for more in ({}, {"chlorophyll": 0.3}))
    full = matrix(mi, mi.load_dict({**sea, "water_leaving": {"type": "uniform", "value": 1.0}}), i, o, mi.BSDFContext(), wavelengths)
    assert np.allclose((clear - black) / (full - black), body, rtol=0.025, atol=1e-6)
    for variant in ("scalar_rgb", "llvm_ad_rgb"):
        mi = use(variant)
        below = lambda c: colours(mi, mi.load_dict({**sea, "chlorophyll": c}), i, o) - colours(mi, mi.load_dict(sea), i, o)
        rare, much = below(0.03), below(10.0)
        assert rare[2] > rare[1] > rare[0] and much[1] > much[2], (rare, much)
    for variant in CPU_VARIANTS:
        use(variant).load_dict({**sea, "chlorophyll": 1.0})


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"chlorophyll": -1.0}, ["chlorophyll", "-1", "0 to 30"]),
        ({"chlorophyll": "much"}, ["chlorophyll", "much", "a number"]),
        ({"chlorophyll": 1.0, "water_leaving": {"type": "uniform", "value": 0.1}}, ["chlorophyll", "water_leaving"]),
        ({"salinity": {"type": "uniform", "value": 0.1}}, ["salinity", "an object"]),
    ],
)
def test_refusals(use, given, words):
    """Chlorophyll is a number within its range, and the only water body."""
    mi = use("scalar_spectral")
    with pytest.raises(RuntimeError) as refused:
        mi.load_dict({"type": "prob_water", **given})
    assert all(word in str(refused.value) for word in words), refused.value
