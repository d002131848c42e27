"""Every claim about the report's figures, with as many instances as decide it, and the page."""

from functools import cache

import numpy as np
import pytest

from validation.figures import draw, variation
from validation.figures.claim import Claim, Figure, Tables, bell, least, sigmas
from validation.figures.data import IN_PLANE, OUT_OF_PLANE, Command, stack
from validation.support.command import COMMAND

CLAIMS = [pytest.param(figure, claim, id=f"{figure.name}-{claim.check.__name__}")
          for figure in draw.FIGURES for claim in figure.claims]


@cache
def tables_of(name: str) -> Tables:
    """The tables of a figure."""
    figure, = draw.select([name])
    return figure.collect(Command(COMMAND), draw.QUICK_INSTANCES)


@pytest.mark.parametrize(("figure", "claim"), CLAIMS)
def test_claim(figure: Figure, claim: Claim) -> None:
    """The claim holds, or does not, as it is known to."""
    verdict = claim.check(tables_of(figure.name))
    print(f"\n{figure.name}: {claim.text}\n  {verdict.numbers}")
    assert verdict.holds == claim.expected, f"{claim.text}: {verdict.numbers}"


def without_wind_direction() -> Tables:
    """Tables of Fig. 12 of a sea that knows no wind direction: curves alike but for noise, fits at 0."""
    rng, azimuths = np.random.default_rng(1), variation.AZIMUTHS
    angles = {"in": IN_PLANE, "out": OUT_OF_PLANE}
    curves = [{"plane": np.array([plane] * len(x)), "angle": x, "wind_direction": np.full(len(x), azimuth),
               "instances": np.full(len(x), 20_000.0), "sem": np.full(len(x), 7e-4),
               "mean": bell(x, 0.14, 30.0 if plane == "in" else 0.0, 12.0) + 7e-4 * rng.standard_normal(len(x))}
              for azimuth in azimuths for plane, x in angles.items()]
    rows = {"wind_direction": np.repeat(azimuths, 8), "centre": 0.07 * rng.standard_normal(8 * len(azimuths))}
    exact = {"wind_direction": np.array(azimuths), "centre": np.zeros(len(azimuths))}
    return {"azimuths": stack(curves), "fits": rows, "fits-exact": exact}


@pytest.mark.parametrize("check", [variation.in_plane_dependence_is_slight,
                                   variation.out_of_plane_shifts_slightly,
                                   variation.out_of_plane_shift_returns], ids=lambda check: check.__name__)
def test_no_effect_is_not_a_slight_one(check) -> None:
    """Where the wind's direction changes nothing, what the report says of Fig. 12 does not hold."""
    verdict = check(without_wind_direction())
    assert not verdict.holds, verdict.numbers


def test_no_number_decides_nothing() -> None:
    """A standard error or a margin that is not a number passes no comparison, wherever it stands."""
    assert np.isnan(sigmas(1.0, np.nan)) and np.isnan(sigmas(np.nan, 1.0)) and np.isnan(sigmas(np.nan, 0.0))
    assert np.isnan(least([5.0, np.nan])) and np.isnan(least([np.nan, 5.0])) and least([5.0, 6.0]) == 5.0
    assert (sigmas(1.0, 0.0), sigmas(-1.0, 0.0), sigmas(0.0, 0.0)) == (np.inf, -np.inf, 0.0)


def test_page(tmp_path, monkeypatch, capsys) -> None:
    """The script writes a picture, data and a page with every claim on them."""
    monkeypatch.setattr("sys.argv", ["draw.py", "--quick", "--only", "figure-02", "--out", str(tmp_path)])
    assert draw.main() == 0, capsys.readouterr().err
    text = (tmp_path / "index.html").read_text(encoding="utf-8")
    figure, = draw.select(["figure-02"])
    assert all(text.count(f"“{claim.text}”") == 2 for claim in figure.claims)
    assert (tmp_path / "data/figure-02-spectra.csv").read_text().startswith("friction_velocity_cm_s,k_rad_cm,")
    assert 10_000 < (tmp_path / "figure-02.png").stat().st_size < 300_000
