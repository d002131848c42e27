"""The parts of the closed form to 50 digits, written from docs/model.md alone: wind, slopes, reflectance, shadowing,
whitecaps. Arguments and results are mpmath's numbers.
"""

import csv
from functools import cache

from mpmath import mp, mpf

from validation.support.paths import ROOT

mp.dps = 50
SQRT_PI = mp.sqrt(mp.pi)

Vector = list[mpf]


def number(text: str) -> mpf:
    """A constant as printed, not its nearest float."""
    return mpf(text)


def exact(values: list[float]) -> Vector:
    """Floats as they are."""
    return [mpf(x) for x in values]


def dot(a: Vector, b: Vector) -> mpf:
    """Scalar product."""
    return mp.fsum(x * y for x, y in zip(a, b, strict=True))


def bisect(low: mpf, high: mpf, beyond) -> mpf:
    """Where `beyond` begins to hold, to 30 digits."""
    for _ in range(110):
        middle = (low + high) / 2
        low, high = (low, middle) if beyond(middle) else (middle, high)
    return high


# Wind, Eqs. 1-2.

def wind_speed(w: mpf, height: mpf) -> mpf:
    """m/s at a height in m of a friction velocity in cm/s."""
    if w <= 0:
        return mpf(0)
    h0 = number("0.684") / w + number("4.28e-5") * w**2 - number("0.0443")
    return max(mpf(0), w / number("0.4") * mp.log(100 * height / h0) / 100)


# Slopes, Eqs. 74-78.

def variances(w: mpf, footprint: mpf) -> Vector:
    """sigma_u^2 and sigma_c^2, not below 1e-6."""
    w10, w12 = wind_speed(w, mpf(10)), wind_speed(w, number("12.5"))

    def share(a: str, b: str, c: str, d: str) -> mpf:
        scale, power = footprint * (number(a) * w10 + number(b)), number(c) * w10 + number(d)
        return mpf(1) if mp.isinf(scale) else mp.erfc(scale**-power)

    e_u, e_c = mp.exp(-w10 / number("36.8188")), mp.exp(-w10 / number("35.1072"))
    u = ((1 - e_u) * share("1.3261", "6.2780", "0.0033", "0.2666")
         + e_u * share("7.0628", "24.2598", "0.0240", "0.4956"))
    c = ((1 - e_c) * share("1.2156", "11.3065", "0.0021", "0.2965")
         + e_c * share("7.0596", "24.4595", "0.0241", "0.5021"))
    m = number("0.00316") * w12, number("0.003") + number("0.00192") * w12
    return [max(m[0] * u, number("1e-6")), max(m[1] * c, number("1e-6"))]


def skewness(w: mpf) -> Vector:
    """c21 and c03."""
    w12 = wind_speed(w, number("12.5"))
    return [number("0.01") - number("0.0086") * w12, number("0.04") - number("0.033") * w12]


def gram_charlier(c21: mpf, c03: mpf, u: mpf, c: mpf) -> mpf:
    """p_ks, not clamped."""
    return (1 - c21 * (c**2 - 1) * u / 2 - c03 * (u**3 - 3 * u) / 6
            + number("0.40") * (c**4 - 6 * c**2 + 3) / 24
            + number("0.12") * (c**2 - 1) * (u**2 - 1) / 4
            + number("0.23") * (u**4 - 6 * u**2 + 3) / 24)


# Reflectance, Eqs. 62-63 and Fresnel's.

def schlick(ior: mpf, cos: mpf) -> mpf:
    """Eq. 63."""
    normal = ((ior - 1) / (ior + 1))**2
    return normal + (1 - normal) * (1 - min(cos, mpf(1)))**5


def fresnel(ior: mpf, cos: mpf) -> mpf:
    """Unpolarised, by the angle of refraction; the index may be complex."""
    inside = mp.sqrt(1 - (1 - cos**2) / ior**2)
    senkrecht = (cos - ior * inside) / (cos + ior * inside)
    parallel = (ior * cos - inside) / (ior * cos + inside)
    return (abs(senkrecht)**2 + abs(parallel)**2) / 2


@cache
def water_index() -> list[tuple[mpf, mpf]]:
    """Hale and Querry's wavelengths in micrometres and indices, as printed."""
    with open(ROOT / "rust-core/data/water_nk_hale_querry_1973.csv", encoding="utf-8") as file:
        rows = list(csv.reader(file))[1:]
    return [(number(row[0].strip()), number(row[1].strip())) for row in rows]


def index(wavelength: mpf) -> mpf:
    """Linear between the entries."""
    table = water_index()
    for (a, n), (b, m) in zip(table, table[1:]):
        if a <= wavelength <= b:
            return n + (m - n) * (wavelength - a) / (b - a)
    return table[0][1] if wavelength < table[0][0] else table[-1][1]


def index_between_entries() -> Vector:
    """What linear interpolation errs by, relative: a quarter of what an entry is off when it is left out."""
    table = water_index()
    return [abs(p + (r - p) * (b - a) / (c - a) - q) / q / 4
            for (a, p), (b, q), (c, r) in zip(table, table[1:], table[2:])]


# Shadowing, Eqs. 64-67.

def ierfc(x: mpf) -> mpf:
    """The integral of erfc from x on."""
    return mp.exp(-x**2) / SQRT_PI - x * mp.erfc(x)


def hidden(cos: mpf, spread: mpf) -> mpf:
    """cos F, with Eq. 66 as read."""
    # Beyond nu of 1000 it is below 1e-434000.
    if cos > 1000 * spread:
        return mpf(0)
    nu = cos / spread
    return cos * (mp.exp(-nu**2) / (SQRT_PI * nu) - mp.erfc(nu)) / 2


# Whitecaps, Eqs. 51, 53-55.

def foam(w10: mpf) -> mpf:
    """Fraction of the sea."""
    return min(mpf(1), number("1.7e-6") * w10**number("3.75"))


def breaking(w: mpf, acceleration: mpf) -> mpf:
    """Probability at a vertical acceleration in cm/s^2."""
    a = acceleration / 981
    alpha = number("-0.0022") * w + number("0.4448")
    if a <= number("-0.39"):
        return mpf(1)
    return mpf(0) if a > max(-alpha, number("-0.39")) else (a + alpha) / (alpha - number("0.39"))


def foam_brdf(wavelength: mpf) -> mpf:
    """1/sr."""
    return number("0.22") * mp.exp(number("-1.75") * (max(wavelength, number("0.6")) - number("0.6"))) / mp.pi
