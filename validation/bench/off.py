"""What is off costs nothing: instructions of the scalar core by callgrind, operations of traced kernels, and the time of work
that is left out where it makes no difference.

Run by `cargo xtask bench off [--docs]`.
"""

import json
import os
import shutil
import subprocess
import sys
from typing import Any, NamedTuple

from validation.bench.report import Table, show, shown_time, write_page
from validation.support.mitsuba_setup import usable_llvm
from validation.support.paths import ROOT
from validation.support.plugin_calls import operations

COUNT = 20_000
CARGO = os.environ.get("CARGO", "cargo")
CAMPAIGNS = ROOT / "target/release"
#: Of the campaign `off`: features that can be compiled away.
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


class Term(NamedTuple):
    """An optional term: what switches it off, what does so by itself, and how that is measured: a case of the campaign `off`,
    parameters with and without it for a traced kernel, or a line of the campaign `skips`."""

    name: str
    switch: str
    by_itself: str
    scalar: str = ""
    traced: tuple[dict[str, Any], dict[str, Any]] | None = None
    timed: str = ""


NEVER = "never"
TERMS = [
    Term("whitecaps", "`whitecaps = false`", "no wind; for drawn waves, all crests together too gentle", "whitecaps",
         ({}, {"whitecaps": False})),
    Term("shadowing", "`shadowing = false`", NEVER, "shadowing", ({}, {"shadowing": False})),
    Term("its exponential and erfc, float64", "", "directions high above the horizon (cos > 8 sigma sin)",
         timed="exponential and erfc of shadowing, float64"),
    Term("masking bound", "`shadowing = false`, `readings` 65 or 66",
         "where Eq. 67 stays within 11 % of it everywhere: w* above 9 cm/s for D = inf", "visible_bound",
         ({"friction_velocity": 8.0}, {"friction_velocity": 24.0})),
    Term("Gram-Charlier", "`gram_charlier = false`", NEVER, "gram_charlier", ({}, {"gram_charlier": False})),
    Term("exact Fresnel", "default", NEVER, "exact_fresnel", ({"fresnel": "exact"}, {})),
    Term("tilt angles: arctangents and the hold of steep facets", "`slope_measure = slope`", NEVER, "tilt_angles",
         ({}, {"slope_measure": "slope"})),
    Term("unsigned angles, for bounds of steep facets", "default", NEVER, "unsigned_angles", ({"readings": "71-73"}, {})),
    Term("sum of 64 drawn waves", "`surface = flat`", "a wind that raises no waves", timed="sum of 64 waves",
         traced=({"surface": "instance"}, {})),
    Term("footprint from place to place", "default", "a number instead of a texture",
         traced=({"footprint": {"type": "uniform", "value": 0.3}}, {"footprint": 0.3})),
    Term("march to an observer, one instance", "", "a way there steeper than all slopes together", timed="march to an observer"),
    Term("whitecaps of exact means, w* = 24", "`whitecaps = false`", "a fraction below 1e-7",
         timed="whitecaps of exact means, w* = 24"),
    Term("the same, w* = 8", "`whitecaps = false`", "the same", timed="whitecaps of exact means, w* = 8"),
    Term("the ensemble's table", "any other `surface`", "a wind that raises no waves", timed="table of the ensemble"),
    Term("turning into the wind's axes", "", "a wind from azimuth 0; traced, along any axis", "oblique_wind",
         ({"wind_direction": 37.0}, {})),
]


def main() -> None:
    """Builds the campaigns and prints the tables."""
    for campaign in ("off", "skips"):
        build = [CARGO, "build", "--quiet", "--release", "--target-dir", "target", "-p", "prob-water-measure", "--bin", campaign]
        subprocess.run(build, cwd=ROOT, check=True)
    found = [*scalar(), *lanes(), *traced(), terms()]
    show(found)
    if "--docs" in sys.argv:
        write_page(found)


def scalar() -> list[Table]:
    """Instructions of an evaluation, by code that looks at its switches and by code compiled without the feature."""
    if not shutil.which("valgrind"):
        print("instructions: skipped, valgrind is not installed (Debian package valgrind)")
        return []
    rows = []
    for case in CASES:
        switched, without = (instructions(case, code) for code in ("switched", "without"))
        rows.append([case, f"{switched:.0f}", f"{without:.0f}", f"{100 * (switched / without - 1):.1f} %"])
    return [Table("off", "Instructions of one scalar evaluation, float32", ["off", "switched off", "without it", "more"], rows)]


def lanes() -> list[Table]:
    """Instructions of a row in lanes; valgrind knows no AVX-512."""
    if not shutil.which("valgrind"):
        return []
    rows = [[level, *(f"{instructions(level, operation):.0f}" for operation in ("eval", "pdf", "sample"))]
            for level in ("portable", "avx2")]
    return [Table("inlined", "Instructions of a row in lanes", ["", "eval", "pdf", "sample"], rows)]


def instructions(case: str, code: str) -> float:
    """Of one evaluation: those of a run less those of its beginning. `off` is built."""
    def run(count: int) -> int:
        done = subprocess.run(
            ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null",
             str(CAMPAIGNS / "off"), case, code, str(count)],
            capture_output=True, text=True, check=True)
        return int(next(line for line in done.stderr.splitlines() if "Collected" in line).split()[-1])

    return (run(COUNT) - run(0)) / COUNT


def traced() -> list[Table]:
    """Operations in the kernels of eval, pdf and sample."""
    usable, reason = usable_llvm()
    if not usable:
        print(f"operations of kernels: skipped, {reason}")
        return []
    rows = []
    for name, parameters in TRACED.items():
        counts = operations({"friction_velocity": 24.0, **parameters})
        rows.append([name, *(str(counts[call]) for call in ("eval", "pdf", "sample"))])
    return [Table("kernels", "Operations of traced kernels", ["", "eval", "pdf", "sample"], rows)]


def terms() -> Table:
    """Every optional term, what it costs and what switches it off."""
    done = subprocess.run([CAMPAIGNS / "skips"], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    timed = {row["name"]: row for row in map(json.loads, done.stdout.splitlines())}
    valgrind, llvm = bool(shutil.which("valgrind")), usable_llvm()[0]
    rows = []
    for term in TERMS:
        cells = []
        if term.scalar and valgrind:
            on, off = (instructions(term.scalar, code) for code in ("with", "switched"))
            cells.append(f"{on:.0f} to {off:.0f} instructions ({change(on, off)})")
        if term.traced and llvm:
            on, off = (operations({"friction_velocity": 24.0, **parameters})["eval"] for parameters in term.traced)
            cells.append(f"{on} to {off} traced operations ({change(on, off)})")
        if term.timed:
            on, off = (min(timed[term.timed][kind]) for kind in ("with", "without"))
            cells.append(f"{shown_time(on)} to {shown_time(off)}")
        rows.append([term.name, term.switch, term.by_itself, "; ".join(cells)])
    return Table("terms", "Optional terms", ["term", "off by choice", "off by itself", "saves"], rows)


def change(on: float, off: float) -> str:
    """In percent of what it was."""
    percent = round(100 * (off / on - 1))
    return f"{percent:+} %" if percent else "0 %"


if __name__ == "__main__":
    main()
