"""How fronts of run time against error look."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from validation.bench.fronts import FRONTS, efficient
from validation.bench.report import shown_time
from validation.support import look

#: What every family is drawn with, in the order of the legends: colour and marker.
COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#444444", "#8c564b"]
MARKERS = "osD^vP*X"
#: Errors of references are drawn here, below all others.
BELOW = 0.1


def draw(axes: Axes, front: str, points: list[dict[str, Any]], small: bool = False) -> None:
    """One front: a line a family, labels of settings, and the efficient points joined by steps."""
    title, time, error, _ = FRONTS[front]
    points = [point for point in points if point["front"] == front]
    known = [point["error"] for point in points if point["error"] > 0]
    edge = BELOW * min(known)
    place = {id(point): (point["seconds"]["best"], point["error"] or edge) for point in points}
    front_line(axes, [place[id(point)] for point in efficient(points)], edge)
    names = list(dict.fromkeys(point["family"] for point in points))
    for name, colour, marker in zip(names, COLOURS, MARKERS):
        family = [point for point in points if point["family"] == name]
        x, y = np.array([place[id(point)] for point in family]).T
        axes.plot(x, y, color=colour, marker=marker, markersize=6, linewidth=1, label=name, zorder=3,
                  markerfacecolor="white" if not any(point["error"] for point in family) else colour)
        ends = np.array([(point["seconds"]["best"], point["seconds"]["quartiles"][1]) for point in family])
        axes.hlines(y, *ends.T, color=colour, linewidth=3, alpha=0.35, zorder=2)
        labelled = family if not small else [family[0], family[-1]] if len(family) > 1 else family
        for point in labelled:
            if point["setting"].isdigit():
                axes.annotate(f"{int(point['setting']):,}", place[id(point)], xytext=(5, 4), textcoords="offset points",
                              fontsize=7.5, color=colour)
    axes.set(xscale="log", yscale="log", title=title, xlabel=time, ylabel=error)
    decorate(axes)
    if not all(point["error"] for point in points):
        zero(axes, edge)


def front_line(axes: Axes, places: list[tuple[float, float]], edge: float) -> None:
    """Everything up and to the right of it is beaten in both time and error."""
    axes.step(*zip(*places), where="post", color="#999999", linewidth=5, alpha=0.35, zorder=1,
              label="efficient front")


def decorate(axes: Axes) -> None:
    """Times with their units, and room for labels."""
    axes.margins(0.12, 0.12)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda x, _: shown_time(x)))
    low, high = np.log10(axes.get_xlim())
    if high - low < 1.6:
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axes.xaxis.set_minor_formatter(NullFormatter())
    low, high = np.log10(axes.get_ylim())
    if high - low < 1.6:
        axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{y:g}"))
    axes.yaxis.set_minor_formatter(NullFormatter())


def zero(axes: Axes, edge: float) -> None:
    """References stand at 0, below a break of the logarithmic axis."""
    ends = axes.get_ylim()
    axes.axhline(2.5 * edge, color="#999999", linewidth=0.8, linestyle=(0, (4, 4)))
    ticks = [y for y in axes.get_yticks() if 3 * edge < y <= ends[1]]
    words = [f"{y:.0e}" if y < 1e-3 else f"{y:g}" for y in ticks]
    axes.set_yticks([edge, *ticks], ["0", *words])
    axes.set_yticks([], minor=True)
    axes.set_ylim(edge / 2.5, ends[1])


def single(front: str, points: list[dict[str, Any]]) -> Any:
    """A picture of one front, its legend beside it."""
    page = look.canvas()
    page.set_size_inches(8.6, 4.2)
    draw(page.subplots(), front, points)
    look.legend(page, page.axes[0])
    return page


def overview(points: list[dict[str, Any]], fronts: list[str]) -> Any:
    """Several at once."""
    page = look.canvas()
    page.set_size_inches(11, 3.7 * ((len(fronts) + 1) // 2))
    panels = page.subplots((len(fronts) + 1) // 2, 2, squeeze=False).flat
    for axes, front in zip(panels, fronts, strict=False):
        draw(axes, front, points, small=True)
        corner = "lower left" if any(point["front"] == front and not point["error"] for point in points) else "upper right"
        axes.legend(fontsize=7.5, loc=corner)
    for axes in list(panels)[len(fronts):]:
        axes.remove()
    return page
