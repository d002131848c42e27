"""A plugin for another Mitsuba, another Dr.Jit or another instruction set is refused, at build or at load, never silently wrong.
`cargo xtask compat` loads it into other versions of Mitsuba."""

import subprocess
import sys

import pytest

from validation.support.paths import ROOT
from validation.support.plugin_calls import BOTH

PLUGINS = ROOT / "target/mitsuba/plugins"
LOAD = """
import mitsuba as mi, sys
mi.set_variant(sys.argv[2])
mi.file_resolver().append(sys.argv[1])
for _ in range(2):  # A second try is no different.
    try:
        mi.load_dict({"type": "prob_water"})
    except RuntimeError as error:
        print("refused:", error)
"""


def compile_plugin(name, output, *changes):
    """Runs the compiler as `cargo xtask build` did, with other options."""
    words = (PLUGINS / f"{name}.command").read_text().split()
    at = words.index("-o")
    words = [w for w in words[:at] + words[at + 2:] if not w.startswith("-march")]
    return subprocess.run([*words, *changes, "-o", str(output)], capture_output=True, text=True, cwd=ROOT)


@pytest.fixture
def plugins(tmp_path):
    (tmp_path / "plugins").mkdir()
    return tmp_path / "plugins"


def refusal(plugins, variant="scalar_rgb"):
    """What Mitsuba says of the plugin in a folder, which it refuses every time."""
    done = subprocess.run([sys.executable, "-c", LOAD, str(plugins.parent), variant], capture_output=True, text=True)
    assert done.returncode == 0 and done.stdout.count("refused:") == 2, done.stdout + done.stderr
    return done.stdout


@pytest.mark.parametrize("march, word", [("x86-64", "AVX2"), ("x86-64-v2", "AVX2"), ("x86-64-v4", "AVX-512")])
def test_refused_by_the_compiler(tmp_path, march, word):
    result = compile_plugin("prob_water.impl", tmp_path / "prob_water.so", f"-march={march}", "-fsyntax-only", "-Wfatal-errors")
    assert result.returncode != 0
    assert "prob_water must" in result.stderr and word in result.stderr and "-march=x86-64-v3" in result.stderr


def test_refused_when_loaded(plugins):
    """With the compiler's check taken out, the plugin itself says what is wrong."""
    result = compile_plugin("prob_water.impl", plugins / "prob_water.so", "-march=x86-64", "-DPROB_WATER_ONLY_LOAD_CHECK", "-O0")
    assert result.returncode == 0, result.stderr
    said = refusal(plugins)
    assert "another instruction set" in said and "cargo xtask build" in said, said


@pytest.mark.parametrize("variant", BOTH)
@pytest.mark.parametrize("package, version", [("mitsuba", "3.8.0"), ("drjit", "1.3.1"), ("drjit", "1.5.00")])
def test_other_versions_are_refused(use, plugins, variant, package, version):
    """A plugin that was built for another version than the running one names both and is not opened."""
    use(variant)
    import drjit as dr
    import mitsuba as mi

    running = {"mitsuba": mi.__version__, "drjit": dr.__version__}
    built = {**running, package: version}
    definitions = [f'-DPROB_WATER_{name.upper()}="{text}"' for name, text in built.items()]
    undefined = [f"-UPROB_WATER_{name.upper()}" for name in built]
    result = compile_plugin("prob_water", plugins / "prob_water.so", *undefined, *definitions)
    assert result.returncode == 0, result.stderr
    said = refusal(plugins, variant)
    for versions in (built, running):
        assert f"Mitsuba {versions['mitsuba']} with Dr.Jit {versions['drjit']}" in said, said
    assert "impl" not in said


def test_what_lacks_a_symbol_is_refused(plugins):
    """Before anything of it runs, in a sentence that names the versions."""
    import mitsuba as mi

    (plugins / "prob_water.so").symlink_to(PLUGINS / "prob_water.so")
    missing = refusal(plugins)
    assert "prob_water.impl.so: cannot open shared object file" in missing and f"Mitsuba {mi.__version__}" in missing, missing
    source = plugins / "lacking.cpp"
    source.write_text('void nowhere(); extern "C" void init_plugin() { nowhere(); }')
    impl = plugins / "prob_water.impl.so"
    subprocess.run(["g++", "-shared", "-fPIC", "-Wl,-z,lazy", source, "-o", impl], check=True)
    said = refusal(plugins)
    assert "undefined symbol" in said and said.count(f"Mitsuba {mi.__version__}") == 4, said


@pytest.mark.parametrize("name", ["prob_water", "prob_water_surface"])
def test_all_symbols_are_bound_when_loaded(name):
    """However a plugin is opened, what it lacks is found then (-z now)."""
    for file in (f"{name}.so", f"{name}.impl.so"):
        found = subprocess.run(["readelf", "-d", PLUGINS / file], capture_output=True, text=True, check=True).stdout
        assert "NOW" in found, file
