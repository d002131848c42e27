"""Fronts of run time against error, on made-up points; and how many samples an error needs."""

import pytest

from validation.bench import front_page, fronts
from validation.bench.glint import needed
from validation.bench.report import spread


def point(family: str, seconds: float, error: float, front: str = "means") -> dict:
    """As `measure` gives it."""
    return {"front": front, "family": family, "setting": "16", "error": error, "seconds": spread([seconds])}


POINTS = [point("a", 1.0, 0.1), point("a", 4.0, 0.05), point("b", 2.0, 0.01), point("b", 3.0, 0.2), point("c", 9.0, 0.0)]


def test_efficient_points_are_beaten_by_none():
    """Fastest first; slower ones only where they are closer."""
    assert fronts.efficient(POINTS) == [POINTS[0], POINTS[2], POINTS[4]]


@pytest.mark.parametrize(("last", "expected"), [(0.02, 1024), (0.01, 256), (0.04, 4096)])
def test_samples_by_the_square_root(last, expected):
    """Errors that halve for four times the samples."""
    runs = [{"spp": 64, "rmse": 2 * last}, {"spp": 256, "rmse": last}]
    assert needed(runs) == expected


def test_page(tmp_path, monkeypatch):
    """Pictures of the fronts that have points, and a table of all."""
    monkeypatch.setattr(front_page, "ROOT", tmp_path)
    page = front_page.write({"points": POINTS, "glint": None}, "a machine", tmp_path / "small.png")
    text = page.read_text(encoding="utf-8")
    assert text.count("<svg") == 0 and text.count("bench/means.svg") == 1 and "a machine" in text
    assert (tmp_path / "out/bench/means.svg").exists() and not (tmp_path / "out/bench/cast.svg").exists()
    assert 5_000 < (tmp_path / "small.png").stat().st_size < 300_000
