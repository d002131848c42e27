"""Reference values of the glint of eradiate-mitsuba's `ocean_legacy` (6S's ocean) for 100 random pairs.

Run in the peers' environment: `.venv-peer/bin/python -m validation.data.ocean_legacy [OUTPUT.csv]`. What it
writes is ocean_legacy.csv beside it, which `test_peer.py` compares with the command `prob-water brdf`.

Conventions of ocean_legacy in eradiate-mitsuba 0.5.0, taken from its documentation and sources and
confirmed by the numbers. f is the BRDF in 1/sr; the sea compared has `footprint = inf`, `slope_measure =
slope`, `fresnel = exact` and neither shadowing nor whitecaps.

* Variant `scalar_mono_double`; all but the double ones compute in single precision.
* `component = 2`, a property of the plugin, makes eval() return `pi (1 - coverage) f`: a reflectance factor
  of the glint alone, without the cosine that eval() otherwise includes. The parameter `coverage` is
  Monahan's whitecap fraction, `2.95e-6 wind_speed^3.52`; here it is divided out.
* `shadowing` is on by default: Smith's height-correlated term of a Beckmann surface instead of the report's
  (Nakajima and Tanaka's). It is compared switched off.
* `wind_speed` (m/s) enters Cox and Munk's variances and the Gram-Charlier coefficients c21 and c03 as it
  stands. Those are defined by the wind at 12.5 m, so here the same number is given at `wind_height = 12.5`.
* `wind_direction` (degrees) is "North Left": where the wind blows to, clockwise from +y. As the azimuth
  that it comes from, counter-clockwise from +x, it is `270 - wind_direction`.
* `wavelength` is in nm. The index is Hale and Querry's, linear between the entries, plus 0.00017492711
  (0.03 + 1.805 chlorinity), and is given here as `ior`. The imaginary part k takes part in Fresnel's
  equations; at the wavelengths used here it is below 4e-8 and changes nothing.
* The Gram-Charlier factor is not clamped at 0; it is positive for all of these pairs.
* In radiance mode `si.wi` points to the observer and `wo` to the source; the glint is symmetric in the two.

The largest relative difference over the 100 pairs is 4.6e-8. It comes from the peer's constants, which are
written in single precision (0.00316f, 0.0086f, ...) in the double variant too: with Cox and Munk's rounded
likewise it falls to 3e-9.
"""

import csv
import math
import sys
from pathlib import Path

import mitsuba as mi
import numpy as np

OUTPUT = Path(__file__).with_suffix(".csv")
COLUMNS = "wind_speed wind_height wind_direction ior ix iy iz ox oy oz f".split()
SEED = 20230002
#: m/s; setting up each sea takes the peer two seconds.
WINDS = [2.0, 5.0, 8.0, 11.0, 15.0]
PAIRS = 20
#: Hale and Querry's index at three of their wavelengths, nm.
PURE_WATER = {400: 1.339, 550: 1.333, 700: 1.331}


def random_pair(rng: np.random.Generator, wind_speed: float, wind_direction: float) -> np.ndarray:
    """Source, up to 75 degrees off the zenith, and observer with a half vector of likely slopes."""
    sigma = np.sqrt([0.00316 * wind_speed, 0.003 + 0.00192 * wind_speed])
    upwind = math.radians(wind_direction)
    while True:
        theta, phi = rng.uniform(0, math.radians(75)), rng.uniform(0, math.tau)
        s = math.sin(theta)
        source = np.array([s * math.cos(phi), s * math.sin(phi), math.cos(theta)])
        tilt = complex(*(rng.uniform(-1.75, 1.75, 2) * sigma)) * complex(math.cos(upwind), math.sin(upwind))
        half = np.array([tilt.real, tilt.imag, 1]) / math.hypot(tilt.real, tilt.imag, 1)
        observer = 2 * (source @ half) * half - source
        if observer[2] > 0.1:
            return np.array([source, observer])


def rows() -> list[list[float]]:
    """One row per pair: the sea in prob_water's parameters, the directions, the peer's f."""
    mi.set_variant("scalar_mono_double")
    rng = np.random.default_rng(SEED)
    context, interaction = mi.BSDFContext(), mi.SurfaceInteraction3f()
    result = []
    for wind_speed in WINDS:
        wavelength = int(rng.choice(list(PURE_WATER)))
        peer_direction, chlorinity = rng.uniform([0, 0], [360, 35])
        wind_direction = 270 - peer_direction
        ior = PURE_WATER[wavelength] + 0.00017492711 * (0.03 + 1.805 * chlorinity)
        bsdf = mi.load_dict({
            "type": "ocean_legacy", "component": 2, "shadowing": False, "wavelength": float(wavelength),
            "wind_speed": wind_speed, "wind_direction": peer_direction, "chlorinity": chlorinity,
        })
        factor = math.pi * (1 - mi.traverse(bsdf)["coverage"])
        for _ in range(PAIRS):
            source, observer = random_pair(rng, wind_speed, wind_direction)
            interaction.wi = observer
            f = bsdf.eval(context, interaction, source)[0] / factor
            result.append([wind_speed, 12.5, wind_direction, ior, *source, *observer, f])
    return result


def main() -> None:
    """Writes the table."""
    output = Path(sys.argv[1]) if len(sys.argv) > 1 else OUTPUT
    with output.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows([format(float(x), ".17g") for x in row] for row in rows())


if __name__ == "__main__":
    main()
