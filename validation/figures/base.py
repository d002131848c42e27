"""The figures of the base engagement scenario: Fig. 6, its instances, and Fig. 7, their average."""

import numpy as np
from matplotlib.figure import Figure as Canvas
from scipy.stats import spearmanr

from validation.figures import plot
from validation.figures.claim import (MARGIN, Claim, Figure, Tables, Verdict, at, bell, fit_bell, half_width, least,
                                      peak, sigmas)
from validation.figures.data import (BASE, BASE_TEXT, REPORT_INSTANCES, Command, averages, flat_wave, observers_of,
                                     select)
from validation.support import look


# ---- Figure 6: instances

CHECKED_INSTANCES = 500


def collect_instances(command: Command, _: int) -> Tables:
    """Every curve of 500 instances, the report's 50 first."""
    directions, labels = observers_of(BASE["incidence"])
    rows = command.instances({}, directions, CHECKED_INSTANCES)
    curves = {name: np.repeat(values, CHECKED_INSTANCES) for name, values in labels.items()}
    return {"instances": curves | {name: rows[name] for name in ("instance", "f", "nx", "ny")}}


def draw_instances(tables: Tables, page: Canvas) -> None:
    """The report's 50, shaded by the tilt across the panel's own plane."""
    panels = plot.plane_panels(page)
    nx, ny = tilts(tables)
    across = {"in": ny, "out": nx}
    for plane, axes in panels.items():
        angles, values = curves_of(tables, plane)
        lines = plot.shaded_lines(axes, angles, values[:REPORT_INSTANCES], abs(across[plane][:REPORT_INSTANCES]))
        page.colorbar(lines, ax=axes, label=f"size of the normal's {'y' if plane == 'in' else 'x'}")


def curves_of(tables: Tables, plane: str) -> tuple[np.ndarray, np.ndarray]:
    """Angles, and f by instance and angle."""
    rows = select(tables["instances"], plane=plane)
    return np.unique(rows["angle"]), rows["f"].reshape(-1, CHECKED_INSTANCES).T


def tilts(tables: Tables) -> tuple[np.ndarray, np.ndarray]:
    """The wave normals' x (in-plane) and y (out-of-plane), by instance."""
    rows = tables["instances"]
    return rows["nx"][:CHECKED_INSTANCES], rows["ny"][:CHECKED_INSTANCES]


def spans_a_range(tables: Tables) -> Verdict:
    """Of the report's 50: where their peaks are and how high."""
    parts, holds = [], True
    for plane, name in (("in", "in-plane"), ("out", "out-of-plane")):
        angles, values = curves_of(tables, plane)
        values = values[:REPORT_INSTANCES]
        where, height = angles[values.argmax(axis=1)], values.max(axis=1)
        holds &= np.ptp(where) > 10 and height.max() > 3 * height.min()
        parts.append(f"{name} the peaks of 50 instances lie between {where.min():g} and {where.max():g} degrees "
                     f"and are {height.min():.2g} to {height.max():.2g} 1/sr high")
    return Verdict(bool(holds), "; ".join(parts))


def correlation(first: np.ndarray, second: np.ndarray) -> tuple[float, float]:
    """Spearman's rank correlation, and it in standard errors (Fisher's z)."""
    found = float(spearmanr(first, second).statistic)
    return found, float(np.arctanh(found)) * np.sqrt(len(first) - 3)


def magnitude_rises_with_the_angle(tables: Tables) -> Verdict:
    """In-plane peaks: height against angle, for all instances and for those hardly tilted out of plane."""
    angles, values = curves_of(tables, "in")
    where, height, level = angles[values.argmax(axis=1)], values.max(axis=1), abs(tilts(tables)[1]) < 0.02
    everything, margin = correlation(height, where)
    in_plane_only, _ = correlation(height[level], where[level])
    return Verdict(margin > MARGIN, "rank correlation of an instance's in-plane peak with its angle: "
                   f"{everything:.2f} over {len(where)} instances ({margin:.0f} standard errors), "
                   f"{in_plane_only:.2f} over the {level.sum()} tilted out of plane by less than 0.02")


def out_of_plane_tilt_moves_the_peak(tables: Tables) -> Verdict:
    """Fig. 6b: the peak's angle against the normal's y."""
    angles, values = curves_of(tables, "out")
    found, margin = correlation(angles[values.argmax(axis=1)], tilts(tables)[1])
    return Verdict(margin > MARGIN, "rank correlation of the out-of-plane peak's angle with the normal's y: "
                   f"{found:.3f} ({margin:.0f} standard errors)")


def out_of_plane_tilt_lowers(tables: Tables, plane: str) -> Verdict:
    """The peak's height against both tilts."""
    _, values = curves_of(tables, plane)
    nx, ny = tilts(tables)
    across, margin = correlation(values.max(axis=1), abs(ny))
    along, _ = correlation(values.max(axis=1), abs(nx))
    return Verdict(margin < -MARGIN, "rank correlation of the peak's height with the size of the tilt out of "
                   f"plane: {across:.2f} ({margin:.0f} standard errors); with that in plane: {along:.2f}")


def out_of_plane_tilt_lowers_6a(tables: Tables) -> Verdict:
    """In-plane curves."""
    return out_of_plane_tilt_lowers(tables, "in")


def out_of_plane_tilt_lowers_6b(tables: Tables) -> Verdict:
    """Out-of-plane curves."""
    return out_of_plane_tilt_lowers(tables, "out")


# ---- Figure 7: averages

def collect_averages(command: Command, instances: int) -> Tables:
    """The base scenario with many instances, with the report's 50, and without waves."""
    return {"averages": averages(command, {}, instances),
            "report": averages(command, {}, REPORT_INSTANCES, "drawn"),
            "flat": flat_wave(command)}


