"""Speed of the statistics of engagements: what the campaign `engagements` measures, as tables."""

from typing import Any

from validation.bench.report import Table, aim

#: Means at 100 observers: how much less time exact ones are to take than plain draws, by relative error.
AIMS = {"1": 30, "0.1": 1000}
STAGES = ("draw", "cast", "normal", "obscuration", "brdf")


def tables(rows: list[dict[str, Any]]) -> list[Table]:
    """The stages of an instance, the growth with the scenario's size, and the race."""
    stages, growth, races = [], [], []
    for row in rows:
        if "stages" in row:
            case, total = row["stages"], sum(row[stage] for stage in STAGES)
            stages.append([f"w* = {case['w']}, incidence and view {case['incidence']} deg",
                           *(f"{row[stage]:.2f} ({100 * row[stage] / total:.0f} %)" for stage in STAGES)])
        elif "growth" in row:
            case, best = row["growth"], row["seconds"]["best"]
            growth.append([str(case["components"]), str(case["instances"]), str(case["observers"]), f"{1 / best:.1f}",
                           f"{row['instances_per_s']:.0f}"])
        else:
            case = row["race"]
            cells = [f"{1e3 * row['exact']['best']:.1f} ms"]
            for percent, least in AIMS.items():
                ratio = row[f"ratio_{percent}"]
                cells += [f"{row[f'draws_{percent}_percent']:.2f} s", f"{ratio:.0f}, {aim(ratio, least)}"]
            races.append([str(case["w"]), str(case["incidence"]), *cells, f"{row['off_in_standard_errors']:.1f}"])
    return [
        Table("stages", "One instance of 5 components, one observer, one thread, microseconds (share)", ["", *STAGES], stages),
        Table("scenarios", "Scenarios (w* = 8, incidence 30 deg) with all statistics, all cores",
              ["components", "instances", "observers", "scenarios/s", "instances/s"], growth),
        Table("races", "Means at 100 observers, set-up included, all cores: draws for this standard error at each, over exact",
              ["w*, cm/s", "incidence", "exact", "draws to 1 %", "times", "draws to 0.1 %", "times",
               "differ by, standard errors of 20,000 draws"], races),
    ]
