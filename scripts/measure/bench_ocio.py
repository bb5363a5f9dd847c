"""Views of OpenColorIO against `view_transform` with `srgb`: the pass at 1080p, in turns, on software GL. Prints the medians and
their ratios, and fills the table of docs/color.md. Exits 1 where a view costs more than twice as much.

    SIZE=1920x1080 REPETITIONS=9 VERBOSE=1
"""
import os
import sys

import numpy

from measure.effect_bench import run_bench
from measure.exr import RGB, read_exr, write_exr
from measure.pages import Page, table
from measure.tree import ROOT

WORK = ROOT / "build/bench-ocio"
SIZE = [int(n) for n in os.environ.get("SIZE", "1920x1080").split("x")]
REPETITIONS = int(os.environ.get("REPETITIONS", "9"))
MOST = 2.0
EDGE = 33
CONFIG = """ocio_profile_version: 2
search_path: "."
roles: {default: light, aces_interchange: light}
displays: {Monitor: [!<View> {name: Film, colorspace: film}]}
colorspaces:
  - !<ColorSpace> {name: light}
  - !<ColorSpace>
    name: film
    from_scene_reference: !<GroupTransform>
      children:
        - !<LogAffineTransform> {base: 2, log_side_slope: 0.05, log_side_offset: 0.6, lin_side_offset: 0.002}
        - !<FileTransform> {src: film.cube, interpolation: tetrahedral}
"""


def write_config() -> str:
    """A view by a logarithm and a cube, as studios have them."""
    axis = numpy.linspace(0, 1, EDGE)
    b, g, r = numpy.meshgrid(axis, axis, axis, indexing="ij")
    rows = numpy.stack([r ** 1.2 * 0.9 + g * b / 10, g ** 1.3, b ** 1.1 * (1 - r / 4)], -1).reshape(-1, 3)
    lines = "\n".join(" ".join(f"{value:.6f}" for value in row) for row in rows)
    (WORK / "film.cube").write_text(f"LUT_3D_SIZE {EDGE}\n{lines}\n")
    path = WORK / "config.ocio"
    path.write_text(CONFIG)
    return str(path)


def write_frame() -> None:
    """Suzanne, each pixel many times."""
    width, height = SIZE
    suzanne = read_exr(ROOT / "scenes/suzanne/gbuffer_0003.exr", [f"ViewLayer.Combined.{c}" for c in RGB])
    rows = numpy.arange(height) * suzanne.shape[0] // height
    columns = numpy.arange(width) * suzanne.shape[1] // width
    picture = suzanne[rows][:, columns]
    planes = {channel: picture[..., i] for i, channel in enumerate(RGB)}
    write_exr(WORK / "in.exr", planes | {"A": numpy.ones((height, width), numpy.float32)})


def main() -> None:
    page = Page("color.md", "scripts/bench ocio", ["cost"])
    WORK.mkdir(parents=True, exist_ok=True)
    write_frame()
    srgb = {"display": "sRGB - Display"}
    cases = [
        {"name": "`view_transform`, `srgb`", "effect": "view_transform", "params": {}},
        {"name": "a matrix: `Un-tone-mapped`", "effect": "ocio_view", "params": srgb | {"view": "Un-tone-mapped"}},
        {"name": f"a logarithm and a LUT of {EDGE} points a side", "effect": "ocio_view", "params": {"config": write_config()}},
        {"name": "`ACES 1.0 - SDR Video`", "effect": "ocio_view", "params": srgb | {"view": "ACES 1.0 - SDR Video"}},
    ]
    job = {"size": SIZE, "repetitions": REPETITIONS, "role": "display", "capture": str(WORK / "in.exr"), "profile": "native",
           "frame": 1, "roles": ["color"], "cases": cases}
    runs = run_bench(job, [], [ROOT / "effects"], WORK)
    names = [str(case["name"]) for case in cases]
    ratios = [runs[name]["ms"] / runs[names[0]]["ms"] for name in names]
    for name, ratio in zip(names, ratios, strict=True):
        print(f"{name:>50}: {runs[name]['ms']:.1f} ms, ratio {ratio:.2f}")
    rows = [[name, f"{runs[name]['ms']:.0f}", f"{ratio:.1f}"] for name, ratio in zip(names, ratios, strict=True)]
    page.fill({"cost": table(["view", "ms", "times `srgb`"], rows)})
    if max(ratios) > MOST:
        sys.exit(f"a view costs {max(ratios):.2f} times srgb (limit {MOST})")


if __name__ == "__main__":
    main()
