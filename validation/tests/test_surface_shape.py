"""The shape prob_water_surface: its vertices against the core's sea, its slopes at every distance, time, and refusals."""

import csv
import re
import subprocess

import numpy as np
import pytest

from validation.support.core import Core
from validation.support.paths import ROOT

VARIANTS = ["scalar_rgb", "llvm_ad_rgb"]
DIFFUSE = {"type": "diffuse"}


def surface(mi, **parameters):
    """The shape under a diffuse BSDF."""
    return mi.load_dict({"type": "prob_water_surface", "bsdf": DIFFUSE, **parameters})


def buffers(mi, shape):
    """Positions, normals and attributes, a row for each vertex."""
    found = mi.traverse(shape)
    width = {"vertex_positions": 3, "vertex_normals": 3, "vertex_texcoords": 2, "vertex_footprint": 1, "vertex_whitecaps": 1}
    return {name: np.array(found[name]).reshape(-1, n) for name, n in width.items() if name in found}


def looked_down(mi, shape, places):
    """Shading normals, D and whitecaps below places."""
    import drjit as dr

    scene = mi.load_dict({"type": "scene", "shape": shape})

    def hit(x, y):
        si = scene.ray_intersect(mi.Ray3f(mi.Point3f(x, y, 100), mi.Vector3f(0, 0, -1)))
        return [si.sh_frame.n, shape.eval_attribute_1("vertex_footprint", si),
                shape.eval_attribute_1("vertex_whitecaps", si), si.dp_du]

    if dr.is_jit_v(mi.Float):
        return [np.array(x).T for x in hit(*places.T.astype(np.float32))]
    rows = [hit(x, y) for x, y in places.tolist()]
    return [np.array([row[m] for row in rows]) for m in range(4)]


@pytest.mark.parametrize("variant", VARIANTS)
def test_vertices_are_the_sea_of_the_command(use, variant):
    """Where all cells are the centre's, heights and normals are those of `prob-water surface` to float32."""
    mi = use(variant)
    sea = {"friction_velocity": 16.0, "wind_direction": 30.0, "footprint": 0.2, "seed": 4, "components": 300}
    shape = surface(mi, **sea, radius=4.0, center=[20.0, -7.0, 0.0], time=2.5)
    for time in (2.5, -8.0):
        if time != 2.5:
            parameters = mi.traverse(shape)
            parameters["time"] = time
            parameters.update()
        found = buffers(mi, shape)
        assert np.array_equal(found["vertex_texcoords"], found["vertex_positions"][:, :2])
        # Facets make up for what interpolation between vertices loses.
        assert 0.2 <= found["vertex_footprint"].min() == found["vertex_footprint"].max() < 0.25
        rows = np.random.default_rng(1).integers(0, len(found["vertex_positions"]), 500)
        points = "x,y\n" + "".join(f"{x:.9g},{y:.9g}\n" for x, y in found["vertex_positions"][rows, :2])
        flags = [f"--{name.replace('_', '-')}={value}" for name, value in {**sea, "time": time}.items()]
        command = [ROOT / "target/release/prob-water", "surface", "--points", "-", "--draws", "stratified", "--fade", *flags]
        text = subprocess.run(command, input=points, capture_output=True, text=True, check=True).stdout
        expected = np.array([[float(r[n]) for n in ("height", "nx", "ny", "nz")] for r in csv.DictReader(text.splitlines())])
        assert np.allclose(found["vertex_positions"][rows, 2], expected[:, 0], rtol=0, atol=2e-7)
        assert np.allclose(found["vertex_normals"][rows], expected[:, 1:], rtol=0, atol=2e-7)
    assert "time = -8\n" in str(shape)


