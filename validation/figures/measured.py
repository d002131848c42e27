"""Our own figures: measured slope variances by wind and by footprint beside those of the model."""

import numpy as np
from matplotlib.figure import Figure as Canvas

from validation.figures.claim import Claim, Figure, Tables, Verdict
from validation.figures.data import Case, Command, Table, select, stack
from validation.support import look

SPEEDS = np.array([0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0, 12.0, 14.0, 15.0])  # m/s at 10 m
FOOTPRINT = 0.15  # m
#: The part of the variance along the wind that Eqs. 18-20 give, the mean of cos^2.
ALONG = 0.7
AXES = {"u": "upwind", "c": "crosswind"}
#: Pelevin and Burtsev's measurements of 1957, of winds from 4 to 7 m/s.
PELEVIN_BURTSEV = {"u": (-0.0033, 0.00248), "c": (0.00196, 0.00196)}


def collect(command: Command, _: int) -> Tables:
    """Upwind and crosswind variances of all waves."""
    all_waves = {"cox_munk": {}, "breon_henriot": {"slopes": "breon_henriot"}}
    rows = [table(name, SPEEDS, [facets(command, speed, case | {"footprint": "inf"}) for speed in SPEEDS])
            for name, case in all_waves.items()]
    usual = SPEEDS[(SPEEDS >= 4) & (SPEEDS <= 7)]
    rows.append(table("pelevin_burtsev", usual, [[a + b * speed for a, b in PELEVIN_BURTSEV.values()] for speed in usual]))
    rows += [table(f"model_{budget}", SPEEDS, [model(command, speed, budget) for speed in SPEEDS])
             for budget in ("report", "closed")]
    return {"slopes": stack(rows)}


def table(name: str, speeds: np.ndarray, variances: list[list[float]]) -> Table:
    """A curve of both axes."""
    upwind, crosswind = np.array(variances).T
    return {"curve": np.full(len(speeds), name), "wind_speed": speeds, "u": upwind, "c": crosswind}


def facets(command: Command, speed: float, case: Case) -> list[float]:
    """Slope variances of the facets under a wind, upwind and crosswind."""
    return facets_at(command, {"wind_speed": speed} | case)


def facets_at(command: Command, case: Case) -> list[float]:
    """Slope variances of the facets, upwind and crosswind."""
    row = command.run("wind", parameters=case)
    return [float(row[name][0]) for name in ("sigma_u2", "sigma_c2")]


def model(command: Command, speed: float, budget: str) -> list[float]:
    """Drawn waves, the integral of k^2 S by the trapezium rule in ln k, and facets."""
    case = {"wind_speed": speed, "slope_budget": budget, "footprint": FOOTPRINT}
    rows = command.run("spectrum", "--points", "4000", parameters=case)
    k, k_max = rows["k_rad_cm"], rows["kmax_rad_cm"][0]
    density = k**3 * rows["S_cm3"]
    parts = np.diff(np.log(k)) * (density[1:] + density[:-1]) / 2
    drawn = np.interp(k_max, k, np.concatenate([[0.0], np.cumsum(parts)])) if k_max == k_max else 0.0
    return [share * drawn + rest for share, rest in zip((ALONG, 1 - ALONG), facets(command, speed, case), strict=True)]


STYLES = {"cox_munk": ("Cox and Munk 1954", "-", "black"), "breon_henriot": ("Breon and Henriot 2006", "--", "tab:green"),
          "pelevin_burtsev": ("Pelevin and Burtsev 1957", "-.", "tab:purple"),
          "model_report": (f"drawn and facets, D = {FOOTPRINT} m", ":", "tab:red"),
          "model_closed": ("the same, closed budget", "o", "tab:blue")}


def draw(tables: Tables, page: Canvas) -> None:
    """A panel for each axis."""
    for axes, (axis, name) in zip(page.subplots(1, 2), AXES.items(), strict=True):
        for curve, (label, style, colour) in STYLES.items():
            rows = select(tables["slopes"], curve=curve)
            axes.plot(rows["wind_speed"], rows[axis], style, color=colour, label=label, markersize=4)
        axes.set(title=name, xlabel="wind speed at 10 m, m/s", ylabel="slope variance")
    look.legend(page, axes)


def ratios(tables: Tables, curve: str, lowest: float = 0.0) -> np.ndarray:
    """A curve over Cox and Munk's at the same winds, from a wind on, by axis."""
    rows, munk = select(tables["slopes"], curve=curve), select(tables["slopes"], curve="cox_munk")
    same = np.isin(munk["wind_speed"], rows["wind_speed"])
    return np.array([(rows[axis] / munk[axis][same])[rows["wind_speed"] >= lowest] for axis in AXES])


def shown(values: np.ndarray) -> str:
    """The range of each axis."""
    return ", ".join(f"{name} {row.min():.2f} to {row.max():.2f}" for name, row in zip(AXES.values(), values, strict=True))


def measurements_agree(tables: Tables) -> Verdict:
    """Breon and Henriot over Cox and Munk from 4 m/s."""
    found = ratios(tables, "breon_henriot", 4.0)
    return Verdict(bool(abs(found - 1).max() < 0.1), f"over Cox and Munk's: {shown(found)}")


