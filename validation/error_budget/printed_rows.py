"""Facets by equations as printed (`readings`) to 50 digits, equation by equation from the report's text and
docs/model.md: reference rows for the core's tests.

    .venv/bin/python -m validation.error_budget.printed_rows > rust-core/tests/data/facet_as_printed.csv

Tilts are formed as Eqs. 69-71 have them, by projection, normalisation and arccosine, which takes more digits than
float64 has; where Eqs. 71-73 are read they get the sign of the slope that rises upwind. The clamp of Eq. 78 and the floor
of the variances stay.
"""

import random
import sys
from math import pi
from typing import NamedTuple

from mpmath import mp, mpf

from validation.error_budget.model import (Vector, dot, exact, fresnel, number, schlick, skewness, variances,
                                           wind_speed)

#: Every equation of the facets that has a reading.
EQUATIONS = ["56", "65", "66", "70", "71-73", "78"]
#: The whole print: the text says of Eq. 70 that the wave's index is implicit.
AS_PRINTED = [equation for equation in EQUATIONS if equation != "70"]
#: Which equations are taken as printed, and rows of each for every reflectance and slope measure.
READINGS = {"as_printed": (AS_PRINTED, 60)} | {equation: ([equation], 10) for equation in EQUATIONS}
FOOTPRINTS = [0.005, 0.02, 0.05, 0.15, 0.3, 1.0, float("inf")]
COLUMNS = ("friction_velocity_cm_s,wind_direction_deg,footprint_m,n,exact_fresnel,slope_measure,"
           "ix,iy,iz,ox,oy,oz,nx,ny,nz,f_sr-1,readings")


class Sea(NamedTuple):
    """What a row says of the water: cm/s, degrees, m; Fresnel's equations or Schlick's, slopes or tilt angles."""

    friction_velocity: float
    wind_direction: float
    footprint: float
    ior: float
    exact_fresnel: bool
    slope_measure: bool


def unit(v: Vector) -> Vector:
    """Of length 1."""
    length = mp.sqrt(dot(v, v))
    return [x / length for x in v]


def across(v: Vector, w: Vector) -> Vector:
    """The unit vector of what is left of `v` without its part along `w`, Eqs. 69-70."""
    part = dot(v, w)
    return unit([x - part * y for x, y in zip(v, w, strict=True)])


def tilt(half: Vector, normal: Vector, along: Vector, other: Vector, printed: list[str]) -> mpf:
    """A tilt of Eqs. 69-71 in the vertical plane that `other` is normal to."""
    if "70" in printed:
        normal = exact([0.0, 0.0, 1.0])
    h, n = across(half, other), across(normal, other)
    size = mp.acos(dot(h, n))
    # A facet that leans upwind falls that way.
    leans = dot(h, along) * n[2] - dot(n, along) * h[2]
    return size if "71-73" in printed or leans <= 0 else -size


def shadow(cos: mpf, sigma: mpf, printed: list[str]) -> mpf:
    """F of Eqs. 65-66."""
    nu = cos / (sigma * mp.sqrt(1 - cos if "65" in printed else 1 - cos**2))
    power = 2 if "66" in printed else 1
    return (mp.exp(-nu**2) / (mp.sqrt(mp.pi) * nu**power) - mp.erfc(nu)) / 2


def correction(w: mpf, u: mpf, c: mpf, printed: list[str]) -> tuple[mpf, mpf]:
    """p_ks of Eq. 78, and the sum of the sizes of its terms."""
    c21, c03 = skewness(w)
    factor = 1 if "78" in printed else u
    terms = [mpf(1), -c21 * (c**2 - 1) * factor / 2, -c03 * (u**3 - 3 * u) / 6, number("0.40") * (c**4 - 6 * c**2 + 3) / 24,
             number("0.12") * (c**2 - 1) * (u**2 - 1) / 4, number("0.23") * (u**4 - 6 * u**2 + 3) / 24]
    return mp.fsum(terms), mp.fsum(map(abs, terms))


