"""A far patch of waves as geometry reflects as the ensemble of the same sea does."""

import numpy as np
import pytest

from validation.support.core import direction
from validation.support.lit_water import IRRADIANCE, sun

#: Incidence, and views (from the vertical, azimuth from the sun's) up to 70 degrees.
CASES = {
    0.0: [(0, 0), (15, 40), (30, 0)],
    30.0: [(0, 0), (30, 180), (50, 180), (40, 150), (60, 180)],
    60.0: [(30, 180), (50, 180), (60, 180), (70, 180), (60, 160), (70, 170)],
}
FOOTPRINT = 0.4
RADIUS = 35.0


@pytest.mark.parametrize("wind", [8.0, 24.0])
def test_radiance_of_a_patch_is_the_ensembles(use, wind, full):
    """Within 5 % plus 4 standard errors over seeds, wherever the ensemble exceeds 1 % of its peak."""
    mi = use("llvm_ad_rgb")
    import drjit as dr

    sea = {"friction_velocity": wind, "wind_direction": 20.0, "footprint": FOOTPRINT}
    afar, context = mi.load_dict({"type": "prob_water", "surface": "ensemble", "components": 512, **sea}), mi.BSDFContext()
    rays, rng = 60_000, np.random.default_rng(1)
    seen = {incidence: [] for incidence in CASES}
    for seed in range(24 if full else 4):
        patch = {"type": "prob_water_surface", "radius": RADIUS, "seed": seed, "vertices": 1_000_000, **sea}
        scene = mi.load_dict({"type": "scene", "patch": patch, "sun": sun(direction(0.0, 0.0)),
                              "integrator": {"type": "path", "max_depth": 2}})
        # The scene is built once; the sun moves.
        light = mi.traverse(scene)
        for incidence, looks in CASES.items():
            light["sun.to_world"] = mi.Transform4f(mi.load_dict(sun(direction(incidence, 0.0))).world_transform())
            light.update()
            seen[incidence].append([radiance(mi, scene, direction(*look), rays, rng, seed) for look in looks])
    beyond = []
    for incidence, looks in CASES.items():
        views = np.array([direction(*look) for look in looks])
        si = dr.zeros(mi.SurfaceInteraction3f, len(views))
        si.wi = mi.Vector3f(views.T)
        wanted = IRRADIANCE * np.array(afar.eval(context, si, mi.Vector3f(direction(incidence, 0.0).tolist())))[0]
        rows = seen[incidence]
        mean, error = np.mean(rows, axis=0), np.std(rows, axis=0, ddof=1) / np.sqrt(len(rows))
        counts = wanted > 0.01 * wanted.max()
        for look, m, e, w, c in zip(looks, mean, error, wanted, counts):
            print(f"\nw* {wind} {incidence:.0f} -> {look}: {m / w:.3f} +- {e / w:.3f}{'' if c else ' (below 1 %)'}", end="")
        off = np.maximum(np.abs(mean / wanted - 1) - 4 * error / wanted, 0)[counts]
        beyond.extend(off)
        # Enough seeds for the errors to decide.
        assert np.all(error[counts] < 0.05 * wanted[counts])
        assert counts.sum() >= 2
    print(f"\nworst beyond 4 standard errors: {np.max(beyond):.3f}")
    assert np.max(beyond) < 0.05


def radiance(mi, scene, view, rays, rng, seed):
    """Mean over parallel rays against `view` onto the inner part of the patch."""
    r, turn = 0.8 * RADIUS * np.sqrt(rng.random(rays)), 2 * np.pi * rng.random(rays)
    level = np.stack([r * np.cos(turn), r * np.sin(turn), 0 * r])
    sampler = mi.load_dict({"type": "independent"})
    sampler.seed(seed, rays)
    ray = mi.RayDifferential3f(mi.Ray3f(mi.Point3f(level + 100 * view[:, None]), mi.Vector3f((-view).tolist())))
    return np.array(scene.integrator().sample(scene, sampler, ray)[0])[0].mean()
