"""The error budget: every stage of the model in float64 and float32 against the equations evaluated to 50 digits.

Run by `cargo xtask errors [--quick]`, which builds the campaign `errors` that evaluates the stages. Writes
docs/error-budget.md and docs/images/error-budget.png; `--quick` only prints. The exit status is 1 where a bound fails.
"""

import argparse
import subprocess
import sys
import time
from pathlib import Path

from validation.error_budget import plot
from validation.error_budget.compare import Comparison
from validation.error_budget.rows import CONFIGURED, GROUPS, KINDS, ROWS, Row
from validation.support.paths import ROOT

CAMPAIGN = ROOT / "target/release/errors"
#: Rows a stage, about.
COUNT, QUICK_COUNT = 2000, 150


def compare(campaign: Path, count: int) -> Comparison:
    """Runs the campaign and compares what it prints."""
    comparison = Comparison()
    with subprocess.Popen([campaign, str(count)], stdout=subprocess.PIPE, text=True) as process:
        comparison.read(process.stdout)
    if process.returncode != 0:
        raise RuntimeError(f"{campaign} failed ({process.returncode})")
    return comparison


def failures(comparison: Comparison) -> list[str]:
    """Bounds that do not hold, and rows without errors to hold them against."""
    found = []
    for row in ROWS:
        for kind in KINDS:
            errors = comparison.of(row.name, kind)
            if errors is None:
                if kind in row.bounds:
                    found.append(f"{row.title}, {kind}: nothing was compared")
                continue
            for name, error, bound in zip(("median", "worst"), errors, row.bound(kind), strict=True):
                if not error <= bound:
                    found.append(f"{row.title}, {kind}: {name} {error:.1e} is above {bound:.0e}")
    return found


def shown(error: float) -> str:
    """Two digits, of anything that matters."""
    return f"{error:.1e}" if error >= 1e-18 else "< 1e-18"


def cell(comparison: Comparison, row: Row, kind: str) -> str:
    """Median, worst and bound of one kind."""
    errors = comparison.of(row.name, kind)
    if errors is None:
        return ""
    return f"{shown(errors[0])} / {shown(errors[1])} ({row.bound(kind)[1]:.0e})"


def page(comparison: Comparison) -> str:
    """docs/error-budget.md."""
    kinds = [kind for kind in KINDS if any(comparison.of(row.name, kind) for row in ROWS)]
    lines = [INTRODUCTION.format(count=COUNT)]
    for group in GROUPS:
        lines += [f"## {group.title}", ""]
        if group is GROUPS[0]:
            lines += [CONFIGURED, ""]
        lines += ["| stage | Eqs. | measure | " + " | ".join(kinds) + " |",
                  "| --- | --- | --- |" + " --- |" * len(kinds)]
        for row in group.rows:
            cells = " | ".join(cell(comparison, row, kind) for kind in kinds)
            lines.append(f"| {row.title} | {row.equations} | {row.measure} | {cells} |")
        lines += ["", "| stage | domain | passed on to f | dominated by |", "| --- | --- | --- | --- |"]
        lines += [f"| {row.title} | {row.domain} | {row.passed_on} | {row.dominated_by} |" for row in group.rows]
        lines.append("")
    return "\n".join(lines) + CLOSING


def printed(comparison: Comparison) -> str:
    """The same numbers for a terminal."""
    lines = []
    for group in GROUPS:
        lines.append(f"{group.title:<32}" + "".join(f"{kind:>28}" for kind in KINDS))
        for row in group.rows:
            lines.append(f"  {row.title:<30}" + "".join(f"{cell(comparison, row, kind):>28}" for kind in KINDS))
    return "\n".join(lines)


INTRODUCTION = """\
# Error budget

Every stage of the model in float64, in float32, and where it is an approximation by itself, against the equations of
[model.md](model.md) evaluated to 50 digits. They were written a second time for it (`model.py`, `lobe.py`,
`waves.py` in `validation/error_budget/`); only how far the proposal of draws is widened is taken from the Rust. `cargo xtask errors`
writes this page in a minute and a half on two cores; `--quick` prints the table from a tenth of the inputs, and
`validation/tests/test_error_budget.py` holds its bounds in every test.

![Error of every stage](images/error-budget.png)

A cell is median / worst (bound of the worst) over up to {count} inputs a stage, random ones and extreme ones: half
of all directions within 10 degrees of the horizon, to 89.9999; standard deviations at their floor of 1e-3; w* from 0 to
238.65 cm/s; D from 1 mm to infinity. Inputs count as the exact values of their floats, so the float32 column is what
float32 arithmetic does to float32 directions; what rounding the directions costs stands in a row of its own. Sines,
exponents and tilts are not exposed: without Gram-Charlier and shadowing f is the Gaussian of the tilts, and f with
shadowing over f without is G.
"""

CLOSING = """
## What dominates

- **The model's choices**, by far: Schlick's formula is off by up to a quarter of Fresnel's equations. The sea from afar
  and the empirical table follow with 0.1 to 2 %.
- **float32 directions**: their rounding, 3e-8, moves the half vector by 6e-5 standard deviations of the narrowest lobe, and by
  a third of one where source and observer face each other at the horizon. No arithmetic gets that back.
- **float32 arithmetic** adds roundings of the result, 1e-7 of it, since tilts and Gram-Charlier's polynomial are formed in
  float64. Far out, where that polynomial is 50 to 130, they are up to 3e-5 of the lobe without it; up to 6e-5 in lanes, whose
  tilts are pairs of float32 and whose polynomial is float32.
- **float64** is at its last digits but for the wind's azimuth: 1e-16 of it turns a wide crosswind tilt into 1e-14 to 1e-13
  standard deviations of a narrow sigma_u, and the polynomial makes that 1e-12 to 1e-11 of f. With the azimuth's rounding in
  the reference too, the Gaussian's worst error falls to a fiftieth (once tried).
- **Waves far out** lose digits in the phase k x alone: 1e-10 of a standard deviation at 10 km.
"""


def main() -> int:
    """Compares, prints and, unless quick, writes the page and the plot."""
    parser = argparse.ArgumentParser(prog="cargo xtask errors", description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help=f"{QUICK_COUNT} inputs a stage, nothing is written")
    parser.add_argument("--campaign", type=Path, default=CAMPAIGN, metavar="PATH", help="the campaign errors")
    arguments = parser.parse_args()
    start = time.monotonic()
    comparison = compare(arguments.campaign, QUICK_COUNT if arguments.quick else COUNT)
    print(printed(comparison))
    if not arguments.quick:
        (ROOT / "docs/error-budget.md").write_text(page(comparison), encoding="utf-8")
        plot.draw(comparison, ROOT / "docs/images/error-budget.png")
    found = failures(comparison)
    for failure in found:
        print(f"errors: {failure}", file=sys.stderr)
    print(f"{time.monotonic() - start:.0f} s, {len(found)} bounds fail")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
