"""How the figures look."""

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure as Canvas
from matplotlib.ticker import MultipleLocator

from validation.figures.data import Table, select
from validation.support.look import legend

#: Title, label, and the common and the full range of angles in degrees.
PLANES = {"in": ("(a) in-plane", "angle of reflection θr, degrees", (-30, 90), (-90, 90)),
          "out": ("(b) out-of-plane", "out-of-plane angle φr, degrees", (-40, 40), (-60, 60))}
BRDF = "BRDF, 1/sr"


def shades(count: int) -> list[tuple]:
    """Colours for an ordered parameter, dark to light, all visible on white."""
    return list(matplotlib.colormaps["viridis"](np.linspace(0, 0.87, count)))


def line(axes: Axes, curve: Table, **style: object) -> None:
    """A mean with its standard error as a band."""
    drawn, = axes.plot(curve["angle"], curve["mean"], **style)
    axes.fill_between(curve["angle"], curve["mean"] - curve["sem"], curve["mean"] + curve["sem"],
                      color=drawn.get_color(), alpha=0.25, linewidth=0)


def shaded_lines(axes: Axes, x: np.ndarray, curves: np.ndarray, shade: np.ndarray) -> LineCollection:
    """Thin lines shaded by a value each; for a colour bar."""
    lines = LineCollection([np.column_stack([x, curve]) for curve in curves], array=shade, linewidths=0.8)
    axes.add_collection(lines)
    axes.autoscale_view()
    return lines


def angle_axis(axes: Axes, plane: str, wide: bool = False) -> None:
    """Labels and range of a panel over angles; `wide` shows all that is computed."""
    title, label, narrow, full = PLANES[plane]
    axes.set(title=title, xlabel=label, ylabel=BRDF, xlim=full if wide else narrow)
    axes.xaxis.set_major_locator(MultipleLocator(30 if plane == "in" else 20))


def plane_panels(page: Canvas, wide: bool = False) -> dict[str, Axes]:
    """Two panels, in-plane and out-of-plane."""
    panels = dict(zip(PLANES, page.subplots(1, 2), strict=True))
    for plane, axes in panels.items():
        angle_axis(axes, plane, wide)
    return panels


def family(page: Canvas, table: Table, key: str, title: str, wide: bool = False) -> dict[str, Axes]:
    """In-plane and out-of-plane averages for every value of a column, with one legend beside them."""
    panels = plane_panels(page, wide)
    values = np.unique(table[key])
    for plane, axes in panels.items():
        for value, colour in zip(values, shades(len(values)), strict=True):
            line(axes, select(table, **{"plane": plane, key: value}), color=colour, label=f"{value:g}")
    legend(page, panels["in"], title)
    return panels
