"""The plugin beside Mitsuba's own BSDFs: errors, parameters, components, masks, variants, documentation."""

import re
import subprocess
import sys

import numpy as np
import pytest

from validation.support.core import Core, direction
from validation.support.mitsuba_setup import usable_llvm
from validation.support.paths import PLUGIN_ROOT, ROOT
from validation.support.plugin_calls import BOTH, CPU_VARIANTS, I, O, by_angle, interaction, number, value

@pytest.mark.parametrize("variant", CPU_VARIANTS)
def test_every_variant(use, variant):
    """Every CPU variant of the wheel loads the plugin and gives the same value, at one wavelength."""
    mi = use(variant)
    bsdf = mi.load_dict({"type": "prob_water", "wind_speed": 7, "wavelength": 0.55})
    assert abs(value(mi, bsdf) / (Core(wind_speed=7).f(I, O)[0] * O[2]) - 1) < 1e-5


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
        ({"surface": "ensemble", "whitecap_lifetime": 3.85}, ["whitecap_lifetime", "3.85", "0 s with surface = ensemble"]),
        ({"surface": "instance", "swell_height": 12.0}, ["swell_height", "12", "0 to 11.24"]),
        ({"surface": "instance", "swell_height": 2.0, "footprint": 30.0}, ["footprint", "30", "19.87"]),
        ({"waves": 3.0}, ["waves", "3"]),
        ({"whitecaps": "maybe"}, ["whitecaps", "maybe"]),
        ({"fresnel": 2.0}, ["fresnel", "2"]),
        ({"wavelength": {"type": "uniform", "value": 0.5}}, ["wavelength", "an object or an array", "a plain number"]),
        ({"water_leaving": 50.0}, ["water_leaving = 50 is out of range", "0 to 1"]),
        ({"water_leaving": -1.0}, ["water_leaving = -1 is out of range", "0 to 1"]),
        ({"water_leaving": {"type": "uniform", "value": 1.5}}, ["water_leaving = 1.5 is out of range"]),
        ({"water_leaving": float("nan")}, ["water_leaving = nan is out of range"]),
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


def test_what_traced_variants_cannot_take(use):
    """Arrays of Dr.Jit where a number is meant, the pixel's footprint without its angle, as they have no ray differentials, and a past."""
    mi = use("llvm_ad_rgb")
    with pytest.raises(RuntimeError, match="wind_speed is an object or an array: allowed is a plain number"):
        mi.load_dict({"type": "prob_water", "wind_speed": mi.Float(5)})
    with pytest.raises(RuntimeError, match="footprint = pixel needs pixel_angle here"):
        mi.load_dict({"type": "prob_water", "footprint": "pixel"})
    mi.load_dict({"type": "prob_water", "footprint": "pixel", "pixel_angle": 0.05})
    foam = {"type": "prob_water", "surface": "instance", "whitecap_lifetime": 3.85}
    with pytest.raises(RuntimeError, match="whitecap_lifetime = 3.85 .* in traced variants"):
        mi.load_dict(foam)
    use("scalar_rgb").load_dict(foam)
    mi.load_dict({"type": "prob_water", "footprint": "pixel"})


@pytest.mark.parametrize("variant", CPU_VARIANTS)
def test_water_leaving_is_a_share(use, variant):
    """An update beyond 0 and 1 is refused and leaves what was; a texture is held within."""
    mi = use(variant)
    bsdf = mi.load_dict({"type": "prob_water", "water_leaving": 0.25})
    parameters, key = mi.traverse(bsdf), "water_leaving.value"
    before = value(mi, bsdf)
    for refused in (50.0, -1.0, float("nan")):
        parameters[key] = refused
        with pytest.raises(RuntimeError, match=f"water_leaving = {refused:g} is out of range: allowed is 0 to 1"):
            parameters.update()
        assert number(parameters[key]) == 0.25 and value(mi, bsdf) == before
    # With a change of something else neither is taken.
    parameters[key], parameters["wind_speed"] = 2.0, 9.0
    with pytest.raises(RuntimeError, match="water_leaving = 2"):
        parameters.update()
    assert parameters["wind_speed"] == 5.0 and number(parameters[key]) == 0.25 and value(mi, bsdf) == before
    parameters[key] = 1.0
    parameters.update()
    assert number(parameters[key]) == 1.0 and value(mi, bsdf) > before
    texture = {"type": "bitmap", "raw": True, "filter_type": "nearest"}
    held = [mi.load_dict({"type": "prob_water", "water_leaving": {**texture, "bitmap": mi.Bitmap(pixels)}})
            for pixels in (np.full((2, 2, 1), x, np.float32) for x in (7.0, 1.0))]
    assert value(mi, held[0]) == value(mi, held[1]) > before
    if variant.endswith("_rgb"):
        bsdf = mi.load_dict({"type": "prob_water", "water_leaving": {"type": "rgb", "value": [0.1, 0.2, 0.3]}})
        parameters, before = mi.traverse(bsdf), value(mi, bsdf)
        parameters[key] = mi.Color3f(0.1, 3.0, 0.2)
        with pytest.raises(RuntimeError, match="water_leaving = 3 is out of range"):
            parameters.update()
        assert value(mi, bsdf) == before and np.allclose(np.array(parameters[key]).ravel(), [0.1, 0.2, 0.3])


