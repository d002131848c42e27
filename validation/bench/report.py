"""What all measurements share: spreads of figures, tables as Markdown, and the page that shows the last run's."""

import re
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from validation.support.paths import ROOT

PAGE = ROOT / "docs/benchmarks.md"


def spread(values: list[float], better: str = "less") -> dict[str, Any]:
    """Best, median and quartiles of one figure's rounds."""
    quartiles = [float(q) for q in np.percentile(values, [25, 75])]
    return {"best": float(min(values) if better == "less" else max(values)), "median": float(np.median(values)),
            "quartiles": quartiles, "rounds": len(values)}


class Table(NamedTuple):
    """A table: its mark in the page, its heading, columns and rows of cells."""

    mark: str
    title: str
    columns: list[str]
    rows: list[list[str]]

    def markdown(self) -> str:
        """Numbers to the right, the first column to the left."""
        numeric = [bool(self.rows) and all(re.match(r"-?[\d.].{,23}$|-?$", row[k]) for row in self.rows)
                   for k in range(len(self.columns))]
        head = ["---:" if k and number else "---" for k, number in enumerate(numeric)]
        return "\n".join("| " + " | ".join(row) + " |" for row in [self.columns, head, *self.rows])


def show(tables: list[Table]) -> None:
    """Prints tables as they stand in the page."""
    for table in tables:
        print(f"\n{table.title}\n\n{table.markdown()}", flush=True)


def write_page(tables: list[Table], page: Path = PAGE) -> None:
    """Replaces what stands between the marks `<!-- NAME -->` and `<!-- end -->` of each table that the page has."""
    text = page.read_text(encoding="utf-8")
    for table in tables:
        pattern = re.compile(rf"(<!-- {re.escape(table.mark)} -->\n).*?(<!-- end -->)", re.DOTALL)
        text, count = pattern.subn(lambda found, new=table.markdown(): f"{found[1]}{new}\n{found[2]}", text)
        if not count:
            print(f"{page.name} has no place for the table {table.mark!r}")
    page.write_text(text, encoding="utf-8")


def shown_time(seconds: float) -> str:
    """With the unit that leaves the fewest zeros."""
    for unit, scale in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= scale:
            return f"{seconds / scale:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


def aim(value: float, least: float) -> str:
    """Whether an aim is met."""
    return "met" if value >= least else "missed"
