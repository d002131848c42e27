"""`surface = "instance"`: one drawn sea on a level surface, and what changes from place to place."""

import io
import subprocess

import numpy as np
import pytest

from validation.support.command import COMMAND, flags
from validation.support.core import direction
from validation.support.lit_water import IRRADIANCE, scene, sun
from validation.support.plugin_calls import adapter, draw, evaluate, glints

SEAS = [
    {"friction_velocity": 8.0},
    {"friction_velocity": 24.0, "components": 20, "wind_direction": 30.0, "seed": 4, "time": 3.5},
    {"friction_velocity": 56.0, "slope_measure": "slope", "fresnel": "exact", "footprint": 0.3},
    # Waves too gentle for whitecaps, whatever Eq. 51 says of this wind.
    {"wind_speed": 25.0, "footprint": "inf", "whitecap_onset": "ramp"},
]


def command(sea, i, o, places):
    """f by the command at places, m."""
    rows = np.column_stack([i, o, places])
    text = "ix,iy,iz,ox,oy,oz,x,y\n" + "\n".join(",".join(f"{x:.17g}" for x in row) for row in rows) + "\n"
    done = subprocess.run([COMMAND, "brdf", "--surface", "instance", *flags(sea)], input=text, capture_output=True,
                          text=True, check=True)
    return np.loadtxt(io.StringIO(done.stdout), delimiter=",", skiprows=1)[:, 8]


def looks(mi, plane, origins, views):
    """Radiance along rays from `origins` against `views`, shape (rows,), and where they meet the water, (rows, 2)."""
    import drjit as dr

    integrator, sampler = plane.integrator(), mi.load_dict({"type": "independent", "sample_count": 1})
    if dr.is_jit_v(mi.Float):
        sampler.seed(7, len(views))
        ray = mi.RayDifferential3f(mi.Ray3f(mi.Point3f(origins.T), mi.Vector3f(-views.T)))
        return np.array(integrator.sample(plane, sampler, ray)[0])[0], np.array(plane.ray_intersect(ray).p).T[:, :2]
    sampler.seed(7)
    rows = []
    for origin, view in zip(origins.tolist(), views.tolist()):
        ray = mi.RayDifferential3f(mi.Ray3f(mi.Point3f(origin), mi.Vector3f([-x for x in view])))
        rows.append([integrator.sample(plane, sampler, ray)[0][0], *plane.ray_intersect(ray).p[:2]])
    rows = np.array(rows)
    return rows[:, 0], rows[:, 1:]


@pytest.mark.parametrize("variant", ["scalar_rgb", "llvm_ad_rgb"])
@pytest.mark.parametrize("sea", SEAS, ids=lambda s: "-".join(map(str, s.values())))
def test_radiance_equals_the_core(use, variant, sea):
    """L = f E cos(theta_i) at 100 points of flat water under a directional emitter, within 1e-4."""
    mi, rng = use(variant), np.random.default_rng(3)
    i = direction(35.0, 60.0).astype(np.float32)
    h = direction(12 * np.sqrt(rng.random(100)), rng.uniform(0, 360, 100))
    o = 2 * (h @ i)[:, None] * h - i
    o = (o / np.linalg.norm(o, axis=1, keepdims=True)).astype(np.float32)
    origins = (10 * o).astype(np.float32)
    origins[:, :2] += rng.uniform(-40, 40, (100, 2)).astype(np.float32)
    plane = scene(mi, {"surface": "instance", **sea}, sun=sun(i))
    found, places = looks(mi, plane, origins, o)
    expected = command(sea, np.tile(i / np.linalg.norm(i.astype(float)), (100, 1)), o, places) * IRRADIANCE * i[2]
    counts = expected > 1e-3 * expected.max()
    error = np.abs(found - expected)[counts] / expected[counts]
    print(f"\n{variant} {sea}: {counts.sum()} points, worst {error.max():.1e}, median {np.median(error):.1e}")
    assert counts.sum() > 60 and error.max() < 1e-4


