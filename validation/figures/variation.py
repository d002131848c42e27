"""The variations of the base engagement scenario: Figs. 8-12."""

import numpy as np
from matplotlib.figure import Figure as Canvas

from validation.figures import plot
from validation.figures.claim import (MARGIN, Claim, Figure, Tables, Verdict, at, fit_bell, full_width, least, listed,
                                      peak, peaks, sigmas, steps)
from validation.figures.data import (BASE_TEXT, IN_PLANE, REPORT_INSTANCES, WINDS, Command, Table, averages, column,
                                     in_plane, select, stack, sweep)
from validation.support import look


# ---- Figure 8: wind

def collect_winds(command: Command, instances: int) -> Tables:
    """The friction velocities of section 3."""
    return {"winds": sweep(command, ({"friction_velocity": wind} for wind in WINDS), instances)}


def draw_winds(tables: Tables, page: Canvas) -> None:
    """Logarithmic: the maxima differ by a factor of 27."""
    panels = plot.family(page, tables["winds"], "friction_velocity", "w*, cm/s", wide=True)
    for axes in panels.values():
        axes.set_yscale("log")
        axes.set_ylim(1e-4, 2)


def decreases_with_wind(tables: Tables) -> Verdict:
    """Every step of the wind lowers the maximum."""
    winds, tops = peaks(tables["winds"], "friction_velocity")
    values, errors = np.array([t.value for t in tops]), np.array([t.error for t in tops])
    margin = -steps(values, errors).max()
    return Verdict(margin > MARGIN, f"maxima {listed(values)} 1/sr at w* = {listed(winds)}; every step falls by "
                   f"at least {margin:.0f} standard errors")


def falls_by_more_than_ten(tables: Tables) -> Verdict:
    """First maximum over last."""
    _, tops = peaks(tables["winds"], "friction_velocity")
    first, last = tops[0], tops[-1]
    margin = sigmas(first.value - 10 * last.value, first.error + 10 * last.error)
    return Verdict(margin > MARGIN, f"by a factor of {first.value / last.value:.1f}; above 10 by {margin:.0f} "
                   "standard errors")


def is_inverse_to_wind(tables: Tables) -> Verdict:
    """The exponent of a power law fitted to the maxima, and how far the maxima leave 1/w*."""
    winds, tops = peaks(tables["winds"], "friction_velocity")
    values, errors = np.array([t.value for t in tops]), np.array([t.error / t.value for t in tops])
    x = np.log(winds) - np.log(winds).mean()
    exponent = x @ np.log(values) / (x @ x)
    error = np.sqrt((x**2) @ errors**2) / (x @ x)
    product = winds * values
    local = np.diff(np.log(values)) / np.diff(np.log(winds))
    margin = sigmas(0.15 - abs(exponent + 1), error)
    return Verdict(margin > MARGIN, f"fitted exponent {exponent:.3f} ± {error:.3f} (within 0.15 of -1 by "
                   f"{margin:.0f} standard errors), from step to step {listed(local, 2)}; w* times the maximum "
                   f"varies between {product.min():.2f} and {product.max():.2f} cm/s/sr: only roughly inverse")


# ---- Figure 9: the secondary peak

STORM = 56.0
#: The corrected equations, and the unsigned angles as printed, with their names.
READINGS = {"corrected": "corrected", "71-73": "Eqs. 71-73 as printed"}
#: Contrasts of f at θi = 30 between angles of reflection, by instance: name and weights.
CONTRASTS = {"rise from 67.5 to 80": {67.5: -1, 80.0: 1},
             "fall from 80 to 87.5": {80.0: 1, 87.5: -1},
             "fall from 60 to 67.5, less that from 70 to 77.5": {60.0: 1, 67.5: -1, 70.0: -1, 77.5: 1}}
CONTRAST_ANGLES = [60.0, 67.5, 70.0, 77.5, 80.0, 87.5]
CONTRAST_INSTANCES = 10000


def collect_storm(command: Command, instances: int) -> Tables:
    """Strong winds at 30 degrees and every incidence at the strongest, in both readings."""
    cases = [{"friction_velocity": wind} for wind in (24.0, 40.0, STORM)]
    cases += [{"friction_velocity": STORM, "incidence": incidence} for incidence in (15.0, 45.0, 60.0)]
    curves = sweep(command, (case | {"readings": reading} for reading in READINGS for case in cases), instances)
    return {"storm": curves, "contrasts": stack(contrasts(command, reading) for reading in READINGS)}


