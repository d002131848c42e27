"""Compares two runs of the benchmarks: every figure's ratio, and what got worse by more than noise.

Run by `cargo xtask bench compare A.json B.json [--slack X]`. Exit status 1 if anything got worse, 2 on bad input.

Each figure has rounds: their best, median and quartiles. Of two runs of the same code the best is disturbed least by other
work, and the quartiles tell how much the rounds were. So a figure counts as worse where its best and its median are both
worse by more than the factor

    threshold = (1 + slack) q(A) q(B),    q = upper quartile / lower quartile,

with slack 0.10, the drift between two quiet runs that no spread within a run shows. A figure without noise (an error) has
q = 1 and slack 0.02, for another platform's last digits. Figures of one round of something timed have no spread to go by:
they are shown and not judged.
"""

import argparse
import json
import math
import sys
from pathlib import Path
from typing import Any

SLACK, EXACT_SLACK = 0.10, 0.02
#: Fewer rounds say nothing of the spread.
ROUNDS = 3
#: Names told of figures that one run lacks.
SHOWN = 5


class BadInput(Exception):
    """A file that is not a run's."""


def load(path: Path) -> dict[str, dict[str, Any]]:
    """The figures of a run."""
    try:
        figures = json.loads(path.read_text())["figures"]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise BadInput(f"{path}: not what `cargo xtask bench` writes ({error!r})") from None
    return figures


def worse(a: dict[str, Any], b: dict[str, Any], kind: str) -> float:
    """How many times worse B is by its best or its median."""
    ratio = b[kind] / a[kind] if a[kind] else math.inf if b[kind] else 1.0
    return ratio if a["better"] == "less" else 1 / ratio if ratio else math.inf


def spread(figure: dict[str, Any]) -> float:
    """Upper over lower quartile."""
    low, high = figure["quartiles"]
    return high / low if low > 0 else 1.0


def threshold(a: dict[str, Any], b: dict[str, Any], slack: float) -> float | None:
    """The factor beyond which B is worse than noise explains; `None` where nothing is known of that."""
    if a["unit"] == "":
        return 1 + EXACT_SLACK
    if min(a["rounds"], b["rounds"]) < ROUNDS:
        return None
    return (1 + slack) * spread(a) * spread(b)


def compare(a: dict[str, dict[str, Any]], b: dict[str, dict[str, Any]], slack: float = SLACK) -> list[dict[str, Any]]:
    """Every figure that both have: its ratios by best and median, above 1 where B is worse, threshold and verdict."""
    rows = []
    for name in (name for name in a if name in b):
        factors = [worse(a[name], b[name], kind) for kind in ("best", "median")]
        limit = threshold(a[name], b[name], slack)
        verdict = ("not judged" if limit is None else "WORSE" if min(factors) > limit
                   else "better" if max(factors) < 1 / limit else "")
        rows.append({"name": name, "best": factors[0], "median": factors[1], "threshold": limit, "verdict": verdict})
    return rows


def main() -> int:
    """Prints the comparison."""
    parser = argparse.ArgumentParser(prog="cargo xtask bench compare", description=__doc__.splitlines()[0])
    parser.add_argument("a", type=Path, help="the earlier run's bench.json")
    parser.add_argument("b", type=Path, help="the later run's")
    parser.add_argument("--slack", type=float, default=SLACK, help=f"drift between runs ({SLACK})")
    arguments = parser.parse_args()
    try:
        a, b = load(arguments.a), load(arguments.b)
    except BadInput as error:
        print(f"bench compare: {error}", file=sys.stderr)
        return 2
    rows = compare(a, b, arguments.slack)
    if not rows:
        print("bench compare: the two runs have no figure in common", file=sys.stderr)
        return 2
    print("ratios of times and errors, and of rates the other way round: above 1 the second run is worse\n")
    print(f"{'':70}{'best':>8}{'median':>8}{'noise':>8}")
    for row in rows:
        limit = "-" if row["threshold"] is None else f"{row['threshold']:.2f}"
        print(f"{row['name'][:69]:70}{row['best']:8.2f}{row['median']:8.2f}{limit:>8}  {row['verdict']}")
    for title, one, other in (("first", a, b), ("second", b, a)):
        if missing := [name for name in one if name not in other]:
            more = f" and {len(missing) - SHOWN} more" if len(missing) > SHOWN else ""
            print(f"only in the {title}: {'; '.join(missing[:SHOWN])}{more}")
    found = [row["name"] for row in rows if row["verdict"] == "WORSE"]
    medians = sorted(row["median"] for row in rows)
    if rows:
        print(f"\nmiddle of all ratios: {medians[len(medians) // 2]:.2f} (far from 1: another machine, or other work on it)")
    print(f"{len(found)} of {len(rows)} figures worse than noise explains" + "".join(f"\n  {name}" for name in found))
    if missing := sum(name not in b for name in a):
        print(f"{missing} figures of the first run were not measured in the second: nothing is known of them")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
