"""f and the density of draws to 50 digits, written from docs/model.md alone. Inputs are taken as the exact values of their
floats.
"""

from functools import cached_property
from typing import NamedTuple

from mpmath import mp, mpf

from validation.error_budget.model import (Vector, bisect, dot, foam, foam_brdf, fresnel, gram_charlier, hidden,
                                           number, schlick, skewness, variances, wind_speed)


class Value(NamedTuple):
    """f, what it is without Gram-Charlier's factor, and the tilt."""

    f: mpf
    size: mpf
    u: mpf
    c: mpf

    @property
    def reach(self) -> mpf:
        """U^2 + C^2."""
        return self.u**2 + self.c**2


class Sea:
    """The closed form of one sea, from its parameters."""

    def __init__(self, line: dict) -> None:
        self.line = line
        self.w, self.ior = mpf(line["friction_velocity"]), mpf(line["ior"])
        footprint = line["footprint"]
        self.w10 = wind_speed(self.w, mpf(10))
        self.variances = variances(self.w, mp.inf if footprint is None else mpf(footprint))
        self.sigma = [mp.sqrt(v) for v in self.variances]
        azimuth = mpf(line["wind_direction"]) * mp.pi / 180
        self.wind = mp.cos(azimuth), mp.sin(azimuth)
        self.c21, self.c03 = skewness(self.w)
        self.sigma_shadow = mp.sqrt(number("5.34e-3") * self.w10)
        self.foam = foam(self.w10) if line["whitecaps"] else mpf(0)
        # The proposal's widening goes in steps of 0.02.
        stretch = mpf(round(50 * line["stretch"])) / 50
        self.proposal = [stretch * s for s in self.sigma]

    def rho(self, cos: mpf) -> mpf:
        """Of a facet."""
        return fresnel(self.ior, cos) if self.line["exact"] else schlick(self.ior, cos)

    @cached_property
    def steep(self) -> tuple[mpf, mpf]:
        """The tilt's cosine from which exp(-xi^2/2 sigma^2)/cos^4 xi rises, and 1/cos^4 there."""
        variance = max(self.variances)
        cos = mp.cos(bisect(number("0.1"), mp.pi / 2, lambda xi: 4 * mp.tan(xi) > xi / variance))
        return cos, cos**-4

    @cached_property
    def bounded(self) -> bool:
        """Whether rho G (1 + Lambda) passes 1.11 at any two of 65 elevations."""
        if not self.line["shadowing"]:
            return False
        spread = mp.sqrt(2 * max(self.variances))
        elevations = [(90 * mpf(10)**(mpf(-6 * k) / 64)) * mp.pi / 180 for k in range(65)]

        def terms(sigma: mpf) -> list[float]:
            return [float(hidden(mp.sin(e), sigma * mp.cos(e)) / mp.sin(e)) for e in elevations]

        shadow, own = terms(self.sigma_shadow), terms(spread)
        # rho is at most 1, which settles most pairs.
        return any(1 + own[a] > 1.11 * (1 + shadow[a] + shadow[b])
                   and float(self.rho(mp.sin((elevations[a] + elevations[b]) / 2))) * (1 + own[a])
                   > 1.11 * (1 + shadow[a] + shadow[b]) for a in range(65) for b in range(a + 1))

    def in_wind(self, x: mpf, y: mpf) -> Vector:
        """Components along W_u and W_c, Eq. 68."""
        return [x * self.wind[0] + y * self.wind[1], y * self.wind[0] - x * self.wind[1]]

    def tilts(self, half: Vector, n: Vector) -> Vector:
        """U and C of a half vector of any length, Eqs. 69-73."""
        angles = []
        for h, m in zip(self.in_wind(*half[:2]), self.in_wind(*n[:2]), strict=True):
            angles.append(mp.atan2(h, half[2]) - mp.atan2(m, n[2]))
        if self.line["slope"]:
            angles = [mp.tan(a) for a in angles]
        return [-angles[0] / self.sigma[0], angles[1] / self.sigma[1]]

    def f(self, i: Vector, o: Vector, n: Vector) -> Value:
        """f, 1/sr. Directions are unit vectors to a rounding: Eq. 61 is half the length of V_s + V_r, which suffers
        least from that."""
        cos_i, cos_r = dot(i, n), dot(o, n)
        if cos_i <= 0 or cos_r <= 0:
            return Value(mpf(0), mpf(0), mpf(0), mpf(0))
        half = [a + b for a, b in zip(i, o, strict=True)]
        length = mp.sqrt(dot(half, half))
        u, c = self.tilts(half, n)
        density = self.density(u, c, dot(half, n) / length)
        visible = self.rho(length / 2) * self.shadowing(i, o, n, cos_i, cos_r, self.rho(length / 2))
        smooth = density * visible / (4 * cos_i * cos_r)
        factor = max(mpf(0), gram_charlier(self.c21, self.c03, u, c)) if self.line["gram_charlier"] else mpf(1)
        foam = self.foam * foam_brdf(mpf(self.line["wavelength"]))
        return Value((1 - self.foam) * smooth * factor + foam, (1 - self.foam) * smooth + foam, u, c)

    def density(self, u: mpf, c: mpf, cos_xi: mpf) -> mpf:
        """p0/cos^4 xi, Eq. 72, with 1/cos^4 kept where facets are steep."""
        gauss = mp.exp(-(u**2 + c**2) / 2)
        p = gauss / cos_xi**4
        if not self.line["slope"] and cos_xi < self.steep[0]:
            p = min(p, max(gauss * self.steep[1], number("1e-6")))
        return p / (2 * mp.pi * self.sigma[0] * self.sigma[1])

    def shadowing(self, i: Vector, o: Vector, n: Vector, cos_i: mpf, cos_r: mpf, rho: mpf) -> mpf:
        """G, held to what the facets' own roughness leaves visible."""
        if not self.line["shadowing"]:
            return mpf(1)
        terms = [hidden(cos, self.sigma_shadow * mp.sqrt(max(mpf(0), 1 - cos**2))) / cos for cos in (cos_i, cos_r)]
        g = 1 / (1 + terms[0] + terms[1])
        if not self.bounded:
            return g
        own = []
        for v, cos in ((i, cos_i), (o, cos_r)):
            a, b = self.in_wind(v[0] * n[2] - v[2] * n[0], v[1] * n[2] - v[2] * n[1])
            own.append(hidden(cos, mp.sqrt(2 * ((a * self.sigma[0])**2 + (b * self.sigma[1])**2))) / cos)
        bound = number("0.99") / (1 if self.line["slope"] else 1 + 3 * (self.variances[0] + self.variances[1]))
        return min(g, bound / (1 + max(own)) / rho)

    # Draws, about the vertical.

    def source(self, i: Vector) -> tuple[Vector, Vector, mpf]:
        """The source in the wind's frame, the components of z that make r D, and D."""
        x, y = self.in_wind(*i[:2])
        towards = [x * self.proposal[0] / i[2], y * self.proposal[1] / i[2]]
        return [x, y, i[2]], towards, mp.sqrt(dot(towards, towards))

    def pdf(self, i: Vector, o: Vector) -> mpf:
        """Density of draws, 1/sr."""
        source, towards, d = self.source(i)
        half = [a + b for a, b in zip(i, o, strict=True)]
        length = mp.sqrt(dot(half, half))
        h = [x / length for x in self.in_wind(*half[:2]) + [half[2]]]
        cos = dot(source, h)
        flat = mp.sqrt(h[0]**2 + h[1]**2)
        if self.line["slope"]:
            tilt, jacobian = [h[0] / h[2], h[1] / h[2]], h[2]**3
        else:
            over_sine = mp.atan2(flat, h[2]) / flat if flat else mpf(1)
            tilt, jacobian = [h[0] * over_sine, h[1] * over_sine], 1 / over_sine
        z = [t / s for t, s in zip(tilt, self.proposal, strict=True)]
        phi = mp.exp(-dot(z, z) / 2) / (2 * mp.pi)
        r_d, v = dot(z, towards), 1 / d
        shown, turned = max(mpf(0), cos), max(mpf(0), source[2] * h[2] - source[0] * h[0] - source[1] * h[1])
        weight = 2 * shown / (shown + turned)
        if r_d > 1:
            weight += (r_d - 1) * mp.exp(v * (r_d / d - v))
        normal = 1 + d * mp.npdf(v)
        return phi * weight / normal / (self.proposal[0] * self.proposal[1]) / jacobian / (4 * cos)

    def draw(self, i: Vector, u: Vector) -> Vector:
        """The observer's direction of three uniform numbers."""
        source, towards, d = self.source(i)
        v = 1 / d
        tail = d * mp.npdf(v)
        scaled = u[0] * (1 + tail)
        rayleigh = mp.sqrt(-2 * mp.log(1 - u[1]))
        if scaled < tail:
            across = mp.sqrt(-2 * mp.log(1 - u[2])) * mp.cos(2 * mp.pi * scaled / tail)
            r, q, rest = v + rayleigh, across, None
        else:
            r, q, rest = rayleigh * mp.cos(2 * mp.pi * u[2]), rayleigh * mp.sin(2 * mp.pi * u[2]), scaled - tail
        e = [t / d for t in towards]
        tilt = [(e[0] * r - e[1] * q) * self.proposal[0], (e[1] * r + e[0] * q) * self.proposal[1]]
        size = mp.sqrt(dot(tilt, tilt))
        angle = mp.atan(size) if self.line["slope"] else size
        h = [tilt[0] / size * mp.sin(angle), tilt[1] / size * mp.sin(angle), mp.cos(angle)]
        areas = [max(mpf(0), h[2] * source[2] + s * (h[0] * source[0] + h[1] * source[1])) for s in (1, -1)]
        if rest is not None and rest * (areas[0] + areas[1]) < areas[1]:
            h = [-h[0], -h[1], h[2]]
        c = 2 * dot(source, h)
        x, y, z = (c * a - b for a, b in zip(h, source, strict=True))
        return [x * self.wind[0] - y * self.wind[1], x * self.wind[1] + y * self.wind[0], z]
