"""Another Mitsuba than the plugin was built for: an exception with a sentence that names both versions, in every CPU variant.

`cargo xtask compat` runs it in environments of their own; it needs nothing but Mitsuba.
"""

import subprocess
import sys

from validation.support.paths import PLUGIN_ROOT

#: In a process of its own: a plugin that is not refused may end it.
LOAD = """
import drjit, mitsuba, sys
mitsuba.set_variant(sys.argv[1])
mitsuba.file_resolver().append(sys.argv[3])
try:
    bsdf = mitsuba.load_dict({"type": sys.argv[2]})
except RuntimeError as error:
    sentence = str(error)[str(error).index(sys.argv[2] + ": "):]
    assert f"running is Mitsuba {mitsuba.__version__} with Dr.Jit {drjit.__version__}" in sentence, sentence
    assert f"built for Mitsuba {sys.argv[4]} with Dr.Jit" in sentence, sentence
    print(f"  {sys.argv[1]}: {sentence}")
else:
    raise SystemExit(f"{sys.argv[1]}: {sys.argv[2]} was not refused")
"""


def main(built: str) -> int:
    import mitsuba

    print(f"compat: Mitsuba {mitsuba.__version__}", flush=True)
    failures = 0
    for variant in ("scalar_rgb", "scalar_spectral_polarized", "llvm_ad_rgb", "llvm_ad_spectral"):
        for plugin in ("prob_water", "prob_water_surface"):
            command = [sys.executable, "-c", LOAD, variant, plugin, str(PLUGIN_ROOT), built]
            failures += subprocess.run(command).returncode != 0
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
