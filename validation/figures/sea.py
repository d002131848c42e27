"""The figures about the sea: spectra, whitecaps, heights and, our own, the variance of slopes."""

import numpy as np
from matplotlib.figure import Figure as Canvas

from validation.figures import plot
from validation.figures.claim import MARGIN, Claim, Figure, Tables, Verdict, least, listed, sigmas
from validation.figures.data import BASE, WINDS, Case, Command, Table, in_plane, select, stack
from validation.support import look

GRAVITY = 9.81  # m/s^2


# ---- Figure 2: spectra

def collect_spectra(command: Command, _: int) -> Tables:
    """S(k) for the winds of section 3."""
    return {"spectra": stack(spectrum(command, wind) for wind in WINDS)}


def spectrum(command: Command, wind: float) -> Table:
    """S(k) of one wind over 400 wave numbers from k_min to k2."""
    found = command.run("spectrum", "--points", "400", parameters={"friction_velocity": wind})
    return {"friction_velocity": np.full(len(found["k_rad_cm"]), wind)} | found


def draw_spectra(tables: Tables, page: Canvas) -> None:
    """S over k, both logarithmic."""
    axes = page.subplots()
    for wind, colour in zip(WINDS, plot.shades(len(WINDS)), strict=True):
        rows = select(tables["spectra"], friction_velocity=wind)
        axes.loglog(rows["k_rad_cm"], rows["S_cm3"], color=colour, label=f"{wind:g}")
        axes.plot(rows["k0_rad_cm"][0], np.interp(rows["k0_rad_cm"][0], rows["k_rad_cm"], rows["S_cm3"]),
                  "o", color=colour, markersize=4)
    axes.set(xlabel="wave number k, rad/cm", ylabel="wave energy spectrum S(k), cm³", ylim=(1e-6, None))
    look.legend(page, axes, "w*, cm/s")


def energy_follows_the_wind(tables: Tables) -> Verdict:
    """Height variance and dominant wavelength rise with every step of the wind."""
    deviations, lengths = [], []
    for wind in WINDS:
        rows = select(tables["spectra"], friction_velocity=wind)
        deviations.append(0.01 * np.sqrt(np.trapezoid(rows["S_cm3"], rows["k_rad_cm"])))
        lengths.append(rows["wavelength_m"][rows["S_cm3"].argmax()])
    rising = np.diff(deviations).min() > 0 and np.diff(lengths).min() > 0
    return Verdict(bool(rising), f"for w* = {listed(WINDS)}: standard deviation of the height "
                   f"{listed(deviations)} m, wavelength at the peak {listed(lengths)} m; both rise at every "
                   "step")


def surface_tension_is_negligible(tables: Tables) -> Verdict:
    """How far omega^2 is from g k for waves longer than a metre (deep water)."""
    rows = tables["spectra"]
    long = rows["wavelength_m"] > 1
    excess = rows["omega_rad_s"][long] ** 2 / (100 * GRAVITY * rows["k_rad_cm"][long]) - 1
    return Verdict(bool(excess.max() < 0.01), f"omega² exceeds g k by at most {100 * excess.max():.2g} %")


# ---- Figure 3: whitecaps

WHITECAP_FOOTPRINT = 0.10
#: Beams of one observer are cheap, whitecaps rare: batches, each of so many times the instances of an average.
BATCHES, BATCH_SIZE = 8, 6
SHARP_SEAS = 500


def collect_whitecaps(command: Command, instances: int) -> Tables:
    """The fraction of Eq. 51, by Eqs. 53-54 for M = 5 and 20, and by the sharp limit of Eq. 52."""
    simulated = [fraction(command, wind, components, instances) for components in (5, 20) for wind in WINDS[3:]]
    sharp = [sharp_fraction(command, wind) for wind in (40.0, 56.0)]
    winds = np.arange(6.0, 60.5, 1.0)
    return {"whitecaps": stack(simulated), "sharp": stack(sharp),
            "eq-51": {"friction_velocity": winds, "eq_51": np.array([eq_51(command, wind) for wind in winds])}}


