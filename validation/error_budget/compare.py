"""What the campaign `errors` printed against the reference: errors by row of the budget and by kind (float64, float32,
lanes, approximation).
"""

import json
from collections import defaultdict
from collections.abc import Callable, Iterable
from functools import lru_cache

import numpy as np
from mpmath import mp, mpc, mpf

from validation.error_budget import model
from validation.error_budget.lobe import Sea, Value
from validation.error_budget.model import exact
from validation.error_budget.waves import MeanOverSlopes, Spectrum, crossing, waves_at

#: Errors of a line: row of the budget, kind, error.
Found = Iterable[tuple[str, str, mpf]]
#: U^2 + C^2 up to which f is looked at; float32 moves directions across the edge.
REACH = 55.01
#: Below it float32 has not four digits left.
FAINT = 1e-34


def relative(found: float, expected: mpf) -> mpf:
    """The error over the value; 0 where both are 0."""
    return abs(found - expected) / abs(expected) if expected else abs(mpf(found))


@lru_cache(maxsize=2)
def spectrum_of(*sea: float | None) -> Spectrum:
    """Its wave numbers are found once for the lines of a sea."""
    return Spectrum(*sea)


class Comparison:
    """Errors, gathered line by line."""

    def __init__(self) -> None:
        self.seas: dict[int, Sea] = {}
        self.mesh: list[list[float]] = []
        self.means: dict[tuple, MeanOverSlopes] = {}
        self.double: Value | None = None
        self.errors: dict[tuple[str, str], list[float]] = defaultdict(list)
        self.errors["index", "approximation"] = [float(error) for error in model.index_between_entries()]

    def read(self, lines: Iterable[str]) -> None:
        """Compares every line."""
        for text in lines:
            line = json.loads(text)
            if "sea" in line:
                self.seas[line["sea"]] = Sea(line)
            elif "waves" in line:
                self.mesh = line["waves"]
            else:
                for row, kind, error in getattr(self, line["stage"])(line["x"], line["y"]):
                    self.errors[row, kind].append(float(error))

    def of(self, row: str, kind: str) -> tuple[float, float] | None:
        """Median and largest error; nothing where nothing was compared."""
        errors = self.errors.get((row, kind))
        return (float(np.median(errors)), max(errors)) if errors else None

    @staticmethod
    def each(row: str, y: dict, expected: list[mpf], error: Callable[[float, mpf], mpf]) -> Found:
        """An error for every kind and every value."""
        for kind, values in y.items():
            for found, value in zip(values, expected, strict=True):
                yield row, kind, error(found, value)

    # Functions of a few numbers.

    def wind(self, x, y) -> Found:
        yield from self.each("wind", y, [model.wind_speed(*exact(x))], relative)

    def inverse(self, x, y) -> Found:
        speed, height = exact(x)
        yield "inverse", "float64", relative(model.wind_speed(mpf(y["float64"][0]), height), speed)

    def variances(self, x, y) -> Found:
        expected = model.variances(mpf(x[0]), mp.inf if x[1] is None else mpf(x[1]))
        yield from self.each("variances", y, expected, relative)

    def skewness(self, x, y) -> Found:
        yield from self.each("skewness", y, model.skewness(mpf(x[0])), lambda a, b: abs(a - b))

    def gram_charlier(self, x, y) -> Found:
        yield from self.each("gram_charlier", y, [model.gram_charlier(*exact(x))], lambda a, b: abs(a - b))

    def schlick(self, x, y) -> Found:
        rho = model.schlick(*exact(x))
        yield from self.each("schlick", y, [rho], relative)
        if "float64" in y and 1.3 < x[0] < 1.4:
            yield "schlick_choice", "approximation", relative(rho, model.fresnel(*exact(x)))

    def fresnel(self, x, y) -> Found:
        yield from self.each("fresnel", y, [model.fresnel(*exact(x))], relative)

    def absorbing(self, x, y) -> Found:
        ior, extinction, cos = exact(x)
        yield from self.each("absorbing", y, [model.fresnel(mpc(ior, extinction), cos)], relative)

    def index(self, x, y) -> Found:
        yield from self.each("index", y, [model.index(mpf(x[0]))], relative)

    def ierfc(self, x, y) -> Found:
        value = model.ierfc(mpf(x[0]))
        yield from self.each("ierfc", y, [value], lambda a, b: abs(a - b) / (mpf(x[0]) + b / 2))

    def hidden(self, x, y) -> Found:
        value = model.hidden(*exact(x))
        yield from self.each("hidden", y, [value], lambda a, b: abs(a - b) / (x[0] + b))

    def foam(self, x, y) -> Found:
        yield from self.each("foam", y, [model.foam(mpf(x[0]))], relative)

    def breaking(self, x, y) -> Found:
        yield from self.each("breaking", y, [model.breaking(*exact(x))], lambda a, b: abs(a - b))

    def foam_brdf(self, x, y) -> Found:
        yield from self.each("foam_brdf", y, [model.foam_brdf(mpf(x[0]))], relative)

    # The BRDF.

    def values(self, x) -> list[Value]:
        """f of every sea of a line; none where the half vector lies beyond what is looked at."""
        ids, *directions = x
        values = [self.seas[number].f(*map(exact, directions)) for number in ids]
        return values if all(FAINT < value.size and value.reach < REACH for value in values) else []

    def gaussian(self, x, y) -> Found:
        for value in self.values(x):
            for kind, (found,) in y.items():
                error = relative(found, value.f)
                yield "gaussian", kind, error
                # Of float32 it would be the result's rounding: its tilts have digits to spare.
                if kind == "float64" and value.reach > 1:
                    yield "tilts", kind, error / value.reach

    def shadowing(self, x, y) -> Found:
        if values := self.values(x):
            with_g, without = values
            for kind, found in y.items():
                yield "shadowing", kind, relative(mpf(found[0]) / mpf(found[1]), with_g.f / without.f)

    def steep(self, x, y) -> Found:
        value, = [self.seas[number].f(*map(exact, x[1:])) for number in x[0]]
        if value.f > FAINT:
            yield from self.each("steep", y, [value.f], relative)

    def f(self, x, y) -> Found:
        # A line in float64 is followed by the same directions rounded to float32.
        value = self.seas[x[0][0]].f(*map(exact, x[1:]))
        if "float64" in y:
            self.double = value
        elif value.size:
            yield "rounded", "float32", mp.hypot(value.u - self.double.u, value.c - self.double.c)
        if FAINT < value.size and value.reach < REACH:
            for kind, (found,) in y.items():
                yield "f", kind, abs(found - value.f) / value.size
                if value.f > value.size / 10:
                    yield "f_itself", kind, relative(found, value.f)

    def f_tilted(self, x, y, row="f_tilted") -> Found:
        for value in self.values(x):
            for kind, (found,) in y.items():
                yield row, kind, abs(found - value.f) / value.size

    def f_foamy(self, x, y) -> Found:
        yield from self.f_tilted(x, y, "f_foamy")

    def pdf(self, x, y) -> Found:
        (number,), i, o, _ = x
        expected = self.seas[number].pdf(exact(i), exact(o))
        if expected > FAINT:
            yield from self.each("pdf", y, [expected], relative)

    def draw(self, x, y) -> Found:
        number, i, u = x
        expected = self.seas[number].draw(exact(i), exact(u))
        for kind, found in y.items():
            if expected[2] > 0 and any(found):
                off = [a - b for a, b in zip(found, expected, strict=True)]
                yield "draw", kind, mp.sqrt(model.dot(off, off))

    # Waves.

    def wave_numbers(self, x, y) -> Found:
        *sea, footprint, _ = x
        s = spectrum_of(*sea)
        yield from self.each("wave_numbers", y, [s.k0, s.k1, s.k2, s.k_min, s.k_max(footprint)], relative)

    def spectrum(self, x, y) -> Found:
        *sea, _, k = x
        s = spectrum_of(*sea)
        density, frequency = y["float64"]
        yield "spectrum", "float64", relative(density, s.density(mpf(k)))
        yield "dispersion", "float64", relative(frequency, s.frequency(mpf(k)))

    def component(self, x, y) -> Found:
        *sea, footprint, k, azimuth = x
        amplitude = spectrum_of(*sea).amplitude(mpf(k), mpf(azimuth), footprint, 5)
        yield "component", "float64", relative(y["float64"][0], amplitude)

    def sine(self, x, y) -> Found:
        angle = mpf(x[0])
        yield from self.each("sine", y, [mp.sin(angle), mp.cos(angle)], lambda a, b: abs(a - b))

    def sum(self, x, y) -> Found:
        waves, place, time = x
        expected = waves_at(waves, exact(place), time)
        spread = [np.sqrt(sum((a * factor)**2 for _, _, _, a, _, factor in rows) / 2) for rows in (
            [(*w, 1) for w in waves], [(*w, w[0]) for w in waves], [(*w, w[0]) for w in waves],
            [(*w, w[4]**2) for w in waves])]
        names = ("height", "slope", "slope", "acceleration")
        for kind, found in y.items():
            for name, a, b, s in zip(names, found, expected, spread, strict=True):
                yield name, kind, abs(a - b) / s

    def cast(self, x, y) -> Found:
        waves, origin, direction = x
        origin, direction, hit = exact(origin), exact(direction), exact(y["float64"])
        near = model.dot([h - o for h, o in zip(hit, origin, strict=True)], direction) / model.dot(direction, direction)
        distance = crossing(waves, origin, direction, near)
        off = [h - o - distance * d for h, o, d in zip(hit, origin, direction, strict=True)]
        yield "cast", "float64", mp.sqrt(model.dot(off, off))

    def mesh_vertex(self, x, y) -> Found:
        place, time, footprint = x
        height, sx, sy, _ = waves_at(self.mesh, exact(place), time, footprint)
        n = 1 / mp.sqrt(1 + sx**2 + sy**2)
        z, *normal = y["float32"]
        yield "mesh", "float32", abs(z - height)
        off = [a - b for a, b in zip(normal, (-sx * n, -sy * n, n), strict=True)]
        yield "mesh_normal", "float32", mp.sqrt(model.dot(off, off))

    # Means.

    def exact(self, x, y) -> Found:
        *sea, i, o = x
        if tuple(sea) not in self.means:
            self.means[tuple(sea)] = MeanOverSlopes(*sea)
        yield "exact", "approximation", relative(y["float64"][0], mpf(self.means[tuple(sea)].mean(i, o)))

    def ensemble(self, x, y) -> Found:
        _, theta, expected = x
        row = "ensemble" if theta < 60.001 else "ensemble_low"
        yield row, "approximation", relative(y["float64"][0], mpf(expected))

    def empirical(self, x, y) -> Found:
        yield "empirical", "approximation", relative(y["float64"][0], mpf(x[1]))
        yield "empirical", "float32", relative(y["float32"][0], mpf(y["float64"][0]))
