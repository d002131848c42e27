"""Run time against error: evaluations, means, rays, meshes and renders.

Run by `cargo xtask bench fronts [--quick] [--docs]`, and as part of `cargo xtask bench`; front_page.py shows them.
"""

import json
import os
import subprocess
import sys
import tempfile
from typing import Any

from validation.bench import glint
from validation.bench.report import Table, shown_time, spread
from validation.support.paths import ROOT

#: Errors below this are a reference's.
ROUNDING = 1e-12
#: What stands in the page beside each front: title, what takes the time, what is wrong, and what was compared.
FRONTS = {
    "brdf": ("One evaluation of f", "time per evaluation", "RMS error over the RMS of f",
             "Flat sea, 262,144 random pairs of directions, one thread, the same pairs for all. Errors are against float64."),
    "wavy": ("One value of the mean over drawn seas", "time per value", "RMS error over the RMS of f",
             "w* = 8 cm/s, D = 0.15 m, 400 random pairs of directions, one thread, against exact means. The table's time is "
             "that of 262,144 pairs all over it; a drawn value is the report's, of 50 instances. Setting up is not counted."),
    "means": ("Means over drawn seas", "time for 25 observers", "relative RMS error of a mean",
              "w* = 8 cm/s, incidence 30 degrees, observers within 10 degrees of the reflection, one thread, set-up "
              "included; over 16 seeds. The exact means' error is at most how far they are from 524,288 evenly spread draws."),
    "cast": ("A ray onto a drawn sea", "time per ray", "RMS error of the hit's distance, m",
             "w* = 8 cm/s, 512 waves, from 10 m up, 10 to 60 degrees below the horizon, one thread. The exact cast has no "
             "tolerance to choose; its last step leaves 1e-15 m. A mesh is hit by Mitsuba's ray tracer; labels are "
             "its vertices within 60 m."),
    "cast_normal": ("The normal at the hit", "time per ray", "RMS error of the normal, degrees",
                    "The same rays. The exact cast's normal is that of the waves at its hit."),
    "mesh_height": ("A mesh of the same sea", "time to build", "RMS error of the height, m",
                    "Heights over 20,000 places within 50 m, tree for rays included in the time; labels are vertices. The "
                    "mesh leaves out waves shorter than two cells, more of them the farther away: facets stand for those."),
    "mesh_slope": ("Slopes of that mesh", "time to build", "RMS error of the slope", "Of triangles, and of their "
                   "interpolated normals, at the same places."),
    "rendering": ("A picture of water alone", "time per image", "relative RMS error of a pixel",
                  "96 x 64 pixels, environment map with a sun, llvm_ad_rgb on all cores, one integrator for all, which draws "
                  "directions by the light sources and also as named, joined by the balance heuristic; labels are samples "
                  "per pixel. Each BSDF is compared with its own converged image."),
}


def measure(quick: bool, rounds: int, skipped: dict[str, str]) -> dict[str, Any]:
    """Points of all fronts, and the times to 1 %."""
    repeats = 1 if quick else 5
    with tempfile.TemporaryDirectory() as directory:
        points = lines([os.environ.get("CARGO", "cargo"), "run", "--release", "--quiet", "-p", "prob-water-measure", "--bin",
                        "fronts", "--", str(repeats), directory], "the core's fronts")
        renders = None
        if "prob_water" not in skipped:
            points += lines([sys.executable, "-m", "validation.bench.front_traced", str(repeats), directory]
                            + ["--quick"] * quick, "traced fronts")
            renders = glint.measure(quick, rounds, ["ocean_legacy"] if "peer" in skipped else [])
            points += renders.pop("curves")
    for point in points:
        point["error"] = point["error"] if point["error"] > ROUNDING else 0.0
        point["seconds"] = spread(point["seconds"])
    return {"points": points, "glint": renders}


def lines(command: list[str], what: str, one_thread: bool = True) -> list[dict[str, Any]]:
    """What a program prints as lines of JSON."""
    print(f"bench: {what}", file=sys.stderr, flush=True)
    threads = {"RAYON_NUM_THREADS": "1"} if one_thread else {}
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True, env=os.environ | threads)
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]


def efficient(points: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Those that no other beats in both time and error, from the fastest on."""
    found: list[dict[str, Any]] = []
    for point in sorted(points, key=lambda p: (p["seconds"]["best"], p["error"])):
        if not found or point["error"] < found[-1]["error"]:
            found.append(point)
    return found


def tables(fronts: dict[str, Any]) -> list[Table]:
    """All points, and the times to 1 %."""
    rows = []
    for front, (title, *_) in FRONTS.items():
        points = [point for point in fronts["points"] if point["front"] == front]
        best = efficient(points)
        for point in sorted(points, key=lambda p: p["seconds"]["best"]):
            name = ", ".join(filter(None, [point["family"], point["setting"]]))
            rows.append([title, name, shown_time(point["seconds"]["best"]), shown_error(point["error"]),
                         "yes" if point in best else ""])
    table = Table("fronts", "Run time against error", ["front", "", "best time", "error", "efficient"], rows)
    return [table, *(glint.tables(fronts["glint"]) if fronts["glint"] else [])]


def shown_error(error: float) -> str:
    """Two digits; none for a reference."""
    return f"{error:.2g}" if error else "reference"


def figures(fronts: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """Every point's time and error, and the times to 1 %, by name."""
    found = {}
    for point in fronts["points"]:
        name = " / ".join(filter(None, ["front", point["front"], point["family"], point["setting"]]))
        if point["front"] in ("cast_normal", "mesh_slope"):
            found[f"{name} / error"] = exactly(point["error"])
            continue
        found[f"{name} / time"] = {"unit": "s", "better": "less", **point["seconds"]}
        if "errors" in point:
            found[f"{name} / error"] = {"unit": "of the mean", "better": "less", **spread(point["errors"])}
        elif point["error"]:
            found[f"{name} / error"] = exactly(point["error"])
    for scene, race in (fronts["glint"] or {"races": {}})["races"].items():
        for water in (water for water in glint.WATERS if water in race):
            found[f"time to 1 % / {scene} / {water}"] = {"unit": "s", "better": "less", **race[water]["seconds"]}
    return found


def exactly(value: float) -> dict[str, Any]:
    """A figure without noise."""
    return {"unit": "", "better": "less", **spread([value])}
