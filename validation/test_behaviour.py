"""The plugin beside Mitsuba's own BSDFs: errors, parameters, components, masks, variants, documentation."""

import re

import numpy as np
import pytest

from core import ROOT, Core, direction
from mitsuba_setup import usable_llvm
from plugin_calls import BOTH, CPU_VARIANTS, I, O, by_angle, interaction, number, value

@pytest.mark.parametrize("variant", CPU_VARIANTS)
def test_every_variant(use, variant):
    """Every CPU variant of the wheel loads the plugin and gives the same value; polarised ones depolarise."""
    mi = use(variant)
    bsdf = mi.load_dict({"type": "prob_water", "wind_speed": 7})
    assert abs(value(mi, bsdf) / (Core(wind_speed=7).f(I, O)[0] * O[2]) - 1) < 1e-5
    if mi.is_polarized:
        mueller = np.array(bsdf.eval(mi.BSDFContext(), interaction(mi), mi.Vector3f(O.tolist()))).reshape(16, -1)
        assert mueller[0, 0] > 0 and np.all(mueller[1:] == 0)


def test_variants_are_all_tested_or_need_a_gpu():
    import mitsuba as mi

    assert {v for v in mi.variants() if not v.startswith("cuda")} == set(CPU_VARIANTS)


@pytest.mark.parametrize("variant", BOTH)
@pytest.mark.parametrize(
    "parameters, words",
    [
        ({"wind_speed": 5.0, "beaufort": 3}, ["wind_speed", "beaufort", "5", "3"]),
        ({"wind_speed": -1.0}, ["wind_speed", "-1"]),
        ({"wind_speed": float("nan")}, ["wind_speed", "NaN"]),
        ({"wind_speed": float("inf")}, ["wind_speed", "inf"]),
        ({"wind_speed": 36.5}, ["wind_speed", "36.5", "Table 1"]),
        ({"friction_velocity": 239.0}, ["friction_velocity", "239"]),
        ({"footprint": 0.0}, ["footprint", "0"]),
        ({"footprint": -0.2}, ["footprint", "-0.2"]),
        ({"beaufort": 13}, ["beaufort", "13"]),
        ({"ior": 0.9}, ["ior", "0.9"]),
        ({"surface": "lumpy"}, ["surface", "lumpy", "flat"]),
        ({"surface": "ensemble", "footprint": "pixel"}, ["footprint", "pixel", "number", "ensemble"]),
        ({"surface": "ensemble", "whitecaps": {"type": "uniform", "value": 0.1}}, ["whitecaps", "texture", "ensemble"]),
        ({"footprint": "wide"}, ["footprint", "wide"]),
        ({"pixel_angle": 0.1}, ["pixel_angle", "0.1", "pixel"]),
        ({"footprint": "pixel", "pixel_angle": -1.0}, ["pixel_angle", "-1", "0 to 90"]),
        ({"surface": "ensemble", "components": 3}, ["components", "3", "4"]),
        ({"components": 0}, ["components", "0"]),
        ({"depth": -1.0}, ["depth", "-1"]),
        ({"waves": 3.0}, ["waves", "3"]),
        ({"whitecaps": "maybe"}, ["whitecaps", "maybe"]),
        ({"fresnel": 2.0}, ["fresnel", "2"]),
        ({"wavelength": {"type": "uniform", "value": 0.5}}, ["wavelength"]),
    ],
    ids=lambda p: "-".join(p) if isinstance(p, dict) else "",
)
def test_bad_input(use, variant, parameters, words):
    """A Mitsuba exception that names parameter and value."""
    mi = use(variant)
    with pytest.raises(RuntimeError) as error:
        mi.load_dict({"type": "prob_water", **parameters})
    for word in words:
        assert word in str(error.value), str(error.value)


@pytest.mark.parametrize("variant", BOTH)
def test_calm_is_valid(use, variant):
    mi = use(variant)
    bsdf = mi.load_dict({"type": "prob_water", "wind_speed": 0.0})
    assert 0 < value(mi, bsdf, i=[0, 0, 1], o=[0, 0, 1]) < 100