def fraction(command: Command, wind: float, components: int, instances: int) -> Table:
    """The mean probability of Eq. 53 under a vertical beam; its error from batches with seeds of their own."""
    case = {"friction_velocity": wind, "components": components, "footprint": WHITECAP_FOOTPRINT,
            "incidence": 0.0}
    overhead, size = in_plane(np.array([0.0])), BATCH_SIZE * instances
    found = [command.scenario(case | {"seed": seed}, overhead, size)["whitecap"][0] for seed in range(BATCHES)]
    row = {"friction_velocity": wind, "components": components, "instances": BATCHES * size,
           "eq_51": eq_51(command, wind), "simulated": np.mean(found),
           "error": np.std(found, ddof=1) / np.sqrt(BATCHES)}
    return {name: np.array([float(value)]) for name, value in row.items()}


def eq_51(command: Command, wind: float) -> float:
    """The whitecap fraction of a wind."""
    return float(command.run("wind", parameters={"friction_velocity": wind})["whitecap_fraction"][0])


def sharp_fraction(command: Command, wind: float) -> Table:
    """The share of points with an acceleration below -0.39 g, over drawn seas of 60 points each."""
    parameters = {"friction_velocity": wind, "components": 5, "footprint": WHITECAP_FOOTPRINT}
    points = line_of_points(np.arange(60) * 3.7)
    shares = [np.mean(surface(command, points, parameters, number)["acceleration"] <= -0.39 * GRAVITY)
              for number in range(SHARP_SEAS)]
    row = {"friction_velocity": wind, "eq_51": eq_51(command, wind), "sharp": np.mean(shares),
           "error": np.std(shares) / np.sqrt(len(shares))}
    return {name: np.array([float(value)]) for name, value in row.items()}


def surface(command: Command, points: Table, parameters: Case, instance: int) -> Table:
    """The drawn sea at points."""
    return command.run("surface", "--points", "-", "--instance", str(instance), parameters=parameters,
                       text=csv_text(points))


def csv_text(table: Table) -> str:
    """The table as the command reads it."""
    rows = zip(*(values.tolist() for values in table.values()), strict=True)
    return "\n".join([",".join(table), *(",".join(map(repr, row)) for row in rows)]) + "\n"


def line_of_points(distances: np.ndarray, time: float = 0.0) -> Table:
    """Points along +x at a time (m, s)."""
    return {"x": distances, "y": np.zeros_like(distances), "time": np.full_like(distances, time)}


def draw_whitecaps(tables: Tables, page: Canvas) -> None:
    """Eq. 51 as a line, simulations as marks, and their ratio."""
    left, right = page.subplots(1, 2)
    left.semilogy(tables["eq-51"]["friction_velocity"], tables["eq-51"]["eq_51"], color="black", label="Eq. 51")
    series = [(select(tables["whitecaps"], components=m), "simulated", mark, f"Eqs. 52-54, M = {m}")
              for m, mark in ((5, "o"), (20, "s"))]
    for rows, name, mark, label in [*series, (tables["sharp"], "sharp", "x", "below -0.39 g, M = 5")]:
        style = {"fmt": mark, "fillstyle": "none", "label": label}
        left.errorbar(rows["friction_velocity"], rows[name], rows["error"], **style)
        right.errorbar(rows["friction_velocity"], rows[name] / rows["eq_51"], rows["error"] / rows["eq_51"],
                       **style)
    right.axhspan(0.8, 1.2, color="0.9", linewidth=0)
    left.set(title="(a)", xlabel="friction velocity w*, cm/s", ylabel="whitecap fraction", ylim=(1e-5, 0.1))
    right.set(title="(b) over Eq. 51; the band is 20 %", xlabel="friction velocity w*, cm/s", ylabel="ratio",
              ylim=(0, None))
    look.legend(page, left)


