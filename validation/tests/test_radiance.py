"""Rendered radiance against direct evaluation by the core."""

import numpy as np
import pytest

from validation.support.core import Core, direction, pairs
from validation.support.lit_water import IRRADIANCE, scene, sun

VARIANTS = ["scalar_rgb", "scalar_spectral", "llvm_ad_rgb", "llvm_ad_spectral"]
WINDS = (2.0, 8.0, 40.0)


def radiance(mi, scene, o, samples=1):
    """Radiance along rays that look at the origin's neighbourhood from the directions `o`: through the
    integrator, so that no pixel averages. Shape (rows, samples)."""
    import drjit as dr

    integrator = scene.integrator()
    sampler = mi.load_dict({"type": "independent", "sample_count": 1})
    if dr.is_jit_v(mi.Float):
        rays = np.repeat(o, samples, axis=0)
        sampler.seed(7, len(rays))
        view = mi.Vector3f(np.ascontiguousarray(rays.T))
        ray = mi.RayDifferential3f(mi.Ray3f(mi.Point3f(10.0 * view), -view))
        if mi.is_spectral:
            ray.wavelengths = [450.0, 550.0, 600.0, 700.0]
        value, valid, _ = integrator.sample(scene, sampler, ray)
        value = np.array(value)
        assert np.array(valid).all()
    else:
        sampler.seed(7)
        rows = []
        for view in np.repeat(o, samples, axis=0).tolist():
            ray = mi.RayDifferential3f(mi.Ray3f(mi.Point3f([10 * x for x in view]), mi.Vector3f([-x for x in view])))
            if mi.is_spectral:
                ray.wavelengths = [450.0, 550.0, 600.0, 700.0]
            rows.append(np.array(integrator.sample(scene, sampler, ray)[0]).ravel())
        value = np.array(rows).T
    # Water is grey at one wavelength: every channel or lane carries the same value.
    assert np.allclose(value, value[0], rtol=1e-5, atol=0)
    return value[0].reshape(len(o), samples)


@pytest.mark.parametrize("variant", VARIANTS)
def test_directional_emitter(use, variant):
    """L = f E cos(theta_i) within 1e-4, for 240 geometries from overhead to 88 degrees and three winds."""
    mi, rng, errors = use(variant), np.random.default_rng(11), []
    for wind in WINDS:
        parameters = {"friction_velocity": wind, "wind_direction": 50.0, "wavelength": 0.55}
        core, gaussian = Core(**parameters), Core(**parameters, gram_charlier=False)
        sources, _ = pairs(core, 8, rng, 50.0)
        sources[0] = [0, 0, 1]
        for i in sources:
            # Views whose half vectors lie in the lobe of this source.
            many_i, many_o = pairs(core, 4000, rng, 50.0)
            half = many_i + many_o
            half /= np.linalg.norm(half, axis=1, keepdims=True)
            o = 2 * (half @ i)[:, None] * half - i
            o = o[(o[:, 2] > np.cos(np.radians(88))) & (half @ i > 0.02)][:10].astype(np.float32)
            assert len(o) == 10
            found = radiance(mi, scene(mi, parameters, sun=sun(i)), o)[:, 0]
            expected = core.f(i, o) * IRRADIANCE * i[2]
            size = gaussian.f(i, o) * IRRADIANCE * i[2]
            errors.extend(np.abs(found - expected) / size)
    print(f"\n{variant}: {len(errors)} geometries, worst error {np.max(errors):.1e}")
    assert len(errors) >= 200 and np.max(errors) < 1e-4


@pytest.mark.parametrize("variant", VARIANTS)
def test_through_sensors_and_film(use, variant):
    """The same through a distant and a perspective sensor and a film."""
    mi = use(variant)
    parameters = {"friction_velocity": 8.0, "wind_direction": 20.0, "wavelength": 0.55}
    i, o = direction(35.0, 200.0), direction(40.0, 15.0)
    expected = float(Core(**parameters).f(i, o)[0]) * IRRADIANCE * i[2]
    film = {
        "type": "hdrfilm", "width": 1, "height": 1, "rfilter": {"type": "box"}, "pixel_format": "luminance",
        "component_format": "float32",
    }
    transform = mi.ScalarTransform4f()
    sensors = {
        "distant": {"type": "distant", "direction": [-float(x) for x in o], "target": [0, 0, 0], "film": film},
        "perspective": {
            "type": "perspective",
            "fov": 0.01,
            "to_world": transform.look_at(origin=[float(5 * x) for x in o], target=[0, 0, 0], up=[0, 0, 1]),
            "film": film,
        },
    }
    # Beside a diffuse plane of known radiance, seen along the same paths: what the film makes of a radiance,
    # and in spectral variants of the sampled wavelengths, divides out.
    diffuse = {"type": "diffuse", "reflectance": {"type": "uniform", "value": 0.5}}
    known = 0.5 / np.pi * IRRADIANCE * i[2]
    for name, sensor in sensors.items():
        images = []
        for bsdf in ({"type": "prob_water", **parameters}, diffuse):
            plane = {"type": "rectangle", "to_world": transform.scale(1000), "bsdf": bsdf}
            view = mi.load_dict({
                "type": "scene", "water": plane, "sun": sun(i), "sensor": sensor,
                "integrator": {"type": "path", "max_depth": 2},
            })
            images.append(np.array(mi.render(view, spp=256, seed=3)).item())
        error = images[0] / images[1] * known / expected - 1
        print(f"\n{variant} {name}: {error:.1e}")
        assert abs(error) < 1e-4


@pytest.mark.parametrize("variant", ["scalar_rgb", "llvm_ad_rgb"])
@pytest.mark.parametrize("wind", [0.0, 8.0, 56.0])
def test_uniform_sky(use, variant, wind):
    """Under a uniform sky the Monte Carlo mean is the quadrature of f cos, within 4 standard errors."""
    mi = use(variant)
    parameters = {"friction_velocity": wind, "wind_direction": 0.0, "wavelength": 0.55}
    core = Core(**parameters)
    sky = {"type": "constant", "radiance": {"type": "uniform", "value": 1.0}}
    view = np.array([direction(t, p) for t, p in ((0, 0), (45, 30), (75, 90), (86, 180))])
    samples = 40_000 if variant.startswith("llvm") else 4000
    values = radiance(mi, scene(mi, parameters, sky=sky), view.astype(np.float32), samples)
    mean, error = values.mean(axis=1), values.std(axis=1) / np.sqrt(samples)
    for k, o in enumerate(view):
        expected = core.albedo(o)
        assert error[k] < 0.02 * expected
        assert abs(mean[k] - expected) < 4 * error[k] + 2e-5 * expected, (wind, o, mean[k], expected, error[k])