def test_mean_over_places_is_the_ensemble(use):
    """Over an area and seeds, within 4 standard errors of them."""
    mi = use("llvm_ad_rgb")
    import drjit as dr

    rng, context = np.random.default_rng(8), mi.BSDFContext()
    sea = {"friction_velocity": 16.0, "components": 8, "wind_direction": 25.0, "shadowing": True}
    i = direction(np.array([0.0, 30, 30, 50]), np.zeros(4))
    o = direction(np.array([20.0, 20, 45, 40]), np.array([100.0, 180, 160, 190]))
    afar = mi.load_dict({"type": "prob_water", "surface": "ensemble", **sea})
    si = dr.zeros(mi.SurfaceInteraction3f, 4)
    si.wi = mi.Vector3f(i.T)
    wanted = np.array(afar.eval(context, si, mi.Vector3f(o.T)))[0]
    means = []
    for seed in range(300):
        bsdf = mi.load_dict({"type": "prob_water", "surface": "instance", "seed": seed, **sea})
        places = rng.uniform(-2000, 2000, (2, 4 * 1000))
        si = dr.zeros(mi.SurfaceInteraction3f, 4000)
        si.wi = mi.Vector3f(np.repeat(i, 1000, axis=0).T)
        si.p = mi.Point3f(places[0], places[1], 0)
        si.sh_frame = mi.Frame3f(mi.Vector3f(1, 0, 0), mi.Vector3f(0, 1, 0), mi.Vector3f(0, 0, 1))
        value = bsdf.eval(context, si, mi.Vector3f(np.repeat(o, 1000, axis=0).T))
        means.append(np.array(value)[0].reshape(4, 1000).mean(axis=1))
    mean, error = np.mean(means, axis=0), np.std(means, axis=0) / np.sqrt(len(means))
    print("\n", mean, wanted, (mean - wanted) / error)
    assert (error < 0.03 * mean).all() and (np.abs(mean - wanted) < 4 * error).all()


@pytest.mark.parametrize("variant", ["scalar_rgb", "llvm_ad_rgb"])
@pytest.mark.parametrize("wind", [2.0, 24.0])
def test_a_footprint_texture_is_the_footprint(use, variant, wind):
    """A texture that says 0.3 m is footprint = 0.3; likewise for whitecaps."""
    mi, rng = use(variant), np.random.default_rng(4)
    i, o = glints(rng, 300)
    uniform = {"type": "uniform", "value": 0.3}
    for textured, plain in [
        ({"footprint": uniform}, {"footprint": 0.3}),
        ({"footprint": {"type": "uniform", "value": 1e9}}, {}),
    ]:
        a, b = (mi.load_dict({"type": "prob_water", "friction_velocity": wind, "gram_charlier": False, **p})
                for p in (textured, plain))
        (f, pdf), (f2, pdf2) = evaluate(mi, a, i, o), evaluate(mi, b, i, o)
        counts = f2 > 1e-4 * f2.max()
        assert np.max(np.abs(f / f2 - 1)[counts]) < 3e-3 and np.max(np.abs(pdf / pdf2 - 1)[counts]) < 3e-3
    # Of the whitecaps' texture the share is linear.
    none, all_, some = (
        evaluate(mi, mi.load_dict({"type": "prob_water", "friction_velocity": wind,
                                   "whitecaps": {"type": "uniform", "value": share}}), i, o)[0]
        for share in (0.0, 1.0, 0.3))
    np.testing.assert_allclose(some, 0.7 * none + 0.3 * all_, rtol=1e-4, atol=1e-6)


def places(mi, parameters, i, o, rng):
    """f cos(theta_o) at random places of a square of 400 m."""
    import drjit as dr

    bsdf, context = mi.load_dict({"type": "prob_water", **parameters}), mi.BSDFContext()
    where = rng.uniform(-200, 200, (len(i), 2)).astype(np.float32)
    frame = mi.Frame3f(mi.Vector3f(1, 0, 0), mi.Vector3f(0, 1, 0), mi.Vector3f(0, 0, 1))
    if dr.is_jit_v(mi.Float):
        si = dr.zeros(mi.SurfaceInteraction3f, len(i))
        si.wi, si.p, si.sh_frame = mi.Vector3f(i.T), mi.Point3f(where[:, 0], where[:, 1], 0), frame
        return np.array(bsdf.eval(context, si, mi.Vector3f(o.T)))[0]
    si, found = mi.SurfaceInteraction3f(), []
    si.sh_frame = frame
    for a, b, x in zip(i.tolist(), o.tolist(), where.tolist()):
        si.wi, si.p = mi.Vector3f(a), mi.Point3f(*x, 0)
        found.append(bsdf.eval(context, si, mi.Vector3f(b))[0])
    return np.array(found)