def contrasts(command: Command, reading: str) -> Table:
    """Mean and standard error of every contrast; instances see all angles, so most of the scatter cancels."""
    case = {"friction_velocity": STORM, "readings": reading}
    rows = command.instances(case, in_plane(np.array(CONTRAST_ANGLES)), CONTRAST_INSTANCES)
    seen = dict(zip(CONTRAST_ANGLES, rows["f"].reshape(len(CONTRAST_ANGLES), -1), strict=True))
    sums = [sum(weight * seen[angle] for angle, weight in weights.items()) for weights in CONTRASTS.values()]
    return {"readings": np.array([reading] * len(sums)), "contrast": np.array(list(CONTRASTS)),
            "mean": np.array([values.mean() for values in sums]),
            "sem": np.array([values.std() / np.sqrt(len(values)) for values in sums])}


def draw_storm(tables: Tables, page: Canvas) -> None:
    """In-plane at w* = 56: both readings at 30 degrees, then the corrected one over the incidence."""
    left, right = page.subplots(1, 2)
    for axes in (left, right):
        plot.angle_axis(axes, "in", wide=True)
    rows = select(tables["storm"], friction_velocity=STORM, plane="in")
    for reading, colour in zip(READINGS, ("black", "tab:orange"), strict=True):
        curve = select(rows, readings=reading, incidence=30.0)
        plot.line(left, curve, color=colour, label=READINGS[reading])
        incidences = np.unique(rows["incidence"])
        for incidence, shade in zip(incidences, plot.shades(len(incidences)), strict=True):
            curve = select(rows, readings=reading, incidence=incidence)
            plot.line(right, curve, color=shade, linestyle="-" if reading == "corrected" else ":",
                      label=f"θi = {incidence:g}°" if reading == "corrected" else None)
    left.axvline(80, color="0.6", linewidth=1, linestyle="--")
    left.set(title="(a) in-plane, w* = 56 cm/s, θi = 30°", ylim=(0, None))
    right.set(title="(b) in-plane, w* = 56 cm/s; dotted: Eqs. 71-73 as printed", yscale="log", ylim=(1e-4, 5))
    left.legend(loc="upper left")
    look.legend(page, right)


def contrast(tables: Tables, reading: str, name: str) -> tuple[float, float, float]:
    """Mean, standard error (1/sr) and margin of a contrast."""
    row = select(tables["contrasts"], readings=reading, contrast=name)
    return row["mean"][0], row["sem"][0], sigmas(row["mean"][0], row["sem"][0])


def secondary_peak(tables: Tables, reading: str) -> Verdict:
    """At 30 degrees of incidence: a rise towards 80 degrees and a fall after it."""
    rise, error, margin = contrast(tables, reading, "rise from 67.5 to 80")
    _, _, fall = contrast(tables, reading, "fall from 80 to 87.5")
    curve = select(tables["storm"], readings=reading, friction_velocity=STORM, incidence=30.0, plane="in")
    outer = {name: values[curve["angle"] >= 67.5] for name, values in curve.items()}
    top = peak(outer)
    holds = margin > MARGIN and fall > MARGIN and abs(top.angle - 80) <= 2.5
    shape = f"highest beyond 67.5 degrees at {top.angle:g}: {top.value:.4f} 1/sr"
    return Verdict(bool(holds), f"{READINGS[reading]}, θi = 30: f(80) - f(67.5) = {rise:.5f} ± "
                   f"{error:.5f} 1/sr ({margin:+.0f} standard errors); {shape}")


def secondary_peak_as_printed(tables: Tables) -> Verdict:
    """The printed, unsigned angles."""
    return secondary_peak(tables, "71-73")


def secondary_peak_corrected(tables: Tables) -> Verdict:
    """The corrected reading."""
    return secondary_peak(tables, "corrected")


def shoulder_corrected(tables: Tables) -> Verdict:
    """The corrected reading: no peak but a stretch of slower fall."""
    change, error, margin = contrast(tables, "corrected", "fall from 60 to 67.5, less that from 70 to 77.5")
    _, _, rise = contrast(tables, "corrected", "rise from 67.5 to 80")
    _, _, end = contrast(tables, "corrected", "fall from 80 to 87.5")
    return Verdict(margin > MARGIN and rise < -MARGIN and end > MARGIN,
                   f"falls by {change:.5f} ± {error:.5f} 1/sr less from 70 to 77.5 than from 60 to 67.5 degrees "
                   f"({margin:.0f} standard errors), then steeply; f(80) is below f(67.5) by {-rise:.0f} "
                   "standard errors")