@pytest.mark.parametrize("variant", CPU_VARIANTS)
def test_attributes(use, variant):
    """Numbers and textures that traverse() shows are attributes with their values, before and after a change."""
    mi = use(variant)
    numbers = {"wind_speed": 7.0, "wind_height": 12.5, "wind_direction": 30.0, "wavelength": 0.6, "ior": 1.35, "time": 2.5,
               "footprint": 0.25}
    bsdf = mi.load_dict({"type": "prob_water", "surface": "instance", **numbers})
    parameters = mi.traverse(bsdf)
    assert set(parameters.keys()) == set(numbers)
    parameters["wind_speed"] = numbers["wind_speed"] = 9.0
    parameters.update()
    for one in ({"friction_velocity": 24.0}, {"beaufort": 5}):
        numbers |= one
    others = [mi.load_dict({"type": "prob_water", **one}) for one in ({"friction_velocity": 24.0}, {"beaufort": 5})]
    for name, wanted in numbers.items():
        holder = {"friction_velocity": others[0], "beaufort": others[1]}.get(name, bsdf)
        assert np.all(holder.has_attribute(name))
        for call in ("eval_attribute", "eval_attribute_1", "eval_attribute_3"):
            found = np.array(getattr(holder, call)(name, interaction(mi))).ravel()
            assert found.size and np.allclose(found, wanted, rtol=1e-6), (name, call, found)
    textures = {"footprint": 0.3, "whitecaps": 0.1, "water_leaving": 0.02}
    bsdf = mi.load_dict({"type": "prob_water", **{name: {"type": "uniform", "value": x} for name, x in textures.items()}})
    for name, wanted in textures.items():
        assert np.all(bsdf.has_attribute(name)) and np.isclose(number(bsdf.eval_attribute_1(name, interaction(mi))), wanted)
    assert not np.any(bsdf.has_attribute("ior"))


@pytest.mark.parametrize("variant, surface", [("scalar_rgb", "ensemble"), *(("llvm_ad_rgb", surface) for surface in (
    "ensemble", "empirical", "instance", "flat"))])
def test_memory_stays(use, variant, surface, full):
    """Further loads and updates take no more memory than the first did, though nothing is rendered in between."""
    use(variant)
    counts = ["20", "100"] if full else ["6", "14"]
    done = subprocess.run([sys.executable, "-c", MEMORY, variant, surface, *counts], capture_output=True, text=True,
                          cwd=ROOT)
    assert done.returncode == 0, done.stderr
    loads, updates = map(float, done.stdout.split())
    print(f"\n{variant} {surface}: {loads:.1f} MiB more by loads, {updates:.1f} by updates")
    # The tables of one sea are 4 MiB at most.
    assert loads < 12 and updates < 12


MEMORY = """
import sys
import mitsuba as mi
from validation.support.mitsuba_setup import load_plugin

variant, surface = sys.argv[1:3]
first, more = map(int, sys.argv[3:])
mi.set_variant(variant)
load_plugin()

def grown(step):
    def resident():
        return int(open("/proc/self/statm").read().split()[1]) * 4096 / 2**20
    for k in range(first):
        step(k)
    before = resident()
    for k in range(more):
        step(k)
    return resident() - before

bsdf = mi.load_dict({"type": "prob_water", "surface": surface, "water_leaving": 0.02})
parameters = mi.traverse(bsdf)

def load(k):
    mi.load_dict({"type": "prob_water", "surface": surface, "wind_direction": k + 0.5})

def update(k):
    parameters["wind_direction"] = k + 0.5
    parameters.update()

print(grown(load), grown(update))
"""


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
    """The XML and the dictionary of the plugin's documentation load and mean the same."""
    mi = use("scalar_rgb")
    text = (ROOT / "mitsuba-plugin/docs/prob_water.rst").read_text()
    xml = re.search(r"(<bsdf type.*?</bsdf>)", text, re.S).group(1)
    dictionary = re.search(r"code-tab:: python\s+(.*)\Z", text, re.S).group(1)
    first = mi.load_string(xml.replace("<bsdf ", '<bsdf version="3.0.0" ', 1))
    second = mi.load_dict(eval("{" + dictionary + "}"))
    assert str(first) == str(second) and "wind_speed = 7" in str(first)


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


@pytest.mark.parametrize("variant", BOTH)
def test_values_hardly_meant_are_told_once(variant):
    """In a process of its own: Mitsuba writes its log where no test sees it."""
    code = (f"import mitsuba as mi; mi.set_variant('{variant}'); mi.file_resolver().append('{PLUGIN_ROOT}');"
            "mi.load_dict({'type': 'prob_water', 'footprint': 2e-4, 'wind_direction': 7200});"
            "mi.load_dict({'type': 'prob_water', 'footprint': 0.2, 'wind_direction': 270})")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    said = done.stdout + done.stderr
    for name in ("prob_water: footprint = 0.0002", "prob_water: wind_direction = 7200"):
        assert said.count(name) == 1, said
    assert said.count("prob_water: ") == 2, said
