"""The width of the glitter path against wind agrees with the slope density of the core."""

import numpy as np

from validation.render.glitter_width import table


def test_glitter_path_widens_as_the_slopes_do(use, full):
    """Within 6 % at every wind, and wider with every Beaufort number."""
    rows = table(use("llvm_ad_rgb"), 12) if full else table(use("llvm_ad_rgb"), 2, (1, 3, 6))
    print("\nBeaufort, width as rendered, as expected (degrees)")
    for beaufort, drawn, expected in rows:
        print(f"{beaufort:>8} {drawn:8.2f} {expected:8.2f} {drawn / expected - 1:+.1%}")
    _, drawn, expected = np.array(rows).T
    assert np.all(np.abs(drawn / expected - 1) < 0.06)
    assert np.all(np.diff(drawn) > 0) and np.all(np.diff(expected) > 0)
