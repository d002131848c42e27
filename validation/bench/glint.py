"""Rendering: error against time as samples grow, and the time to an error of 1 %, beside ocean_legacy.

Every error is the root mean square over pixels and channels, relative to the image's mean, against the converged
image of the same BSDF: the two are different models. Times are of rendering alone.
"""

import json
import subprocess
import sys
from typing import Any

import numpy as np

from validation.bench.report import Table, aim, shown_time, spread
from validation.support.paths import PLUGIN_ROOT, ROOT

PYTHONS = {"prob_water": sys.executable, "ocean_legacy": str(ROOT / ".venv-peer/bin/python")}
WATERS: dict[str, dict[str, Any]] = {
    "prob_water": {"type": "prob_water", "wind_speed": 5.0},
    # Its azimuth is where the wind blows to, clockwise from +y.
    "ocean_legacy": {"type": "ocean_legacy", "wavelength": 550.0, "wind_speed": 5.0, "wind_direction": 270.0},
}
#: What both wheels have, and what only one has.
VARIANTS = {"prob_water": ["llvm_ad_rgb", "llvm_ad_spectral", "scalar_rgb"],
            "ocean_legacy": ["llvm_ad_rgb", "llvm_ad_spectral_polarized", "scalar_rgb"]}
SCENES = {"sun_glint": "the sun-glint scene", "water_alone": "water alone"}
PATH = {"type": "path", "max_depth": 2}
#: Name, BSDF and strategy of what is drawn.
CURVES = [("prob_water, its sampling", "prob_water", "bsdf"), ("prob_water, cosine", "prob_water", "cosine"),
          ("prob_water, light sources only", "prob_water", "emitter"), ("ocean_legacy, its sampling", "ocean_legacy", "bsdf")]
TARGET = 0.01
#: Times of ocean_legacy over prob_water's.
AIM = 2.0