@pytest.mark.parametrize("variant", VARIANTS)
def test_to_world_and_frame(use, variant):
    """A rotated and shifted shape is the same sea there; the shading frame's s is the sea's +x."""
    mi = use(variant)
    sea = {"friction_velocity": 24.0, "vertices": 20_000, "radius": 1000.0}
    turn = mi.ScalarTransform4f().translate([5, 6, 7]).rotate([0, 0, 1], 90)
    plain, turned = (buffers(mi, surface(mi, **sea, **more)) for more in ({}, {"to_world": turn}))
    x, y, z = plain["vertex_positions"].T
    assert np.allclose(turned["vertex_positions"], np.stack([5 - y, 6 + x, 7 + z], axis=1), rtol=1e-6, atol=2e-4)
    nx, ny, nz = plain["vertex_normals"].T
    assert np.allclose(turned["vertex_normals"], np.stack([-ny, nx, nz], axis=1), atol=1e-6)
    shape = surface(mi, **sea, to_world=turn)
    places = np.random.default_rng(2).uniform(-300, 300, (40, 2))
    s = looked_down(mi, shape, places)[3]
    s /= np.linalg.norm(s, axis=1, keepdims=True)
    assert np.all(np.abs(s[:, 0]) < 0.02) and np.all(s[:, 1] > 0.8)
    box = shape.bbox()
    assert np.allclose([box.min.x, box.min.y, box.max.x, box.max.y], [-995, -994, 1005, 1006], atol=1)


def test_slopes_are_complete_at_every_distance(use, full):
    """Waves in the shading normals and facets at the attribute's D have together the variance of the spectrum's resolved
    part and the facets at the mesh's D, from 2 m to 10 km, within 5 %; nothing jumps between distances."""
    mi = use("llvm_ad_rgb")
    distances, seeds, rays = 2.0 * 1.5 ** np.arange(22), 24 if full else 8, 4000
    for wind in (8.0, 24.0) if not full else (4.0, 8.0, 16.0, 24.0, 40.0, 56.0):
        rows = np.zeros((len(distances), 4))
        for seed in range(seeds):
            shape = surface(mi, friction_velocity=wind, seed=seed, vertices=150_000)
            rng = np.random.default_rng(seed)
            radius = np.repeat(distances, rays) * rng.uniform(0.8, 1.2, rays * len(distances))
            turn = rng.uniform(0, 2 * np.pi, len(radius))
            places = np.stack([radius * np.cos(turn), radius * np.sin(turn)], axis=1)
            normal, footprint, whitecap, _ = looked_down(mi, shape, places)
            slope = normal[:, :2] / normal[:, 2:]
            columns = [slope[:, 0] ** 2, slope[:, 1] ** 2, footprint, whitecap]
            rows += np.stack([np.mean(c.reshape(len(distances), rays), axis=1) for c in columns], axis=1) / seeds
        print(f"\nw* = {wind}: distance, D, resolved, facets, all upwind; the same crosswind; whitecaps")
        totals = []
        center, edge = map(float, re.search(r"footprint at center = (.*), at edge = (.*)\]", str(shape)).groups())
        for distance, (u, c, at_facets, whitecap) in zip(distances, rows):
            footprint = max(center, edge * distance / 20e3)
            core, seen = (Core(friction_velocity=wind, footprint=d) for d in (footprint, at_facets))
            facets = np.array([seen.sigma_u2, seen.sigma_c2])
            ratio = (np.array([u, c]) + facets) / (resolved(wind, footprint) + np.array([core.sigma_u2, core.sigma_c2]))
            totals.append(ratio)
            print(f"{distance:8.1f} {footprint:8.2f}   {u:.5f} {facets[0]:.5f} {ratio[0]:.3f}   "
                  f"{c:.5f} {facets[1]:.5f} {ratio[1]:.3f}   {whitecap:.5f}")
        totals = np.array(totals)
        assert np.all(np.abs(totals - 1) < 0.05)
        assert np.all(np.abs(np.diff(totals, axis=0)) < 0.05)


def resolved(wind, footprint):
    """Variances of the slopes that a footprint leaves to geometry, from the waves that the command draws."""
    flags = ["--waves", "--draws", "stratified", "--fade", "--components", "4000",
             f"--friction-velocity={wind}", f"--footprint={footprint}"]
    command = [ROOT / "target/release/prob-water", "surface", *flags]
    text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    waves = list(csv.DictReader(text.splitlines()))
    a, k, phi = (np.array([float(w[n]) for w in waves]) for n in ("amplitude_m", "wave_number_rad_m", "azimuth_rad"))
    return np.array([np.sum(0.5 * (a * k * np.cos(phi)) ** 2), np.sum(0.5 * (a * k * np.sin(phi)) ** 2)])