def draw_averages(tables: Tables, page: Canvas) -> None:
    """Three curves a panel."""
    panels = plot.plane_panels(page)
    count = tables["averages"]["instances"][0]
    for plane, axes in panels.items():
        flat = select(tables["flat"], plane=plane)
        plot.line(axes, select(tables["averages"], plane=plane), color="black", label=f"N = {count:g}")
        plot.line(axes, select(tables["report"], plane=plane), color="tab:blue", linewidth=1, label="N = 50")
        axes.plot(flat["angle"], flat["f"], "--", color="tab:red", label="flat wave")
    look.legend(page, panels["in"])


def maximum_is_near_specular(tables: Tables) -> Verdict:
    """The peak is within a step of the grid, and the curve is lower 7.5 degrees from specular, by the margin."""
    parts, holds = [], True
    for plane, name, specular in (("in", "in-plane", BASE["incidence"]), ("out", "out-of-plane", 0.0)):
        curve = select(tables["averages"], plane=plane)
        top, (value, error) = peak(curve), at(curve, specular)
        sides = [at(curve, specular + side) for side in (-7.5, 7.5)]
        margin = least(sigmas(value - v, error + e) for v, e in sides)
        holds &= abs(top.angle - specular) <= 2.5 and margin > MARGIN
        parts.append(f"{name} {top.value:.4f} ± {top.error:.4f} 1/sr at {top.angle:g} degrees (specular "
                     f"{specular:g}), above both sides 7.5 degrees off by {margin:.0f} standard errors")
    return Verdict(bool(holds), "; ".join(parts))


def is_gaussian_near_the_maximum(tables: Tables) -> Verdict:
    """The largest departure from the nearest Gaussian, over the peak."""
    parts, holds = [], True
    for plane, name in (("in", "in-plane"), ("out", "out-of-plane")):
        curve = select(tables["averages"], plane=plane)
        height, centre, width = fit_bell(curve["angle"], curve["mean"])
        off = abs(curve["mean"] - bell(curve["angle"], height, centre, width)).max() / height
        error = curve["sem"].max() / height
        holds &= off + MARGIN * error < 0.1
        parts.append(f"{name} the nearest Gaussian has a 1/e half width of {width:.1f} degrees and is off by at "
                     f"most {100 * off:.1f} ± {100 * error:.1f} % of the peak")
    return Verdict(bool(holds), "; ".join(parts))


def maximum_is_below_the_flat_waves(tables: Tables) -> Verdict:
    """Peak against peak."""
    top, flat = peak(select(tables["averages"], plane="in")), tables["flat"]["f"].max()
    margin = sigmas(flat - top.value, top.error)
    return Verdict(margin > MARGIN, f"{top.value:.4f} ± {top.error:.4f} against {flat:.4f} 1/sr, "
                   f"{top.value / flat:.2f} of it; lower by {margin:.0f} standard errors")


def is_wider_than_the_flat_waves(tables: Tables) -> Verdict:
    """Full widths at half maximum; decided where the flat wave's is half, rounded outwards to the grid."""
    parts, holds = [], True
    for plane, name in (("in", "in-plane"), ("out", "out-of-plane")):
        curve, flat = select(tables["averages"], plane=plane), select(tables["flat"], plane=plane)
        left, right = half_width(flat["angle"], flat["f"])
        wide = np.diff(half_width(curve["angle"], curve["mean"]))[0]
        top = peak(curve)
        outside = [at(curve, 2.5 * np.floor(left / 2.5)), at(curve, 2.5 * np.ceil(right / 2.5))]
        margin = least(sigmas(v - top.value / 2, e + top.error / 2) for v, e in outside)
        holds &= margin > MARGIN
        parts.append(f"{name} {wide:.1f} against {right - left:.1f} degrees at half maximum; above half where "
                     f"the flat wave's is below, by {margin:.0f} standard errors")
    return Verdict(bool(holds), "; ".join(parts))


FIGURES = [
    Figure(
        "figure-06", "Figure 6: instances of the BRDF",
        "The 50 instances of the base scenario, w* = 8 cm/s, D = 0.15 m, θi = 30°, M = 5; the checks use 500.",
        collect_instances, draw_instances,
        [Claim("The instances of BRDF span a significant range in both angle of reflection and magnitude.",
               spans_a_range),
         Claim("In-plane variations account for the increase in the magnitude of BRDF in Fig. 6(a) as the "
               "angle of reflection increases.", magnitude_rises_with_the_angle),
         Claim("Out-of-plane variations account for the range in angle of the maximum BRDF in Fig. 6(b)",
               out_of_plane_tilt_moves_the_peak),
         Claim("Out-of-plane variations account [...] for the decrease in magnitude in [...] Figs. 6(a)",
               out_of_plane_tilt_lowers_6a),
         Claim("[and] 6(b).", out_of_plane_tilt_lowers_6b, expected=False)]),
    Figure(
        "figure-07", "Figure 7: average and flat wave BRDF",
        BASE_TEXT + " Blue: the report's 50 instances.",
        collect_averages, draw_averages,
        [Claim("Both the in-plane and out-of-plane average BRDFs in Fig. 7 are well behaved, with maximums at, "
               "or close to, the specular reflection angle.", maximum_is_near_specular),
         Claim("In general, the water BRDF has a maximum in the specular reflection direction with a Gaussian "
               "distribution around this maximum [here: within 10 % of the peak].", is_gaussian_near_the_maximum),
         Claim("The maximum of the average is less than that of the flat wave BRDF,",
               maximum_is_below_the_flat_waves),
         Claim("while the width is greater", is_wider_than_the_flat_waves)]),
]
