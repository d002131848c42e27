"""The review page: one static file beside the pictures, made from what the EXR files say about themselves."""

from html import escape
from pathlib import Path

import mitsuba as mi

from validation.render.review_set import COMPARISONS, PICTURES, WIDTHS, Chart, Comparison, Picture
from validation.support.mitsuba_setup import SEA

STYLE = """
:root { color-scheme: light dark; }
body { max-width: 82rem; margin: 2rem auto; padding: 0 1rem; font: 1rem/1.5 system-ui, sans-serif; }
article { margin: 3rem 0; }
img { display: block; width: 100%; height: auto; }
h2 { margin: 0.6rem 0 0; }
p { max-width: 46rem; margin: 0.3rem 0; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 0 1rem; margin: 0.5rem 0; }
dt { opacity: 0.7; }
dd { margin: 0; font-variant-numeric: tabular-nums; overflow-wrap: anywhere; }
pre { overflow-x: auto; }
"""

# Entries of an EXR's metadata that are shown as they are; the sea is shown folded away.
FACTS = ["scene", "parameters", "size", "samples", "seconds", "variant", "rendered", "pictures", "overall", "scale"]


def write_page(directory: Path, target: Path) -> None:
    """Writes the page on all pictures of the review set that are in `directory` into `target`."""
    cards = [card(p, directory) for p in (*PICTURES, *COMPARISONS) if (directory / f"{p.name}.exr").is_file()]
    if (directory / f"{WIDTHS.name}.png").is_file():
        cards.append(figure(WIDTHS))
    target.write_text(
        "<!DOCTYPE html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'>\n"
        "<meta name='viewport' content='width=device-width, initial-scale=1'>\n"
        f"<title>prob-water: review renders</title>\n<style>{STYLE}</style>\n</head>\n<body>\n"
        f"<h1>prob-water: review renders</h1>\n{''.join(cards)}</body>\n</html>\n",
        encoding="utf-8",
    )


def card(picture: Picture | Comparison, directory: Path) -> str:
    """One picture with its words and facts."""
    exr = mi.Bitmap(str(directory / f"{picture.name}.exr"))
    facts = exr.metadata()
    rows = "".join(f"<dt>{key}</dt><dd>{escape(str(facts[key]))}</dd>\n" for key in FACTS if key in facts)
    sea = "" if SEA not in facts else f"<details><summary>the water in full</summary><pre>{escape(str(facts[SEA]))}</pre></details>\n"
    width, height = exr.size()
    return (
        f"<article id='{picture.name}'>\n"
        f"<a href='{picture.name}.png'><img src='{picture.name}.png' width='{width}' height='{height}' "
        f"alt='{escape(picture.title)}'></a>\n"
        f"<h2>{escape(picture.title)}</h2>\n<p>{escape(picture.caption)}</p>\n<dl>\n{rows}"
        f"<dt>files</dt><dd><a href='{picture.name}.exr'>{picture.name}.exr</a> (linear), "
        f"<a href='{picture.name}.png'>{picture.name}.png</a></dd>\n</dl>\n"
        f"{sea}</article>\n"
    )


def figure(chart: Chart) -> str:
    """A chart with its words."""
    return (
        f"<article id='{chart.name}'>\n<a href='{chart.name}.png'><img src='{chart.name}.png' alt='{escape(chart.title)}'></a>\n"
        f"<h2>{escape(chart.title)}</h2>\n<p>{escape(chart.caption)}</p>\n</article>\n"
    )
