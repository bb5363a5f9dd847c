"""Reads 4 of 25 channels of ZIP files, and writes half RGB with ZIP, by Aftershade and by OpenImageIO's wheel in turns on
as many threads, at 960x540 and 1080p; prints medians and their ratios. The pictures are a scene's, enlarged, with some
noise. With $AFTERSHADE_CAPTURES also reads a capture of Blender's, 25 channels at 960x540.

    FIGURES=FILE     also writes the ratios as JSON
    scripts/bench exr [EXR_BENCH [ROUNDS [THREADS]]]      build/release/tests/bench/exr_bench, 15, 2
"""
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import OpenImageIO as oiio

from measure.measures import Array
from measure.tree import ROOT

SIZES = ((960, 540), (1920, 1080))
CHANNELS = ["A", "B", "G", "R", "Z"] + [f"{layer}.{c}" for layer in ("albedo", "normal", "motion", "light", "position") for c in "XYZW"]
WANTED = ["R", "G", "B", "A"]  # the first in OpenImageIO's order, which reads a range of channels
SCENE = ROOT / "scenes/suzanne/gbuffer_0003.exr"


def spec_of(width: int, height: int, names: Sequence[str], kind: str) -> oiio.ImageSpec:
    spec = oiio.ImageSpec(width, height, len(names), kind)
    spec.channelnames = names
    spec.attribute("compression", "zip")
    return spec


def make_capture(path: Path, width: int, height: int) -> None:
    """25 float channels: smooth pictures of a scene, of which every fourth has the noise of few samples."""
    scene = oiio.ImageBuf(str(SCENE))
    pixels = oiio.ImageBufAlgo.resize(scene, roi=oiio.ROI(0, width, 0, height, 0, 1, 0, scene.nchannels)).get_pixels(oiio.FLOAT)
    random = np.random.default_rng(1)
    planes = []
    for i in range(len(CHANNELS)):
        plane = pixels[..., i % pixels.shape[2]] * (1 + i / 8)
        planes.append(plane * random.normal(1, 0.02, plane.shape) if i % 4 == 0 else plane.astype(np.float16))
    out = oiio.ImageOutput.create(str(path))
    out.open(str(path), spec_of(width, height, CHANNELS, "float"))
    out.write_image(np.stack(planes, axis=-1).astype(np.float32))
    out.close()


def timed_ms(work: Callable[[], object]) -> float:
    begin = time.perf_counter()
    work()
    return 1000 * (time.perf_counter() - begin)


def rival_read(path: Path, wanted: Sequence[str] = WANTED) -> Array:
    file = oiio.ImageInput.open(str(path))
    first = file.spec().channelnames.index(wanted[0])
    pixels = file.read_image(0, 0, first, first + len(wanted), "float")
    file.close()
    return pixels


def rival_write(path: Path, pixels: Array) -> None:
    out = oiio.ImageOutput.create(str(path))
    out.open(str(path), spec_of(pixels.shape[1], pixels.shape[0], ["R", "G", "B"], "half"))
    out.write_image(pixels)
    out.close()


class Bench:
    def __init__(self, program: str, threads: int) -> None:
        self.process = subprocess.Popen([program, str(threads)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def time_ms(self, *words: object) -> float:
        print(*words, file=self.process.stdin, flush=True)
        assert self.process.stdout
        return float(self.process.stdout.readline())


FIGURES = {}


def compare(what: str, rounds: int, ours: Callable[[], float], theirs: Callable[[], float]) -> None:
    times = [(ours(), theirs()) for _ in range(rounds + 1)][1:]
    our_ms, their_ms = (statistics.median(side) for side in zip(*times))
    print(f"{what:<34} {our_ms:8.1f} ms   OpenImageIO {their_ms:8.1f} ms   {their_ms / our_ms:5.2f} times as fast", flush=True)
    FIGURES[f"EXR, {what}: times as fast as OpenImageIO"] = round(their_ms / our_ms, 2)


def main() -> None:
    program = sys.argv[1] if len(sys.argv) > 1 else "build/release/tests/bench/exr_bench"
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 15
    threads = int(sys.argv[3]) if len(sys.argv) > 3 else 2
    oiio.attribute("threads", threads)
    oiio.attribute("exr_threads", threads)
    bench = Bench(program, threads)
    print(f"OpenImageIO {oiio.VERSION_STRING}, {threads} threads, medians of {rounds}")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for width, height in SIZES:
            size, capture = f"{width}x{height}", folder / f"capture_{width}.exr"
            make_capture(capture, width, height)
            compare(f"{size}: read 4 of 25, ZIP", rounds, lambda: bench.time_ms("read", capture, *WANTED), lambda: timed_ms(lambda: rival_read(capture)))
            pixels = np.ascontiguousarray(rival_read(capture)[..., :3])
            mine, theirs = folder / "mine.exr", folder / "theirs.exr"
            compare(
                f"{size}: write half RGB, zip",
                rounds,
                lambda: bench.time_ms("write", mine, capture, "zip"),
                lambda: timed_ms(lambda: rival_write(theirs, pixels)),
            )
            FIGURES[f"EXR, {size}: size of the written file, of OpenImageIO's"] = round(mine.stat().st_size / theirs.stat().st_size, 3)
            print(f"{'':<34} size {mine.stat().st_size / theirs.stat().st_size:.3f} of OpenImageIO's")
    captures = os.environ.get("AFTERSHADE_CAPTURES")
    if captures:
        frame = Path(captures) / "suzanne/large/gbuffer_0004.exr"
        wanted = [f"ViewLayer.Combined.{c}" for c in "RGBA"]
        compare(
            "Blender's 960x540: read 4 of 25",
            rounds,
            lambda: bench.time_ms("read", frame, *wanted),
            lambda: timed_ms(lambda: rival_read(frame, wanted)),
        )
    if "FIGURES" in os.environ:
        Path(os.environ["FIGURES"]).write_text(json.dumps(FIGURES))


if __name__ == "__main__":
    main()
