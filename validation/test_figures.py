"""Every claim about the report's figures, with as many instances as decide it, and the page."""

from functools import cache

import pytest

import figures
from figure_claim import Claim, Figure, Tables
from figure_data import COMMAND, Command

CLAIMS = [pytest.param(figure, claim, id=f"{figure.name}-{claim.check.__name__}")
          for figure in figures.FIGURES for claim in figure.claims]


@cache
def tables_of(name: str) -> Tables:
    """The tables of a figure."""
    figure, = figures.select([name])
    return figure.collect(Command(COMMAND), figures.QUICK_INSTANCES)


@pytest.mark.parametrize(("figure", "claim"), CLAIMS)
def test_claim(figure: Figure, claim: Claim) -> None:
    """The claim holds, or does not, as it is known to."""
    verdict = claim.check(tables_of(figure.name))
    print(f"\n{figure.name}: {claim.text}\n  {verdict.numbers}")
    assert verdict.holds == claim.expected, f"{claim.text}: {verdict.numbers}"


def test_page(tmp_path, monkeypatch, capsys) -> None:
    """The script writes a picture, data and a page with every claim on them."""
    monkeypatch.setattr("sys.argv", ["figures.py", "--quick", "--only", "figure-02", "--out", str(tmp_path)])
    assert figures.main() == 0, capsys.readouterr().err
    text = (tmp_path / "index.html").read_text(encoding="utf-8")
    figure, = figures.select(["figure-02"])
    assert all(text.count(f"“{claim.text}”") == 2 for claim in figure.claims)
    assert (tmp_path / "data/figure-02-spectra.csv").read_text().startswith("friction_velocity_cm_s,k_rad_cm,")
    assert 10_000 < (tmp_path / "figure-02.png").stat().st_size < 300_000