def more_pronounced(tables: Tables, key: str, **wanted: float) -> Verdict:
    """f at 80 degrees over f in the specular direction, along a column, in both readings."""
    parts, margins = [], []
    for reading in READINGS:
        rows = select(tables["storm"], readings=reading, plane="in", **wanted)
        values = np.unique(rows[key])
        curves = [select(rows, **{key: value}) for value in values]
        pairs = [(at(curve, 80.0), at(curve, curve["incidence"][0])) for curve in curves]
        ratios = np.array([far[0] / near[0] for far, near in pairs])
        errors = ratios * np.array([far[1] / far[0] + near[1] / near[0] for far, near in pairs])
        margins.append(steps(ratios, errors).min())
        parts.append(f"{READINGS[reading]} {listed(ratios)}")
    margin = least(margins)
    return Verdict(margin > MARGIN, f"f(80) over f(θi) at {listed(values)}: {'; '.join(parts)}; every step rises "
                   f"by at least {margin:.0f} standard errors")


def more_pronounced_with_wind(tables: Tables) -> Verdict:
    """At 30 degrees of incidence."""
    return more_pronounced(tables, "friction_velocity", incidence=30.0)


def more_pronounced_with_incidence(tables: Tables) -> Verdict:
    """At w* = 56 cm/s."""
    return more_pronounced(tables, "incidence", friction_velocity=STORM)


def grazing_peak_from_45(tables: Tables) -> Verdict:
    """The corrected reading at 45 and 60 degrees of incidence: where the curve is highest."""
    parts, holds = [], True
    rows = select(tables["storm"], readings="corrected", friction_velocity=STORM, plane="in")
    for incidence in (45.0, 60.0):
        curve = select(rows, incidence=incidence)
        top, (before, error), (after, error_after) = peak(curve), at(curve, 75.0), at(curve, 87.5)
        margin = least([sigmas(top.value - before, top.error + error),
                        sigmas(top.value - after, top.error + error_after)])
        holds &= top.angle == 82.5 and margin > MARGIN
        parts.append(f"θi = {incidence:g}: {top.value:.3f} 1/sr at {top.angle:g} degrees, above 75 and 87.5 "
                     f"degrees by {margin:.0f} standard errors")
    return Verdict(bool(holds), "; ".join(parts))


# ---- Figure 10: beam diameter

def collect_footprints(command: Command, instances: int) -> Tables:
    """Steps of 5 cm."""
    return {"diameters": sweep(command, ({"footprint": d / 100} for d in range(5, 31, 5)), instances)}


def draw_footprints(tables: Tables, page: Canvas) -> None:
    """All six."""
    plot.family(page, tables["diameters"], "footprint", "D, m")


def slight_increase_with_diameter(tables: Tables) -> Verdict:
    """Last maximum over first."""
    diameters, tops = peaks(tables["diameters"], "footprint")
    first, last = tops[0], tops[-1]
    growth, error = last.value / first.value - 1, last.error / last.value + first.error / first.value
    margin = least([sigmas(growth, error), sigmas(0.25 - growth, error)])
    return Verdict(margin > MARGIN, f"maxima {listed([t.value for t in tops])} 1/sr at D = {listed(diameters)} "
                   f"m: {100 * growth:+.1f} ± {100 * error:.1f} %, above 0 and below 25 % by at least "
                   f"{margin:.0f} standard errors")


def no_other_trend_with_diameter(tables: Tables) -> Verdict:
    """Widths at half maximum and the peak's place."""
    parts, holds = [], True
    for plane, name in (("in", "in-plane"), ("out", "out-of-plane")):
        curves = by_diameter(tables, plane)
        widths, errors = np.array([full_width(curve) for curve in curves]).T
        change, error = widths[-1] / widths[0] - 1, errors[-1] / widths[-1] + errors[0] / widths[0]
        margin = sigmas(0.25 - abs(change), error)
        where = [peak(curve).angle for curve in curves]
        holds &= margin > MARGIN and np.ptp(where) <= 2.5
        parts.append(f"{name} widths at half maximum {listed(widths)} degrees, "
                     f"{100 * change:+.1f} ± {100 * error:.1f} %, below 25 % by {margin:.0f} standard errors, "
                     f"peaks at {listed(where)}")
    return Verdict(bool(holds), "; ".join(parts))


