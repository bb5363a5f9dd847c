"""What a frame costs `dof` of which 5 % is out of focus, and one all out of focus, at 1920x1080 with a CoC radius of 16 px: its passes,
and these with upload and readback, which copy every pixel of both frames; of each the least of seven frames."""
import json
import os
import re
import subprocess

import numpy

from family import AFTERSHADE, ROOT, write_exr

WORK = ROOT / "build/bench/focus"
WIDTH, HEIGHT, FRAMES = 1920, 1080, 7
FOCUS_M, FOCAL_MM, SENSOR_MM, COC_RADIUS_PX = 2, 200, 36, 16
ROW = re.compile(r"^(\S+) +[\d.]+ +([\d.]+) +[\d.]+$", re.M)  # mean, least, most


def sequence(name, blurred):
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


def frame_ms(look, frames):
    """Of the passes, and of all rows of the table."""
    words = [AFTERSHADE, "run", look, frames, "-o", WORK / "out_####.exr", "--backend", "osmesa", "--compression", "none", "--no-journal",
             "--overwrite"]
    for _ in range(2):  # the first fills the program cache
        done = subprocess.run([str(w) for w in words], check=True, capture_output=True, text=True)
    rows = [(name, float(ms)) for name, ms in ROW.findall(done.stdout + done.stderr)]
    return sum(ms for name, ms in rows if name.startswith("dof.")), sum(ms for _, ms in rows)


def figures():
    WORK.mkdir(parents=True, exist_ok=True)
    aperture_mm = 2 * COC_RADIUS_PX * SENSOR_MM / WIDTH * FOCUS_M * 1000 / FOCAL_MM
    params = {"focus_distance": FOCUS_M, "focal_length": FOCAL_MM, "sensor_width": SENSOR_MM, "lens_model": "pinhole",
              "f_number": FOCAL_MM / aperture_mm, "max_coc_radius": 64, "blades": 6}
    look = WORK / "dof.json"
    look.write_text(json.dumps({"aftershade": 1, "steps": [{"effect": "dof", "params": params}]}))
    part, whole = (frame_ms(look, sequence(name, blurred)) for name, blurred in (("part", 0.05), ("whole", 1)))
    print(f"dof: a frame with 5 % out of focus {part[0]:.1f} ms, one all out of focus {whole[0]:.1f} ms; with upload and readback "
          f"{part[1]:.1f} and {whole[1]:.1f} ms", flush=True)
    name = "a frame with 5 % out of focus, of one all out of focus"
    return {f"`dof`, passes alone: {name}": round(part[0] / whole[0], 3), f"`dof`: {name}": round(part[1] / whole[1], 3)}
