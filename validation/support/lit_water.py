"""Water under one light, for tests that render."""

IRRADIANCE = 3.0


def scene(mi, parameters, **others):
    """A square of 2 km of water and what else is given, with a path integrator."""
    plane = {
        "type": "rectangle",
        "to_world": mi.ScalarTransform4f().scale(1000),
        "bsdf": {"type": "prob_water", **parameters},
    }
    return mi.load_dict({"type": "scene", "water": plane, "integrator": {"type": "path", "max_depth": 2}, **others})


def sun(i):
    """A directional emitter of irradiance 3 whose light comes from the direction `i`."""
    return {
        "type": "directional",
        "direction": [-float(x) for x in i],
        "irradiance": {"type": "uniform", "value": IRRADIANCE},
    }
