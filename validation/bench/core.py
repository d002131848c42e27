"""Speed of the Rust core on one thread: the closed form, and sums of waves."""

from typing import Any

from validation.bench.report import Table, aim

#: Of lanes: times the scalar float64 rate of eval, and million/s a core; of wave sums: times the plain loop with the
#: platform's sine and cosine, and components/s a core.
LANES = {"times float64": 10, "million/s": 150}
WAVES = {"times libm": 8, "million/s": 1000}
LEVELS = ("lanes, portable", "lanes, avx2", "lanes, avx512")
PRECISIONS = ("float64", "float32", *LEVELS)


def tables(scalar: list[dict[str, Any]], waves: list[dict[str, Any]]) -> list[Table]:
    """Rates, best (median), and what they come to beside the gates of lanes and of wave sums."""
    rates = {(row["name"], row["precision"]): row["per_s"] for row in scalar}
    rows = []
    for sea, label in (("default", ""), ("slope", ", slopes")):
        for precision in PRECISIONS:
            if (f"eval {sea}", precision) in rates:
                rows.append([precision + label, *(cell(rates.get((f"{call} {sea}", precision)))
                                                  for call in ("eval", "pdf", "sample"))])
    configure = rates["configure", "float64"]
    rows.append(["`configure()`, µs", f"{1e6 / configure['best']:.0f} ({1e6 / configure['median']:.0f})", "", ""])
    sums = [[row["name"], str(row["components"]), cell(row["per_s"])] for row in waves]
    return [Table("core", "Rust core, one thread, million/s: best (median)", ["", "eval", "pdf", "sample"], rows),
            Table("waves", "Sums of waves, one thread, million components/s: best (median)", ["", "waves", "rate"], sums),
            Table("gates", "Gates of lanes and of wave sums", ["", "found", "gate or aim", ""], gates(rates, waves))]


def cell(rate: dict[str, Any] | None) -> str:
    """Million/s."""
    return f"{rate['best'] / 1e6:.2f} ({rate['median'] / 1e6:.2f})" if rate else "-"


def gates(rates: dict[tuple[str, str], dict[str, Any]], waves: list[dict[str, Any]]) -> list[list[str]]:
    """Rows of what there is on this processor: lanes, and any sum of `wave_sums` but the first."""
    rows = []
    plain = rates["eval default", "float64"]
    for level in LEVELS:
        if lanes := rates.get(("eval default", level)):
            rows += gate(f"eval, {level}", lanes["best"] / plain["best"], lanes["best"], LANES, "times float64")
    for components in sorted({row["components"] for row in waves}):
        best = {row["name"]: row["per_s"]["best"] for row in waves if row["components"] == components}
        for name in (name for name in best if name != "libm"):
            rows += gate(f"{name}, {components} waves", best[name] / best["libm"], best[name], WAVES, "times libm")
    return rows


def gate(name: str, times: float, per_s: float, least: dict[str, float], factor: str) -> list[list[str]]:
    """A gate and an aim."""
    return [[name, f"{times:.1f} {factor}", f"{least[factor]}", aim(times, least[factor])],
            [name, f"{per_s / 1e6:.0f} million/s", f"{least['million/s']}", aim(per_s / 1e6, least["million/s"])]]
