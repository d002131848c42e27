"""The bounds that docs/error-budget.md claims, on a tenth of its inputs."""

import json

import pytest

from validation.error_budget import plot
from validation.error_budget.budget import CAMPAIGN, QUICK_COUNT, compare, failures, page
from validation.error_budget.compare import Comparison
from validation.error_budget.rows import KINDS, ROWS

CLAIMS = [pytest.param(row, kind, id=f"{row.name}-{kind}") for row in ROWS for kind in KINDS if kind in row.bounds]


@pytest.fixture(scope="module")
def quick() -> Comparison:
    """Compared once for all tests."""
    return compare(CAMPAIGN, QUICK_COUNT)


@pytest.mark.parametrize(("row", "kind"), CLAIMS)
def test_bound(quick, row, kind) -> None:
    """Median and worst are within what is claimed."""
    found = quick.of(row.name, kind)
    assert found is not None, "nothing was compared"
    assert found[0] <= row.bound(kind)[0] and found[1] <= row.bound(kind)[1], found


def test_all_that_was_compared_is_claimed(quick) -> None:
    """Every kind of error of every row has a bound, and it holds; lanes have those of float32."""
    names = {row.name: row for row in ROWS}
    for name, kind in quick.errors:
        assert names[name].bound(kind)
    assert failures(quick) == []


@pytest.mark.parametrize(("stage", "x", "value", "wrong"), [
    ("wind", [8.0, 10.0], 2.00654, 1e-6), ("ierfc", [0.5], 0.19964, 1e-4), ("schlick", [1.33, 0.5], 0.0507, 1e-2),
])
def test_a_wrong_digit_fails(stage, x, value, wrong) -> None:
    """A value that is right to a few digits only breaks the row's bound."""
    comparison = Comparison()
    comparison.read([json.dumps({"stage": stage, "x": x, "y": {"float64": [value]}})])
    assert 0 < comparison.of(stage, "float64")[0] < wrong
    assert any(f"{comparison.of(stage, 'float64')[0]:.1e} is above" in line for line in failures(comparison))


def test_page(quick, tmp_path) -> None:
    """Page and plot show every row."""
    text = page(quick)
    assert all(text.count(f"| {row.title} |") >= 2 for row in ROWS)
    plot.draw(quick, tmp_path / "plot.png")
    assert 10_000 < (tmp_path / "plot.png").stat().st_size < 300_000
