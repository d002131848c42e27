"""The reference rows of equations as printed are what their script gives."""

from validation.error_budget.printed_rows import rows
from validation.support.paths import ROOT


def test_stored_rows_are_current() -> None:
    """Byte for byte."""
    stored = ROOT / "rust-core/tests/data/facet_as_printed.csv"
    assert stored.read_text(encoding="utf-8") == "\n".join(rows()) + "\n"
