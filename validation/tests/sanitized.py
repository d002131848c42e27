"""The plugin's own memory: loaded, evaluated, updated, refused and freed, and used by many threads at once.

`cargo xtask sanitize` runs it with a plugin compiled with the address sanitizer, whose directory PROB_WATER_PLUGINS names.
"""

import gc
import os
import sys
import threading

import mitsuba as mi
import numpy as np

from validation.support.mitsuba_setup import load_plugin, usable_llvm

SEAS = (
    {},
    {"slope_measure": "slope", "fresnel": "exact", "friction_velocity": 24.0},
    {"surface": "ensemble", "footprint": 0.15},
    {"surface": "empirical"},
    {"surface": "instance", "components": 20, "footprint": 0.15},
)
REFUSED = (
    {"wind_speed": -1.0},
    {"surface": "lumpy"},
    {"beaufort": 4, "wind_speed": 3.0},
    {"ior": 9.0},
    {"table": "/nowhere/table.npz", "surface": "empirical"},
    {"no_such_parameter": 1.0},
)


def directions(count, rng):
    v = rng.normal(size=(count, 3))
    v[:, 2] = np.abs(v[:, 2])
    return (v / np.linalg.norm(v, axis=1, keepdims=True)).astype(np.float32)


def scalar_values(bsdf, rng, count=64):
    """f, densities and draws of a BSDF at a point, one after the other."""
    context, si = mi.BSDFContext(), mi.SurfaceInteraction3f()
    rows = []
    for i, o, u in zip(directions(count, rng).tolist(), directions(count, rng).tolist(), rng.uniform(size=(count, 3)).tolist()):
        si.wi = mi.Vector3f(i)
        value, pdf = bsdf.eval_pdf(context, si, mi.Vector3f(o))
        sample, weight = bsdf.sample(context, si, u[0], mi.Point2f(u[1], u[2]))
        rows.append([value[0], pdf, *sample.wo, sample.pdf, weight[0]])
    return np.array(rows)


def traced_values(bsdf, rng, count=4096):
    """The same of many points at a time."""
    import drjit as dr

    context, si = mi.BSDFContext(), dr.zeros(mi.SurfaceInteraction3f, count)
    i, o, u = directions(count, rng).T, directions(count, rng).T, rng.uniform(size=(3, count)).astype(np.float32)
    si.wi = mi.Vector3f(np.ascontiguousarray(i))
    value, pdf = bsdf.eval_pdf(context, si, mi.Vector3f(np.ascontiguousarray(o)))
    sample, weight = bsdf.sample(context, si, mi.Float(u[0]), mi.Point2f(mi.Float(u[1]), mi.Float(u[2])))
    return np.stack([np.array(value)[0], np.array(pdf), np.array(sample.pdf), np.array(weight)[0]])


def refuses(make):
    try:
        make()
    except Exception:
        return
    raise SystemExit("what had to be refused was not")


def one_by_one(values):
    for sea in SEAS:
        bsdf = mi.load_dict({"type": "prob_water", **sea})
        assert np.isfinite(values(bsdf, np.random.default_rng(1))).all(), sea
        str(bsdf)
        del bsdf
        gc.collect()
    for sea in REFUSED:
        refuses(lambda: mi.load_dict({"type": "prob_water", **sea}))


def updates(values):
    scene = mi.load_dict({"type": "scene", "plane": {"type": "rectangle", "bsdf": {"type": "prob_water", "wind_speed": 5.0}}})
    parameters = mi.traverse(scene)
    key = next(name for name in parameters.keys() if name.endswith("wind_speed"))
    bsdf = scene.shapes()[0].bsdf()
    before = values(bsdf, np.random.default_rng(2))
    parameters[key] = 9.0
    parameters.update()
    assert not np.array_equal(before, values(bsdf, np.random.default_rng(2)))
    parameters[key] = -1.0
    refuses(parameters.update)
    parameters[key] = 5.0
    parameters.update()
    assert np.array_equal(before, values(bsdf, np.random.default_rng(2)))


def shape():
    sea = {"type": "prob_water_surface", "wind_speed": 7.0, "components": 16, "bsdf": {"type": "prob_water"}}
    for more in ({}, {"wind_speed": -3.0}, {"no_such_parameter": 2.0}):
        try:
            mesh = mi.load_dict({**sea, **more})
            assert mesh.face_count() > 0
            del mesh
        except RuntimeError as error:
            print(f"  shape: {str(error).splitlines()[-1].strip()[:100]}")
        gc.collect()


def render():
    """Many threads of the renderer, one BSDF."""
    scene = mi.load_dict({
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 3},
        "light": {"type": "constant"},
        "plane": {"type": "rectangle", "to_world": mi.ScalarTransform4f().scale(100), "bsdf": {"type": "prob_water", "wind_speed": 5.0}},
        "sensor": {
            "type": "perspective",
            "to_world": mi.ScalarTransform4f().look_at([0, -20, 5], [0, 0, 0], [0, 0, 1]),
            "film": {"type": "hdrfilm", "width": 48, "height": 32},
            "sampler": {"type": "independent", "sample_count": 8},
        },
    })
    image = np.array(mi.render(scene, spp=8, seed=1))
    assert np.isfinite(image).all() and image.max() > 0
    # Blocks are summed as they come.
    assert np.allclose(image, np.array(mi.render(scene, spp=8, seed=1)), rtol=1e-4, atol=1e-6)


def concurrently():
    """Many Python threads, one BSDF: the values are those of a single thread."""
    for sea in SEAS[:4]:
        bsdf = mi.load_dict({"type": "prob_water", **sea})
        expected = scalar_values(bsdf, np.random.default_rng(3))
        differs = []

        def work():
            for _ in range(5):
                if not np.array_equal(scalar_values(bsdf, np.random.default_rng(3)), expected):
                    differs.append(sea)

        threads = [threading.Thread(target=work) for _ in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert not differs, differs


def main():
    load_plugin(os.environ.get("PROB_WATER_PLUGINS", "target/mitsuba"))
    for variant in ("scalar_rgb", "llvm_ad_rgb"):
        traced = variant.startswith("llvm")
        if traced and not usable_llvm()[0]:
            print(f"sanitized: {variant} is left out: {usable_llvm()[1]}")
            continue
        mi.set_variant(variant)
        load_plugin(os.environ.get("PROB_WATER_PLUGINS", "target/mitsuba"))
        values = traced_values if traced else scalar_values
        one_by_one(values)
        updates(values)
        shape()
        render()
        if not traced:
            concurrently()
        gc.collect()
        print(f"sanitized: {variant}: no error", flush=True)


if __name__ == "__main__":
    sys.exit(main())
