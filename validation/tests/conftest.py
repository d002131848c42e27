"""The plugin and the variants for all tests; `--full` runs the long campaigns."""

import pytest

from validation.support.mitsuba_setup import load_plugin, usable_llvm


def pytest_addoption(parser):
    parser.addoption("--full", action="store_true", help="long campaigns (`cargo xtask verify`)")


@pytest.fixture(scope="session")
def full(request):
    """Whether to run at full length."""
    return request.config.getoption("--full")


@pytest.fixture
def use():
    """A function that switches to a variant, or skips the test with the reason why it cannot."""
    import mitsuba as mi

    def switch(variant):
        if variant.startswith("llvm"):
            usable, reason = usable_llvm()
            if not usable:
                pytest.skip(reason)
        mi.set_variant(variant)
        load_plugin()
        return mi

    return switch
