"""Speed: prob_water, Mitsuba's own BSDFs, their peer `ocean_legacy`, and the Rust core, its engagements and its
empirical model included.

Run by `cargo xtask bench [--quick] [--rounds N] [--output FILE]`. The traced BSDFs are timed by
bench_throughput.py in two processes, one per Python environment, that take turns; the table shows the best
and the median of all passes. The aims are judged by the best, which other work on the machine disturbs least;
nothing fails when one is missed.
"""

import argparse
import json
import os
import platform
import statistics
import subprocess
import sys
from pathlib import Path
from typing import Any

import bench_empirical
import bench_engagements

ROOT = Path(__file__).parents[1]
PYTHONS = {"prob_water": sys.executable, "peer": str(ROOT / ".venv-peer/bin/python")}
PLUGINS = {"prob_water": str(ROOT / "target/mitsuba"), "peer": None}
ROUGHCONDUCTOR = {"type": "roughconductor", "alpha": 0.2}
OFF = {"whitecaps": False, "shadowing": False, "gram_charlier": False}
BSDFS: dict[str, dict[str, dict[str, Any]]] = {
    "prob_water": {
        "prob_water": {"type": "prob_water"},
        "prob_water, slopes": {"type": "prob_water", "slope_measure": "slope"},
        "prob_water, w* = 4": {"type": "prob_water", "friction_velocity": 4},
        "prob_water, ensemble": {"type": "prob_water", "surface": "ensemble"},
        "prob_water, empirical": {"type": "prob_water", "surface": "empirical"},
        "prob_water, empirical, slopes": {"type": "prob_water", "surface": "empirical", "across": "slopes"},
        "prob_water, instance": {"type": "prob_water", "surface": "instance"},
        "prob_water, footprint a texture": {"type": "prob_water", "footprint": {"type": "uniform", "value": 0.3}},
        "prob_water, no whitecaps": {"type": "prob_water", "whitecaps": False},
        "prob_water, no shadowing": {"type": "prob_water", "shadowing": False},
        "prob_water, no Gram-Charlier": {"type": "prob_water", "gram_charlier": False},
        "prob_water, slopes, none of these": {"type": "prob_water", "slope_measure": "slope", **OFF},
        "roughconductor": ROUGHCONDUCTOR,
        "principled": {"type": "principled", "roughness": 0.2, "specular": 0.5},
    },
    "peer": {
        "ocean_legacy": {"type": "ocean_legacy", "wavelength": 550.0, "wind_speed": 5.0},
        "roughconductor of the peer": ROUGHCONDUCTOR,
    },
}
WATERS = [name for name, bsdf in BSDFS["prob_water"].items()
          if name.startswith("prob_water") and not {"surface", "footprint"} & bsdf.keys()]
#: Operation, numerator, denominator and the least ratio aimed at.
AIMS = [("eval", "prob_water", "ocean_legacy", 2.0), ("eval", "prob_water, empirical", "ocean_legacy", 1.0),
        ("sample", "prob_water", "ocean_legacy", 3.0),
        *(("sample", name, "roughconductor", 1.0) for name in WATERS)]


def throughput(environment: str, bsdfs: dict[str, Any], pairs: int, passes: int) -> dict[str, Any]:
    """What bench_throughput.py measures in one environment."""
    job = {"plugins": PLUGINS[environment], "bsdfs": bsdfs, "pairs": pairs, "passes": passes}
    done = subprocess.run([PYTHONS[environment], ROOT / "validation/bench_throughput.py"], cwd=ROOT,
                          input=json.dumps(job), capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"bench_throughput.py in the {environment} environment: status "
                           f"{done.returncode}\n{done.stderr.strip()}")
    return json.loads(done.stdout)


def why_not(environment: str) -> str | None:
    """Why an environment's llvm_ad_rgb cannot be timed: Dr.Jit may abort the process that tries."""
    if not Path(PYTHONS[environment]).exists():
        return f"{PYTHONS[environment]} is missing (`cargo xtask peer`)"
    try:
        throughput(environment, {"roughconductor": ROUGHCONDUCTOR}, pairs=1000, passes=1)
    except RuntimeError as error:
        reason = str(error).splitlines()[-1]
        return f"LLVM is not usable (install LLVM 16 or newer; Debian, Ubuntu: libllvm19): {reason}"
    return None


def summary(rates: list[float]) -> dict[str, float]:
    """Best and median."""
    return {"best": max(rates), "median": statistics.median(rates)}


def traced(rounds: int, passes: int, pairs: int) -> dict[str, Any]:
    """Rounds that alternate between the environments: their versions and every candidate's figures."""
    skipped = {environment: reason for environment in BSDFS if (reason := why_not(environment))}
    versions, rates = {}, {}
    for number in range(rounds):
        for environment, bsdfs in BSDFS.items():
            if environment in skipped:
                continue
            print(f"bench: round {number + 1} of {rounds}, {environment}", file=sys.stderr)
            result = throughput(environment, bsdfs, pairs, passes)
            versions[environment] = result["versions"]
            for name, operations in result["rates"].items():
                for operation, values in operations.items():
                    rates.setdefault(name, {}).setdefault(operation, []).extend(values)
    figures = {name: {operation: summary(values) for operation, values in operations.items()}
               for name, operations in rates.items()}
    return {"pairs": pairs, "skipped": skipped, "versions": versions, "million_per_s": figures}


