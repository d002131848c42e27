"""A plugin compiled for the wrong instruction set is refused, at build or at load, never silently wrong."""

import subprocess
import sys

import pytest

from core import ROOT

COMMAND = ROOT / "target/mitsuba/plugins/prob_water.command"


def compile_plugin(output, *changes):
    """Runs the compiler as `cargo xtask build` did, with other options."""
    words = COMMAND.read_text().split()
    at = words.index("-o")
    words = [w for w in words[:at] + words[at + 2:] if not w.startswith("-march")]
    return subprocess.run([*words, *changes, "-o", str(output)], capture_output=True, text=True, cwd=ROOT)


@pytest.mark.parametrize("march, word", [("x86-64", "AVX2"), ("x86-64-v2", "AVX2"), ("x86-64-v4", "AVX-512")])
def test_refused_by_the_compiler(tmp_path, march, word):
    result = compile_plugin(tmp_path / "prob_water.so", f"-march={march}", "-fsyntax-only", "-fmax-errors=3")
    assert result.returncode != 0
    assert "prob_water must" in result.stderr and word in result.stderr and "-march=x86-64-v3" in result.stderr


def test_refused_when_loaded(tmp_path):
    """With the compiler's check taken out, the plugin itself says what is wrong."""
    plugin = tmp_path / "plugins/prob_water.so"
    plugin.parent.mkdir()
    result = compile_plugin(plugin, "-march=x86-64", "-DPROB_WATER_ONLY_LOAD_CHECK", "-O1")
    assert result.returncode == 0, result.stderr
    program = (
        "import mitsuba as mi, sys; mi.set_variant('scalar_rgb'); mi.file_resolver().append(sys.argv[1]);"
        "mi.load_dict({'type': 'prob_water'})"
    )
    result = subprocess.run([sys.executable, "-c", program, str(tmp_path)], capture_output=True, text=True)
    assert result.returncode != 0
    assert "another instruction set" in result.stderr and "cargo xtask build" in result.stderr, result.stderr
