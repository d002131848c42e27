"""How pictures and pages look."""

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas

PICTURE = {
    "figure.figsize": (10.5, 4.4), "figure.dpi": 110, "figure.constrained_layout.use": True,
    "font.size": 10, "axes.grid": True, "grid.alpha": 0.3, "axes.spines.top": False, "axes.spines.right": False,
    "lines.linewidth": 1.5, "legend.frameon": False, "axes.titlesize": 10, "axes.titlelocation": "left",
}
PAGE = """
:root { color-scheme: light dark; }
body { max-width: 76rem; margin: 2rem auto; padding: 0 1rem; font: 1rem/1.5 system-ui, sans-serif; }
section { margin: 3.5rem 0; }
img { display: block; max-width: 100%; height: auto; background: white; }
h2 { margin: 0 0 0.6rem; }
p { max-width: 50rem; margin: 0.5rem 0; }
table { border-collapse: collapse; width: 100%; margin: 0.8rem 0; }
th, td { padding: 0.35rem 0.8rem 0.35rem 0; text-align: left; vertical-align: top;
  border-bottom: 1px solid color-mix(in srgb, currentColor 25%, transparent); }
td.claim { width: 36%; }
td.verdict { white-space: nowrap; font-weight: 600; }
.holds { color: light-dark(#1a6b2a, #7fd08f); }
.fails { color: light-dark(#a11d1d, #ff9a8f); }
.own { font-style: italic; }
"""


def canvas() -> Canvas:
    """An empty page of the common size."""
    matplotlib.rcParams.update(PICTURE)
    return Canvas()


def legend(page: Canvas, axes: Axes, title: str | None = None) -> None:
    """A legend right of the panels, so that it covers nothing."""
    page.legend(*axes.get_legend_handles_labels(), loc="outside right upper", title=title)
