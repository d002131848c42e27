"""The shape prob_water_surface: time and memory to build it, and what a ray onto it costs.

Run by `cargo xtask bench surface [--vertices N ...]`; each case is a process of its own, so that its peak counts.
"""

import argparse
import json
import resource
import subprocess
import sys
import time

import numpy as np

from validation.support.mitsuba_setup import load_plugin, usable_llvm
from validation.support.paths import ROOT

RAYS = 1_000_000


def peak() -> float:
    """Most memory that this process has had, MiB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def case(variant: str, vertices: int) -> dict:
    """One shape: seconds, MiB above what Mitsuba takes by itself, and nanoseconds per ray (traced variants)."""
    import drjit as dr
    import mitsuba as mi

    mi.set_variant(variant)
    load_plugin()
    mi.load_dict({"type": "scene", "shape": {"type": "sphere"}}).ray_intersect(mi.Ray3f([0, 0, 9], [0, 0, -1]))
    before, start = peak(), time.perf_counter()
    shape = mi.load_dict({"type": "prob_water_surface", "vertices": vertices, "memory": 1 << 20,
                          "bsdf": {"type": "diffuse"}})
    built = time.perf_counter()
    scene = mi.load_dict({"type": "scene", "shape": shape})
    scene.ray_intersect(mi.Ray3f([0, 0, 9], [0, 0, -1]))
    result = {"vertices": shape.vertex_count(), "shape_s": built - start, "scene_s": time.perf_counter() - built,
              "peak_mib": peak() - before, "bytes": (peak() - before) * 2**20 / shape.vertex_count()}
    if dr.is_jit_v(mi.Float):
        rng = np.random.default_rng(1)
        down, turn = np.radians(rng.uniform(2, 60, RAYS)), rng.uniform(0, 2 * np.pi, RAYS)
        way = np.stack([np.cos(down) * np.cos(turn), np.cos(down) * np.sin(turn), -np.sin(down)])
        ray = mi.Ray3f(mi.Point3f(0, 0, 10), mi.Vector3f(way))
        best = np.inf
        for _ in range(4):
            start = time.perf_counter()
            dr.eval(scene.ray_intersect(ray).sh_frame.n)
            dr.sync_thread()
            best = min(best, time.perf_counter() - start)
        result["ns_per_ray"] = 1e9 * best / RAYS
    return result


def main() -> None:
    """Measures each case and prints the table."""
    parser = argparse.ArgumentParser(prog="cargo xtask bench surface", description=__doc__.splitlines()[0])
    parser.add_argument("--vertices", type=int, nargs="+", default=[1_000_000, 4_000_000, 16_000_000])
    parser.add_argument("--case", nargs=2, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.case:
        print(json.dumps(case(arguments.case[0], int(arguments.case[1]))))
        return
    print(f"{'variant':12} {'vertices':>9} {'shape s':>8} {'scene s':>8} {'peak MiB':>9} {'B/vertex':>9} {'ns/ray':>7}")
    for variant in ["scalar_rgb"] + ["llvm_ad_rgb"] * usable_llvm()[0]:
        for vertices in arguments.vertices:
            command = [sys.executable, "-m", "validation.bench.surface", "--case", variant, str(vertices)]
            row = json.loads(subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout)
            print(f"{variant:12} {row['vertices']:9} {row['shape_s']:8.2f} {row['scene_s']:8.2f} {row['peak_mib']:9.0f} "
                  f"{row['bytes']:9.0f} {row.get('ns_per_ray', np.nan):7.0f}", flush=True)
    print("\nA ray cast onto the sum of waves itself, exact, one thread")
    done = subprocess.run(["cargo", "run", "--quiet", "--release", "-p", "prob-water-measure", "--bin", "cast"], cwd=ROOT,
                          check=True, capture_output=True, text=True)
    for row in map(json.loads, done.stdout.splitlines()):
        print(f"{row['components']:5} waves {row['ns_per_ray']:9} ns/ray")


if __name__ == "__main__":
    main()
