"""Run time against error of traced evaluation and of the mesh, one thread, as lines of JSON.

`python -m validation.bench.front_traced REPEATS DIRECTORY [--quick]`, after the campaign `fronts` has written the same pairs and rays there.
"""

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path

import drjit as dr
import mitsuba as mi
import numpy as np

from validation.support.mitsuba_setup import load_plugin

VERTICES = [10_000, 30_000, 100_000, 300_000, 1_000_000]
RADIUS = 60.0
#: Rays are cast so many times over, turned about the vertical, to fill the traced lanes.
COPIES = 50


def point(front: str, family: str, setting: str, error: float, seconds: list[float]) -> None:
    """Prints one, as that campaign does."""
    print(json.dumps({"front": front, "family": family, "setting": setting, "error": float(error), "seconds": seconds}))


def times(run: Callable[[], object], repeats: int) -> list[float]:
    """Seconds of runs whose results are evaluated, but for the first two."""
    found = []
    for _ in range(repeats + 2):
        dr.sync_thread()
        start = time.perf_counter()
        dr.eval(run())
        dr.sync_thread()
        found.append(time.perf_counter() - start)
    return found[2:]


def rms(values: np.ndarray) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(np.square(values, dtype=np.float64))))


def brdf(repeats: int, directory: Path) -> None:
    """The pairs of the core's front."""
    pairs = np.fromfile(directory / "pairs.f32", "<f4").reshape(-1, 2, 3)
    reference = np.fromfile(directory / "brdf.f64", "<f8")
    bsdf, context = mi.load_dict({"type": "prob_water"}), mi.BSDFContext()
    si = dr.zeros(mi.SurfaceInteraction3f, len(pairs))
    si.wi, wo = mi.Vector3f(pairs[:, 0].T), mi.Vector3f(pairs[:, 1].T)
    dr.eval(si, wo)
    # eval() holds the cosine too.
    f = np.array(bsdf.eval(context, si, wo))[0] / pairs[:, 1, 2].astype(np.float64)
    seconds = [t / len(pairs) for t in times(lambda: bsdf.eval(context, si, wo)[0], repeats)]
    point("brdf", "Dr.Jit", "llvm_ad_rgb", rms(f - reference) / rms(reference), seconds)


def mesh(repeats: int, directory: Path, quick: bool) -> None:
    """Rays, and looks from above, onto meshes of the core's sea."""
    look, hit, normal = np.moveaxis(np.fromfile(directory / "rays.f64", "<f8").reshape(-1, 3, 3), 1, 0)
    place = np.fromfile(directory / "places.f64", "<f8").reshape(-1, 5)
    distance = np.linalg.norm(hit - [0, 0, 10], axis=1)
    for vertices in VERTICES[:2 if quick else None]:
        start = time.perf_counter()
        shape = mi.load_dict({"type": "prob_water_surface", "friction_velocity": 8, "radius": RADIUS, "memory": 4096,
                              "vertices": vertices, "bsdf": {"type": "diffuse"}})
        scene = mi.load_dict({"type": "scene", "shape": shape})
        built = time.perf_counter() - start
        count = f"{shape.vertex_count()}"

        ray = mi.Ray3f(mi.Point3f(0, 0, 10), mi.Vector3f(np.tile(look.T, COPIES)))
        dr.eval(ray)
        seconds = [t / len(look) / COPIES for t in times(lambda: scene.ray_intersect(ray).sh_frame.n, repeats)]
        si = scene.ray_intersect(mi.Ray3f(mi.Point3f(0, 0, 10), mi.Vector3f(look.T)))
        tilt = np.linalg.norm(np.array(si.sh_frame.n).T - normal, axis=1)
        point("cast", "mesh", count, rms(np.array(si.t) - distance), seconds)
        point("cast_normal", "mesh", count, np.degrees(rms(tilt)), seconds)

        down = mi.Ray3f(mi.Point3f(place[:, 0], place[:, 1], 10), mi.Vector3f(0, 0, -1))
        si = scene.ray_intersect(down)
        flat, smooth = np.array(si.n), np.array(si.sh_frame.n)
        point("mesh_height", "mesh", count, rms(np.array(si.p)[2] - place[:, 2]), [built])
        for family, n in (("triangles", flat), ("interpolated normals", smooth)):
            slope = -(n[:2] / n[2]).T
            point("mesh_slope", family, count, rms(slope - place[:, 3:]), [built])


def main() -> None:
    """Prints all points."""
    mi.set_variant("llvm_ad_rgb")
    load_plugin()
    dr.set_thread_count(1)
    repeats, directory = int(sys.argv[1]), Path(sys.argv[2])
    brdf(repeats, directory)
    mesh(repeats, directory, "--quick" in sys.argv)


if __name__ == "__main__":
    main()
