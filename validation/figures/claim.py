"""A figure, the claims about it and the few statistics that decide them."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure as Canvas
from scipy.optimize import curve_fit

from validation.figures.data import Command, Table, select

#: A statistical claim holds where it does so by more standard errors than this.
MARGIN = 4.0

#: The tables of a figure by name; each is written as a CSV file.
Tables = dict[str, Table]


class Verdict(NamedTuple):
    """Whether a claim holds, and the numbers that say so."""

    holds: bool
    numbers: str


@dataclass(frozen=True)
class Claim:
    """What is said about a figure and the check of it.

    `expected` is what is known to come out; `own` marks a statement that is not the report's.
    """

    text: str
    check: Callable[[Tables], Verdict]
    expected: bool = True
    own: bool = False


@dataclass(frozen=True)
class Figure:
    """A figure: `collect` takes the number of instances of an average, `draw` fills a canvas."""

    name: str
    title: str
    caption: str
    collect: Callable[[Command, int], Tables]
    draw: Callable[[Tables, Canvas], None]
    claims: list[Claim]


class Peak(NamedTuple):
    """The largest mean of a curve: where (degrees), how high and its standard error (1/sr)."""

    angle: float
    value: float
    error: float


def peak(curve: Table) -> Peak:
    """The peak on the grid of angles."""
    top = int(curve["mean"].argmax())
    return Peak(curve["angle"][top], curve["mean"][top], curve["sem"][top])


def peaks(table: Table, key: str, **wanted: float | str) -> tuple[np.ndarray, list[Peak]]:
    """The in-plane peak for every value of a column."""
    rows = select(table, **{"plane": "in", **wanted})
    values = np.unique(rows[key])
    return values, [peak(select(rows, **{key: value})) for value in values]


def at(curve: Table, angle: float) -> tuple[float, float]:
    """Mean and standard error (1/sr) at an angle of the grid."""
    row = select(curve, angle=angle)
    return row["mean"][0], row["sem"][0]


def sigmas(difference: float, error: float) -> float:
    """A difference in standard errors; 0 of 0 is 0, and of an error that is not a number neither is this."""
    if error == 0:
        return np.inf * np.sign(difference) if difference else 0.0
    return difference / error


def least(margins: Iterable[float]) -> float:
    """The smallest margin; not a number if one of them is not, so that it passes no test."""
    return float(np.min(list(margins)))


def steps(values: np.ndarray, errors: np.ndarray) -> np.ndarray:
    """The steps of a series in standard errors, each the sum of its two: no less whatever their correlation."""
    return np.array([sigmas(step, error)
                     for step, error in zip(np.diff(values), errors[1:] + errors[:-1], strict=True)])


def bell(angle: np.ndarray, height: float, centre: float, width: float) -> np.ndarray:
    """The report's Gaussian, Eq. 90: `width` is the 1/e half width."""
    return height * np.exp(-(((angle - centre) / width) ** 2))


def fit_bell(angles: np.ndarray, values: np.ndarray) -> tuple[float, float, float]:
    """Height, centre and 1/e half width (degrees) of the Gaussian nearest in least squares."""
    start = (values.max(), angles[values.argmax()], 15.0)
    return tuple(curve_fit(bell, angles, values, start)[0])


def half_width(angles: np.ndarray, values: np.ndarray) -> tuple[float, float]:
    """The angles (degrees) left and right of the peak at which a curve is half of it."""
    top, half = int(values.argmax()), values.max() / 2
    left = np.interp(half, values[:top + 1], angles[:top + 1])
    right = np.interp(-half, -values[top:], angles[top:])
    return left, right


def full_width(curve: Table) -> tuple[float, float]:
    """The full width at half maximum (degrees) and, from the slopes there, a bound on its standard error."""
    angles, values = curve["angle"], curve["mean"]
    left, right = half_width(angles, values)
    slopes, top = abs(np.gradient(values, angles)), peak(curve)
    error = sum((np.interp(side, angles, curve["sem"]) + top.error / 2) / np.interp(side, angles, slopes)
                for side in (left, right))
    return right - left, error


def listed(values: np.ndarray | list[float], digits: int = 3) -> str:
    """Numbers in one line."""
    return ", ".join(f"{value:.{digits}g}" for value in values)
