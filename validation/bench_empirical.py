"""Speed of the empirical model: what rust-core's example `empirical` measures, as a table."""

from typing import Any

#: How much less time a value of a float32 batch is to take than the full model with 50 instances.
AIM = 20


def show(rows: list[dict[str, Any]]) -> None:
    """Prints times per value, and how many go into one query of the full model."""
    print("\nEmpirical model, one thread, per value (configure: per sea)")
    for w in sorted({row["w"] for row in rows}):
        times = {row["name"]: row["seconds"] for row in rows if row["w"] == w}
        print(f"w* = {w:g}:")
        for name, seconds in times.items():
            text = f"{1e3 * seconds:.1f} ms" if seconds > 1e-3 else f"{1e9 * seconds:.0f} ns"
            print(f"    {name:28}{text:>12}")
        ratio = times["full, 50 instances"] / times["eval, float32"]
        print(f"    full over eval, float32: {ratio:.0f}  aim {AIM}: {'met' if ratio >= AIM else 'missed'}")
