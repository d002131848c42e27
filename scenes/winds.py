"""One scene, made in Python, in three winds: a level sea against the sun, its glint wider and dimmer as the wind rises.

From the project's root, after `cargo xtask build`: `.venv/bin/python scenes/winds.py [DIRECTORY]` writes `wind_2.exr`, ...
"""

import sys
from pathlib import Path

import mitsuba as mi

mi.set_variant("scalar_rgb")                    # llvm_ad_rgb, many times as fast, where there is LLVM
mi.file_resolver().append("target/mitsuba")     # where plugins/prob_water.so is
directory = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
directory.mkdir(parents=True, exist_ok=True)

transform = mi.ScalarTransform4f()
scene = mi.load_dict({
    "type": "scene",
    "integrator": {"type": "path", "max_depth": 2},
    "sky": {"type": "sunsky", "sun_direction": [0.9272, 0, 0.3746], "turbidity": 2, "albedo": 0.06},
    "sensor": {
        "type": "perspective",
        "fov": 65,
        "far_clip": 1e7,
        "to_world": transform.look_at(origin=[0, 0, 6], target=[1, 0, 5.86], up=[0, 0, 1]),
        "film": {"type": "hdrfilm", "width": 320, "height": 180},
        "sampler": {"type": "multijitter", "sample_count": 16},
    },
    # A rectangle, whose dp_du is +x: the wind's azimuth counts from there.
    "sea": {
        "type": "rectangle",
        "to_world": transform.scale(1e6),
        "bsdf": {"type": "prob_water", "id": "water", "wind_speed": 2, "wind_direction": 90},
    },
})
parameters = mi.traverse(scene)
name = next(key for key in parameters.keys() if key.endswith("wind_speed"))
for wind_speed in [2, 5, 10]:
    parameters[name] = wind_speed
    parameters.update()
    image = mi.render(scene)
    mi.Bitmap(image).write(str(directory / f"wind_{wind_speed}.exr"))
    print(f"{wind_speed} m/s: brightest pixel {max(image.array):.0f} W/(m^2 sr nm)")
