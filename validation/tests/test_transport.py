"""Who is the source and who the observer: the renderer's f is the command's and the ray cast's, on paths from the camera and
from the light."""

import csv
import io
import subprocess

import numpy as np
import pytest

from validation.support.command import COMMAND, flags
from validation.support.core import direction
from validation.support.plugin_calls import BOTH, evaluate, glints

#: Surfaces that are not reciprocal.
ONE_WAY = [
    {"surface": "ensemble", "average": "report", "friction_velocity": 47.0, "footprint": 0.3, "wind_direction": 200.0},
    {"surface": "ensemble", "average": "report", "friction_velocity": 8.0, "wind_direction": 35.0},
    {"surface": "empirical", "friction_velocity": 47.0, "footprint": 0.3, "wind_direction": 200.0},
    {"surface": "empirical", "across": "slopes", "friction_velocity": 20.0, "ior": 1.33},
]
RECIPROCAL = [
    {"friction_velocity": 24.0},
    {"surface": "instance", "friction_velocity": 24.0, "components": 20},
    {"surface": "ensemble", "friction_velocity": 24.0, "wind_direction": 50.0},
    {"friction_velocity": 24.0, "water_leaving": {"type": "uniform", "value": 0.1}},
]


def names(seas):
    return ["-".join(map(str, sea.values())) for sea in seas]


def brdf(sea, light, observer):
    """f by the command."""
    rows = "\n".join(",".join(f"{x:.17g}" for x in (*a, *b)) for a, b in zip(light, observer, strict=True))
    done = subprocess.run([COMMAND, "brdf", *flags(sea)], input="ix,iy,iz,ox,oy,oz\n" + rows + "\n", capture_output=True,
                          text=True, check=True)
    return np.loadtxt(io.StringIO(done.stdout), delimiter=",", skiprows=1)[:, 6]


@pytest.mark.parametrize("variant", BOTH)
@pytest.mark.parametrize("sea", ONE_WAY, ids=names(ONE_WAY))
def test_f_is_the_commands(use, variant, sea):
    """eval over the cosine to wo is f with the light at wo in Radiance mode, at wi in Importance mode, for 100 pairs within
    1e-4; the two exchanged are far from it. Densities know nothing of it."""
    mi = use(variant)
    light, observer = glints(np.random.default_rng(3), 2000)
    f = brdf(sea, light.astype(float), observer.astype(float))
    light, observer, f = (v[f > 1e-3 * f.max()][:100] for v in (light, observer, f))
    assert len(f) == 100
    bsdf = mi.load_dict({"type": "prob_water", **sea})
    seen, seen_pdf = evaluate(mi, bsdf, observer, light, "Radiance")
    sent, sent_pdf = evaluate(mi, bsdf, light, observer, "Importance")
    for found in (seen / light[:, 2], sent / observer[:, 2]):
        print(f"\n{variant} {sea}: worst error {np.abs(found / f - 1).max():.1e}", end="")
        assert np.abs(found / f - 1).max() < 1e-4
    exchanged, pdf = evaluate(mi, bsdf, light, observer, "Radiance")
    print(f", exchanged {np.abs(exchanged / observer[:, 2] / f - 1).max():.1e}")
    assert np.abs(exchanged / observer[:, 2] / f - 1).max() > 0.05
    np.testing.assert_array_equal(pdf, sent_pdf)
    assert (seen_pdf > 0).all()


@pytest.mark.parametrize("variant", BOTH)
@pytest.mark.parametrize("sea", RECIPROCAL, ids=names(RECIPROCAL))
def test_reciprocal_surfaces_know_no_mode(use, variant, sea):
    mi = use(variant)
    i, o = glints(np.random.default_rng(4), 200)
    bsdf = mi.load_dict({"type": "prob_water", **sea})
    (seen, pdf), (sent, pdf2) = (evaluate(mi, bsdf, i, o, mode) for mode in ("Radiance", "Importance"))
    np.testing.assert_allclose(seen, sent, rtol=2e-6)
    np.testing.assert_array_equal(pdf, pdf2)


@pytest.mark.parametrize("variant", BOTH)
@pytest.mark.parametrize("mode", ["Radiance", "Importance"])
def test_eval_pdf_sample_is_the_three(use, variant, mode):
    """The fused call follows the mode as eval, pdf and sample do."""
    mi = use(variant)
    context = mi.BSDFContext(getattr(mi.TransportMode, mode))
    si = __import__("drjit").zeros(mi.SurfaceInteraction3f)
    si.wi = mi.Vector3f(direction(60.0, 180.0).tolist())
    wo, u = mi.Vector3f(direction(40.0, 10.0).tolist()), (0.3, mi.Point2f(0.4, 0.7))
    for sea in ONE_WAY:
        bsdf = mi.load_dict({"type": "prob_water", **sea})
        value, pdf, sample, weight = bsdf.eval_pdf_sample(context, si, wo, *u)
        drawn, weight2 = bsdf.sample(context, si, *u)
        for a, b in ((value, bsdf.eval(context, si, wo)), (pdf, bsdf.pdf(context, si, wo)), (weight, weight2),
                     (weight, bsdf.eval(context, si, drawn.wo) / drawn.pdf), (sample.wo, drawn.wo)):
            np.testing.assert_allclose(np.array(a), np.array(b), rtol=1e-4)