@pytest.mark.parametrize("variant", BOTH)
def test_components(use, variant):
    """Component 0 is glossy, 1 diffuse; they add up; without whitecaps there is one."""
    mi = use(variant)
    bsdf = mi.load_dict({"type": "prob_water", "friction_velocity": 97.0})
    F = mi.BSDFFlags
    assert bsdf.component_count() == 2
    assert bsdf.flags(0) == F.GlossyReflection | F.Anisotropic | F.FrontSide
    assert bsdf.flags(1) == F.DiffuseReflection | F.FrontSide
    assert bsdf.flags() == bsdf.flags(0) | bsdf.flags(1)
    parts = []
    for component in (0, 1):
        context = mi.BSDFContext()
        context.component = component
        parts.append(value(mi, bsdf, context))
        # A draw from one component alone has its flag, density and weight.
        sample, weight = bsdf.sample(context, interaction(mi), 0.4, mi.Point2f(0.3, 0.7))
        assert number(sample.sampled_component) == component
        assert int(number(sample.sampled_type)) == int([F.GlossyReflection, F.DiffuseReflection][component])
        pdf = number(bsdf.pdf(context, interaction(mi), sample.wo))
        assert abs(number(sample.pdf) / pdf - 1) < 1e-4
        f = number(bsdf.eval(context, interaction(mi), sample.wo))
        assert abs(number(weight) - f / pdf) < 1e-4 * f / pdf
    assert all(p > 0 for p in parts) and abs(sum(parts) / value(mi, bsdf) - 1) < 1e-5
    types = mi.BSDFContext()
    types.type_mask = +F.DiffuseReflection
    assert abs(value(mi, bsdf, types) / parts[1] - 1) < 1e-6
    types.type_mask = +F.DeltaReflection
    assert value(mi, bsdf, types) == 0
    sample, weight = bsdf.sample(types, interaction(mi), 0.4, mi.Point2f(0.3, 0.7))
    assert number(sample.pdf) == 0 and number(weight) == 0
    smooth = mi.load_dict({"type": "prob_water", "friction_velocity": 97.0, "whitecaps": False})
    assert smooth.component_count() == 1
    diffuse = number(bsdf.eval_diffuse_reflectance(interaction(mi)))
    assert abs(diffuse - np.pi * parts[1] / O[2]) < 1e-5


@pytest.mark.parametrize("variant", BOTH)
def test_black_from_below(use, variant):
    mi = use(variant)
    bsdf = mi.load_dict({"type": "prob_water"})
    assert value(mi, bsdf, i=-I) == 0 and value(mi, bsdf, o=-O) == 0 and value(mi, bsdf, i=-I, o=-O) == 0


def test_masks(use):
    """Masked lanes are zero (scalar variants have no masks)."""
    mi = use("llvm_ad_rgb")
    bsdf = mi.load_dict({"type": "prob_water"})
    assert value(mi, bsdf, active=False) == 0
    assert number(bsdf.pdf(mi.BSDFContext(), interaction(mi), mi.Vector3f(O.tolist()), False)) == 0
    both, density = bsdf.eval_pdf(mi.BSDFContext(), interaction(mi), mi.Vector3f(O.tolist()), False)
    assert number(both) == 0 and number(density) == 0
    _, weight = bsdf.sample(mi.BSDFContext(), interaction(mi), 0.4, mi.Point2f(0.3, 0.7), False)
    assert number(weight) == 0


@pytest.mark.parametrize("variant", BOTH)
def test_eval_pdf_is_eval_and_pdf(use, variant):
    mi = use(variant)
    bsdf = mi.load_dict({"type": "prob_water", "friction_velocity": 56.0})
    context, o = mi.BSDFContext(), mi.Vector3f(O.tolist())
    f, pdf = bsdf.eval_pdf(context, interaction(mi), o)
    assert abs(number(f) / value(mi, bsdf) - 1) < 1e-6
    assert abs(number(pdf) / number(bsdf.pdf(context, interaction(mi), o)) - 1) < 1e-5


