"""What is off costs nothing in traced kernels (the scalar core: `cargo xtask bench off`); lanes are inlined."""

import shutil
from pathlib import Path

import pytest

from validation.bench.off import instructions
from validation.support.plugin_calls import operations


def test_switches_leave_nothing_in_kernels(use):
    """A feature that is off, or that this wind does not raise, is in no kernel."""
    use("llvm_ad_rgb")
    plain = operations({"friction_velocity": 24.0})
    for off in ("whitecaps", "shadowing", "gram_charlier"):
        without = operations({"friction_velocity": 24.0, off: False})
        assert without["eval"] < plain["eval"], off
    # No wind, no whitecaps: as many operations as with whitecaps = false.
    calm, off = (operations({"friction_velocity": 0.0, "whitecaps": on}) for on in (True, False))
    assert calm == off
    # Waves too gentle for whitecaps.
    gentle, off = (operations({"surface": "instance", "friction_velocity": 2.0, "whitecaps": on}) for on in (True, False))
    assert gentle == off
    # Other surfaces are compiled only where they are asked for: numbers alone differ between winds and footprints.
    assert operations({"friction_velocity": 40.0, "footprint": 0.5}) == plain
    assert operations({"surface": "instance", "friction_velocity": 24.0})["eval"] > plain["eval"]


@pytest.mark.skipif(not shutil.which("valgrind"), reason="valgrind is not installed")
@pytest.mark.parametrize(("operation", "most"), [("eval", 130), ("pdf", 90), ("sample", 290)])
def test_lanes_are_inlined(operation, most):
    """A function that is not inlined takes no vectors in registers: three times the instructions and more. Bounds are twice what
    there are."""
    if "avx2" not in Path("/proc/cpuinfo").read_text(encoding="utf-8"):
        pytest.skip("no AVX2")
    assert instructions("avx2", operation) < most
