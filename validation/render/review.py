"""Renders the review set: an EXR and a PNG per picture, and a page that shows them all.

`cargo xtask render [--quality final] [--only NAME] [--variant V] [--readme]` builds the plugin and runs it.
"""

import argparse
import os
import sys
import time
import xml.etree.ElementTree as xml
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import mitsuba as mi
import numpy as np

from validation.render import gallery, glitter_width
from validation.render.comparison import compare
from validation.render.review_set import COMPARISONS, PICTURES, WIDTHS, Picture
from validation.render.tone import EXPOSURE, to_bytes, tone_map
from validation.support.mitsuba_setup import SEA, SetupError, load_plugin, pick_variant, sea_of
from validation.support.paths import ROOT

# Samples are taken in passes, each with its own seed, so that the time left can be told.
PER_PASS = 16
QUALITIES = {
    "preview": {"passes": 2, "size": {"width": 640, "height": 360}, "vertices": 1_500_000},
    "final": {"passes": 16, "size": {"width": 1280, "height": 720}, "vertices": 5_000_000},
}
README_PICTURE = "beaufort_4"
README_IMAGE = ROOT / "docs" / "images" / "open_sea.png"
README_WIDTH = 700


def main() -> None:
    """Parses, renders, and turns what a user can mend into one line and exit status 2."""
    arguments = parse()
    try:
        variant = pick_variant(arguments.variant)
        if "rgb" not in variant and "spectral" not in variant:
            raise SetupError(f"{variant}: the scenes need colour, an rgb or spectral variant")
        load_plugin()
        pictures = select(arguments.only)
    except SetupError as error:
        sys.stdout.flush()
        print(f"render: {error}", file=sys.stderr)
        sys.exit(2)
    mi.set_variant(variant)
    mi.set_log_level(mi.LogLevel.Warn)
    arguments.out.mkdir(parents=True, exist_ok=True)
    for number, picture in enumerate(pictures, 1):
        label = f"[{number}/{len(pictures)}] {picture.name}"
        render(picture, label, variant, QUALITIES[arguments.quality], arguments.out)
    for comparison in COMPARISONS:
        if any(picture.name in (comparison.first, comparison.second) for picture in pictures):
            compare(comparison, arguments.out, replacing)
    # A hundred thousand rays at a time: only traced variants are fast enough.
    if not arguments.only and variant.startswith(("llvm", "cuda")):
        print(f"{WIDTHS.name}: half a minute", flush=True)
        with replacing(arguments.out / f"{WIDTHS.name}.png") as file:
            glitter_width.draw(glitter_width.table(mi, seeds=2), file)
    with replacing(arguments.out / "index.html") as file:
        gallery.write_page(arguments.out, file)
    print(f"render: {arguments.out / 'index.html'}")
    if arguments.readme:
        write_readme_image(arguments.out)


def parse() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(prog="cargo xtask render", description="Renders the review set.")
    parser.add_argument("--out", type=Path, default=Path("out"), help="directory to write into (out)")
    parser.add_argument("--quality", choices=QUALITIES, default="preview", help="size and samples (preview)")
    parser.add_argument("--variant", help="Mitsuba variant (llvm_ad_rgb, or scalar_rgb without LLVM)")
    parser.add_argument("--only", action="append", metavar="NAME", help="this picture; may be repeated")
    parser.add_argument(
        "--readme",
        action="store_true",
        help=f"also write {README_IMAGE.relative_to(ROOT)}, from {README_PICTURE}",
    )
    return parser.parse_args()


def select(names: list[str] | None) -> list[Picture]:
    """The pictures of these names, all where there are none."""
    known = {picture.name: picture for picture in PICTURES}
    for name in names or []:
        if name not in known:
            raise SetupError(f"no picture {name!r}: {', '.join(known)}")
    return [known[name] for name in names or known]


