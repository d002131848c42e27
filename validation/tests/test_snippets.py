"""The examples of README, guides and the plugin's documentation are run as they stand.

Those of the command's guide are compared with what it prints in cli/tests/command/guide.rs.
"""

import os
import re
import shlex
import subprocess
import sys
import textwrap

import pytest

from validation.support.command import COMMAND
from validation.support.core import LIBRARY
from validation.support.paths import PLUGIN_ROOT, ROOT

RST = ROOT / "mitsuba-plugin/docs/prob_water.rst"


def blocks(path, language):
    """The fenced blocks of a language."""
    return re.findall(rf"^```{language}\n(.*?)^```", (ROOT / path).read_text(), re.MULTILINE | re.DOTALL)


def rst_block(language):
    """A tab of the plugin's documentation."""
    found = re.search(rf"code-tab:: {language}\n(?: +:name:.*\n)?\n((?: {{8}}.*\n|\n)+)", RST.read_text())
    return textwrap.dedent(found.group(1))


def run(arguments, **options):
    """What a program prints; it must succeed."""
    done = subprocess.run(arguments, capture_output=True, text=True, cwd=options.pop("cwd", ROOT), **options)
    assert done.returncode == 0, f"{arguments}\n{done.stdout}{done.stderr}"
    return done.stdout


XML = [("README.md", n, text) for n, text in enumerate(blocks("README.md", "xml"))] + [("rst", 0, rst_block("xml"))]


@pytest.mark.parametrize("path, number, text", XML, ids=[f"{path}-{number}" for path, number, _ in XML])
def test_xml(use, path, number, text):
    """A BSDF lies on a rectangle, a shape stands alone."""
    mi = use("scalar_rgb")
    shape = f'<shape type="rectangle">{text}</shape>' if text.lstrip().startswith("<bsdf") else text
    scene = mi.load_string(f'<scene version="3.0.0">{shape}</scene>')
    assert "ProbWater" in str(scene.shapes()[0].bsdf())


@pytest.mark.parametrize("path", ["README.md", "docs/guide-mitsuba.md"])
def test_python(path, tmp_path):
    """All blocks of a page, one after the other, in a scalar variant. `scene` is one of the reader's own."""
    assert PLUGIN_ROOT.is_dir()
    before = "from validation.support.mitsuba_setup import sea_of\n"
    scene = """
scene = mi.load_dict({"type": "scene", "integrator": {"type": "direct"}, "light": {"type": "constant"},
    "sensor": {"type": "perspective", "film": {"type": "hdrfilm", "width": 8, "height": 8}}})
"""
    found = blocks(path, "python")
    assert found
    code = before + (scene + "\n").join(found)
    code = code.replace("llvm_ad_rgb", "scalar_rgb").replace('"render.exr"', repr(str(tmp_path / "render.exr")))
    run([sys.executable, "-c", code])


def test_python_example(tmp_path):
    """A picture and a line for every wind."""
    printed = run([sys.executable, "scenes/winds.py", tmp_path]).splitlines()
    assert len(printed) == len(list(tmp_path.glob("wind_*.exr"))) == 3


def test_plugin_documentation(use):
    """Its dictionary loads; what it calls exposed is what `traverse` gives, for every way to give the wind."""
    mi = use("scalar_rgb")
    mi.load_dict(eval("{" + rst_block("python") + "}"))
    exposed = set(re.search(r"^\.\. exposed: (.*)$", RST.read_text(), re.MULTILINE).group(1).split(", "))
    found = set()
    for wind in [{"wind_speed": 7}, {"friction_velocity": 8}, {"beaufort": 3}]:
        bsdf = mi.load_dict({"type": "prob_water", "surface": "instance", "ior": 1.34, "extinction": 0.1, **wind})
        found |= {name for name, _ in mi.traverse(bsdf)}
    assert found == exposed


def test_commands_of_the_readme():
    """The project's own are known by name; the scenario is worked out."""
    lines = [shlex.split(line, comments=True) for block in blocks("README.md", "sh") for line in block.splitlines()]
    known = (ROOT / "xtask/src/main.rs").read_text()
    assert len(lines) >= 4
    for words in lines:
        if words[:2] == ["cargo", "xtask"]:
            assert f"\n  {words[2]} " in known, words
        elif "--example" in words:
            # `cargo xtask examples` runs it.
            assert (ROOT / f"rust-core/examples/{words[-1]}.rs").is_file(), words
        else:
            assert words[:6] == ["cargo", "run", "--release", "-p", "prob-water-cli", "--"], words
            assert run([COMMAND, *words[6:]]).startswith("time,observer,mean")


def test_rust(tmp_path):
    """Every section of the guide, after what its first one configures."""
    sections = (ROOT / "docs/guide-rust.md").read_text().split("\n## ")[1:]
    examples = [re.findall(r"^```rust\n(.*?)^```", section, re.MULTILINE | re.DOTALL) for section in sections]
    configured, code = examples[0][:1], []
    for found in filter(None, examples):
        # Each in a scope of its own, within that of the one before it.
        within = found if found is examples[0] else configured + found
        code.append("{" + "{\n".join(within) + "}" * len(within))
    main = "fn main() -> Result<(), Box<dyn std::error::Error>> {\n" + "\n".join(code) + "\nOk(()) }\n"
    source = tmp_path / "guide.rs"
    source.write_text("#![allow(unused)]\n" + main)
    program = tmp_path / "guide"
    run(["rustc", "--edition", "2024", source, "-o", program, "--extern", f"prob_water={LIBRARY.with_suffix('.rlib')}",
         "-L", f"dependency={ROOT / 'target/release/deps'}"])
    assert "+-" in run([program])


def test_c(tmp_path):
    """The guide's program prints the numbers it promises; its fragments compile and run within it."""
    archive = LIBRARY.with_suffix(".a")
    program, *fragments = blocks("docs/guide-c.md", "c")
    extra = """
    double sx[1] = {0}, sy[1] = {0}, sz[1] = {1}, ox[1] = {0}, oy[1] = {0}, oz[1] = {1};
    size_t rows = 1;
"""
    types = (ROOT / "rust-core/include/prob_water.h").read_text()
    if re.search(r"eval_columns\([^;]*const float", types):
        extra = extra.replace("double", "float") + "    float g[1];\n"
        fragments = [f.replace("NULL, f)", "NULL, g)") for f in fragments]
    printed = program.index("    prob_water_free(sea);\n    prob_water_options_free(options);\n    return 0;")
    texts = {"guide": program}
    texts["fragments"] = program[:printed] + extra + "".join("{" + f + "}\n" for f in fragments) + program[printed:]
    for name, text in texts.items():
        source = tmp_path / f"{name}.c"
        source.write_text(text)
        run([os.environ.get("CC", "cc"), "-std=c99", "-I", "rust-core/include", source, archive, "-lm", "-lpthread", "-ldl",
             "-o", tmp_path / name])
        shown = run([tmp_path / name]).split()
        promised = re.search(r"prints (\S+) and (\S+), in", (ROOT / "docs/guide-c.md").read_text()).groups()
        assert all(abs(float(x) / float(y) - 1) < 1e-14 for x, y in zip(shown, promised, strict=False)), shown
