"""The page of the fronts: out/bench.html, its pictures in out/bench/."""

from html import escape
from pathlib import Path
from typing import Any

from validation.bench import front_plot
from validation.bench.fronts import FRONTS, tables
from validation.bench.report import Table
from validation.support.look import PAGE
from validation.support.paths import ROOT

OVERVIEW = ["brdf", "wavy", "means", "cast", "mesh_height", "rendering"]


def write(fronts: dict[str, Any], facts: str, small: Path | None) -> Path:
    """Pictures and page; `small` is where one picture of all goes too."""
    out = ROOT / "out/bench"
    out.mkdir(parents=True, exist_ok=True)
    points = fronts["points"]
    sections = []
    for front, (title, *_, caption) in FRONTS.items():
        if not any(point["front"] == front for point in points):
            continue
        front_plot.single(front, points).savefig(out / f"{front}.svg")
        sections.append(f"<section id='{front}'>\n<h2>{escape(title)}</h2>\n<img src='bench/{front}.svg' "
                        f"alt='{escape(title)}: run time against error'>\n<p>{escape(caption)}</p>\n</section>\n")
    shown = [front for front in OVERVIEW if any(point["front"] == front for point in points)]
    for target in filter(None, [out / "fronts.png", small]):
        front_plot.overview(points, shown).savefig(target, dpi=80, pil_kwargs={"optimize": True})
    numbers = "".join(map(section, tables(fronts)))
    page = ROOT / "out/bench.html"
    page.write_text(
        "<!DOCTYPE html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'>\n"
        "<meta name='viewport' content='width=device-width, initial-scale=1'>\n"
        f"<title>prob-water: run time against error</title>\n<style>{PAGE}</style>\n</head>\n<body>\n"
        "<h1>Run time against error</h1>\n<p>Every point is a configuration that can be had. Nothing lies below and to the "
        "left of the grey line; what lies above and to the right of it is beaten in both. Times are the best, bars reach to "
        f"the upper quartile.</p>\n<p>{escape(facts)}</p>\n{''.join(sections)}{numbers}</body>\n</html>\n", encoding="utf-8")
    return page


def section(table: Table) -> str:
    """A table under its heading."""
    head = "".join(f"<th>{escape(name)}</th>" for name in table.columns)
    rows = "".join("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>\n" for row in table.rows)
    return f"<section>\n<h2>{escape(table.title)}</h2>\n<table>\n<tr>{head}</tr>\n{rows}</table>\n</section>\n"
