"""Speed of the statistics of engagements: what rust-core's example `engagements` measures, as tables."""

from typing import Any

#: Means at 100 observers: how much less time exact ones are to take than plain draws, by relative error.
AIMS = {"1": 30, "0.1": 1000}


def show(rows: list[dict[str, Any]]) -> None:
    """Prints the stages of an instance, the growth with the scenario's size, and the race."""
    print("\nOne instance of 5 components, one observer, one thread, microseconds (share)")
    stages = ("draw", "cast", "normal", "obscuration", "brdf")
    print(f"{'':36}" + "".join(f"{stage:>15}" for stage in stages))
    for row in (row for row in rows if "stages" in row):
        case = row["stages"]
        total = sum(row[stage] for stage in stages)
        name = f"w* = {case['w']}, incidence and view {case['incidence']} deg"
        cells = (f"{row[stage]:.2f} ({100 * row[stage] / total:.0f} %)" for stage in stages)
        print(f"{name:36}" + "".join(f"{cell:>15}" for cell in cells))

    print("\nScenarios (w* = 8, incidence 30 deg) with all statistics, all cores")
    print(f"{'components':>12}{'instances':>12}{'observers':>12}{'scenarios/s':>14}{'instances/s':>14}")
    for row in (row for row in rows if "growth" in row):
        case = row["growth"]
        print(f"{case['components']:>12}{case['instances']:>12}{case['observers']:>12}"
              f"{1 / row['seconds']:>14.1f}{row['instances_per_s']:>14.0f}")

    print("\nMeans at 100 observers, set-up included, all cores: draws for this standard error at each, over exact")
    for row in (row for row in rows if "race" in row):
        case = row["race"]
        print(f"w* = {case['w']}, incidence {case['incidence']} deg: exact {1e3 * row['exact']:.1f} ms; "
              f"they differ by {row['off_in_standard_errors']:.1f} standard errors of {row['draws']} draws (rms)")
        for percent, aim in AIMS.items():
            ratio = row[f"ratio_{percent}"]
            print(f"    to {percent:>3} %: draws {row[f'draws_{percent}_percent']:8.2f} s, {ratio:.0f} times as long  "
                  f"aim {aim}: {'met' if ratio >= aim else 'missed'}")