@pytest.mark.parametrize("wind, allowed", [(8.0, 0.06), (24.0, 0.03)])
def test_a_drawn_sea_keeps_its_slopes_under_a_texture(use, wind, allowed):
    """Where the footprint's texture says 0.15 m, waves fade around 2 D instead of ending there: on average the same."""
    mi, rng = use("llvm_ad_rgb"), np.random.default_rng(4)
    down = np.tile(direction(0.0, 0.0), (4000, 1)).astype(np.float32)
    for view in (0.0, 20.0, 40.0):
        look = np.tile(direction(view, 30.0), (4000, 1)).astype(np.float32)
        sea = {"surface": "instance", "friction_velocity": wind, "components": 400}
        means = [np.mean([places(mi, {**sea, "seed": seed, "footprint": footprint}, down, look, rng) for seed in range(12)])
                 for footprint in ({"type": "uniform", "value": 0.15}, 0.15)]
        print(f"\nw* {wind} view {view}: {means[0] / means[1] - 1:+.3f}")
        assert abs(means[0] / means[1] - 1) < allowed


@pytest.mark.parametrize("variant", ["scalar_rgb", "llvm_ad_rgb"])
@pytest.mark.parametrize("value", [0.0, -1.0, float("nan"), float("inf"), 1e-30])
@pytest.mark.parametrize("surface", ["flat", "instance"])
def test_no_texture_value_breaks_anything(use, variant, value, surface):
    """What is no length is the smallest footprint, what is no probability lies within 0 and 1, in every variant."""
    mi = use(variant)
    i, o = (np.tile(direction(t, p), (5, 1)).astype(np.float32) for t, p in ((20.0, 0.0), (20.0, 180.0)))
    texture = {"type": "uniform", "value": value}
    for name in ("footprint", "whitecaps"):
        wanted = {"footprint": 1e-6 if not value > 1 else 1e20, "whitecaps": 1.0 if value > 1 else 0.0}[name]
        found, expected = (places(mi, {"surface": surface, "wind_speed": 5.0, name: given}, i, o, np.random.default_rng(2))
                           for given in (texture, {"type": "uniform", "value": wanted}))
        assert np.isfinite(found).all() and (found >= 0).all()
        np.testing.assert_allclose(found, expected, rtol=1e-5)


@pytest.mark.parametrize("variant, integrator, pixel", [
    ("scalar_rgb", "direct", {}),
    ("scalar_rgb", "path", {"pixel_angle": np.degrees(0.02)}),
    ("llvm_ad_rgb", "path", {"pixel_angle": np.degrees(0.02)}),
])
def test_pixel_footprint(use, variant, integrator, pixel):
    """The facets' D is the side of a square as large as the pixel on the water; with differentials, the sample's share."""
    mi = use(variant)
    i, o = direction(35.0, 180.0), direction(40.0, 0.0)
    film = {"type": "hdrfilm", "width": 1, "height": 1, "rfilter": {"type": "box"}, "pixel_format": "luminance",
            "component_format": "float32"}
    distance, width = 50.0, 0.02
    sensor = {"type": "perspective", "fov": float(np.degrees(width)), "film": film, "to_world": mi.ScalarTransform4f()
              .look_at(origin=[float(distance * x) for x in o], target=[0, 0, 0], up=[0, 0, 1])}
    side = float(distance * width / np.sqrt(o[2]))

    def image(water, samples):
        view = scene(mi, {"friction_velocity": 24.0, **water}, sun=sun(i), sensor=sensor)
        return np.array(mi.render(view, integrator=mi.load_dict({"type": integrator}), spp=samples, seed=2)).item()

    for samples in (1, 64):
        share = side if pixel else side / samples**0.5
        found, wanted = image({"footprint": "pixel", **pixel}, samples), image({"footprint": share, "footprint_measure": "side"}, samples)
        other = image({}, samples)
        print(f"\n{samples} samples: {found} {wanted} {other}")
        assert abs(found / wanted - 1) < 1e-2 < 5e-2 < abs(other / wanted - 1)


@pytest.mark.parametrize("variant", ["scalar_rgb", "llvm_ad_rgb"])
def test_nothing_from_below_the_horizon(use, variant):
    """Where the source is below the level surface there is neither value nor density, however the wave leans."""
    mi, rng = use(variant), np.random.default_rng(5)
    i = direction(rng.uniform(90.5, 105, 300), rng.uniform(0, 360, 300)).astype(np.float32)
    o = direction(rng.uniform(0, 60, 300), rng.uniform(0, 360, 300)).astype(np.float32)
    bsdf = mi.load_dict({"type": "prob_water", "surface": "instance", "friction_velocity": 120.0})
    for a, b in ((i, o), (o, i)):
        value, pdf = evaluate(mi, bsdf, a, b)
        assert (value == 0).all() and (pdf == 0).all()