@pytest.mark.parametrize("light", ["directional", "area"])
@pytest.mark.parametrize("sea", ONE_WAY[::3], ids=names(ONE_WAY[::3]))
def test_path_and_ptracer_agree(use, sea, light):
    """Paths from the camera and from the light give the same picture, within 4 standard errors of 1 %; f is 15 % and more
    off where source and observer are exchanged."""
    mi = use("llvm_ad_rgb")
    at, view = direction(40.0, 180.0), direction(65.0, 0.0)
    look = mi.ScalarTransform4f().look_at
    emitters = {
        "directional": {"type": "directional", "direction": [-float(x) for x in at]},
        "area": {"type": "rectangle", "emitter": {"type": "area", "radiance": 20.0},
                 "bsdf": {"type": "diffuse", "reflectance": 0.0}, "to_world": look([float(4 * x) for x in at], [0, 0, 0], [0, 0, 1]) @ mi.ScalarTransform4f().scale(0.5)},
    }
    scene = mi.load_dict({
        "type": "scene",
        "water": {"type": "rectangle", "bsdf": {"type": "prob_water", **sea}},
        "light": emitters[light],
        "sensor": {"type": "perspective", "fov": 8.0, "to_world": look([float(20 * x) for x in view], [0, 0, 0], [0, 0, 1]),
                   "film": {"type": "hdrfilm", "width": 8, "height": 8, "rfilter": {"type": "box"},
                            "component_format": "float32"}},
    })
    means = []
    for integrator, samples in (("path", 500), ("ptracer", 25_000)):
        traced = mi.load_dict({"type": integrator, "max_depth": 2})
        images = [np.array(mi.render(scene, integrator=traced, spp=samples, seed=seed)).mean() for seed in range(6)]
        means.append((np.mean(images), np.std(images, ddof=1) / np.sqrt(len(images))))
    (path, error), (ptracer, error2) = means
    print(f"\n{sea} {light}: path {path:.5f} +- {error:.5f}, ptracer {ptracer:.5f} +- {error2:.5f}, ratio {path / ptracer:.4f}")
    assert np.hypot(error, error2) < 0.01 * path
    assert abs(path - ptracer) < 4 * np.hypot(error, error2)


SEAS = [
    {"friction_velocity": 4.0, "footprint": 0.15},
    {"friction_velocity": 8.0, "footprint": 0.15, "wind_direction": 35.0},
    {"friction_velocity": 16.0, "footprint": 0.3, "wind_direction": -60.0},
    {"friction_velocity": 24.0, "footprint": 0.15, "wind_direction": 90.0},
    {"friction_velocity": 40.0, "footprint": 0.1, "wind_direction": 180.0},
    {"friction_velocity": 56.0, "footprint": 0.15, "wind_direction": 200.0},
]
#: From the vertical, and the azimuth from the light's.
VIEWS = [(0, 0), (20, 180), (40, 180), (60, 180), (70, 180), (75, 180), (50, 160), (70, 165)]


def cast(tmp_path, sea, light, views, instances):
    """Means of f over beams cast onto drawn seas, and their standard errors, by the command."""
    model = "\n".join(f"{name} = {value}" for name, value in sea.items())
    observers = (1e6 * views).tolist()
    (tmp_path / "cast.toml").write_text(
        f'draws = "sobol"\nwhitecap_presence = "expected"\n[model]\n{model}\ninstances = {instances}\n'
        f"[[engagement]]\nlaser = {(1e5 * light).tolist()}\ntarget = [0, 0, 0]\nobservers = {observers}\n")
    done = subprocess.run([COMMAND, "scenario", tmp_path / "cast.toml"], capture_output=True, text=True, check=True)
    return np.array([[float(row[name]) for name in ("mean", "sem")] for row in csv.DictReader(io.StringIO(done.stdout))]).T


@pytest.mark.parametrize("sea", SEAS, ids=names(SEAS))
def test_eval_is_the_ray_casts_mean(use, tmp_path, sea, full):
    """The light at wo, the camera at wi, views to 75 degrees: within 6 % of beams cast from the light onto drawn seas, wherever
    f exceeds 2 % of its peak; with the report's Gaussian in the plane of incidence, where it is meant. The two exchanged are 10 %
    off and more."""
    mi = use("scalar_rgb")
    views = np.array([direction(*view) for view in VIEWS])
    surfaces = {"average = report": {"surface": "ensemble", "average": "report"},
                "slopes": {"surface": "empirical", "across": "slopes"}, "report": {"surface": "empirical"}}
    bsdfs = {name: mi.load_dict({"type": "prob_water", **surface, **sea}) for name, surface in surfaces.items()}
    worst, exchanged = dict.fromkeys(surfaces, 0.0), dict.fromkeys(surfaces, 0.0)
    for incidence in (0.0, 30.0, 45.0, 55.0, 70.0):
        light = direction(incidence, 0.0)
        mean, error = cast(tmp_path, sea, light, views, 400_000 if full else 20_000)
        lights = np.tile(light, (len(views), 1))
        for name, bsdf in bsdfs.items():
            counts = (mean > 0.02 * mean.max()) & (error < 0.012 * mean)
            if name == "report":
                # At normal incidence the plane is the wind's.
                counts &= np.array([theta == 0 or (incidence > 0 and azimuth == 180) for theta, azimuth in VIEWS])
            found = evaluate(mi, bsdf, views, lights)[0] / light[2]
            other = evaluate(mi, bsdf, lights, views)[0] / views[:, 2]
            worst[name] = max(worst[name], np.abs(found / mean - 1)[counts].max())
            exchanged[name] = max(exchanged[name], np.abs(other / mean - 1)[counts].max())
    for name in surfaces:
        print(f"\n{sea} {name}: off by {worst[name]:.3f}, exchanged by {exchanged[name]:.3f}", end="")
        assert worst[name] < 0.06 and exchanged[name] > 0.1