@pytest.mark.parametrize("variant", BOTH)
def test_traverse(use, variant):
    """Parameters can be read and changed; a refused change leaves the sea as it was."""
    mi = use(variant)
    bsdf = mi.load_dict({"type": "prob_water", "friction_velocity": 8.0, "wind_direction": 30.0})
    parameters = mi.traverse(bsdf)
    assert set(parameters.keys()) == {"friction_velocity", "wind_direction", "footprint", "wavelength"}
    for wind in (24.0, 56.0):
        parameters["friction_velocity"] = wind
        parameters.update()
        fresh = mi.load_dict({"type": "prob_water", "friction_velocity": wind, "wind_direction": 30.0})
        assert value(mi, bsdf) == value(mi, fresh)
    before = value(mi, bsdf)
    with pytest.raises(RuntimeError, match="friction_velocity = -3"):
        parameters["friction_velocity"] = -3.0
        parameters.update()
    assert value(mi, bsdf) == before and parameters["friction_velocity"] == 56.0
    parameters["footprint"] = 0.15
    parameters.update()
    assert value(mi, bsdf) != before
    assert "footprint = 0.15" in str(bsdf) and str(bsdf).startswith("ProbWater[")


@pytest.mark.parametrize("variant", BOTH)
def test_wind_direction_is_in_the_shading_frame(use, variant):
    """Turning directions and wind together changes nothing; 0 and 180 degrees differ by the skewness."""
    mi = use(variant)
    turned = [direction(40.0, 200.0 + 70.0), direction(35.0, 15.0 + 70.0)]
    a = value(mi, mi.load_dict({"type": "prob_water", "wind_speed": 10.0}))
    b = value(mi, mi.load_dict({"type": "prob_water", "wind_speed": 10.0, "wind_direction": 70.0}), i=turned[0], o=turned[1])
    c = value(mi, mi.load_dict({"type": "prob_water", "wind_speed": 10.0, "wind_direction": 180.0}))
    assert abs(a / b - 1) < 1e-5 and abs(a / c - 1) > 1e-3


def test_documented_snippets(use):
    """The XML and the dictionary at the head of the plugin load and mean the same."""
    mi = use("scalar_rgb")
    text = (ROOT / "mitsuba-plugin/cpp/prob_water.cpp").read_text()
    xml = re.search(r"(<bsdf type.*?</bsdf>)", text, re.S).group(1)
    dictionary = re.search(r"code-tab:: python\s+(.*?)\n\n?\*/", text, re.S).group(1)
    first = mi.load_string(xml.replace("<bsdf ", '<bsdf version="3.0.0" ', 1))
    second = mi.load_dict(eval("{" + dictionary + "}"))
    assert str(first) == str(second) and "wind_speed = 7" in str(first)
    # Every parameter of the vocabulary is in the documentation's table.
    vocabulary = re.findall(r'entry\("(\w+)"', (ROOT / "rust-core/src/vocabulary.rs").read_text())
    assert len(vocabulary) > 10
    for name in vocabulary:
        assert re.search(rf"\* - .*\b{name}\b", text), name


def test_gradients_flow_through_directions(use):
    """The traced BSDF is differentiable in its directions, against finite differences."""
    mi = use("llvm_ad_rgb")
    import drjit as dr

    bsdf = mi.load_dict({"type": "prob_water", "friction_velocity": 24.0})

    f = by_angle(mi, bsdf)
    angle = mi.Float(0.5)
    dr.enable_grad(angle)
    dr.backward(f(angle))
    difference = (number(f(mi.Float(0.51))) - number(f(mi.Float(0.49)))) / 0.02
    assert abs(number(dr.grad(angle)) / difference - 1) < 2e-2


def test_llvm_is_found_in_ci():
    """In CI nothing may be skipped for want of LLVM."""
    import os

    if os.environ.get("CI") != "true":
        pytest.skip("not in CI")
    usable, reason = usable_llvm()
    assert usable, reason
