"""The comparison of two benchmark runs, on made-up ones; and the tables of the page."""

import json

import pytest

from validation.bench import compare
from validation.bench.report import Table, spread, write_page

TIMES = [1.0, 1.02, 1.04, 1.08, 1.5]


def figure(values: list[float], unit: str = "s", better: str = "less") -> dict:
    """As bench/run.py writes it."""
    return {"unit": unit, "better": better, **spread(values, better)}


def run(tmp_path, monkeypatch, capsys, a: dict, b: dict) -> tuple[int, str]:
    """Exit status and output for two runs' figures."""
    for name, figures in (("a", a), ("b", b)):
        (tmp_path / f"{name}.json").write_text(json.dumps({"figures": figures}))
    monkeypatch.setattr("sys.argv", ["compare.py", str(tmp_path / "a.json"), str(tmp_path / "b.json")])
    return compare.main(), capsys.readouterr().out


@pytest.mark.parametrize(("factor", "status"), [(1.0, 0), (1.1, 0), (1.3, 1), (0.5, 0)])
def test_times(tmp_path, monkeypatch, capsys, factor, status):
    """Quartiles 1.02 and 1.08 and the slack allow a factor of 1.23."""
    found, text = run(tmp_path, monkeypatch, capsys, {"x": figure(TIMES)}, {"x": figure([factor * t for t in TIMES])})
    assert found == status, text
    assert ("WORSE" in text) == bool(status) and ("better" in text) == (factor == 0.5)


def test_rates_are_better_when_larger(tmp_path, monkeypatch, capsys):
    """Half the rate is worse, twice is not."""
    rate, half = (figure([factor * r for r in TIMES], "1/s", "more") for factor in (1.0, 0.5))
    assert run(tmp_path, monkeypatch, capsys, {"x": rate}, {"x": half})[0] == 1
    assert run(tmp_path, monkeypatch, capsys, {"x": half}, {"x": rate})[0] == 0


def test_noise_explains(tmp_path, monkeypatch, capsys):
    """A busy second run: its median is worse, its best is not, or its rounds are all over the place."""
    busy, wild = figure([1.0, 1.9, 2.0, 2.1, 2.2]), figure([1.5, 1.5, 2.0, 2.9, 3.0])
    for later in (busy, wild):
        assert run(tmp_path, monkeypatch, capsys, {"x": figure(TIMES)}, {"x": later})[0] == 0


def test_errors_have_no_noise(tmp_path, monkeypatch, capsys):
    """A tenth more error is worse, though there is one round; a time of one round is not judged."""
    error, time = (lambda x: figure([x], unit="")), (lambda x: figure([x]))
    assert run(tmp_path, monkeypatch, capsys, {"x": error(1e-7)}, {"x": error(1.1e-7)})[0] == 1
    found, text = run(tmp_path, monkeypatch, capsys, {"x": time(1.0), "y": time(1.0)}, {"x": time(9.0)})
    assert found == 0 and "not judged" in text and "only in the first: y" in text


def test_bad_input(tmp_path, monkeypatch, capsys):
    """A file of something else."""
    (tmp_path / "a.json").write_text("[]")
    monkeypatch.setattr("sys.argv", ["compare.py", str(tmp_path / "a.json"), str(tmp_path / "b.json")])
    assert compare.main() == 2
    assert "a.json" in capsys.readouterr().err


def test_tables_go_between_marks(tmp_path):
    """What stands there is replaced, the rest stays."""
    page = tmp_path / "page.md"
    page.write_text("before\n<!-- rates -->\nold\n<!-- end -->\nafter\n<!-- other -->\nkept\n<!-- end -->\n")
    write_page([Table("rates", "Rates", ["", "eval"], [["water", "1.5 (1.2)"]])], page)
    assert page.read_text() == ("before\n<!-- rates -->\n|  | eval |\n| --- | ---: |\n| water | 1.5 (1.2) |\n<!-- end -->\n"
                                "after\n<!-- other -->\nkept\n<!-- end -->\n")