def pelevin_and_burtsev_are_lower(tables: Tables) -> Verdict:
    """Pelevin and Burtsev over Cox and Munk."""
    found = ratios(tables, "pelevin_burtsev")
    return Verdict(bool(found.max() < 1), f"over Cox and Munk's: {shown(found)}")


def closed_budget_is_cox_munks(tables: Tables) -> Verdict:
    """The closed budget over Cox and Munk."""
    found = ratios(tables, "model_closed")
    return Verdict(bool(abs(found - 1).max() < 0.02), f"over Cox and Munk's: {shown(found)}")


def report_is_steeper_upwind(tables: Tables) -> Verdict:
    """The report's budget over Cox and Munk from 2 m/s."""
    found = ratios(tables, "model_report", 2.0)
    return Verdict(bool(found[0].min() > 1.1), f"over Cox and Munk's: {shown(found)}")


#: Medians of the variance of all slopes of waves shorter than 2 D, at friction velocities from 18 to 24 cm/s: the RaDyO
#: experiment of 2008 in the data of Laxague et al., doi 10.1109/TGRS.2025.3538460.
RADYO = {0.02: 0.0199, 0.05: 0.0293, 0.15: 0.0351}
RADYO_WINDS = (18.0, 21.0, 24.0)
BUDGETS = {"report": ("tab:red", "facets, the report's budget"), "closed": ("tab:blue", "facets, closed budget")}


def collect_by_footprint(command: Command, _: int) -> Tables:
    """The facets' variance along and across the wind together, by footprint."""
    footprints = np.unique(np.concatenate([np.geomspace(0.01, 1.0, 25), list(RADYO)]))
    rows = []
    for budget in BUDGETS:
        for w in RADYO_WINDS:
            total = [sum(facets_at(command, {"friction_velocity": w, "footprint": d, "slope_budget": budget})) for d in footprints]
            rows.append({"budget": np.full(len(footprints), budget), "friction_velocity": np.full(len(footprints), w),
                         "footprint": footprints, "variance": np.array(total)})
    return {"by-footprint": stack(rows)}


def draw_by_footprint(tables: Tables, page: Canvas) -> None:
    """A band over the winds for each budget, and what was measured."""
    axes = page.subplots()
    for budget, (colour, label) in BUDGETS.items():
        slow, middle, fast = (select(tables["by-footprint"], budget=budget, friction_velocity=w) for w in RADYO_WINDS)
        axes.fill_between(middle["footprint"], slow["variance"], fast["variance"], color=colour, alpha=0.2, linewidth=0)
        axes.plot(middle["footprint"], middle["variance"], color=colour, label=f"{label}, w* = 18 to 24 cm/s")
    axes.plot(list(RADYO), list(RADYO.values()), "ko", label="measured, RaDyO 2008, medians")
    axes.set(xscale="log", xlabel="footprint D, m", ylabel="slope variance of waves shorter than 2 D")
    look.legend(page, axes)


def over_the_model(tables: Tables, w: float) -> np.ndarray:
    """What was measured over the report's facets at the same footprints."""
    rows = select(tables["by-footprint"], budget="report", friction_velocity=w)
    return np.array([measured / rows["variance"][rows["footprint"] == d].item() for d, measured in RADYO.items()])


def measured_is_steeper(tables: Tables) -> Verdict:
    """RaDyO's medians over the facets of the strongest of its winds, and that the ratio falls with the footprint."""
    fast, middle = over_the_model(tables, RADYO_WINDS[2]), over_the_model(tables, RADYO_WINDS[1])
    text = ", ".join(f"{ratio:.1f} at D = {d} m" for d, ratio in zip(RADYO, middle, strict=True))
    return Verdict(bool(fast.min() > 1.2 and np.all(np.diff(middle) < 0)), f"over the report's facets at w* = 21 cm/s: {text}")


FIGURES = [
    Figure(
        "slopes-by-wind", "Slope variances by wind: as measured and as modelled (not in the report)",
        "Clean water. Cox and Munk's lines are what the report's facets have for D = inf; the model's are drawn waves and "
        f"facets together, D = {FOOTPRINT} m, with the report's budget and with a closed one.",
        collect, draw,
        [Claim("Breon and Henriot's variances are within 10 % of Cox and Munk's from 4 m/s.", measurements_agree, own=True),
         Claim("Pelevin and Burtsev's are lower.", pelevin_and_burtsev_are_lower, own=True),
         Claim("With a closed budget drawn waves and facets have Cox and Munk's variances within 2 %.",
               closed_budget_is_cox_munks, own=True),
         Claim("With the report's they are steeper upwind, from 2 m/s by more than 10 %.", report_is_steeper_upwind,
               own=True)]),
    Figure(
        "slopes-by-footprint", "Slope variance of waves shorter than 2 D: as measured and as modelled (not in the report)",
        "What waves that are not drawn have by the report's budget and by a closed one, for infinite fetch, beside medians of a "
        "field experiment with a polarimetric camera under winds of the same friction velocities. Noise of the camera at high "
        "wave numbers is part of what it measured, so that the order of magnitude is what can be compared.",
        collect_by_footprint, draw_by_footprint,
        [Claim("Measured slopes of short waves are steeper than the model's, the more so the shorter they are.",
               measured_is_steeper, own=True)]),
]