def ratios(tables: Tables, components: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Winds, simulation over Eq. 51 and its standard error."""
    rows = select(tables["whitecaps"], components=components)
    return rows["friction_velocity"], rows["simulated"] / rows["eq_51"], rows["error"] / rows["eq_51"]


def agrees_with_eq_51(tables: Tables, components: float, from_wind: float) -> Verdict:
    """Within 20 % of Eq. 51 from a wind on, by the margin."""
    winds, ratio, error = ratios(tables, components)
    margin = least(sigmas(0.2 - abs(r - 1), e)
                   for w, r, e in zip(winds, ratio, error, strict=True) if w >= from_wind)
    parts = ", ".join(f"{r:.3f} ± {e:.3f}" for r, e in zip(ratio, error, strict=True))
    return Verdict(margin > MARGIN, f"M = {components:g}, D = {WHITECAP_FOOTPRINT} m: simulation over Eq. 51 is "
                   f"{parts} at w* = {listed(winds)}; from w* = {from_wind:g} within 20 % by at least "
                   f"{margin:.1f} standard errors")


def agrees_for_five_waves(tables: Tables) -> Verdict:
    """M = 5."""
    return agrees_with_eq_51(tables, 5.0, from_wind=24.0)


def agrees_for_twenty_waves(tables: Tables) -> Verdict:
    """M = 20, at the two strongest winds only."""
    return agrees_with_eq_51(tables, 20.0, from_wind=40.0)


def exceeds_eq_51_in_light_winds(tables: Tables) -> Verdict:
    """w* = 16 for both M, and w* = 24 for M = 20."""
    margins, parts = [], []
    for components, winds in ((5.0, [16.0]), (20.0, [16.0, 24.0])):
        for wind, ratio, error in zip(*ratios(tables, components), strict=True):
            if wind in winds:
                margins.append(sigmas(ratio - 1, error))
                parts.append(f"{ratio:.2f} ± {error:.2f} (w* = {wind:g}, M = {components:g})")
    return Verdict(least(margins) > MARGIN, f"{', '.join(parts)}; above 1 by at least {least(margins):.0f} standard "
                   "errors")


def sharp_limit_is_lower(tables: Tables) -> Verdict:
    """Without feathering there is less foam than Eq. 51 says."""
    rows = tables["sharp"]
    margins = [sigmas(difference, error)
               for difference, error in zip(rows["eq_51"] - rows["sharp"], rows["error"], strict=True)]
    return Verdict(least(margins) > MARGIN, "share below -0.39 g over Eq. 51: "
                   f"{listed(rows['sharp'] / rows['eq_51'], 2)} at w* = {listed(rows['friction_velocity'])}; "
                   f"lower by at least {least(margins):.0f} standard errors")


# ---- Figure 5: heights

SNAPSHOTS = [0.0, 0.5, 1.0]
SEA: Case = {name: BASE[name]
             for name in ("friction_velocity", "wind_direction", "footprint", "components", "seed")}


def collect_heights(command: Command, _: int) -> Tables:
    """The first drawn sea of the base scenario: along x at three times, and at the origin over time."""
    distances, times = np.arange(0, 200, 0.05), np.arange(0, 200, 0.04)
    along = stack(surface(command, line_of_points(distances, time), SEA, 0) for time in SNAPSHOTS)
    still = {"x": np.zeros_like(times), "y": np.zeros_like(times), "time": times}
    columns = ("time", "x", "y", "height")
    return {"distance": {name: along[name] for name in columns},
            "time": {name: values for name, values in surface(command, still, SEA, 0).items() if name in columns}}


def draw_heights(tables: Tables, page: Canvas) -> None:
    """The first 20 m and 30 s."""
    left, right = page.subplots(1, 2, sharey=True)
    for time, colour in zip(SNAPSHOTS, plot.shades(len(SNAPSHOTS)), strict=True):
        rows = select(tables["distance"], time=time)
        left.plot(rows["x"], 100 * rows["height"], color=colour, label=f"{time:g}")
    right.plot(tables["time"]["time"], 100 * tables["time"]["height"], color="black")
    left.set(title="(a) over distance", xlabel="distance x, m", ylabel="height, cm", xlim=(0, 20))
    right.set(title="(b) at x = 0", xlabel="time, s", xlim=(0, 30))
    look.legend(page, left, "time, s")


def recurrence(heights: np.ndarray, step: float) -> tuple[float, float, float]:
    """Mean distance of upward crossings, its relative spread, and the highest return of the autocorrelation."""
    up = np.flatnonzero((heights[:-1] < 0) & (heights[1:] >= 0))
    gaps = step * np.diff(up)
    centred = heights - heights.mean()
    count = len(centred) // 4
    lags = np.array([np.corrcoef(centred[:-lag], centred[lag:])[0, 1] for lag in range(1, count)])
    first_trough = int(np.flatnonzero(np.diff(lags) > 0)[0])
    return gaps.mean(), gaps.std() / gaps.mean(), lags[first_trough:].max()


def semi_periodic(tables: Tables) -> Verdict:
    """Heights return nearly, not exactly: high autocorrelation below 1, crossings at uneven distances."""
    x = select(tables["distance"], time=0.0)
    parts, holds = [], True
    for rows, key, unit in ((x, "x", "m"), (tables["time"], "time", "s")):
        gap, spread, back = recurrence(rows["height"], rows[key][1] - rows[key][0])
        holds &= 0.4 < back < 0.99 and spread > 0.05
        parts.append(f"upward crossings every {gap:.2f} {unit}, uneven by {100 * spread:.0f} %; the "
                     f"autocorrelation comes back to {back:.2f}")
    return Verdict(bool(holds), "distance: {}; time: {} (an exact period would be 0 % and 1)".format(*parts))


# ---- Our own: slope variance

DIAMETERS = [0.02, 0.03, 0.05, 0.075, 0.10, 0.15, 0.20, 0.25, 0.30, 0.45, 0.70, 1.0]


def collect_slopes(command: Command, _: int) -> Tables:
    """Resolved and facet slope variance for every wind and footprint, beside Cox and Munk's."""
    return {"slopes": stack(slopes(command, wind) for wind in WINDS)}


def slopes(command: Command, wind: float) -> Table:
    """One wind: the integral of k^2 S(k) from k_min to k_max by the trapezium rule in ln k, and the facets'."""
    parameters = {"friction_velocity": wind}
    fine = command.run("spectrum", "--points", "4000", parameters=parameters)
    k, density = fine["k_rad_cm"], fine["k_rad_cm"] ** 3 * fine["S_cm3"]
    pieces = np.diff(np.log(k)) * (density[1:] + density[:-1]) / 2
    total = np.concatenate([[0.0], np.cumsum(pieces)])
    ends = [command.run("spectrum", "--points", "2", parameters=parameters | {"footprint": diameter})
            for diameter in DIAMETERS]
    resolved = np.interp([end["kmax_rad_cm"][0] for end in ends], k, total)
    facets = [facet_variance(command, wind, str(diameter)) for diameter in DIAMETERS]
    cox_munk = facet_variance(command, wind, "inf")
    return {"friction_velocity": np.full(len(DIAMETERS), wind), "footprint": np.array(DIAMETERS),
            "resolved": resolved, "facets": np.array(facets), "cox_munk": np.full(len(DIAMETERS), cox_munk),
            "ratio": (resolved + facets) / cox_munk}


def facet_variance(command: Command, wind: float, footprint: str) -> float:
    """Upwind plus crosswind slope variance of the facets."""
    row = command.run("wind", parameters={"friction_velocity": wind, "footprint": footprint})
    return float(row["sigma_u2"][0] + row["sigma_c2"][0])


def draw_slopes(tables: Tables, page: Canvas) -> None:
    """The parts at one wind, and the ratio to Cox and Munk at all."""
    left, right = page.subplots(1, 2)
    one = select(tables["slopes"], friction_velocity=24.0)
    left.semilogx(one["footprint"], one["resolved"] + one["facets"], color="black", label="both")
    left.semilogx(one["footprint"], one["resolved"], "--", color="tab:blue", label="waves longer than 2 D")
    left.semilogx(one["footprint"], one["facets"], "-.", color="tab:orange", label="facets")
    left.semilogx(one["footprint"], one["cox_munk"], ":", color="tab:red", label="Cox and Munk, D = inf")
    left.set(title="(a) w* = 24 cm/s", xlabel="beam diameter D, m", ylabel="slope variance", ylim=(0, 0.065))
    left.legend(loc="upper left", ncols=2)
    right.axhspan(1.0, 1.25, color="0.9", linewidth=0)
    for wind, colour in zip(WINDS, plot.shades(len(WINDS)), strict=True):
        rows = select(tables["slopes"], friction_velocity=wind)
        right.semilogx(rows["footprint"], rows["ratio"], color=colour, label=f"{wind:g}")
    right.set(title="(b) waves and facets over Cox and Munk", xlabel="beam diameter D, m", ylabel="ratio")
    look.legend(page, right, "w*, cm/s")


def usual(table: Table) -> Table:
    """The rows of the report's beam diameters, 0.05 to 0.30 m."""
    keep = (table["footprint"] >= 0.05) & (table["footprint"] <= 0.30)
    return {name: values[keep] for name, values in table.items()}


def follows_cox_munk(tables: Tables) -> Verdict:
    """Between 1 and 1.25 of Cox and Munk's total for the usual D and w* from 16 cm/s."""
    rows = tables["slopes"]
    strong = {name: values[rows["friction_velocity"] >= 16] for name, values in rows.items()}
    ratio = usual(strong)["ratio"]
    inside = [d for d in DIAMETERS if np.all(abs(select(strong, footprint=d)["ratio"] - 1.125) <= 0.125)]
    return Verdict(bool(ratio.min() >= 1 and ratio.max() <= 1.25),
                   f"ratio {ratio.min():.3f} to {ratio.max():.3f} over D = 0.05 to 0.30 m; of the D computed (0.02 to "
                   f"1 m) inside for {listed(inside)} m")


def nearly_free_of_d(tables: Tables) -> Verdict:
    """The total's change over the usual D, beside that of the facets alone."""
    totals, facets = [], []
    for wind in WINDS[3:]:
        one = usual(select(tables["slopes"], friction_velocity=wind))
        totals.append(100 * (one["ratio"].max() / one["ratio"].min() - 1))
        facets.append(100 * (one["facets"].max() / one["facets"].min() - 1))
    return Verdict(bool(np.max(totals) < 20), f"over D = 0.05 to 0.30 m at w* = {listed(WINDS[3:])} the sum changes by "
                   f"{listed(totals, 2)} %, the facets alone by {listed(facets, 2)} %")


def light_winds_are_off(tables: Tables) -> Verdict:
    """The range of the ratio below w* = 16 cm/s."""
    rows = usual(tables["slopes"])
    ratio = rows["ratio"][rows["friction_velocity"] < 16]
    return Verdict(bool(ratio.min() < 1), f"ratio {ratio.min():.2f} to {ratio.max():.2f} at w* = {listed(WINDS[:3])} "
                   "over D = 0.05 to 0.30 m")


FIGURES = [
    Figure(
        "figure-02", "Figure 2: wave energy spectra",
        "S(k) of Eqs. 5-17 for the friction velocities of section 3, from k_min (Eq. 21) to k2; dots mark k0.",
        collect_spectra, draw_spectra,
        [Claim("The wave energy depends on the wave number and wind speed.", energy_follows_the_wind),
         Claim("Surface tension effects are negligible for wavelengths longer than a meter.",
               surface_tension_is_negligible)]),
    Figure(
        "figure-03", "Figure 3: whitecap fraction",
        "Eq. 51 and the mean probability of Eqs. 53-54 under a vertical beam, D = 0.10 m; bars are standard "
        "errors. Crosses: the share of the water that accelerates downwards by more than 0.39 g, without the "
        "feathering of Eq. 53.",
        collect_whitecaps, draw_whitecaps,
        [Claim("Linear fits of the fraction as a function of wind speed determined the value of α at which the "
               "fit equals the fraction given by Eq. (51) [here: within 20 %, w* = 24 to 56, M = 5].",
               agrees_for_five_waves),
         Claim("The same for M = 20 at w* = 40 and 56.", agrees_for_twenty_waves, own=True),
         Claim("At w* = 16, and for M = 20 at 24, the simulation gives more than Eq. 51.",
               exceeds_eq_51_in_light_winds, own=True),
         Claim("Simulations of whitecap formation as a function of wind speed using Eq. (52) yielded lower "
               "fractions than those given by Eq. (51).", sharp_limit_is_lower)]),
    Figure(
        "figure-05", "Figure 5: wave heights",
        "The first drawn sea of the base scenario, w* = 8 cm/s, D = 0.15 m, M = 5 waves.",
        collect_heights, draw_heights,
        [Claim("The waves are semi-periodic with distance and time, as expected.", semi_periodic)]),
    Figure(
        "slope-variance", "Slope variance: against the beam diameter (not in the report)",
        "Waves longer than 2 D are drawn, shorter ones are facets. Their slope variances, the integral of k² "
        "S(k) from k_min to k_max and σu² + σc² of Eqs. 74-75, should add up to Cox and Munk's total whatever "
        "D is. The band is 1 to 1.25.",
        collect_slopes, draw_slopes,
        [Claim("For w* from 16 cm/s the sum is 1 to 1.25 of Cox and Munk's.", follows_cox_munk, own=True),
         Claim("The sum is nearly free of D: it changes by less than 20 %.", nearly_free_of_d, own=True),
         Claim("Below w* = 16 cm/s waves and facets together fall short of Cox and Munk somewhere.",
               light_winds_are_off, own=True)]),
]