def render(picture: Picture, label: str, variant: str, quality: dict, out: Path) -> None:
    """Renders one picture into its EXR and PNG."""
    known = defaults(picture.scene)
    finer = {"vertices": quality["vertices"]} if "vertices" in known else {}
    parameters = finer | picture.parameters | quality["size"]
    start = time.monotonic()
    scene = mi.load_file(str(ROOT / picture.scene), **parameters)
    built = time.monotonic() - start
    passes = quality["passes"]
    total, start = 0.0, time.monotonic()
    for done in range(passes):
        progress(label, done, passes, time.monotonic() - start)
        total = total + np.array(mi.render(scene, spp=PER_PASS, seed=done), dtype=np.float64)
    seconds = time.monotonic() - start
    progress(label, passes, passes, seconds)

    image = total / passes
    bitmap = mi.Bitmap(image.astype(np.float32))
    facts = bitmap.metadata()
    facts["scene"] = picture.scene
    facts["parameters"] = ", ".join(
        f"{key} = {value}" for key, value in (known | finer | picture.parameters).items()
    )
    facts["size"] = "{width} x {height}".format(**quality["size"])
    facts["samples"] = f"{passes * PER_PASS} per pixel"
    facts["seconds"] = f"{seconds:.1f}, and {built:.1f} to build the scene"
    facts["variant"] = f"{variant}, Mitsuba {mi.__version__}"
    facts["rendered"] = time.strftime("%Y-%m-%d %H:%M UTC", time.gmtime())
    bsdfs = [shape.bsdf() for shape in scene.shapes()]
    waters = [bsdf for bsdf in bsdfs if bsdf.class_name() == "ProbWater"]
    if waters:
        facts[SEA] = sea_of(waters[0])
    with replacing(out / f"{picture.name}.exr") as file:
        bitmap.write(str(file))
    write_png(out / f"{picture.name}.png", image, picture.exposure)


def defaults(scene: str) -> dict[str, str]:
    """What the scene says about its parameters, without those that the quality sets."""
    found = {e.get("name"): e.get("value") for e in xml.parse(ROOT / scene).iter("default")}
    return {name: value for name, value in found.items() if name not in ("spp", "width", "height")}


def progress(label: str, done: int, passes: int, seconds: float) -> None:
    """A line that is kept up to date on a terminal; first and last in a pipe."""
    if done == passes:
        line = f"{label}: {passes * PER_PASS} samples per pixel in {seconds:.1f} s"
    elif done == 0:
        line = f"{label}: started"
    else:
        left = seconds / done * (passes - done)
        line = f"{label}: {100 * done // passes:2d} %, {left:.0f} s left"
    if sys.stdout.isatty():
        print(f"\r\x1b[K{line}", end="\n" if done == passes else "", flush=True)
    elif done in (0, passes):
        print(line, flush=True)


def write_png(target: Path, image: np.ndarray, exposure: float = EXPOSURE, dither: bool = True) -> None:
    """The tone-mapped picture."""
    with replacing(target) as file:
        mi.Bitmap(to_bytes(tone_map(image, exposure), dither)).write(str(file))


def write_readme_image(out: Path) -> None:
    """The README's picture, from the EXR rendered last: smaller, and not dithered, which halves the file."""
    exr = out / f"{README_PICTURE}.exr"
    if not exr.is_file():
        sys.exit(f"render: {exr} is missing: render {README_PICTURE} too")
    # Bitmaps are resampled by the filters of scalar variants.
    mi.set_variant("scalar_rgb")
    full = mi.Bitmap(str(exr))
    # The default filter has negative lobes, which draw a dark line above the glitter at the horizon.
    size = [README_WIDTH, full.size()[1] * README_WIDTH // full.size()[0]]
    small = full.resample(size, mi.load_dict({"type": "tent"}))
    README_IMAGE.parent.mkdir(parents=True, exist_ok=True)
    write_png(README_IMAGE, np.array(small), dither=False)
    print(f"render: {README_IMAGE.relative_to(ROOT)}, {README_IMAGE.stat().st_size // 1000} kB")


@contextmanager
def replacing(target: Path) -> Iterator[Path]:
    """A temporary file that takes the place of `target` once it is complete, and is removed otherwise."""
    temporary = target.with_name(f".{target.stem}.tmp{target.suffix}")
    try:
        yield temporary
        os.replace(temporary, target)
    finally:
        temporary.unlink(missing_ok=True)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit("\nrender: interrupted")
