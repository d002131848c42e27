"""The float32 of the plugin against the core in float64 on the same inputs.

As a script it writes the table docs/float32.md. The error is relative to the lobe without
Gram-Charlier, whose clamp crosses zero. It stays below 1e-4, and 1e-5 in the median, for tilts with
U^2 + C^2 < 55 and slope standard deviations from 1e-3; in the scalar variants, which compute more in
float64, below 5e-5. Up there the polynomial multiplies single roundings by up to 130.
"""

import sys

import numpy as np

from validation.support.core import Core, pairs
from validation.support.paths import ROOT
from validation.support.plugin_calls import evaluate

WINDS = (0.0, 2.0, 8.0, 24.0, 56.0, 97.0, 223.9)
FOOTPRINTS = (0.01, 0.15, 1.0, float("inf"))
#: The contract of float32. It is kept by little: 9.8e-5 is the largest of 39 million pairs (docs/model.md).
BOUND, MEDIAN = 1e-4, 1e-5
#: What f keeps in the scalar variants.
SCALAR_BOUND = 5e-5
#: U^2 + C^2 up to which they hold.
REACH = 55


def errors(mi, parameters, count, rng, reach=REACH, grazing=89.9):
    """Relative errors of f and of the density, and the angles of incidence in degrees, of random pairs
    inside the domain of the bound."""
    core, gaussian = Core(**parameters), Core(**{**parameters, "gram_charlier": False})
    slopes = parameters.get("slope_measure") == "slope"
    i, o = pairs(core, count, rng, parameters.get("wind_direction", 0.0), np.sqrt(reach), grazing, slopes)
    value, pdf = evaluate(mi, mi.load_dict({"type": "prob_water", **parameters}), i, o)
    wide_i, wide_o = i.astype(float), o.astype(float)
    exact, size = core.f(wide_i, wide_o) * wide_o[:, 2], gaussian.f(wide_i, wide_o) * wide_o[:, 2]
    density = core.pdf(wide_i, wide_o)
    # Values that float32 cannot hold to four digits (below 1e-34) say nothing.
    keep = (size > 1e-34) & (density > 1e-34)
    theta = np.degrees(np.arccos(wide_i[keep, 2]))
    return np.abs(value - exact)[keep] / size[keep], np.abs(pdf - density)[keep] / density[keep], theta


def table(mi, count, rng):
    """Rows of (wind, footprint, [(median, worst) by band of incidence])."""
    bands = ((0, 30), (30, 60), (60, 80), (80, 88), (88, 90))
    for wind in WINDS:
        for footprint in FOOTPRINTS:
            parameters = dict(friction_velocity=wind, footprint=footprint, whitecaps=False, wind_direction=25.0)
            error, _, theta = errors(mi, parameters, count, rng)
            yield wind, footprint, [
                (np.median(error[m]), error[m].max()) for m in ((theta >= a) & (theta < b) for a, b in bands)
            ]


def main():
    """Writes docs/float32.md."""
    import mitsuba as mi

    from validation.support.mitsuba_setup import load_plugin, usable_llvm

    usable, reason = usable_llvm()
    if not usable:
        return f"docs/float32.md is about llvm_ad_rgb: {reason}"
    mi.set_variant("llvm_ad_rgb")
    load_plugin()
    lines = [
        "# float32 against float64",
        "",
        f"The plugin's `eval` in `{mi.variant()}` against the core in float64 on the same float32 directions,",
        "relative to the lobe without Gram-Charlier; each cell is median / worst over random pairs, evenly",
        "spread over the tilts with U^2 + C^2 < 55. Bounds: 1e-5 / 1e-4, and 5e-5 in the scalar variants.",
        "Rows marked * have a standard deviation at the floor of 1e-3.",
        "Written by `cargo xtask verify`.",
        "",
        "| w*, cm/s | D, m | 0-30 deg | 30-60 | 60-80 | 80-88 | 88-89.9 |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    for wind, footprint, cells in table(mi, 200_000, np.random.default_rng(1)):
        core = Core(friction_velocity=wind, footprint=footprint)
        star = "*" if min(core.sigma_u2, core.sigma_c2) <= 1.0001e-6 else ""
        values = " | ".join(f"{median:.0e} / {worst:.0e}" for median, worst in cells)
        lines.append(f"| {wind}{star} | {footprint} | {values} |")
    (ROOT / "docs/float32.md").write_text("\n".join(lines) + "\n")
    print("\n".join(lines))


if __name__ == "__main__":
    sys.exit(main())
