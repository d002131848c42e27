"""From scene light to a picture for the screen: by day one exposure and curve, so that pictures compare."""

import numpy as np

# The sky near the horizon, 0.2 in the sky model's units, comes out as a light mid-tone.
EXPOSURE = 5.0
# The value after exposure that is shown as white; the brightest glitter lies near it.
WHITE = 40.0
REC709 = np.array([0.2126, 0.7152, 0.0722])


def tone_map(radiance: np.ndarray, exposure: float = EXPOSURE) -> np.ndarray:
    """Linear sRGB in [0, 1] by Reinhard's curve v / (1 + v), scaled so that `WHITE` is 1.

    The curve on luminance keeps colours, the curve on each channel brings highlights to white: the darker a
    channel, the more of the former.
    """
    light = np.maximum(radiance * exposure, 0.0)
    luminance = (light @ REC709)[..., None]
    channels = light / (1.0 + light)
    shown = (1.0 - channels) * light / (1.0 + luminance) + channels**2
    return np.minimum(shown * (1.0 + 1.0 / WHITE), 1.0)


def to_bytes(linear: np.ndarray, dither: bool = True) -> np.ndarray:
    """Linear values in [0, 1] as 8-bit sRGB, dithered by one step so that a clear sky shows no bands."""
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    offset = np.random.default_rng(0).random(encoded.shape[:2])[..., None] if dither else 0.5
    return np.minimum(encoded * 255.0 + offset, 255.0).astype(np.uint8)