class Renderer:
    """A process of one environment."""

    def __init__(self, water: str):
        self.water = water
        self.process = subprocess.Popen([PYTHONS[water], "-m", "validation.bench.render"], cwd=ROOT, text=True,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.plugins = str(PLUGIN_ROOT) if water == "prob_water" else None

    def ask(self, kind: str, case: str, **request: Any) -> dict[str, Any]:
        """One request and its answer."""
        self.process.stdin.write(json.dumps({"do": kind, "case": case, **request}) + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer:
            raise RuntimeError(f"validation.bench.render for {self.water} ended with status {self.process.wait()}")
        return json.loads(answer)

    def load(self, case: str, variant: str, scene: str, integrator: dict[str, Any], spp: int,
             bsdf: dict[str, Any] | None = None) -> dict[str, Any]:
        """Loads a case of this environment's water, or of another BSDF, and compiles it."""
        return self.ask("load", case, variant=variant, scene=scene, bsdf=bsdf or WATERS[self.water],
                        integrator=integrator, plugins=self.plugins, spp=spp)

    def close(self) -> None:
        """Ends the process."""
        self.process.stdin.close()
        self.process.wait()


def measure(quick: bool, rounds: int, skipped: list[str]) -> dict[str, Any]:
    """The races to 1 % on both scenes and the curves; without ocean_legacy where it is skipped."""
    renderers = {water: Renderer(water) for water in WATERS if water not in skipped}
    try:
        races = {scene: race(renderers, scene, quick, rounds) for scene in SCENES}
        return {"races": races, "curves": curves(renderers, quick)}
    finally:
        for renderer in renderers.values():
            renderer.close()


def race(renderers: dict[str, Renderer], scene: str, quick: bool, rounds: int) -> dict[str, Any]:
    """Time to 1 % of every water in the variant that is best for it, in turns."""
    series, passes, rounds = ([16, 64], 4, 1) if quick else ([64, 256], 16, rounds)
    found: dict[str, Any] = {}
    for water, renderer in renderers.items():
        print(f"bench: {scene}, {water}: the best variant", file=sys.stderr)
        trials = {variant: trial(renderer, scene, variant) for variant in VARIANTS[water][:1 if quick else None]}
        best = min(trials, key=lambda variant: trials[variant])
        loaded = renderer.load(scene, best, scene, PATH, series[-1])
        reference = renderer.ask("reference", scene, spp=series[-1], passes=passes)
        found[water] = {"variant": best, "trials": trials, "loaded": loaded, "reference": reference, "runs": []}
        for spp in series[:-1]:
            renderer.ask("warm", scene, spp=spp)
    print(f"bench: {scene}: in turns", file=sys.stderr)
    for seed in range(rounds):
        for spp in series:
            for water, renderer in renderers.items():
                found[water]["runs"].append(renderer.ask("render", scene, spp=spp, seed=10 * seed + spp))
    for water, renderer in renderers.items():
        found[water]["needed"] = series[-1] if quick else needed(found[water]["runs"])
        found[water]["compiled"] = compiled(renderer, scene, found[water]["needed"])
        found[water]["reached"] = []
    for seed in range(3 * rounds):
        for water, renderer in renderers.items():
            found[water]["reached"].append(renderer.ask("render", scene, spp=found[water]["needed"], seed=500 + seed))
    for water in found:
        found[water].update(to_target(found[water]["reached"]))
    found["renderer"] = renderer_alone(renderers, scene, 16 if quick else 256)
    return found


def trial(renderer: Renderer, scene: str, variant: str, spp: int = 64, passes: int = 4) -> float:
    """Seconds to 1 % as a few small images have it."""
    case = f"{scene} {variant}"
    seconds = renderer.load(case, variant, scene, PATH, spp)["seconds"]
    own = renderer.ask("reference", case, spp=spp, passes=passes)["own_rmse"]
    return seconds * passes * (own / TARGET) ** 2


def needed(runs: list[dict[str, float]]) -> int:
    """Samples for 1 %, by the power of their number with which the error falls: a half or, pixels being sampled evenly, a
    little more. A square, which that sampler takes as it is."""
    fewer, more = sorted({run["spp"] for run in runs})[-2:]
    first, last = (np.sqrt(np.mean([run["rmse"] ** 2 for run in runs if run["spp"] == spp])) for spp in (fewer, more))
    power = np.clip(np.log(first / last) / np.log(more / fewer), 0.5, 1.0)
    return max(4, round(np.sqrt(more * (last / TARGET) ** (1 / power)))) ** 2


def compiled(renderer: Renderer, scene: str, spp: int) -> float:
    """Seconds of a first image, kernels included."""
    return renderer.ask("render", scene, spp=spp, seed=1)["seconds"]


def to_target(runs: list[dict[str, float]]) -> dict[str, Any]:
    """Seconds to exactly 1 %, from runs near it, by the square root of the samples; and their common error."""
    return {"rmse": float(np.sqrt(np.mean([run["rmse"] ** 2 for run in runs]))),
            "drawing": float(np.median([run["seconds"] for run in runs])),
            "seconds": spread([run["seconds"] * (run["rmse"] / TARGET) ** 2 for run in runs])}


def renderer_alone(renderers: dict[str, Renderer], scene: str, spp: int) -> dict[str, float]:
    """Seconds of the same image of the same BSDF in both: what is the renderer's."""
    for renderer in renderers.values():
        renderer.load("metal", "llvm_ad_rgb", scene, PATH, spp, {"type": "roughconductor", "alpha": 0.2})
    seconds: dict[str, list[float]] = {water: [] for water in renderers}
    for seed in range(5):
        for water, renderer in renderers.items():
            seconds[water].append(renderer.ask("render", "metal", spp=spp, seed=seed)["seconds"])
    return {water: min(times) for water, times in seconds.items()}


def curves(renderers: dict[str, Renderer], quick: bool) -> list[dict[str, Any]]:
    """Points of the front: one scene, one integrator, several ways to draw directions."""
    points = []
    for name, water, strategy in CURVES:
        if water not in renderers:
            continue
        print(f"bench: {name}", file=sys.stderr)
        renderer = renderers[water]
        for spp in [4, 16] if quick else [16, 64, 256]:
            renderer.load(name, "llvm_ad_rgb", "water_alone", {"type": "bench_direct", "strategy": strategy}, spp)
            renderer.ask("reference_of", name, other="water_alone")
            runs = [renderer.ask("render", name, spp=spp, seed=20 + seed) for seed in range(1 if quick else 3)]
            points.append({"front": "rendering", "family": name, "setting": str(spp),
                           "error": float(np.sqrt(np.mean([run["rmse"] ** 2 for run in runs]))),
                           "errors": [run["rmse"] for run in runs],
                           "seconds": [run["seconds"] for run in runs]})
    return points


def tables(found: dict[str, Any]) -> list[Table]:
    """Times to 1 %, and their ratios."""
    columns = ["scene", "", "variant", "samples", "error", "time to 1 %", "quartiles", "with loading and compiling"]
    rows, ratios = [], []
    for scene, title in SCENES.items():
        race = found["races"][scene]
        for water in (water for water in WATERS if water in race):
            one = race[water]
            first = one["loaded"]["loading_s"] + max(one["compiled"] - one["drawing"], 0.0)
            low, high = one["seconds"]["quartiles"]
            rows.append([title, water, one["variant"], str(one["needed"]), f"{100 * one['rmse']:.2f} %",
                         shown_time(one["seconds"]["median"]), f"{shown_time(low)} to {shown_time(high)}",
                         shown_time(one["seconds"]["median"] + first)])
        if len(race) > len(WATERS):
            ratio = ratio_of(race)
            rest = race["renderer"]["ocean_legacy"] / race["renderer"]["prob_water"]
            ratios.append([title, f"{ratio:.2f}", f"{AIM:g}", aim(ratio, AIM), f"{rest:.2f}"])
    return [Table("glint", "Time to 1 % RMSE", columns, rows),
            Table("glint ratios", "ocean_legacy's time over prob_water's",
                  ["scene", "ratio", "aim", "", "of roughconductor"], ratios)]


def ratio_of(race: dict[str, Any]) -> float:
    """ocean_legacy's time to 1 % over prob_water's, of medians."""
    return race["ocean_legacy"]["seconds"]["median"] / race["prob_water"]["seconds"]["median"]
