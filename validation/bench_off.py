"""What is off costs nothing: instructions of the scalar core by callgrind, and operations of traced kernels.

Run by `cargo xtask bench off`.
"""

import shutil
import subprocess

import numpy as np

from mitsuba_setup import ROOT, load_plugin, usable_llvm

COUNT = 20_000
CASES = ["whitecaps", "no_wind_for_whitecaps", "shadowing", "gram_charlier"]
#: A kernel without a feature has nothing left of it: fewer operations than with it.
TRACED = {
    "flat, w* = 24": {},
    "whitecaps off": {"whitecaps": False},
    "shadowing off": {"shadowing": False},
    "whitecaps, shadowing and Gram-Charlier off": {"whitecaps": False, "shadowing": False, "gram_charlier": False},
    "instance": {"surface": "instance"},
    "instance, whitecaps off": {"surface": "instance", "whitecaps": False},
    "ensemble": {"surface": "ensemble"},
    "empirical": {"surface": "empirical"},
    "empirical, slopes": {"surface": "empirical", "across": "slopes"},
    "footprint a texture": {"footprint": {"type": "uniform", "value": 0.3}},
    "water_leaving": {"water_leaving": {"type": "uniform", "value": 0.02}},
}


def main() -> None:
    """Prints both tables."""
    scalar()
    traced()


def scalar() -> None:
    """Instructions of an evaluation, by code that looks at its switches and by code compiled without the feature."""
    print("\nInstructions of one scalar evaluation, feature off")
    if not shutil.which("valgrind"):
        print("skipped: valgrind is not installed (Debian package valgrind)")
        return
    subprocess.run(["cargo", "build", "--quiet", "--release", "-p", "prob-water", "--example", "off"], cwd=ROOT, check=True)
    print(f"{'':<26}{'switched off':>14}{'without it':>14}{'more':>8}")
    for case in CASES:
        switched, without = (instructions(case, code) for code in ("switched", "without"))
        print(f"{case:<26}{switched:>14.1f}{without:>14.1f}{switched / without - 1:>8.1%}")


def instructions(case: str, code: str) -> float:
    """Of one evaluation: those of a run less those of its beginning."""
    def run(count: int) -> int:
        done = subprocess.run(
            ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null",
             str(ROOT / "target/release/examples/off"), case, code, str(count)],
            capture_output=True, text=True, check=True)
        return int(next(line for line in done.stderr.splitlines() if "Collected" in line).split()[-1])

    return (run(COUNT) - run(0)) / COUNT


def traced() -> None:
    """Operations in the kernels of eval, pdf and sample."""
    print("\nOperations of traced kernels")
    usable, reason = usable_llvm()
    if not usable:
        print(f"skipped: {reason}")
        return
    print(f"{'':<46}{'eval':>8}{'pdf':>8}{'sample':>8}")
    for name, parameters in TRACED.items():
        counts = operations({"friction_velocity": 24.0, **parameters})
        print(f"{name:<46}" + "".join(f"{counts[call]:>8}" for call in ("eval", "pdf", "sample")))


def operations(parameters: dict) -> dict[str, int]:
    """Operation count of the kernel of each call, for a BSDF of these parameters."""
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb")
    load_plugin()
    import drjit as dr

    bsdf, context = mi.load_dict({"type": "prob_water", **parameters}), mi.BSDFContext()
    found = {}
    with dr.scoped_set_flag(dr.JitFlag.KernelHistory, True):
        for call in ("eval", "pdf", "sample"):
            t = mi.Float(np.linspace(0, 0.5, 1000, dtype=np.float32))
            si = dr.zeros(mi.SurfaceInteraction3f, 1000)
            si.wi, wo, u = mi.Vector3f(t, 0, 0.8), mi.Vector3f(t + 0.1, 0.1, 0.8), 2 * t
            dr.eval(si, wo, u)
            dr.kernel_history_clear()
            if call == "sample":
                dr.eval(bsdf.sample(context, si, u, mi.Point2f(u, u)))
            else:
                dr.eval(getattr(bsdf, call)(context, si, wo))
            kernels = [k for k in dr.kernel_history() if k["type"] == dr.KernelType.JIT]
            found[call] = sum(k["operation_count"] for k in kernels)
    return found


if __name__ == "__main__":
    main()
