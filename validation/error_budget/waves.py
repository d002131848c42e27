"""Spectrum, drawn waves and their sums to 50 digits, and exact means by another quadrature: from docs/model.md."""

from functools import cached_property

import numpy as np
from mpmath import mp, mpf
from scipy.special import erfc, j0

from validation.error_budget.lobe import Sea
from validation.error_budget.model import Vector, bisect, dot, number, wind_speed

G, ALPHA = mpf(981), number("8.1e-3")


class Spectrum:
    """Bjerkaas and Riedel's, Eqs. 3-22, cgs; depth and fetch in m."""

    def __init__(self, w: float, depth: float | None, fetch: float | None, density: float) -> None:
        self.w = mpf(w)
        self.tension = number("76.3") / number(str(density))
        self.depth = mp.inf if depth is None else 100 * mpf(depth)
        self.fetch = None if fetch is None or fetch > 100e3 else 100 * mpf(fetch)
        self.km2 = G / self.tension
        self.p = 5 - mp.log10(self.w)
        w19 = 100 * wind_speed(self.w, number("19.5"))
        self.k0 = mp.sqrt(2 * number("0.74") / 3) * G / w19**2
        rate = (20 * mp.pi)**2
        self.k2 = bisect(mpf(0), rate / G, lambda k: G * k + self.tension * k**3 >= rate)
        self.shoulder = self.k2 * (1 + self.k2**2 / self.km2)
        self.k_min = mpf(10)**(number("-2.108") * mp.log10(self.w) - number("0.267"))

    @cached_property
    def k1(self) -> mpf:
        """The smallest root of Eq. 8 up to k2, k2 where there is none."""
        scale = ((ALPHA / number("0.875"))**2 * (G / (4 * mp.pi**2))**(self.p - 1) * self.shoulder**(self.p - 4))

        def right(k: mpf) -> mpf:
            x = k**2 / self.km2
            return scale * (1 + x)**5 / (1 + 3 * x)**2

        def rises(k: mpf) -> bool:
            x = k**2 / self.km2
            return right(k) * k / self.km2 * (10 / (1 + x) - 12 / (1 + 3 * x)) > 1

        lowest = bisect(mpf(0), self.k2, rises) if rises(self.k2) else self.k2
        return self.k2 if right(lowest) > lowest else bisect(mpf(0), lowest, lambda k: right(k) <= k)

    def k_max(self, footprint: float | None) -> mpf:
        """Eq. 22 as read."""
        shortest = mpf(0) if footprint is None else mp.pi / (100 * mpf(footprint))
        return min(self.k2, max(shortest, mp.sqrt(10) * self.k_min))

    def frequency(self, k: mpf) -> mpf:
        """Eq. 4."""
        deep = mpf(1) if mp.isinf(self.depth) else mp.tanh(k * self.depth)
        return mp.sqrt((G * k + self.tension * k**3) * deep)

    def density(self, k: mpf) -> mpf:
        """S, cm^3."""
        stacey = ((number("271.5") + number("13.585") * self.w) * mp.sqrt(G / k)
                  * mp.exp(number("2.53") * (number("0.4") * mp.pi - mp.sqrt(G * k))))
        if k > self.k1:
            x = k**2 / self.km2
            s = (number("0.4375") * (2 * mp.pi / mp.sqrt(G))**(self.p - 1) * (1 + 3 * x)
                 * self.shoulder**((4 - self.p) / 2) * (k * (1 + x))**(-mpf(5) / 2))
            return max(s, stacey) if self.w >= number("75.76") else s
        s = ALPHA / (2 * k**3) * mp.exp(-3 * self.k0**2 / (2 * k**2))
        if self.fetch is not None:
            peak = 22 * mp.cbrt(G**2 / (self.fetch * 100 * wind_speed(self.w, mpf(10))))
            off = self.frequency(k) - peak
            s *= number("3.3")**mp.exp(-off**2 / (number("0.0098" if off <= 0 else "0.0162") * peak**2))
        return max(s, stacey) if k > self.k0 and self.w >= number("35.8") else s

    def amplitude(self, k: mpf, azimuth: mpf, footprint: float | None, count: int) -> mpf:
        """Eqs. 36-38 for an azimuth from the wind's, m."""
        extent = mp.log(self.k_max(footprint) / self.k_min)
        spreading = number("1.6") / mp.pi * mp.cos(azimuth)**2 + number("0.2") / mp.pi
        return mp.sqrt(2 * mp.pi * extent / count * self.density(k) * spreading * k) / 100


def waves_at(waves: list[list[float]], place: Vector, time: float, footprint: float | None = None) -> Vector:
    """Height, slopes and acceleration, Eqs. 31-40 and 52, of waves given by k, psi, phi, a and omega; where a
    footprint is given, of what stays geometry there."""
    sums = [[], [], [], []]
    for k, psi, phi, a, omega in (map(mpf, wave) for wave in waves):
        if footprint is not None:
            share = number("0.5") - mp.log(k * mpf(footprint) / mp.pi, 2)
            a *= mp.sqrt(min(mpf(1), max(mpf(0), share)))
        if a == 0:
            continue
        kx, ky = k * mp.cos(phi), k * mp.sin(phi)
        phase = psi + omega * mpf(time) + kx * place[0] + ky * place[1]
        sin, cos = mp.sin(phase), mp.cos(phase)
        for terms, term in zip(sums, (a * cos, -a * kx * sin, -a * ky * sin, -a * omega**2 * cos), strict=True):
            terms.append(term)
    return [mp.fsum(terms) for terms in sums]


