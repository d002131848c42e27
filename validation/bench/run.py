"""Speed: prob_water, Mitsuba's own BSDFs, their peer `ocean_legacy`, and the Rust core, its engagements and its
empirical model included; and run time against error.

Run by `cargo xtask bench [fronts] [--quick] [--rounds N] [--output FILE] [--docs]`. Writes out/bench.json, and out/bench.html
with its pictures in out/bench/. The traced BSDFs are timed by throughput.py in two processes, one per Python environment,
that take turns; the table shows the best and the median of all passes. The aims are judged by the best, which other work
on the machine disturbs least; nothing fails when one is missed.
"""

import argparse
import json
import os
import platform
import subprocess
import sys
from pathlib import Path
from typing import Any

from validation.bench import core, empirical, engagements, front_page, fronts
from validation.bench.report import Table, aim, show, spread, write_page
from validation.support.paths import PLUGIN_ROOT, ROOT

PYTHONS = {"prob_water": sys.executable, "peer": str(ROOT / ".venv-peer/bin/python")}
PLUGINS = {"prob_water": str(PLUGIN_ROOT), "peer": None}
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
    """What validation.bench.throughput measures in one environment."""
    job = {"plugins": PLUGINS[environment], "bsdfs": bsdfs, "pairs": pairs, "passes": passes}
    done = subprocess.run([PYTHONS[environment], "-m", "validation.bench.throughput"], cwd=ROOT,
                          input=json.dumps(job), capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"validation.bench.throughput in the {environment} environment: status "
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
    figures = {name: {operation: spread(values, "more") for operation, values in operations.items()}
               for name, operations in rates.items()}
    return {"pairs": pairs, "skipped": skipped, "versions": versions, "million_per_s": figures}


def measured(campaign: str, repeats: int) -> list[dict[str, Any]]:
    """The Rust core's own figures, from one of the campaigns in `measure/`."""
    command = [os.environ.get("CARGO", "cargo"), "run", "--release", "--quiet", "-p", "prob-water-measure",
               "--bin", campaign, "--", str(repeats)]
    rows = fronts.lines(command, f"the Rust core, {campaign}", one_thread=False)
    for row in rows:
        for key in ("per_s", "seconds", "exact"):
            if isinstance(row.get(key), list):
                row[key] = spread(row[key], "more" if key == "per_s" else "less")
    return rows


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
    return {"processor": names[0] if names else platform.processor(), "cores": os.cpu_count(), "load": os.getloadavg()[0],
            "system": platform.platform(), "python": platform.python_version()}


def commit() -> str:
    """The commit measured, marked where files differ from it."""
    command = ["git", "describe", "--always", "--dirty"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    return done.stdout.strip() or "unknown"


def traced_tables(report: dict[str, Any]) -> list[Table]:
    """The BSDFs and what is aimed at; without those that were skipped."""
    operations = ("eval", "pdf", "sample")
    rows = [[name, *(f"{figures[operation]['best']:.0f} ({figures[operation]['median']:.0f})" for operation in operations)]
            for name, figures in report["traced"]["million_per_s"].items()]
    ratios = [[f"{row['operation']}, {row['of']} / {row['over']}", f"{row['best']:.2f} ({row['median']:.2f})",
               f"{row['aim']:g}", aim(row["best"], row["aim"])] for row in report["ratios"]]
    return [Table("traced", f"llvm_ad_rgb, {report['traced']['pairs']} random pairs, million/s: best (median)",
                  ["", *operations], rows),
            Table("ratios", "Ratios, from the best (from the medians)", ["ratio", "", "aim", ""], ratios)]


def facts(report: dict[str, Any]) -> str:
    """What was measured where."""
    machine, parts = report["machine"], []
    for environment, version in report["versions"].items():
        parts.append(f"{environment}: " + ", ".join(f"{name} {value}" for name, value in version.items()))
    parts += [f"skipped, {environment}: {reason}" for environment, reason in report["skipped"].items()]
    return (f"{machine['processor']}, {machine['cores']} cores, load {machine['load']:.1f} when it began; commit "
            f"{report['commit']}. " + "; ".join(parts) + ".")


def tables(report: dict[str, Any]) -> list[Table]:
    """All that was measured."""
    found = [Table("machine", "Where", ["machine and versions"], [[facts(report)]])]
    if "traced" in report:
        found += [*traced_tables(report), *core.tables(report["scalar"], report["waves"]),
                  *empirical.tables(report["empirical"]), *engagements.tables(report["engagements"])]
    return found + fronts.tables(report["fronts"])


def figures(report: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """Everything that `cargo xtask bench compare` compares, by name."""
    found = {}
    for name, operations in report.get("traced", {"million_per_s": {}})["million_per_s"].items():
        for operation, values in operations.items():
            found[f"traced / {name} / {operation}"] = {"unit": "million/s", "better": "more", **values}
    for row in report.get("scalar", []):
        found[f"core / {row['precision']} / {row['name']}"] = {"unit": "1/s", "better": "more", **row["per_s"]}
    for row in report.get("waves", []):
        found[f"waves / {row['name']} / {row['components']}"] = {"unit": "1/s", "better": "more", **row["per_s"]}
    for row in report.get("empirical", []):
        found[f"empirical / w* = {row['w']} / {row['name']}"] = {"unit": "s", "better": "less", **row["seconds"]}
    for row in report.get("engagements", []):
        for kind, times in (("growth", "seconds"), ("race", "exact")):
            if kind in row:
                case = ", ".join(f"{key} {value}" for key, value in row[kind].items())
                found[f"{kind} / {case}"] = {"unit": "s", "better": "less", **row[times]}
    return found | fronts.figures(report["fronts"])


def main() -> None:
    """Measures, prints and writes."""
    parser = argparse.ArgumentParser(prog="cargo xtask bench", description=__doc__.splitlines()[0])
    parser.add_argument("topic", nargs="?", choices=["fronts"], help="only run time against error")
    parser.add_argument("--quick", action="store_true", help="a smoke run: few pairs, one round")
    parser.add_argument("--rounds", type=int, default=3, help="turns of each environment (default: 3)")
    output = ROOT / "out/bench.json"
    parser.add_argument("--output", type=Path, default=output, help="(default: out/bench.json)")
    parser.add_argument("--docs", action="store_true", help="also renew tables and picture of docs/benchmarks.md")
    arguments = parser.parse_args()
    rounds, passes, pairs, repeats = arguments.rounds, 10, 4_000_000, 9
    if arguments.quick:
        rounds, passes, pairs, repeats = 1, 3, 100_000, 1

    report: dict[str, Any] = {"commit": commit(), "machine": machine()}
    if arguments.topic:
        skipped = {environment: reason for environment in BSDFS if (reason := why_not(environment))}
        report |= {"skipped": skipped, "versions": {}}
    else:
        report["traced"] = traced(rounds, passes, pairs)
        skipped = report["traced"]["skipped"]
        report |= {"skipped": skipped, "versions": report["traced"]["versions"], "scalar": measured("throughput", repeats),
                   "waves": measured("wave_sums", repeats), "empirical": measured("empirical", repeats),
                   "engagements": measured("engagements", repeats)}
        report["ratios"] = ratios(report["traced"]["million_per_s"])
    report["fronts"] = fronts.measure(arguments.quick, rounds, skipped)
    report["figures"] = figures(report)
    show(tables(report))
    arguments.output.parent.mkdir(parents=True, exist_ok=True)
    arguments.output.write_text(json.dumps(report, indent=1) + "\n")
    small = ROOT / "docs/images/fronts.png" if arguments.docs else None
    page = front_page.write(report["fronts"], facts(report), small)
    if arguments.docs:
        write_page(tables(report))
    print(f"\nwritten: {arguments.output}, {page}")


if __name__ == "__main__":
    main()