@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize("words, message", [
    ({"memory": 100}, "memory = 100 is out of range: allowed is at least"),
    ({"vertices": 500, "footprint": 0.01}, "vertices = 500 is out of range: allowed is at least"),
    ({"vertices": 400_000_000}, "memory = 2048 is out of range"),
    ({"vertices": 2.5}, "vertices = 2.5 is out of range"),
    ({"radius": -1.0}, "radius = -1 is out of range"),
    ({"opening": 400.0}, "opening = 400 is out of range"),
    ({"footprint": "inf"}, "footprint = inf is out of range"),
    ({"surface": "flat"}, "surface = flat has no meaning here"),
    ({"instances": 5}, "instances = 5 has no meaning here"),
    ({"wind_speed": 99.0}, "wind_speed = 99 is out of range"),
    ({"wave_height": 1.0}, "wave_height"),
    ({"footprint": 1e-310}, "footprint = "),
    ({"opening": 1e-5}, "opening = 0.00001 is out of range"),
    ({"center": [0.0, 0.0, 1.0]}, "center has z = 1"),
    ({"average": "report"}, "average = report has no meaning here"),
    ({"flip_normals": True}, "flip_normals = true has no meaning here"),
    ({"face_normals": True}, "face_normals = true has no meaning here"),
    ({"to_world": ("scale", [1, 1, 3])}, "to_world scales, shears, mirrors"),
    ({"to_world": ("scale", [-1, 1, 1])}, "to_world scales, shears, mirrors"),
    ({"to_world": ("translate", [0, 0, float("inf")])}, "to_world"),
])
def test_refusals(use, variant, words, message):
    mi = use(variant)
    if "to_world" in words:
        name, value = words["to_world"]
        words = {"to_world": getattr(mi.ScalarTransform4f(), name)(value)}
    with pytest.raises(RuntimeError) as error:
        surface(mi, **words)
    assert message in str(error.value)


@pytest.mark.parametrize("variant", VARIANTS)
def test_one_sea_is_described_once(use, variant):
    """A nested prob_water takes the shape's sea, adds what is not the sea, and refuses the rest; the shape's own is the same."""
    mi = use(variant)
    base = {"type": "prob_water_surface", "beaufort": 6, "radius": 20.0, "seed": 3, "vertices": 3000}
    own, plain, exact = (mi.load_dict(base | nested) for nested in (
        {}, {"b": {"type": "prob_water"}}, {"b": {"type": "prob_water", "fresnel": "exact", "water_leaving": 0.02}}))
    assert str(own.bsdf()) == str(plain.bsdf()) != str(exact.bsdf())
    for line in ("beaufort = 6", "seed = 3", "components = 512", 'footprint = "varies"'):
        assert line in str(own.bsdf())
    assert 'fresnel = "exact"' in str(exact.bsdf()) and "water_leaving" in str(exact.bsdf())
    # The sea cannot be changed through its BSDF, time goes to both.
    parameters = mi.traverse(own)
    assert not any(name in parameters for name in ("bsdf.beaufort", "bsdf.wind_direction", "bsdf.time"))
    parameters["time"] = 4.0
    parameters.update()
    assert str(own).count("time = 4\n") == 2
    for nested in ({"wind_speed": 3.0}, {"seed": 3}, {"footprint": 0.3}, {"whitecaps": False}):
        with pytest.raises(RuntimeError, match=f"{next(iter(nested))} is given on the BSDF of a prob_water_surface"):
            mi.load_dict(base | {"b": {"type": "prob_water", **nested}})
    with pytest.raises(RuntimeError, match="ior is given on the BSDF"):
        mi.load_dict(base | {"ior": 1.34, "b": {"type": "prob_water", "ior": 1.34}})
    shared = mi.load_dict({"type": "prob_water"})
    mi.load_dict(base | {"b": shared})
    with pytest.raises(RuntimeError, match="cannot lie on two"):
        mi.load_dict(base | {"b": shared})


