"""Speed of the empirical model: what the campaign `empirical` measures, as a table."""

from typing import Any

from validation.bench.report import Table, aim, shown_time

#: How much less time a value of a float32 batch is to take than the full model with 50 instances.
AIM = 20


def tables(rows: list[dict[str, Any]]) -> list[Table]:
    """Times per value, and how many go into one query of the full model."""
    winds = sorted({row["w"] for row in rows})
    best = {(row["name"], row["w"]): row["seconds"]["best"] for row in rows}
    names = list(dict.fromkeys(row["name"] for row in rows))
    cells = [[name, *(shown_time(best[name, w]) for w in winds)] for name in names]
    ratios = [best["full, 50 instances", w] / best["eval, float32", w] for w in winds]
    cells.append([f"full over eval, float32 (aim {AIM})", *(f"{ratio:.0f}, {aim(ratio, AIM)}" for ratio in ratios)])
    return [Table("empirical", "Empirical model, one thread, per value (configure: per sea), best",
                  ["", *(f"w* = {w:g}" for w in winds)], cells)]
