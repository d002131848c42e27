"""Mitsuba as the tests and renders here use it: which variant this machine can run, and the plugin."""

import textwrap
from pathlib import Path

import drjit as dr
import mitsuba as mi
from drjit.detail import llvm_version

from validation.support.paths import PLUGIN_ROOT

# LLVM 14 and 15 end the process with an abort when they generate code for AVX-512.
OLDEST_LLVM = 16
INSTALL_LLVM = (
    "install LLVM 19 (Debian, Ubuntu: apt-get install libllvm19) or set DRJIT_LIBLLVM_PATH to a libLLVM.so"
)

# Of an EXR's metadata: the sea that it shows, as TOML. `prob-water --from` reads it.
SEA = "prob_water"


class SetupError(Exception):
    """What this machine or this checkout lacks, and what to do about it, in one line."""


def usable_llvm() -> tuple[bool, str]:
    """Whether the llvm variants can run; where they cannot, the reason and what to install."""
    version = llvm_version()
    if version[0] < 0:
        return False, f"no LLVM library was found: {INSTALL_LLVM}"
    if version[0] < OLDEST_LLVM:
        found = ".".join(map(str, version))
        return False, f"LLVM {found} was found, {OLDEST_LLVM} is the oldest that works: {INSTALL_LLVM}"
    return True, "LLVM " + ".".join(map(str, version))


def pick_variant(requested: str | None = None) -> str:
    """The requested variant, or the fastest without a GPU; says so in a line where that is the slow one."""
    usable, reason = usable_llvm()
    if requested is None:
        if not usable:
            print(f"scalar_rgb instead of llvm_ad_rgb, several times slower: {reason}", flush=True)
        return "llvm_ad_rgb" if usable else "scalar_rgb"
    if requested not in mi.variants():
        raise SetupError(f"no variant {requested!r}: {', '.join(mi.variants())}")
    if requested.startswith("llvm") and not usable:
        raise SetupError(f"{requested}: {reason}")
    if requested.startswith("cuda") and not dr.has_backend(dr.JitBackend.CUDA):
        raise SetupError(f"{requested}: no CUDA device was found")
    return requested


def load_plugin(plugin_root: Path | str = PLUGIN_ROOT) -> None:
    """Makes the plugin in `plugin_root`/plugins loadable."""
    library = Path(plugin_root) / "plugins" / "prob_water.so"
    if not library.is_file():
        raise SetupError(f"{library} is missing: run cargo xtask build")
    if str(plugin_root) not in map(str, mi.file_resolver()):
        mi.file_resolver().append(str(plugin_root))


def sea_of(bsdf) -> str:
    """The parameters in force of a ProbWater BSDF and what follows from them, as TOML."""
    head, *lines, tail = str(bsdf).splitlines()
    assert (head, tail) == ("ProbWater[", "]"), head
    return textwrap.dedent("\n".join(lines)) + "\n"