def crossing(waves: list[list[float]], origin: Vector, direction: Vector, near: mpf) -> mpf:
    """The distance along a ray, close to `near`, at which it meets the waves: Newton's method."""
    distance = near
    for _ in range(8):
        place = [o + distance * d for o, d in zip(origin, direction, strict=True)]
        height, sx, sy, _ = waves_at(waves, place[:2], 0.0)
        step = (place[2] - height) / (direction[2] - sx * direction[0] - sy * direction[1])
        distance -= step
        if abs(step) < mpf(10)**-25:
            break
    return distance


class MeanOverSlopes:
    """Exact means of the facets' f over drawn slopes, without obscuration: characteristic function and integrals on
    plain grids in float64."""

    def __init__(self, w: float, footprint: float, azimuth: float, ior: float, count: int = 5) -> None:
        self.sea = Sea({"friction_velocity": w, "footprint": footprint, "wind_direction": azimuth, "ior": ior,
                        "exact": False, "slope": False, "gram_charlier": True, "shadowing": True, "whitecaps": False,
                        "wavelength": 0.55, "stretch": 1.0})
        self.sigma = np.array([float(s) for s in self.sea.sigma])
        spectrum = Spectrum(w, None, None, 1.025)
        low, high = mp.log(spectrum.k_min), mp.log(spectrum.k_max(footprint))
        ln_k = [low + (high - low) * (n + mpf(1) / 2) / 1500 for n in range(1500)]
        # Slope of one component over the root of F, by wave number.
        size = np.sqrt(2 * np.pi * float(high - low) / count
                       * np.array([float(spectrum.density(k) * k**3) for k in map(mp.exp, ln_k)]))
        phi = (np.arange(180) + 0.5) / 180 * np.pi - np.pi / 2
        spread = np.sqrt(1.6 / np.pi * np.cos(phi)**2 + 0.2 / np.pi)
        drawn = np.sqrt(count * np.mean(size**2) / 2 * np.array([np.mean((spread * np.cos(phi))**2),
                                                              np.mean((spread * np.sin(phi))**2)]))
        self.end = 9 * drawn
        q = [np.arange(int(8 / min(s, d) / (np.pi / e)) + 2) * np.pi / e
             for s, d, e in zip(self.sigma, drawn, self.end, strict=True)]
        arguments = np.linspace(0, np.hypot(q[0][-1], q[1][-1]) * spread.max(), 6000)
        table = np.array([j0(size * t).mean() for t in arguments])
        c = np.zeros((len(q[0]), len(q[1])))
        for angle, root in zip(phi, spread, strict=True):
            for sign in (1, -1):
                along = np.abs(q[0][:, None] * np.cos(angle) + sign * q[1] * np.sin(angle))
                c += np.interp(root * along, arguments, table)
        c = (c / (2 * len(phi)))**count
        self.slopes = [np.linspace(-e, e, 2 * int(6 * e / min(s, d)) + 2)[1:]
                       for s, d, e in zip(self.sigma, drawn, self.end, strict=True)]
        wave = [np.cos(np.outer(s, f)) * (f[1] / np.pi) * np.where(f > 0, 1, 0.5)
                for s, f in zip(self.slopes, q, strict=True)]
        area = np.prod([s[1] - s[0] for s in self.slopes])
        self.weights = wave[0] @ c @ wave[1].T * area

    def mean(self, i: list[float], o: list[float]) -> float:
        """Mean of f, 1/sr."""
        cos_w, sin_w = map(float, self.sea.wind)
        i, o = (np.array([v[0] * cos_w + v[1] * sin_w, v[1] * cos_w - v[0] * sin_w, v[2]]) for v in (i, o))
        su, sc = np.meshgrid(*self.slopes, indexing="ij")
        normal = np.stack([-su, -sc, np.ones_like(su)])
        shown = np.maximum(0, np.tensordot(i, normal, 1))
        return float(np.sum(self.weights * shown * self.f(i, o, normal)) / np.sum(self.weights * shown))

    def f(self, i: np.ndarray, o: np.ndarray, normal: np.ndarray) -> np.ndarray:
        """The facets' f about many normals, everything in the wind's frame."""
        n = normal / np.sqrt(np.sum(normal**2, axis=0))
        cos = [np.tensordot(v, n, 1) for v in (i, o)]
        half = (i + o) / np.linalg.norm(i + o)
        u, c = ((np.arctan2(half[k], half[2]) - np.arctan2(n[k], n[2])) / self.sigma[k] for k in (0, 1))
        u = -u
        c21, c03 = float(self.sea.c21), float(self.sea.c03)
        factor = (1 - c21 * (c**2 - 1) * u / 2 - c03 * (u**3 - 3 * u) / 6 + 0.4 * (c**4 - 6 * c**2 + 3) / 24
                  + 0.12 * (c**2 - 1) * (u**2 - 1) / 4 + 0.23 * (u**4 - 6 * u**2 + 3) / 24)
        p = np.exp(-(u**2 + c**2) / 2) / (2 * np.pi * self.sigma[0] * self.sigma[1]) * np.maximum(factor, 0)
        lit = (cos[0] > 0) & (cos[1] > 0)
        g = 1.0
        for x in cos:
            x = np.where(lit, np.clip(x, 1e-9, 1 - 1e-12), 0.5)
            nu = x / (float(self.sea.sigma_shadow) * np.sqrt(1 - x**2))
            g = g + (np.exp(-nu**2) / (np.sqrt(np.pi) * nu) - erfc(nu)) / 2
        rho = float(self.sea.rho(mpf(float(dot(list(i), list(half))))))
        area = np.where(lit, cos[0] * cos[1], 1.0) * np.tensordot(half, n, 1)**4
        return np.where(lit, rho * p / (4 * g * area), 0.0)
