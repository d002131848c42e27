"""The Rust core in float64, through its C interface: what everything else is compared with."""

import ctypes

import numpy as np

from validation.support.paths import ROOT

LIBRARY = ROOT / "target/release/libprob_water.so"


def _load():
    if not LIBRARY.exists():
        raise FileNotFoundError(f"{LIBRARY} is missing: run `cargo xtask c-test`")
    capi = ctypes.CDLL(str(LIBRARY))
    pointer, text, size = ctypes.c_void_p, ctypes.c_char_p, ctypes.c_size_t
    capi.prob_water_last_error.restype = text
    capi.prob_water_options_new.restype = pointer
    for name, arguments in {
        "options_set": [pointer, text, text],
        "configure": [pointer, ctypes.POINTER(pointer)],
        "options_free": [pointer],
        "free": [pointer],
        "summary": [pointer, pointer],
        "eval": [pointer, size, pointer, pointer, pointer, pointer],
        "pdf": [pointer, size, pointer, pointer, pointer, pointer],
        "sample": [pointer, size] + [pointer] * 5,
        "estimate": [pointer, size] + [pointer] * 5,
    }.items():
        getattr(capi, f"prob_water_{name}").argtypes = arguments
    return capi


class Core:
    """A configured sea. Directions are arrays of shape (n, 3)."""

    capi = None

    def __init__(self, **parameters):
        Core.capi = Core.capi or _load()
        options, self.handle = self.capi.prob_water_options_new(), ctypes.c_void_p()
        try:
            for name, value in parameters.items():
                text = str(value).lower() if isinstance(value, bool) else str(value)
                self._check(self.capi.prob_water_options_set(options, name.encode(), text.encode()))
            self._check(self.capi.prob_water_configure(options, ctypes.byref(self.handle)))
        finally:
            self.capi.prob_water_options_free(options)
        summary = np.empty(6)
        self._check(self.capi.prob_water_summary(self.handle, summary.ctypes.data))
        #: cm/s, m/s, and the facets' slope variances along and across the wind
        self.friction_velocity, self.wind_speed_10, self.sigma_u2, self.sigma_c2 = summary[:4]
        self.whitecap_fraction, self.ior = summary[4:]

    def __del__(self):
        if Core.capi and getattr(self, "handle", None):
            Core.capi.prob_water_free(self.handle)

    def _check(self, status):
        if status != 0:
            raise ValueError(self.capi.prob_water_last_error().decode())

    def _batch(self, call, i, o):
        i, o = (np.ascontiguousarray(v, dtype=np.float64).reshape(-1, 3) for v in (i, o))
        i, o = (np.ascontiguousarray(v) for v in np.broadcast_arrays(i, o))
        out = np.empty(len(i))
        self._check(call(self.handle, len(i), i.ctypes.data, o.ctypes.data, None, out.ctypes.data))
        return out

    def f(self, i, o):
        """The BRDF, 1/sr."""
        return self._batch(self.capi.prob_water_eval, i, o)

    def pdf(self, i, o):
        """Density of the observer's direction among draws for the source's, 1/sr."""
        return self._batch(self.capi.prob_water_pdf, i, o)

    def estimate(self, i, o):
        """Mean of f and its standard uncertainty, 1/sr, by the empirical model, and where they lie outside of the table."""
        i, o = (np.ascontiguousarray(v, dtype=np.float64).reshape(-1, 3) for v in np.broadcast_arrays(i, o))
        mean, std, outside = np.empty(len(i)), np.empty(len(i)), np.empty(len(i), dtype=np.uint8)
        self._check(self.capi.prob_water_estimate(self.handle, len(i), *(a.ctypes.data for a in (i, o, mean, std, outside))))
        return mean, std, outside.astype(bool)

    def albedo(self, i, steps=600):
        """Integral of f cos(theta_o) over the observer's hemisphere: midpoints in the half vector's tilts."""
        i = np.asarray(i, dtype=np.float64)
        x = (np.arange(steps) + 0.5) / steps * 2 - 1

        def nodes(sigma):
            end = np.arcsinh(0.5 * np.pi / (4 * sigma))
            return 4 * sigma * np.sinh(x * end), 4 * sigma * np.cosh(x * end) * end * 2 / steps

        (a, wa), (b, wb) = nodes(np.sqrt(self.sigma_u2)), nodes(np.sqrt(self.sigma_c2))
        tu, tc = (t.ravel() for t in np.meshgrid(np.tan(a), np.tan(b), indexing="ij"))
        weight = np.outer(wa, wb).ravel()
        cos = 1 / np.sqrt(1 + tu**2 + tc**2)
        half = np.stack([tu * cos, tc * cos, cos], axis=1)
        c = half @ i
        o = 2 * c[:, None] * half - i
        keep = (c > 0) & (o[:, 2] > 0)
        jacobian = 4 * c * cos**3 * (1 + tu**2) * (1 + tc**2)
        o /= np.linalg.norm(o, axis=1, keepdims=True)
        return float(np.sum((self.f(i, o[keep]) * o[keep, 2] * (jacobian * weight)[keep])))


def direction(theta, phi):
    """Unit vectors of polar and azimuth angles in degrees."""
    t, p = np.radians(theta), np.radians(phi)
    return np.stack(np.broadcast_arrays(np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)), axis=-1)


def pairs(core, count, rng, wind_direction=0.0, reach=3.5, grazing=88.0, slopes=False):
    """Directions to source and observer in float32 whose half vector is tilted by up to about `reach`
    standard deviations (of tilt angles or slopes), the source from overhead to `grazing` degrees; those
    that leave the hemisphere are drawn again."""
    found = []
    while sum(map(len, found)) < count:
        i = direction(rng.uniform(0, grazing, count), rng.uniform(0, 360, count))
        r, psi = reach * np.sqrt(rng.uniform(0, 1, count)), rng.uniform(0, 2 * np.pi, count)
        tu, tc = np.sqrt(core.sigma_u2) * r * np.cos(psi), np.sqrt(core.sigma_c2) * r * np.sin(psi)
        level = np.maximum(np.abs(tu), np.abs(tc)) < 0.5 * np.pi
        if not slopes:
            tu, tc = np.tan(tu), np.tan(tc)
        w = np.radians(wind_direction)
        half = np.stack([tu * np.cos(w) - tc * np.sin(w), tu * np.sin(w) + tc * np.cos(w), np.ones(count)], axis=1)
        half /= np.linalg.norm(half, axis=1, keepdims=True)
        o = 2 * np.sum(half * i, axis=1, keepdims=True) * half - i
        i, o = i.astype(np.float32), o.astype(np.float32)
        keep = (o[:, 2] > np.cos(np.radians(grazing))) & (np.sum(half * i, axis=1) > 0) & (slopes | level)
        found.append(np.concatenate([i, o], axis=1)[keep])
    both = np.concatenate(found)[:count]
    return both[:, :3], both[:, 3:]
