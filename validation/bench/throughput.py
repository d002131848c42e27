"""Times eval(), pdf() and sample() of BSDFs over random pairs in llvm_ad_rgb; one process per environment.

Reads from standard input a JSON object with `plugins` (a folder to load plugins from, or null), `bsdfs`
(dictionaries by name), `pairs` and `passes`; writes one with `versions` and, by name and operation, the
million/s of every pass. The candidates take turns within a pass. Each is evaluated twice before the first, so
that compilation is not counted.
"""

import json
import sys
import time
from collections.abc import Callable
from typing import Any

import drjit as dr
import mitsuba as mi

mi.set_variant("llvm_ad_rgb")


def directions(count: int, seed: int) -> mi.Vector3f:
    """Uniform over the hemisphere down to an elevation of a degree."""
    random = mi.PCG32(count, initseq=seed)
    z, phi = random.next_float32() * 0.98 + 0.02, random.next_float32() * dr.two_pi
    s = dr.sqrt(1 - z * z)
    return mi.Vector3f(s * dr.cos(phi), s * dr.sin(phi), z)


def operations(count: int) -> dict[str, Callable[[mi.BSDF], Any]]:
    """The calls to time; every BSDF gets the same evaluated inputs."""
    context, si = mi.BSDFContext(), dr.zeros(mi.SurfaceInteraction3f, count)
    si.wi, wo = directions(count, 1), directions(count, 2)
    random = mi.PCG32(count, initseq=3)
    u1, u2 = random.next_float32(), mi.Point2f(random.next_float32(), random.next_float32())
    dr.eval(si, wo, u1, u2)
    return {
        "eval": lambda bsdf: bsdf.eval(context, si, wo),
        "pdf": lambda bsdf: bsdf.pdf(context, si, wo),
        "sample": lambda bsdf: bsdf.sample(context, si, u1, u2),
    }


def seconds(call: Callable[[mi.BSDF], Any], bsdf: mi.BSDF) -> float:
    """Time of one call with everything it returns evaluated."""
    dr.sync_thread()
    start = time.perf_counter()
    dr.eval(call(bsdf))
    dr.sync_thread()
    return time.perf_counter() - start


def main() -> None:
    """Measures what standard input asks for."""
    job = json.load(sys.stdin)
    if job["plugins"]:
        mi.file_resolver().append(job["plugins"])
    bsdfs = {name: mi.load_dict(bsdf) for name, bsdf in job["bsdfs"].items()}
    calls = operations(job["pairs"])
    rates = {name: {operation: [] for operation in calls} for name in bsdfs}
    for number in range(-2, job["passes"]):
        for name, bsdf in bsdfs.items():
            for operation, call in calls.items():
                rate = job["pairs"] / seconds(call, bsdf) / 1e6
                if number >= 0:
                    rates[name][operation].append(rate)
    versions = {"mitsuba": mi.__version__, "drjit": dr.__version__, "threads": dr.thread_count(),
                "llvm": ".".join(map(str, dr.detail.llvm_version()))}
    json.dump({"versions": versions, "rates": rates}, sys.stdout)


if __name__ == "__main__":
    main()