@pytest.mark.parametrize("variant", ["scalar_rgb", "llvm_ad_rgb"])
def test_light_from_below(use, variant):
    """Diffuse, reciprocal, and the albedo of all stays below 1 for any reflectance."""
    mi, rng = use(variant), np.random.default_rng(6)
    below = {"water_leaving": {"type": "uniform", "value": 1.0}}
    for sea in ({"friction_velocity": 8.0}, {"friction_velocity": 56.0, "surface": "instance"}, {"friction_velocity": 0.0}):
        with_it, without = (mi.load_dict({"type": "prob_water", **sea, **p}) for p in (below, {}))
        assert with_it.component_count() == 2
        i = direction(rng.uniform(0, 80, 400), rng.uniform(0, 360, 400)).astype(np.float32)
        o = direction(rng.uniform(0, 80, 400), rng.uniform(0, 360, 400)).astype(np.float32)
        there = evaluate(mi, with_it, i, o)[0] - evaluate(mi, without, i, o)[0]
        back = evaluate(mi, with_it, o, i)[0] - evaluate(mi, without, o, i)[0]
        np.testing.assert_allclose(there * i[:, 2], back * o[:, 2], rtol=1e-3, atol=1e-5)
        assert (there > 0).all()
        for incidence in (0.0, 60.0, 80.0):
            count = 200_000 if variant.startswith("llvm") else 2000
            where = np.repeat(direction(incidence, 40.0)[None], count, axis=0).astype(np.float32)
            wo, weight = draw(mi, with_it, where, rng.uniform(0, 1, (count, 3)).astype(np.float32))
            value, pdf = evaluate(mi, with_it, where[:50], wo[:50])
            drawn = pdf > 1e-6
            np.testing.assert_allclose(weight[:50][drawn], value[drawn] / pdf[drawn], rtol=3e-3)
            error = weight.std() / np.sqrt(count)
            print(f"{variant} {sea} {incidence}: albedo {weight.mean():.4f} +- {error:.4f}")
            assert 0.5 < weight.mean() < 1 + 3 * error


def test_chi_square(use):
    """Draws follow their density at a place of a drawn sea, and with light from below."""
    mi = use("llvm_ad_rgb")
    from mitsuba.chi2 import ChiSquareTest, SphericalDomain

    for parameters in (
        {"surface": "instance", "friction_velocity": 24.0, "seed": 3},
        {"friction_velocity": 56.0, "water_leaving": {"type": "uniform", "value": 0.1}},
        {"friction_velocity": 24.0, "footprint": {"type": "uniform", "value": 0.1}},
    ):
        for incidence in (10.0, 60.0):
            sample, pdf = adapter(mi, parameters, direction(incidence, 20.0), mi.BSDFContext())
            test = ChiSquareTest(SphericalDomain(), sample, pdf, sample_dim=3, sample_count=1_000_000, ires=32)
            assert test.run(0.01, test_count=6, quiet=True), (parameters, test.messages)


def test_time_moves_the_waves(use):
    """A still frame depends on parameters and seed alone; time, set afterwards, is that of a new BSDF."""
    mi = use("llvm_ad_rgb")
    import drjit as dr

    context, places = mi.BSDFContext(), np.random.default_rng(1).uniform(-50, 50, (2, 500))

    def value(bsdf):
        si = dr.zeros(mi.SurfaceInteraction3f, 500)
        si.wi, si.p = mi.Vector3f(0, 0, 1), mi.Point3f(places[0], places[1], 0)
        si.sh_frame = mi.Frame3f(mi.Vector3f(1, 0, 0), mi.Vector3f(0, 1, 0), mi.Vector3f(0, 0, 1))
        return np.array(bsdf.eval(context, si, mi.Vector3f(0, 0.1, 0.995)))[0]

    make = lambda **p: mi.load_dict({"type": "prob_water", "surface": "instance", **p})  # noqa: E731
    first, again, later, other = make(), make(), make(time=0.75), make(seed=1)
    assert (value(first) == value(again)).all()
    assert np.abs(value(first) - value(later)).max() > 1e-3 < np.abs(value(first) - value(other)).max()
    parameters = mi.traverse(first)
    parameters["time"] = 0.75
    parameters.update()
    np.testing.assert_allclose(value(first), value(later), rtol=1e-6)
