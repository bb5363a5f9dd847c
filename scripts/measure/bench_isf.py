"""The passes of ten ISF filters at 1080p against native effects of the same picture (tests/bench/isf), in turns, on software GL. Prints
the medians and their ratios, and fills the table of docs/isf.md. Exits 1 where pictures differ or the median of the ratios exceeds 1.1.

    SIZE=1920x1080 REPETITIONS=9 ONLY=bright,edges VERBOSE=1
"""
import os
import statistics
import sys

import numpy

from measure.effect_bench import run_bench
from measure.exr import read_exr, write_exr
from measure.pages import Page, table
from measure.tree import ROOT, command, write_json

FILTERS = ROOT / "tests/bench/isf"
WORK = ROOT / "build/bench-isf"
SIZE = [int(n) for n in os.environ.get("SIZE", "1920x1080").split("x")]
REPETITIONS = int(os.environ.get("REPETITIONS", "9"))
ONLY = [name for name in os.environ.get("ONLY", "").split(",") if name]
CHANNELS = [f"display.{c}" for c in "RGBA"]
PROGRAM = os.environ.get("AFTERSHADE", str(ROOT / "build/release/aftershade"))
MOST = 1.1


def difference(name: str) -> float:
    """Greatest difference of the two pictures, but for the thousandth of pixels that differ most: edges of squares fall by rounding."""
    pictures = []
    for effect in (name, f"native_{name}"):
        look = WORK / f"{effect}.json"
        write_json(look, {"aftershade": 1, "steps": [{"effect": effect}]})
        out = WORK / f"{effect}.exr"
        command([PROGRAM, "run", look, WORK / "capture.json", "-o", out, "--effect-path", FILTERS, "--output-roles", "display", "--pixel-type",
                 "float", "--progress", "none", "--backend", "software", "--overwrite"])
        pictures.append(read_exr(out, CHANNELS))
    return float(numpy.quantile(numpy.abs(pictures[0] - pictures[1]).max(axis=-1), 0.999))


def main() -> None:
    WORK.mkdir(parents=True, exist_ok=True)
    width, height = SIZE
    y, x = numpy.mgrid[0:height, 0:width].astype(numpy.float32)
    planes = [x / width, y / height, ((x // 40 + y // 30) % 2), numpy.ones_like(x)]
    planes = [x / width, y / height, (x // 40 + y // 30) % 2, numpy.ones_like(x)]
    write_exr(WORK / "in.exr", {name: planes[i % 4] for i, name in enumerate([*CHANNELS, *"RGBA"])})
    write_json(WORK / "capture.json", {"aftershade": 1, "frames": "in.exr", "fps": 24, "channels": {"display": {"channels": CHANNELS}}})
    names = [n for n in sorted(f.stem for f in FILTERS.glob("*.fs")) if not ONLY or n in ONLY]
    cases = [{"name": effect, "effect": effect, "params": {}} for n in names for effect in (n, f"native_{n}")]
    job = {"size": SIZE, "repetitions": REPETITIONS, "cases": cases, "role": "display"}
    runs = run_bench(job, [], [FILTERS], WORK)
    rows, ratios, differences = [], [], []
    for name in names:
        isf, native = (runs[effect]["ms"] for effect in (name, f"native_{name}"))
        ratios.append(isf / native)
        differences.append(difference(name))
        rows.append([f"`{name}`", f"{isf:.1f}", f"{native:.1f}", f"{isf / native:.2f}"])
        print(f"{name:>10}: ISF {isf:.2f} ms, native {native:.2f} ms, ratio {isf / native:.3f}, pictures differ by {differences[-1]:.5f}")
    ratio = statistics.median(ratios)
    print(f"median of the ratios: {ratio:.3f}")
    if not ONLY:
        Page("isf.md", "scripts/bench isf", ["cost"]).fill({"cost": table(["filter", "ISF, ms", "native, ms", "ratio"], rows)})
    if ratio > MOST or max(differences) > 2 / 255:
        sys.exit(f"the median of the ratios is {ratio:.3f} (limit {MOST}), and pictures differ by up to {max(differences):.4f}")


if __name__ == "__main__":
    main()
