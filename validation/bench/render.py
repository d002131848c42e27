"""Renders scenes of water on request; one process per environment, so that both can take turns.

Reads requests from standard input, a JSON object a line, and answers each with one: `load` a case, render its
`reference` or take that `reference_of` another case, `warm` the kernels of a number of samples, `render`. Times are of
rendering alone; what loading took and the first rendering, in which kernels are compiled, are answers of `load`.
"""

import json
import os
import sys
import time
import xml.etree.ElementTree as xml
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

from validation.support.paths import ROOT

SIZE = {"width": 96, "height": 64}


def sun_glint(bsdf: dict[str, Any], integrator: dict[str, Any]) -> Any:
    """scenes/sun_glint.xml with a BSDF of numbers and an integrator in place of its own; pixels of one box each."""
    root = xml.parse(ROOT / "scenes/sun_glint.xml").getroot()
    shape, film = root.find("shape"), root.find("sensor/film")
    shape.remove(shape.find("bsdf"))
    shape.append(element("bsdf", bsdf))
    root.remove(root.find("integrator"))
    root.append(element("integrator", integrator))
    film.find("rfilter").set("type", "box")
    return mi.load_string(xml.tostring(root, encoding="unicode"), **{key: str(value) for key, value in SIZE.items()})


def element(tag: str, values: dict[str, Any]) -> xml.Element:
    """A dictionary as a scene file has it."""
    made, kinds = xml.Element(tag, type=values["type"]), {bool: "boolean", int: "integer", float: "float", str: "string"}
    for name, value in values.items():
        if name != "type":
            text = str(value).lower() if isinstance(value, bool) else str(value)
            xml.SubElement(made, kinds[type(value)], name=name, value=text)
    return made


def water_alone(bsdf: dict[str, Any], integrator: dict[str, Any]) -> Any:
    """Nothing but water, from 3 m up, under an environment map of clear sky and sun."""
    look = mi.ScalarTransform4f().look_at(origin=[0, 0, 3], target=[1, 0, 2.4], up=[0, 0, 1])
    return mi.load_dict({
        "type": "scene", "integrator": integrator,
        "sensor": {"type": "perspective", "fov": 60, "to_world": look,
                   "sampler": {"type": "multijitter"},
                   "film": {"type": "hdrfilm", **SIZE, "pixel_format": "rgb", "rfilter": {"type": "box"}}},
        # Mitsuba's maps have +y up.
        "sky": {"type": "envmap", "bitmap": mi.Bitmap(sky()), "to_world": mi.ScalarTransform4f().rotate([1, 0, 0], 90)},
        "water": {"type": "rectangle", "to_world": mi.ScalarTransform4f().scale(10_000), "bsdf": bsdf},
    })


def sky(width: int = 512) -> np.ndarray:
    """Brighter to the horizon, with a sun of two degrees, as through haze, 35 degrees high, that gives five times as much
    light as the rest."""
    up, turn = np.meshgrid((0.5 - (np.arange(width // 2) + 0.5) / (width // 2)) * np.pi,
                           (np.arange(width) + 0.5) / width * 2 * np.pi, indexing="ij")
    way = np.stack([np.sin(turn) * np.cos(up), np.sin(up), -np.cos(turn) * np.cos(up)])
    light = (0.3 + 0.7 * np.exp(-4 * np.maximum(np.sin(up), 0)))[..., None] * [0.5, 0.7, 1.0]
    light[up < 0] = 0.02
    # The map has +y up; +x is where the camera looks.
    height = np.radians(35)
    sun = np.tensordot([np.cos(height), np.sin(height), 0.0], way, 1) > np.cos(np.radians(1))
    level = np.cos(up) * np.maximum(np.sin(up), 0)
    light[sun] = 5 * (light * level[..., None])[~sun].sum() / 3 / level[sun].sum()
    return light.astype(np.float32)


SCENES = {"sun_glint": sun_glint, "water_alone": water_alone}


class Case:
    """A scene to be rendered again and again."""

    def __init__(self, variant: str, scene: str, bsdf: dict[str, Any], integrator: dict[str, Any], plugins: str | None):
        mi.set_variant(variant)
        mi.set_log_level(mi.LogLevel.Error)
        self.variant, self.reference = variant, None
        if variant.startswith("llvm"):
            # The class is the variant's: it can be defined once that is set.
            from validation.bench.integrator import Direct

            mi.register_integrator("bench_direct", Direct)
        if plugins and plugins not in map(str, mi.file_resolver()):
            mi.file_resolver().append(plugins)
        start = time.perf_counter()
        self.scene = SCENES[scene](bsdf, integrator)
        self.loading = time.perf_counter() - start

    def image(self, spp: int, seed: int) -> tuple[float, np.ndarray]:
        """Seconds and pixels."""
        mi.set_variant(self.variant)
        start = time.perf_counter()
        image = mi.render(self.scene, spp=spp, seed=seed)
        if self.variant.startswith("llvm"):
            dr.eval(image)
            dr.sync_thread()
        return time.perf_counter() - start, np.array(image, dtype=np.float64)

    def mean_image(self, spp: int, passes: int) -> None:
        """Sets the reference."""
        images = [self.image(spp, 1000 + seed)[1] for seed in range(passes)]
        self.reference = np.mean(images, axis=0)
        self.noise2 = np.mean(np.var(images, axis=0, ddof=1)) / passes

    def render(self, spp: int, seed: int) -> dict[str, float]:
        """Seconds, and the error relative to the image's mean; the reference's own is taken out."""
        seconds, image = self.image(spp, seed)
        answer = {"seconds": seconds, "spp": spp}
        if self.reference is not None:
            square = np.mean((image - self.reference) ** 2) - self.noise2
            answer["rmse"] = float(np.sqrt(max(square, 0.0)) / self.reference.mean())
        return answer


def main() -> None:
    """Answers requests until there are no more; what the renderer prints is kept out of the answers."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    cases: dict[str, Case] = {}
    for line in sys.stdin:
        request = json.loads(line)
        kind, name = request.pop("do"), request.pop("case", None)
        if kind == "versions":
            answer = {"mitsuba": mi.__version__, "drjit": dr.__version__, "variants": mi.variants()}
        elif kind == "load":
            spp = request.pop("spp")
            cases[name] = Case(**request)
            first, again = (cases[name].image(spp, seed)[0] for seed in (1, 2))
            answer = {"loading_s": cases[name].loading, "compiling_s": max(first - again, 0.0), "seconds": again}
        elif kind == "reference_of":
            other = cases[request["other"]]
            cases[name].reference, cases[name].noise2 = other.reference, other.noise2
            answer = {}
        elif kind == "reference":
            cases[name].mean_image(**request)
            reference = cases[name].reference
            answer = {"mean": float(reference.mean()), "own_rmse": float(np.sqrt(cases[name].noise2) / reference.mean())}
        elif kind == "warm":
            cases[name].image(request["spp"], seed=0)
            answer = {}
        else:
            answer = cases[name].render(**request)
        print(json.dumps(answer), file=answers, flush=True)


if __name__ == "__main__":
    main()