def brdf(sea: Sea, printed: list[str], i: list[float], o: list[float], n: list[float]) -> mpf | None:
    """f_SW of Eq. 56, 1/sr; None next to the zero of Eq. 78, where float64 has no digits left."""
    source, observer, normal = exact(i), exact(o), exact(n)
    w, ior = mpf(sea.friction_velocity), mpf(sea.ior)
    half = unit([a + b for a, b in zip(source, observer, strict=True)])          # 59
    cos_i, cos_r = dot(source, normal), dot(observer, normal)                    # 60
    cos_zeta, cos_xi = dot(source, half), dot(half, normal)                      # 61, 71
    rho = (fresnel if sea.exact_fresnel else schlick)(ior, cos_zeta)             # 62-63
    sigma = mp.sqrt(number("5.34e-3") * wind_speed(w, mpf(10)))                  # 64
    visible = 1 / (1 + shadow(cos_i, sigma, printed) + shadow(cos_r, sigma, printed))  # 65-67
    azimuth = mpf(sea.wind_direction) * mp.pi / 180
    upwind = [mp.cos(azimuth), mp.sin(azimuth), mpf(0)]                          # 68
    crosswind = [-mp.sin(azimuth), mp.cos(azimuth), mpf(0)]
    tilts = [tilt(half, normal, upwind, crosswind, printed), tilt(half, normal, crosswind, upwind, printed)]  # 69-71
    if sea.slope_measure:
        tilts = [mp.tan(tilt) for tilt in tilts]
    sigmas = [mp.sqrt(x) for x in variances(w, mpf(sea.footprint))]              # 74-77
    u, c = (tilt / s for tilt, s in zip(tilts, sigmas, strict=True))             # 73
    p_0 = mp.exp(-(u**2 + c**2) / 2) / (2 * mp.pi * sigmas[0] * sigmas[1])       # 72
    p_ks, size = correction(w, u, c, printed)
    if abs(p_ks) < number("1e-3") * size:
        return None
    factor = (mp.pi if "56" in printed else 1) / mpf(4)
    return factor / (cos_i * cos_r * cos_xi**4) * rho * p_0 * max(p_ks, mpf(0)) * visible  # 56, 79


def direction(rng: random.Random, highest: float) -> list[float]:
    """A direction to within an angle from the vertical, degrees."""
    theta, phi = rng.random() * highest * pi / 180, 2 * pi * rng.random()
    z = float(mp.cos(theta))
    r = float(mp.sin(theta))
    return [r * float(mp.cos(phi)), r * float(mp.sin(phi)), z]


def row(rng: random.Random, readings: str, exact_fresnel: bool, slope_measure: bool) -> str | None:
    """A row whose facets lean by up to six standard deviations from the wave normal; None where none such reflects."""
    sea = Sea(1.3 * 183**rng.random(), 0.0 if rng.random() < 0.3 else 360 * rng.random() - 180,
              FOOTPRINTS[int(len(FOOTPRINTS) * rng.random())], 1.2 + 0.3 * rng.random(), exact_fresnel, slope_measure)
    i, n = direction(rng, 88), direction(rng, 25) if rng.random() < 0.5 else [0.0, 0.0, 1.0]
    sigma = float(mp.sqrt(max(variances(mpf(sea.friction_velocity), mpf(sea.footprint)))))
    reach, turn = 6 * rng.random(), 2 * pi * rng.random()
    slope = [n[0] / n[2] + reach * sigma * float(mp.cos(turn)), n[1] / n[2] + reach * sigma * float(mp.sin(turn)), 1.0]
    h = [float(x) for x in unit(exact(slope))]
    twice = 2 * sum(a * b for a, b in zip(i, h, strict=True))
    o = [float(x) for x in unit([mpf(twice * b - a) for a, b in zip(i, h, strict=True)])]
    if min(sum(a * b for a, b in zip(v, m, strict=True)) for v in (i, o) for m in (n, [0.0, 0.0, 1.0])) < 0.01:
        return None
    f = brdf(sea, READINGS[readings][0], i, o, n)
    if f is None or f < 1e-12:
        return None
    numbers = [*sea[:4], int(sea.exact_fresnel), int(sea.slope_measure), *i, *o, *n]
    return ",".join([*(repr(x) for x in numbers), mp.nstr(f, 17, strip_zeros=False), readings])


def rows() -> list[str]:
    """The lines of the file."""
    rng, lines = random.Random(1954), [COLUMNS]
    for readings, (_, count) in READINGS.items():
        for exact_fresnel in (False, True):
            for slope_measure in (False, True):
                kept = []
                while len(kept) < count:
                    if line := row(rng, readings, exact_fresnel, slope_measure):
                        kept.append(line)
                lines += kept
    return lines


if __name__ == "__main__":
    sys.stdout.write("\n".join(rows()) + "\n")