@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize("wind", [3.0, 15.0])
def test_nested_deeper_it_is_the_same_sea(use, variant, wind):
    """A prob_water inside of other BSDFs takes the shape's sea and time too: pictures and parameters are those of one that
    lies on the shape itself."""
    mi = use(variant)

    def wrapped():
        """New ones every time: each takes a sea of its own."""
        water, up = {"type": "prob_water"}, mi.Bitmap(np.full((2, 2, 3), [0.5, 0.5, 1.0], np.float32))
        return {
            "twosided": {"type": "twosided", "b": water},
            "both sides": {"type": "twosided", "a": water, "b": dict(water)},
            "mask": {"type": "mask", "opacity": 1.0, "b": water},
            "blendbsdf": {"type": "blendbsdf", "weight": 0.5, "a": water, "b": dict(water)},
            "bumpmap": {"type": "bumpmap", "t": {"type": "uniform", "value": 0.0}, "b": water},
            "normalmap": {"type": "normalmap", "normalmap": {"type": "bitmap", "raw": True, "bitmap": up}, "b": water},
            "two deep": {"type": "mask", "opacity": 1.0, "b": {"type": "twosided", "b": water}},
        }

    def picture(bsdf):
        sea = mi.load_dict({"type": "prob_water_surface", "wind_speed": wind, "radius": 100.0, "vertices": 20_000, "seed": 2,
                            "b": bsdf})
        scene = mi.load_dict({
            "type": "scene", "integrator": {"type": "path", "max_depth": 2}, "sea": sea,
            "sun": {"type": "directional", "direction": [-1, 0, -1]},
            "sensor": {"type": "perspective", "fov": 40,
                       "to_world": mi.ScalarTransform4f().look_at([-20, 0, 20], [0, 0, 0], [0, 0, 1]),
                       "film": {"type": "hdrfilm", "width": 24, "height": 24, "rfilter": {"type": "box"}}},
        })
        parameters = mi.traverse(sea)
        images = [np.array(mi.render(scene, spp=16, seed=1))]
        parameters["time"] = 3.0
        parameters.update()
        return [*images, np.array(mi.render(scene, spp=16, seed=1))], str(sea), parameters

    plain, _, _ = picture({"type": "prob_water"})
    assert plain[0].mean() > 1e-3 and not np.array_equal(*plain)
    for name, bsdf in wrapped().items():
        images, text, parameters = picture(bsdf)
        for image, wanted in zip(images, plain, strict=True):
            np.testing.assert_allclose(image, wanted, rtol=2e-3, atol=2e-3 * wanted.mean(), err_msg=name)
        # The sea's own line, and one of each BSDF.
        count = 3 if name in ("both sides", "blendbsdf") else 2
        assert text.count("time = 3\n") >= count and text.count(f"wind_speed = {wind:g}\n") >= count, (name, text)
        assert not any(key.endswith("wind_speed") for key in parameters.keys())
    with pytest.raises(RuntimeError, match="wind_speed is given on the BSDF of a prob_water_surface"):
        picture({"type": "twosided", "b": {"type": "prob_water", "wind_speed": 4.0}})


@pytest.mark.parametrize("variant", VARIANTS)
def test_refused_time_changes_nothing(use, variant):
    mi = use(variant)
    shape = surface(mi, vertices=5000, radius=100.0)
    before = buffers(mi, shape)["vertex_positions"]
    parameters = mi.traverse(shape)
    parameters["time"] = 1e12
    with pytest.raises(RuntimeError, match="time = 1000000000000"):
        parameters.update()
    assert mi.traverse(shape)["time"] == 0 and np.array_equal(buffers(mi, shape)["vertex_positions"], before)
    # No whitecaps: no attribute.
    assert "vertex_whitecaps" not in buffers(mi, surface(mi, whitecaps=False, vertices=5000, radius=100.0))
