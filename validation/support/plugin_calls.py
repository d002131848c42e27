"""Calls of the plugin's BSDF in any variant, for its tests: directions, values, draws, operations."""

import drjit as dr
import numpy as np

from validation.support.core import direction
from validation.support.mitsuba_setup import load_plugin

CPU_VARIANTS = [
    "scalar_rgb", "scalar_spectral", "scalar_spectral_polarized", "llvm_ad_rgb", "llvm_ad_mono",
    "llvm_ad_mono_polarized", "llvm_ad_spectral", "llvm_ad_spectral_polarized",
]
BOTH = ["scalar_rgb", "llvm_ad_rgb"]
I, O = direction(40.0, 200.0), direction(35.0, 15.0)


def interaction(mi, i=I):
    """With the source in a direction."""
    si = dr.zeros(mi.SurfaceInteraction3f) if dr.is_jit_v(mi.Float) else mi.SurfaceInteraction3f()
    si.wi = mi.Vector3f([float(x) for x in i])
    return si


def value(mi, bsdf, context=None, i=I, o=O, **mask):
    """f cos(theta_o) as one number."""
    result = bsdf.eval(context or mi.BSDFContext(), interaction(mi, i), mi.Vector3f([float(x) for x in o]), **mask)
    return float(np.array(result).ravel()[0])


def matrix(mi, bsdf, i, o, context, wavelengths=None):
    """f cos(theta_o) as Mueller matrices, the lanes last and one of them kept unless wavelengths in nm are given; a number in
    variants without polarisation."""
    si = interaction(mi, i)
    if wavelengths is not None:
        si.wavelengths = wavelengths
    value = np.array(bsdf.eval(context, si, mi.Vector3f([float(x) for x in o])), dtype=np.float64)
    value = value.reshape(*(4, 4)[: 2 * mi.is_polarized], -1)
    return value if wavelengths is not None else value[..., 0]


def draw_one(mi, bsdf, i, u, context):
    """Direction, density and weight of one draw, the weight as `matrix` has it."""
    sample, weight = bsdf.sample(context, interaction(mi, i), float(u[0]), mi.Point2f(float(u[1]), float(u[2])))
    weight = np.array(weight, dtype=np.float64).reshape(*(4, 4)[: 2 * mi.is_polarized], -1)[..., 0]
    return np.array(sample.wo).ravel(), number(sample.pdf), weight


def number(x):
    """The first of an array's numbers."""
    return float(np.array(x).ravel()[0])


def by_angle(mi, bsdf):
    """The value for a direction to the observer that an angle turns, as a function of it."""
    def f(angle):
        si = dr.zeros(mi.SurfaceInteraction3f)
        si.wi = mi.Vector3f(I.tolist())
        return bsdf.eval(mi.BSDFContext(), si, mi.Vector3f(dr.sin(angle), 0.1, dr.sqrt(0.99 - dr.sin(angle) ** 2)))[0]

    return f


def evaluate(mi, bsdf, i, o, mode="Radiance"):
    """f cos(theta_o) and the density of the plugin for rows of directions, in any variant. In mode Importance the light is at
    i, in mode Radiance at o, which matters where a surface is not reciprocal."""
    context = mi.BSDFContext(getattr(mi.TransportMode, mode))
    if dr.is_jit_v(mi.Float):
        si = dr.zeros(mi.SurfaceInteraction3f, len(i))
        si.wi = mi.Vector3f(np.ascontiguousarray(i.T))
        value, pdf = bsdf.eval_pdf(context, si, mi.Vector3f(np.ascontiguousarray(o.T)))
        return np.array(value)[0], np.array(pdf)
    si, rows = mi.SurfaceInteraction3f(), []
    for a, b in zip(i.tolist(), o.tolist()):
        si.wi = mi.Vector3f(a)
        value, pdf = bsdf.eval_pdf(context, si, mi.Vector3f(b))
        rows.append((value[0], pdf))
    value, pdf = np.array(rows).T
    return value, pdf