def core(example: str, repeats: int) -> list[dict[str, Any]]:
    """The Rust core's own figures, from one of its examples."""
    print(f"bench: the Rust core, {example}", file=sys.stderr)
    command = [os.environ.get("CARGO", "cargo"), "run", "--release", "--quiet", "-p", "prob-water",
               "--example", example, "--", str(repeats)]
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    return [json.loads(line) for line in done.stdout.splitlines()]


def ratios(figures: dict[str, Any]) -> list[dict[str, Any]]:
    """The aims whose candidates were both measured."""
    result = []
    for operation, name, other, aim in AIMS:
        if name in figures and other in figures:
            ratio = {kind: figures[name][operation][kind] / figures[other][operation][kind]
                     for kind in ("best", "median")}
            result.append({"operation": operation, "of": name, "over": other, "aim": aim, **ratio,
                           "met": ratio["best"] >= aim})
    return result


def machine() -> dict[str, Any]:
    """The processor and the system."""
    cpuinfo = Path("/proc/cpuinfo")
    lines = cpuinfo.read_text().splitlines() if cpuinfo.exists() else []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return {"processor": names[0] if names else platform.processor(), "cores": os.cpu_count(),
            "system": platform.platform(), "python": platform.python_version()}


def commit() -> str:
    """The commit measured, marked where files differ from it."""
    command = ["git", "describe", "--always", "--dirty"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    return done.stdout.strip() or "unknown"


def show(report: dict[str, Any]) -> None:
    """Prints the tables; those of what was skipped are left out."""
    traced, operations = report["traced"], ("eval", "pdf", "sample")
    print(f"{report['machine']['processor']}, {report['machine']['cores']} cores; commit {report['commit']}")
    print(f"\nllvm_ad_rgb, {traced['pairs']} random pairs, million/s: best (median)")
    for environment, version in traced["versions"].items():
        print(f"{environment}: " + ", ".join(f"{name} {value}" for name, value in version.items()))
    for environment, reason in traced["skipped"].items():
        print(f"skipped, {environment}: {reason}")
    if traced["million_per_s"]:
        print(f"{'':36}" + "".join(f"{operation:>15}" for operation in operations))
    for name, figures in traced["million_per_s"].items():
        cells = (figures[operation] for operation in operations)
        texts = (f"{cell['best']:.0f} ({cell['median']:.0f})" for cell in cells)
        print(f"{name:36}" + "".join(f"{text:>15}" for text in texts))

    if report["ratios"]:
        print("\nratio, from the best (from the medians)")
    for row in report["ratios"]:
        print(f"{row['operation']:>6}  {row['of'] + ' / ' + row['over']:50} {row['best']:5.2f}"
              f" ({row['median']:.2f})  aim {row['aim']:g}: {'met' if row['met'] else 'missed'}")

    print("\nRust core, one thread, million/s: best (median); configure: microseconds each")
    for row in report["scalar"]:
        best, median = row["best_per_s"], row["median_per_s"]
        cell = f"{1e6 / best:.0f} ({1e6 / median:.0f})" if row["name"] == "configure" \
            else f"{best / 1e6:.2f} ({median / 1e6:.2f})"
        print(f"{row['name'] + ', ' + row['precision']:36}{cell:>15}")
    bench_empirical.show(report["empirical"])
    bench_engagements.show(report["engagements"])


def main() -> None:
    """Measures, prints and writes."""
    parser = argparse.ArgumentParser(prog="cargo xtask bench", description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="a smoke run: few pairs, one round")
    parser.add_argument("--rounds", type=int, default=3, help="turns of each environment (default: 3)")
    output = ROOT / "out/bench.json"
    parser.add_argument("--output", type=Path, default=output, help="(default: out/bench.json)")
    arguments = parser.parse_args()
    rounds, passes, pairs, repeats = arguments.rounds, 10, 4_000_000, 9
    if arguments.quick:
        rounds, passes, pairs, repeats = 1, 3, 100_000, 1

    report = {"commit": commit(), "machine": machine(), "traced": traced(rounds, passes, pairs),
              "scalar": core("throughput", repeats), "empirical": core("empirical", repeats),
              "engagements": core("engagements", repeats)}
    report["ratios"] = ratios(report["traced"]["million_per_s"])
    show(report)
    arguments.output.parent.mkdir(parents=True, exist_ok=True)
    arguments.output.write_text(json.dumps(report, indent=1) + "\n")
    print(f"\nwritten: {arguments.output}")


if __name__ == "__main__":
    main()