def narrows_with_diameter(tables: Tables) -> Verdict:
    """In-plane, f 20 degrees beyond specular over the maximum: first diameter against last."""
    shares = []
    for curve in by_diameter(tables, "in"):
        (value, error), top = at(curve, 50.0), peak(curve)
        shares.append((value / top.value, error / top.value + value * top.error / top.value**2))
    (first, first_error), (last, last_error) = shares[0], shares[-1]
    margin = sigmas(first - last, first_error + last_error)
    return Verdict(margin > MARGIN, f"f(50) over the maximum: {listed([share for share, _ in shares])}; falls by "
                   f"{margin:.0f} standard errors")


def by_diameter(tables: Tables, plane: str) -> list[Table]:
    """The curves from the smallest diameter to the largest."""
    rows = select(tables["diameters"], plane=plane)
    return [select(rows, footprint=diameter) for diameter in np.unique(rows["footprint"])]


# ---- Figure 11: incidence

def collect_incidences(command: Command, instances: int) -> Tables:
    """0 to 60 degrees."""
    return {"incidences": sweep(command, ({"incidence": i} for i in (0.0, 15.0, 30.0, 45.0, 60.0)), instances)}


def draw_incidences(tables: Tables, page: Canvas) -> None:
    """Logarithmic: the last maximum is ten times the others."""
    for axes in plot.family(page, tables["incidences"], "incidence", "θi, degrees", wide=True).values():
        axes.set_yscale("log")
        axes.set_ylim(1e-4, 3)


def increases_with_incidence(tables: Tables) -> Verdict:
    """Every step raises the maximum."""
    incidences, tops = peaks(tables["incidences"], "incidence")
    values, errors = np.array([t.value for t in tops]), np.array([t.error for t in tops])
    margin = steps(values, errors).min()
    return Verdict(margin > MARGIN, f"maxima {listed(values)} 1/sr at θi = {listed(incidences)}, at θr = "
                   f"{listed([t.angle for t in tops])}; every step rises by at least {margin:.0f} standard "
                   "errors")


def steep_at_large_incidence(tables: Tables) -> Verdict:
    """The factors from one incidence to the next, which grow."""
    _, tops = peaks(tables["incidences"], "incidence")
    values, errors = np.array([t.value for t in tops]), np.array([t.error / t.value for t in tops])
    factors = values[1:] / values[:-1]
    margin = steps(factors, factors * (errors[1:] + errors[:-1])).min()
    return Verdict(bool(margin > MARGIN and factors.min() > 1),
                   f"from one to the next by factors of {listed(factors)}; each larger than the one before by at "
                   f"least {margin:.0f} standard errors")


# ---- Figure 12: wind direction

AZIMUTHS = [0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 90.0]
SEEDS = range(8)
REPORT_SEEDS = range(20)


