"""The report's figures: data, plots and a page that checks what the report's text says about them.

Run by `cargo xtask figures [--quick] [--only NAME]`, which builds the command `prob-water`: it computes everything.
"""

import argparse
import sys
import time
from pathlib import Path

from validation.figures import base, empirical, measured, sea, variation
from validation.figures.claim import Figure
from validation.figures.data import Command, CommandError, write
from validation.figures.page import Result, page
from validation.support import look
from validation.support.command import COMMAND

FIGURES: list[Figure] = sorted(sea.FIGURES + base.FIGURES + variation.FIGURES + empirical.FIGURES + measured.FIGURES,
                               key=lambda figure: figure.name)
#: Instances of an average; the tests run the quick number.
INSTANCES, QUICK_INSTANCES = 50_000, 10_000


def main() -> int:
    """Writes everything; the exit status is 1 where a claim comes out otherwise than known, 2 on bad input."""
    arguments = parse()
    instances = QUICK_INSTANCES if arguments.quick else INSTANCES
    try:
        command = Command(arguments.command)
        chosen = select(arguments.only)
        (arguments.out / "data").mkdir(parents=True, exist_ok=True)
        results = [make(figure, command, instances, arguments.out) for figure in chosen]
    except CommandError as error:
        print(f"figures: {error}", file=sys.stderr)
        return 2
    facts = (f"{command.version()}; averages over {instances} instances unless said otherwise; "
             f"{time.strftime('%Y-%m-%d')}.")
    target = arguments.out / "index.html"
    target.write_text(page(results, facts), encoding="utf-8")
    print(f"figures: {target}")
    return 1 if surprises(results) else 0


def parse() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(prog="cargo xtask figures", description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/report"), help="directory to write into (out/report)")
    parser.add_argument("--quick", action="store_true", help=f"{QUICK_INSTANCES} instances instead of {INSTANCES}")
    parser.add_argument("--only", action="append", metavar="NAME",
                        help="this figure, say figure-08; may be repeated")
    parser.add_argument("--command", type=Path, default=COMMAND, metavar="PATH", help="the command prob-water")
    return parser.parse_args()


def select(names: list[str] | None) -> list[Figure]:
    """The figures of these names, all where there are none."""
    known = {figure.name: figure for figure in FIGURES}
    for name in names or []:
        if name not in known:
            raise CommandError(f"no figure {name!r}: {', '.join(known)}")
    return [known[name] for name in names or known]


def make(figure: Figure, command: Command, instances: int, out: Path) -> Result:
    """Computes, writes and draws one figure, and checks what is said about it."""
    start = time.monotonic()
    tables = figure.collect(command, instances)
    files = {f"{figure.name}-{name}.csv": table for name, table in tables.items()}
    for name, table in files.items():
        write(table, out / "data" / name)
    canvas = look.canvas()
    figure.draw(tables, canvas)
    canvas.savefig(out / f"{figure.name}.png", pil_kwargs={"optimize": True})
    verdicts = [claim.check(tables) for claim in figure.claims]
    held = sum(verdict.holds for verdict in verdicts)
    print(f"{figure.name}: {held} of {len(verdicts)} claims hold, {time.monotonic() - start:.1f} s", flush=True)
    width, height = (canvas.get_size_inches() * canvas.dpi).astype(int)
    return Result(figure, verdicts, list(files), (width, height))


def surprises(results: list[Result]) -> int:
    """Prints and counts the claims that come out otherwise than known."""
    found = [(result.figure.name, claim, verdict) for result in results
             for claim, verdict in zip(result.figure.claims, result.verdicts, strict=True)
             if verdict.holds != claim.expected]
    for name, claim, verdict in found:
        print(f"figures: {name}, unexpected: {claim.text}\n  {verdict.numbers}", file=sys.stderr)
    return len(found)


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit("\nfigures: interrupted")
