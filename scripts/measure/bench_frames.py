"""Whole processes over sequences of frames: one light shader over 100 frames against moderngl with OpenImageIO in Python,
in turns; and 30 frames written with ZIP against the same without compression. Prints medians and ratios. Needs
AFTERSHADE_CAPTURES.

    FIGURES=FILE     also writes the ratios as JSON
    scripts/bench frames [ROUNDS]      5
"""
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import OpenImageIO as oiio

from measure.tree import AFTERSHADE, CAPTURES

CAPTURE = CAPTURES / "suzanne/large/gbuffer_0004.exr"
EFFECT = {
    "aftershade": 1,
    "id": "gain",
    "version": "1.0.0",
    "summary": "Multiplies the light.",
    "inputs": {"color": {"role": "color", "doc": "Any."}},
    "outputs": {"color": {"role": "color", "doc": "Brighter."}},
    "params": {"gain": {"type": "float", "default": 1.5, "min": 0, "max": 10, "ui": [0, 4], "doc": "Factor."}},
    "passes": [{"name": "gain", "shader": "gain.frag"}],
}
SHADER = """#version 450 core
#include <pass>

void main() {
    vec4 texel = texelFetch(color, ivec2(gl_FragCoord.xy), 0);
    out_color = vec4(texel.rgb * param.gain, texel.a);
}
"""


def measured(words: Sequence[str]) -> tuple[float, float]:
    """(wall s, processor s) of a process that must succeed."""
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wall, after = time.perf_counter() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def medians(rounds: int, *works: Callable[[], tuple[float, float]]) -> list[tuple[float, ...]]:
    """Of each work's (wall s, processor s), the works in turns; a first round is left out."""
    runs = [[work() for work in works] for _ in range(rounds + 1)][1:]
    return [tuple(statistics.median(one) for one in zip(*side)) for side in zip(*runs)]


def doubled(folder: Path) -> Path:
    """The same 25 channels at 1920x1080."""
    target = folder / "doubled.exr"
    picture = oiio.ImageBuf(str(CAPTURE))
    spec = oiio.ImageSpec(picture.spec())
    spec.set_format(oiio.FLOAT)
    pixels = picture.get_pixels(oiio.FLOAT).repeat(2, axis=0).repeat(2, axis=1)
    noise = np.random.default_rng(1).normal(1, 1e-3, pixels.shape[:2]).astype(np.float32)
    wide = oiio.ImageSpec(1920, 1080, spec.nchannels, "half")
    wide.channelnames, wide.channelformats = spec.channelnames, picture.spec().channelformats
    wide.attribute("compression", "zip")
    out = oiio.ImageOutput.create(str(target))
    out.open(str(target), wide)
    out.write_image(np.ascontiguousarray(pixels * noise[..., None]))
    out.close()
    return target


def sequence(folder: Path, name: str, file: Path, frames: int) -> str:
    for number in range(1, frames + 1):
        (folder / f"{name}.{number:04}.exr").symlink_to(file)
    return str(folder / f"{name}.####.exr")


def run(look: Path, frames: str, out: Path, *words: str) -> list[str]:
    return [str(AFTERSHADE), "run", str(look), frames, "--profile", "blender", "--effect-path", str(look.parent / "effects"), "-o", str(out), *words]


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    figures = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        effect = folder / "effects/gain"
        effect.mkdir(parents=True)
        (effect / "effect.json").write_text(json.dumps(EFFECT))
        (effect / "gain.frag").write_text(SHADER)
        look = folder / "look.json"
        look.write_text('{ "aftershade": 1, "steps": [ { "effect": "gain" } ] }')
        graded = folder / "graded.json"
        graded.write_text('{ "aftershade": 1, "steps": [ { "effect": "view_transform", "params": { "transform": "agx" } } ] }')
        print(f"medians of {rounds}, in turns")
        for size, file in (("960x540", CAPTURE), ("1920x1080", doubled(folder))):
            frames = sequence(folder, size, file, 100)
            rival = [sys.executable, str(Path(__file__).with_name("moderngl_chain.py")), frames.replace("####", "{}"),
                     str(folder / "theirs.{}.exr"), "ViewLayer.Combined.R"]
            ours = run(look, frames, folder / "ours.####.exr", "--overwrite")
            (a, a_cpu), (b, b_cpu) = medians(rounds, lambda: measured(ours), lambda: measured(rival))
            mine, theirs = (oiio.ImageBuf(str(folder / f"{side}.0007.exr")).get_pixels(oiio.FLOAT) for side in ("ours", "theirs"))
            same = "same pixels" if np.array_equal(mine[..., :3], theirs[..., :3]) else "PIXELS DIFFER"
            print(f"{size}: 100 frames in {a:.2f} s ({a_cpu:.2f} s of processor); moderngl {b:.2f} s ({b_cpu:.2f}): "
                  f"{b / a:.2f} times as fast, {same}", flush=True)
            figures[f"one light shader, 100 frames of {size}: times as fast as moderngl"] = round(b / a, 2)
        frames = sequence(folder, "thirty", CAPTURE, 30)
        words = [run(graded, frames, folder / "out.####.exr", "--overwrite", "--compression", c) for c in ("none", "zip")]
        (_, none), (_, packed) = medians(rounds, *(lambda w=w: measured(w) for w in words))
        print(f"30 frames: {none:.2f} s of processor without compression, {packed:.2f} with ZIP: {packed / none:.2f}")
        figures["30 frames: processor time with ZIP, of that without compression"] = round(packed / none, 2)
    if "FIGURES" in os.environ:
        Path(os.environ["FIGURES"]).write_text(json.dumps(figures))


if __name__ == "__main__":
    main()
