"""What a render says about its sea is enough for the command to give the same BRDF."""

import csv
import io
import subprocess

import numpy as np
import pytest

from validation.support.command import COMMAND
from validation.support.core import direction
from validation.support.mitsuba_setup import SEA, sea_of

SCENE = {
    "type": "scene",
    "integrator": {"type": "path"},
    "sensor": {"type": "perspective", "film": {"type": "hdrfilm", "width": 8, "height": 8}},
    "light": {"type": "constant"},
}
WATERS = [
    {"friction_velocity": 31.7, "wind_direction": 40.1, "footprint": 0.15, "fresnel": "exact", "ior": 1.3337},
    {"wind_speed": 11.0, "wind_height": 19.5, "wavelength": 1.064, "slope_measure": "slope"},
    {"beaufort": 9, "readings": "as_printed", "gram_charlier": False, "water": "fresh"},
    {"wind_speed": 8.1, "surface": "ensemble", "fetch": 3e4, "seed": 7},
    {},
]


@pytest.mark.parametrize("parameters", WATERS, ids=lambda p: "-".join(p) or "default")
def test_the_command_reproduces_a_render(use, tmp_path, parameters):
    """An EXR written as the review renders are; ten directions, f against eval over the cosine."""
    mi = use("scalar_rgb")
    scene = mi.load_dict(SCENE | {"sea": {"type": "rectangle", "bsdf": {"type": "prob_water", **parameters}}})
    bsdf = scene.shapes()[0].bsdf()
    bitmap = mi.Bitmap(np.array(mi.render(scene, spp=1), dtype=np.float32))
    bitmap.metadata()[SEA] = sea_of(bsdf)
    exr = tmp_path / "render.exr"
    bitmap.write(str(exr))
    assert mi.Bitmap(str(exr)).metadata()[SEA] == sea_of(bsdf)

    # Facets tilted by up to 12 degrees, sources to 60 degrees off the vertical.
    rng = np.random.default_rng(5)
    half = direction(rng.uniform(0, 12, 10), rng.uniform(0, 360, 10))
    source = direction(rng.uniform(0, 60, 10), rng.uniform(0, 360, 10))
    observer = 2 * np.sum(half * source, axis=1, keepdims=True) * half - source
    source, observer = (v.astype(np.float32).astype(np.float64) for v in (source, observer))
    assert np.all(observer[:, 2] > 0.1)

    rows = "\n".join(",".join(map(repr, map(float, row))) for row in np.hstack([source, observer]))
    done = subprocess.run(
        [COMMAND, "brdf", "--from", exr], input=f"ix,iy,iz,ox,oy,oz\n{rows}\n", capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    found = np.array([float(row["f"]) for row in csv.DictReader(io.StringIO(done.stdout))])
    si = mi.SurfaceInteraction3f()
    expected = []
    for i, o in zip(source, observer, strict=True):
        si.wi = mi.Vector3f(i.tolist())
        expected.append(np.array(bsdf.eval(mi.BSDFContext(), si, mi.Vector3f(o.tolist())))[0] / o[2])
    assert np.all(found > 1e-3)
    assert np.max(np.abs(found / expected - 1)) < 1e-4


def test_a_footprint_that_varies_has_to_be_told(use, tmp_path):
    """A mesh's BSDF has a footprint of its own at every place: the command asks for it, and then gives the same f."""
    mi = use("scalar_rgb")
    shape = mi.load_dict({"type": "prob_water_surface", "wind_speed": 9.0, "seed": 5, "radius": 30.0, "vertices": 4000,
                          "whitecaps": False})
    scene = mi.load_dict(SCENE | {"sea": shape})
    bsdf = scene.shapes()[0].bsdf()
    bitmap = mi.Bitmap(np.array(mi.render(scene, spp=1), dtype=np.float32))
    bitmap.metadata()[SEA] = sea_of(bsdf)
    exr = tmp_path / "render.exr"
    bitmap.write(str(exr))
    si = scene.ray_intersect(mi.Ray3f([3, 4, 50], [0, 0, -1]))
    footprint = shape.eval_attribute_1("vertex_footprint", si)
    si.wi, o = mi.Vector3f(direction(20.0, 30.0).tolist()), direction(25.0, 220.0)
    expected = bsdf.eval(mi.BSDFContext(), si, mi.Vector3f(o.tolist()))[0] / o[2]
    row = "ix,iy,iz,ox,oy,oz\n" + ",".join(f"{x:.17g}" for x in (*si.wi, *o)) + "\n"
    run = [COMMAND, "brdf", "--from", exr]
    refused = subprocess.run(run, input=row, capture_output=True, text=True)
    assert refused.returncode == 2 and "footprint = varies is not a number" in refused.stderr, refused.stderr
    done = subprocess.run([*run, "--footprint", repr(footprint)], input=row, capture_output=True, text=True, check=True)
    assert abs(float(done.stdout.split(",")[-1]) / expected - 1) < 1e-3
    # And the waves themselves.
    waves = subprocess.run([COMMAND, "surface", "--from", exr, "--footprint", "0.15", "--draws", "stratified", "--fade",
                            "--bounds"], capture_output=True, text=True)
    assert waves.returncode == 0, waves.stderr


def test_a_render_without_a_sea_is_refused(use, tmp_path):
    """The command says which attributes there are instead."""
    mi = use("scalar_rgb")
    bitmap = mi.Bitmap(np.zeros((2, 2, 3), dtype=np.float32))
    bitmap.metadata()["scene"] = "a desert"
    exr = tmp_path / "desert.exr"
    bitmap.write(str(exr))
    done = subprocess.run([COMMAND, "wind", "--from", exr], capture_output=True, text=True)
    assert done.returncode == 2 and not done.stdout
    assert "desert.exr: this OpenEXR image has no attribute prob_water" in done.stderr and "scene" in done.stderr
