"""What a frame costs `dof` of which 5 % is out of focus, and one all out of focus, at 1920x1080 with a CoC radius of 16 px: its passes,
and these with upload and readback, which copy every pixel of both frames; of each the least of four runs of seven frames in turns."""
import os
import re
import subprocess
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy

from measure.exr import write_exr
from measure.pages import Figures
from measure.tree import AFTERSHADE, ROOT, write_look

WORK = ROOT / "build/bench/focus"
WIDTH, HEIGHT, FRAMES, TURNS = 1920, 1080, 7, 4
FOCUS_M, FOCAL_MM, SENSOR_MM, COC_RADIUS_PX = 2, 200, 36, 16
ROW = re.compile(r"^(\S+) +[\d.]+ +([\d.]+) +[\d.]+$", re.M)  # mean, least, most


def sequence(name: str, blurred: float) -> Path:
    """Noise of which `blurred` of the width is at infinity and the rest in focus, for several frames."""
    first = WORK / f"{name}_0001.exr"
    random = numpy.random.default_rng(1)
    planes = {c: random.random((HEIGHT, WIDTH), dtype=numpy.float32) for c in "RGB"}
    planes["A"] = numpy.ones((HEIGHT, WIDTH), numpy.float32)
    planes["Z"] = numpy.full((HEIGHT, WIDTH), FOCUS_M, numpy.float32)
    planes["Z"][:, :int(WIDTH * blurred)] = numpy.inf
    write_exr(first, planes)
    for i in range(2, FRAMES + 1):
        (WORK / f"{name}_{i:04}.exr").unlink(missing_ok=True)
        os.link(first, WORK / f"{name}_{i:04}.exr")
    return WORK / f"{name}_####.exr"


def rows_ms(look: Path, frames: Path, threads: int) -> dict[str, float]:
    words = [AFTERSHADE, "run", look, frames, "-o", WORK / "out_####.exr", "--backend", "software", "--compression", "none", "--no-journal",
             "--overwrite", "--verbose"]
    done = subprocess.run([str(w) for w in words], check=True, capture_output=True, text=True,
                          env=os.environ | {"LP_NUM_THREADS": str(threads)})
    return {name: float(ms) for name, ms in ROW.findall(done.stdout + done.stderr)}


def frames_ms(look: Path, sequences: Sequence[Path], threads: int) -> Iterator[tuple[float, float]]:
    """Of each sequence the passes, and all rows of the table: of each row the least of several runs in turns, of which the first fills
    the program cache."""
    runs = [[rows_ms(look, frames, threads) for frames in sequences] for _ in range(1 + TURNS)][1:]
    for of_sequence in zip(*runs):
        least = {name: min(run[name] for run in of_sequence) for name in of_sequence[0]}
        yield sum(ms for name, ms in least.items() if name.startswith("dof.")), sum(least.values())


def figures() -> Figures:
    WORK.mkdir(parents=True, exist_ok=True)
    aperture_mm = 2 * COC_RADIUS_PX * SENSOR_MM / WIDTH * FOCUS_M * 1000 / FOCAL_MM
    params = {"focus_distance": FOCUS_M, "focal_length": FOCAL_MM, "sensor_width": SENSOR_MM, "lens_model": "pinhole",
              "f_number": FOCAL_MM / aperture_mm, "max_coc_radius": 64, "blades": 6}
    look = write_look(WORK / "dof.json", {"effect": "dof", "params": params})
    sequences = [sequence("part", 0.05), sequence("whole", 1)]
    name = "a frame with 5 % out of focus, of one all out of focus"
    found = {}
    for threads, of in (1, ", one thread"), (os.cpu_count() or 1, ""):
        part, whole = frames_ms(look, sequences, threads)
        print(f"dof{of}: a frame with 5 % out of focus {part[0]:.1f} ms, one all out of focus {whole[0]:.1f} ms; with upload and readback "
              f"{part[1]:.1f} and {whole[1]:.1f} ms", flush=True)
        found[f"`dof`{of}, passes alone: {name}"] = round(part[0] / whole[0], 3)
        found[f"`dof`{of}: {name}"] = round(part[1] / whole[1], 3)
    return found
