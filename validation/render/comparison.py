"""Two pictures that should agree, and by how much they do: a picture of the difference."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path

import matplotlib
import mitsuba as mi
import numpy as np
from scipy.ndimage import gaussian_filter

from validation.render.review_set import Comparison
from validation.render.tone import REC709

#: The difference that is shown in full colour: red where the first picture is brighter, blue where the second is.
FULL = 0.2


def compare(comparison: Comparison, out: Path, replacing: Callable[[Path], AbstractContextManager[Path]]) -> None:
    """Writes EXR and PNG of the relative difference in luminance of two rendered pictures."""
    exrs = [out / f"{name}.exr" for name in (comparison.first, comparison.second)]
    if not all(exr.is_file() for exr in exrs):
        return
    lights = [luminance(exr) for exr in exrs]
    first, second = (gaussian_filter(light, comparison.blur * light.shape[1]) for light in lights)
    mean = 0.5 * (first + second)
    # Where there is light to compare.
    counts = mean > 0.02 * mean.max()
    difference = np.where(counts, (first - second) / np.maximum(mean, 1e-12), 0.0)
    bitmap = mi.Bitmap(difference[..., None].astype(np.float32))
    facts = bitmap.metadata()
    facts["pictures"] = f"{comparison.first} and {comparison.second}, smoothed over {comparison.blur:.1%} of the width"
    facts["overall"] = f"{first[counts].sum() / second[counts].sum() - 1:+.1%} in the mean, " \
                       f"{np.abs(difference[counts]).mean():.1%} on average from place to place"
    facts["scale"] = f"red {FULL:+.0%}, blue {-FULL:+.0%}"
    with replacing(out / f"{comparison.name}.exr") as file:
        bitmap.write(str(file))
    # Diverging, dark in the middle.
    colours = matplotlib.colormaps["berlin"](0.5 + 0.5 * np.clip(difference / FULL, -1, 1))[..., :3]
    with replacing(out / f"{comparison.name}.png") as file:
        mi.Bitmap((255 * colours).astype(np.uint8)).write(str(file))
    print(f"{comparison.name}: {facts['overall']}", flush=True)


def luminance(exr: Path) -> np.ndarray:
    """Of the pixels of an image, shape (height, width)."""
    return np.array(mi.Bitmap(str(exr)), dtype=np.float64)[..., :3] @ REC709