def collect_azimuths(command: Command, instances: int) -> Tables:
    """Eight batches with seeds of their own, the report's 50 instances for 20 seeds, and infinitely many."""
    many = [{"wind_direction": azimuth, "seed": seed} for azimuth in AZIMUTHS for seed in SEEDS]
    few = [{"wind_direction": azimuth, "seed": seed} for azimuth in AZIMUTHS for seed in REPORT_SEEDS]
    batches = stack(averages(command, case, instances // 4) for case in many)
    report = stack(averages(command, case, REPORT_INSTANCES, "drawn") for case in few)
    exact = stack(averages(command, {"wind_direction": azimuth, "statistics": "exact"}, 1, "drawn")
                  for azimuth in AZIMUTHS)
    return {"azimuths": stack(merged(batches, azimuth) for azimuth in AZIMUTHS),
            "fits": fits(batches), "fits-50": fits(report), "fits-exact": fits(exact)}


def merged(batches: Table, azimuth: float) -> Table:
    """The average over the batches of a wind direction, its error from their scatter."""
    rows = select(batches, wind_direction=azimuth)
    means = np.array([select(rows, seed=seed)["mean"] for seed in SEEDS])
    one = select(rows, seed=SEEDS[0])
    return {"wind_direction": one["wind_direction"], "plane": one["plane"], "angle": one["angle"],
            "instances": len(SEEDS) * one["instances"], "mean": means.mean(axis=0),
            "sem": means.std(axis=0, ddof=1) / np.sqrt(len(SEEDS))}


def fits(rows: Table) -> Table:
    """The Gaussian nearest to every out-of-plane curve: centre and 1/e half width in degrees."""
    out, found = select(rows, plane="out"), []
    for azimuth in AZIMUTHS:
        for seed in np.unique(rows["seed"]):
            curve = select(out, wind_direction=azimuth, seed=seed)
            found.append((azimuth, seed, *fit_bell(curve["angle"], curve["mean"])))
    names = ("wind_direction", "seed", "peak", "centre", "width")
    return {name: column(values) for name, values in zip(names, zip(*found, strict=True), strict=True)}


def draw_azimuths(tables: Tables, page: Canvas) -> None:
    """All directions."""
    plot.family(page, tables["azimuths"], "wind_direction", "φW, degrees")


def by_azimuth(fitted: Table, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Mean and standard error over the batches, by wind direction."""
    values = np.array([select(fitted, wind_direction=azimuth)[name] for azimuth in AZIMUTHS])
    return values.mean(axis=1), values.std(axis=1, ddof=1) / np.sqrt(values.shape[1])


def in_plane_dependence_is_slight(tables: Tables) -> Verdict:
    """The largest change of the in-plane curve between wind directions, over the peak: there is one, and it is small.

    Chance alone makes 2 to 3 % of it, being the range of seven curves and the largest over all angles.
    """
    rows = select(tables["azimuths"], plane="in")
    curves = [select(rows, wind_direction=azimuth) for azimuth in AZIMUTHS]
    means, tops = np.array([curve["mean"] for curve in curves]), np.array([peak(curve).value for curve in curves])
    change = np.ptp(means, axis=0)
    most = int(change.argmax())
    largest, error = change[most] / tops.max(), 2 * max(curve["sem"][most] for curve in curves) / tops.max()
    chance = curves[0]["sem"][most] * np.sqrt(curves[0]["instances"][most] / REPORT_INSTANCES) / tops.max()
    margin = least([sigmas(0.25 - largest, error), sigmas(largest - 0.05, error)])
    return Verdict(bool(margin > MARGIN), f"the maximum varies by {100 * np.ptp(tops) / tops.mean():.1f} %; the curve "
                   f"by at most {100 * largest:.1f} ± {100 * error:.1f} % of the maximum, at {IN_PLANE[most]:g} "
                   f"degrees, where it is {100 * change[most] / means[:, most].max():.0f} % of the curve and "
                   f"the standard error of N = 50 is {100 * chance:.0f} %; above 5 % and below 25 % by at least "
                   f"{margin:.0f} standard errors")


#: The least shift of the fitted centre that counts as one and the largest that is slight, degrees.
SHIFTS = 0.05, 1.0


def out_of_plane_shifts_slightly(tables: Tables) -> Verdict:
    """The fitted centre leaves the specular direction downwind with every step of the wind to 45 degrees.

    Its size is that of infinitely many instances; the drawn ones, whose errors are as large as itself, have to agree.
    """
    exact, (drawn, error) = tables["fits-exact"]["centre"], by_azimuth(tables["fits"], "centre")
    turned = exact[:AZIMUTHS.index(45.0) + 1]
    off = np.max([abs(sigmas(d - c, e)) for d, c, e in zip(drawn, exact, error, strict=True)])
    holds = np.diff(turned).max() < 0 and SHIFTS[0] < turned[0] - turned[-1] < SHIFTS[1] and off < MARGIN
    return Verdict(bool(holds), f"fitted centre {listed(exact, 2)} degrees at φW = {listed(AZIMUTHS)}, negative downwind; "
                   f"drawn {listed(drawn, 2)}, each ± {error.max():.2f}, at most {off:.1f} standard errors from it")


def out_of_plane_shift_returns(tables: Tables) -> Verdict:
    """Across the wind the fitted centre is no further from the specular direction than what counts as a shift."""
    exact = tables["fits-exact"]["centre"]
    return Verdict(bool(abs(exact[-1]) < SHIFTS[0] < abs(exact).max()),
                   f"largest at φW = {AZIMUTHS[abs(exact).argmax()]:g}: {exact[abs(exact).argmax()]:+.3f} degrees; at "
                   f"{AZIMUTHS[-1]:g}: {exact[-1]:+.3f}")


def fifty_instances_shift_by_chance(tables: Tables) -> Verdict:
    """The centre's travel over the wind directions with 50 instances, against that of the mean."""
    centres = np.array([select(tables["fits-50"], wind_direction=azimuth)["centre"] for azimuth in AZIMUTHS])
    travel = np.ptp(centres, axis=0)
    mean = np.ptp(tables["fits-exact"]["centre"])
    margin = sigmas(travel.mean() - mean, travel.std(ddof=1) / np.sqrt(len(travel)))
    return Verdict(margin > MARGIN, f"with N = 50 the centre travels {travel.mean():.2f} degrees in the mean "
                   f"over {len(travel)} seeds ({travel.min():.2f} to {travel.max():.2f}), with infinitely many "
                   f"{mean:.2f}; more by {margin:.0f} standard errors")


def out_of_plane_widens(tables: Tables) -> Verdict:
    """The fitted 1/e half width from along the wind to across it."""
    width, error = by_azimuth(tables["fits"], "width")
    margin = sigmas(width[-1] - width[0], error[-1] + error[0])
    return Verdict(margin > MARGIN, f"1/e half width {listed(width)} degrees at φW = {listed(AZIMUTHS)}: "
                   f"{100 * (width[-1] / width[0] - 1):+.0f} %, {margin:.0f} standard errors")


FIGURES = [
    Figure(
        "figure-08", "Figure 8: wind friction velocity",
        BASE_TEXT, collect_winds, draw_winds,
        [Claim("The maximum BRDF decreases rapidly with increasing wind velocity.", decreases_with_wind),
         Claim("This decrease is inversely proportional to the wind friction speed [here: a fitted exponent "
               "within 0.15 of -1]", is_inverse_to_wind),
         Claim("and is greater than an order of magnitude over the range.", falls_by_more_than_ten)]),
    Figure(
        "figure-09", "Figure 9: the secondary peak at the maximum wind",
        "w* = 56 cm/s, otherwise the base scenario, with the corrected equations and with Eqs. 71-73 as printed.",
        collect_storm, draw_storm,
        [Claim("A “secondary” BRDF peak occurs at angles of reflection near 80° [Eqs. 71-73 as printed].",
               secondary_peak_as_printed),
         Claim("A “secondary” BRDF peak occurs at angles of reflection near 80° [corrected].",
               secondary_peak_corrected, expected=False),
         Claim("Corrected, at θi = 30°, there is a shoulder instead.", shoulder_corrected, own=True),
         Claim("Corrected, from θi = 45° the curve's maximum itself lies at 82.5°.", grazing_peak_from_45,
               own=True),
         Claim("Increasing wind friction velocity [...] makes these “secondary” peaks more pronounced [here: f "
               "at 80° over f at the specular angle; w* = 24, 40, 56].", more_pronounced_with_wind),
         Claim("Increasing [...] angle of incidence makes these “secondary” peaks more pronounced [the same "
               "for θi = 15, 30, 45, 60].", more_pronounced_with_incidence)]),
    Figure(
        "figure-10", "Figure 10: laser beam diameter",
        BASE_TEXT, collect_footprints, draw_footprints,
        [Claim("There are no definite trends with beam diameter [here: the width changes by less than 25 %, "
               "the place by at most 2.5 degrees],", no_other_trend_with_diameter),
         Claim("other than a possible slight increase in maximum BRDF with increasing beam diameter.",
               slight_increase_with_diameter),
         Claim("In-plane the curve narrows with the diameter.", narrows_with_diameter, own=True)]),
    Figure(
        "figure-11", "Figure 11: angle of incidence",
        BASE_TEXT, collect_incidences, draw_incidences,
        [Claim("the maximum BRDF increases with increasing angle of incidence,", increases_with_incidence),
         Claim("with the increase being particularly steep at large angles of incidence.",
               steep_at_large_incidence)]),
    Figure(
        "figure-12", "Figure 12: wind direction",
        BASE_TEXT + " The wind turns from 0 to 90°.", collect_azimuths, draw_azimuths,
        [Claim("Dependence of the in-plane BRDF is slight [here: 5 to 25 % of the maximum],",
               in_plane_dependence_is_slight),
         Claim("while the out-of-plane BRDF shifts slightly with increasing angle [here: downwind with every step to "
               "45 degrees, by 0.05 to 1 degree in all].", out_of_plane_shifts_slightly),
         Claim("From 60 degrees on the shift goes back; across the wind it is below 0.05 degrees.",
               out_of_plane_shift_returns, own=True),
         Claim("With N = 50 chance moves the peak further than the wind direction does.",
               fifty_instances_shift_by_chance, own=True),
         Claim("Across the wind the out-of-plane curve is wider than along it.", out_of_plane_widens, own=True)]),
]