def draw(mi, bsdf, i, uniform, mode="Radiance"):
    """Directions and weights that `sample` gives, in any variant."""
    context = mi.BSDFContext(getattr(mi.TransportMode, mode))
    if dr.is_jit_v(mi.Float):
        si = dr.zeros(mi.SurfaceInteraction3f, len(i))
        si.wi = mi.Vector3f(np.ascontiguousarray(i.T))
        u = [mi.Float(np.ascontiguousarray(uniform[:, k])) for k in range(3)]
        sample, weight = bsdf.sample(context, si, u[0], mi.Point2f(u[1], u[2]))
        keep = np.array(sample.pdf) > 0
        return np.array(sample.wo).T * keep[:, None], np.array(weight)[0]
    si, rows = mi.SurfaceInteraction3f(), []
    for a, u in zip(i.tolist(), uniform.tolist()):
        si.wi = mi.Vector3f(a)
        sample, weight = bsdf.sample(context, si, u[0], mi.Point2f(u[1], u[2]))
        rows.append([*sample.wo, weight[0]])
    rows = np.array(rows)
    return rows[:, :3], rows[:, 3]


def interactions(mi, i, count):
    """Interactions with the source in the direction `i` of a frame that is set."""
    si = dr.zeros(mi.SurfaceInteraction3f, count)
    si.wi = mi.Vector3f([float(x) for x in i])
    si.sh_frame = mi.Frame3f([1, 0, 0], [0, 1, 0], [0, 0, 1])
    return si


def adapter(mi, parameters, i, context):
    """`sample` and `pdf` as Mitsuba's chi-square test wants them. A draw counts where it has a density, be
    its weight zero (Gram-Charlier's clamp) or not."""
    bsdf = mi.load_dict({"type": "prob_water", **parameters})

    def sample(u):
        drawn, _ = bsdf.sample(context, interactions(mi, i, dr.width(u)), u[0], mi.Point2f(u[1], u[2]))
        return drawn.wo, dr.select(drawn.pdf > 0, mi.Float(1), 0)

    def pdf(o):
        return bsdf.pdf(context, interactions(mi, i, dr.width(o)), o)

    return sample, pdf


def glints(rng, count):
    """Pairs of directions whose half vectors lean up to 30 degrees, to 85 degrees from the vertical."""
    h = direction(30 * np.sqrt(rng.random(8 * count)), rng.uniform(0, 360, 8 * count))
    i = direction(rng.uniform(0, 85, 8 * count), rng.uniform(0, 360, 8 * count))
    o = 2 * np.sum(i * h, axis=1, keepdims=True) * h - i
    keep = np.flatnonzero(o[:, 2] > 0.087)[:count]
    return [(v[keep] / np.linalg.norm(v[keep], axis=1, keepdims=True)).astype(np.float32) for v in (i, o)]


def operations(parameters: dict) -> dict[str, int]:
    """Operation count of the kernel of each call, for a BSDF of these parameters."""
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb")
    load_plugin()
    bsdf, context = mi.load_dict({"type": "prob_water", **parameters}), mi.BSDFContext()
    found = {}
    with dr.scoped_set_flag(dr.JitFlag.KernelHistory, True):
        for call in ("eval", "pdf", "sample"):
            t = mi.Float(np.linspace(0, 0.5, 1000, dtype=np.float32))
            si = dr.zeros(mi.SurfaceInteraction3f, 1000)
            si.wi, wo, u = mi.Vector3f(t, 0, 0.8), mi.Vector3f(t + 0.1, 0.1, 0.8), 2 * t
            dr.eval(si, wo, u)
            dr.kernel_history_clear()
            if call == "sample":
                dr.eval(bsdf.sample(context, si, u, mi.Point2f(u, u)))
            else:
                dr.eval(getattr(bsdf, call)(context, si, wo))
            kernels = [k for k in dr.kernel_history() if k["type"] == dr.KernelType.JIT]
            found[call] = sum(k["operation_count"] for k in kernels)
    return found
