"""The plot of the error budget."""

from pathlib import Path

import matplotlib
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from validation.error_budget.compare import Comparison
from validation.error_budget.rows import GROUPS, KINDS

#: Colour by kind.
COLOURS = {"float64": "#1f5fa8", "float32": "#d9711a", "lanes": "#7b3fa0", "approximation": "#2a8a4a"}
#: What errors that are not relative are in.
UNITS = {"absolute, m": "m", "absolute, radians": "rad", "absolute, standard": "std", "absolute": "abs.",
         "over its standard": "std"}
#: The axis, and what lies below it.
LEAST, MOST = 1e-18, 1e2


def draw(comparison: Comparison, path: Path) -> None:
    """Every row from its median to its worst error, with the claimed bound."""
    matplotlib.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False})
    rows = sum(len(group.rows) + 1 for group in GROUPS)
    page = Figure(figsize=(9.5, 0.235 * rows + 1.3), dpi=120, layout="constrained")
    axes = page.subplots()
    y, ticks, labels = 0.0, [], []
    for group in GROUPS:
        axes.text(LEAST, y + 0.15, group.title, weight="bold", va="center")
        y += 1
        for number, row in enumerate(group.rows):
            if number % 2 == 0:
                axes.axhspan(y - 0.5, y + 0.5, color="0.955", zorder=0)
            kinds = [kind for kind in KINDS if comparison.of(row.name, kind)]
            # float64 lies far left of the others, which share the row.
            others = [kind for kind in kinds if kind != "float64"]
            for kind in kinds:
                colour, found = COLOURS[kind], comparison.of(row.name, kind)
                place = (others.index(kind) + 0.5) / len(others) - 0.5 if kind in others else 0.0
                median, worst = (max(x, 1.3 * LEAST) for x in found)
                at = y + 0.75 * place
                axes.plot([median, worst], [at, at], color=colour, linewidth=2.2, solid_capstyle="round")
                axes.plot(median, at, "o", color=colour, markersize=4, markerfacecolor="white")
                axes.plot(worst, at, "o", color=colour, markersize=4)
                axes.plot(row.bound(kind)[1], at, "|", color=colour, markersize=6, markeredgewidth=1.4)
            ticks.append(y)
            unit = next((f" [{unit}]" for start, unit in UNITS.items() if row.measure.startswith(start)), "")
            equations = f" ({row.equations})" if row.equations[0].isdigit() else ""
            labels.append(row.title + equations + unit)
            y += 1
    axes.set(xscale="log", xlim=(LEAST, MOST), ylim=(y - 0.4, -0.6),
             xlabel="error: relative; [abs.] absolute, [std] in standard deviations, [m] metres, [rad] radians")
    axes.set_xticks([10.0**e for e in range(-18, 3, 2)])
    axes.set_yticks(ticks, labels)
    axes.tick_params(axis="y", length=0)
    axes.tick_params(axis="x", top=True, labeltop=True)
    axes.grid(axis="x", alpha=0.35)
    # Half of the last digit of a number near 1.
    for value, name in ((2**-53, "rounding of float64"), (2**-24, "rounding of float32")):
        axes.axvline(value, color="0.45", linewidth=0.9, linestyle=":")
        axes.annotate(name, (value, y - 0.5), rotation=90, fontsize=7.5, color="0.35", ha="right", va="bottom")
    shown = [kind for kind in KINDS if any(key[1] == kind for key in comparison.errors)]
    marks = [Line2D([], [], color=COLOURS[kind], linewidth=2.2, label=kind) for kind in shown]
    marks += [Line2D([], [], color="0.3", marker="o", markerfacecolor="white", linestyle="", label="median"),
              Line2D([], [], color="0.3", marker="o", linestyle="", label="worst"),
              Line2D([], [], color="0.3", marker="|", linestyle="", markeredgewidth=1.4, label="bound of the worst")]
    page.legend(handles=marks, loc="outside upper center", ncols=len(marks), frameon=False)
    page.savefig(path, pil_kwargs={"optimize": True})
