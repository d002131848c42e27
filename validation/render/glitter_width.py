"""Width of the glitter path against wind: as rendered from drawn waves, and as the core's slope density has it."""

import re
from pathlib import Path

import numpy as np

#: m over the sea; degrees: of the sun, and of the looks below the horizon, over which the path is averaged.
HEIGHT, SUN, LOOKS = 30.0, 25.0, (18.0, 32.0)
#: Looks to both sides, degrees, and bins among them.
SIDE, BINS = 80.0, 81
BEAUFORTS = range(1, 8)


def profiles(mi, beaufort: int, seeds: int, rays: int = 100_000) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Azimuths from the sun's in degrees, and radiance there: of drawn seas under the sun, and of their ensemble."""
    import drjit as dr

    rng = np.random.default_rng(beaufort)
    azimuth, down = rng.uniform(-SIDE, SIDE, rays), np.radians(rng.uniform(*LOOKS, rays))
    turn = np.radians(azimuth)
    look = np.stack([np.cos(down) * np.cos(turn), np.cos(down) * np.sin(turn), -np.sin(down)])
    elevation = np.radians(SUN)
    to_sun = [float(np.cos(elevation)), 0.0, float(np.sin(elevation))]
    sun = {"type": "directional", "direction": [-x for x in to_sun], "irradiance": {"type": "uniform", "value": 1.0}}
    bins = ((azimuth + SIDE) * BINS / (2 * SIDE)).astype(int)

    def binned(value):
        return np.bincount(bins, value, BINS) / np.bincount(bins, minlength=BINS)

    drawn = np.zeros(BINS)
    sea = {"beaufort": beaufort, "whitecaps": False}
    for seed in range(seeds):
        shape = mi.load_dict({"type": "prob_water_surface", **sea, "seed": seed, "radius": 400.0, "opening": 2 * SIDE + 10,
                              "vertices": 250_000})
        scene = mi.load_dict({"type": "scene", "sea": shape, "sun": sun, "integrator": {"type": "path", "max_depth": 2}})
        sampler = mi.load_dict({"type": "independent"})
        sampler.seed(seed, rays)
        ray = mi.RayDifferential3f(mi.Ray3f(mi.Point3f(0, 0, HEIGHT), mi.Vector3f(look)))
        drawn += binned(np.array(scene.integrator().sample(scene, sampler, ray)[0])[0]) / seeds
    edge = float(re.search(r"footprint at center = .*, at edge = (.*)\]", str(shape)).group(1))
    footprint = max(0.15, edge * HEIGHT / np.tan(np.radians(np.mean(LOOKS))) / 400.0)
    afar = mi.load_dict({"type": "prob_water", **sea, "surface": "ensemble", "components": 512, "footprint": footprint})
    si = dr.zeros(mi.SurfaceInteraction3f, rays)
    si.wi = mi.Vector3f(-look)
    expected = binned(np.array(afar.eval(mi.BSDFContext(), si, mi.Vector3f(to_sun)))[0])
    return np.linspace(-SIDE, SIDE, BINS + 1)[:-1] + SIDE / BINS, drawn, expected


def width(azimuth: np.ndarray, profile: np.ndarray) -> float:
    """Root mean square of the azimuth, degrees, weighted with the radiance."""
    return float(np.sqrt(np.sum(profile * azimuth**2) / np.sum(profile)))


def table(mi, seeds: int, beauforts=BEAUFORTS) -> list[tuple[int, float, float]]:
    """Beaufort number, width as drawn and as expected."""
    rows = []
    for beaufort in beauforts:
        azimuth, drawn, expected = profiles(mi, beaufort, seeds)
        rows.append((beaufort, width(azimuth, drawn), width(azimuth, expected)))
    return rows


def draw(rows: list[tuple[int, float, float]], target: Path) -> None:
    """The chart."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot as plt

    beaufort, drawn, expected = np.array(rows).T
    figure, axes = plt.subplots(figsize=(7, 3.9), layout="constrained")
    axes.plot(beaufort, expected, color="0.35", label="the core's slope density (ensemble)")
    axes.plot(beaufort, drawn, "o", color="tab:blue", label="rendered from drawn waves")
    axes.set(xlabel="Beaufort number", ylabel="width of the path, degrees (rms)", ylim=(0, None))
    axes.legend()
    figure.savefig(target, dpi=150)
    plt.close(figure)
