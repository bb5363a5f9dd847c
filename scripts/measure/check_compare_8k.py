"""`aftershade compare` of pictures of 7680 x 4320: equal ones are the same, one pixel among 33 million is found with its place, as PNG
(LDR-FLIP), Radiance (HDR-FLIP) and OpenEXR; prints time and peak memory of each. Takes a minute or two and 4 GB.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time

import numpy as np
from PIL import Image

from measure.radiance import write_hdr
from measure.tree import AFTERSHADE, Document

WIDTH, HEIGHT, X, Y = 7680, 4320, 6543, 3210


def compare(*words: str) -> tuple[int, Document, float, float]:
    """Exit code, report, s, peak MB."""
    begin = time.perf_counter()
    run = subprocess.Popen([AFTERSHADE, "compare", *words, "--json", "-q"], stdout=subprocess.PIPE)
    assert run.stdout
    report = json.load(run.stdout)
    _, status, used = os.wait4(run.pid, 0)
    return os.waitstatus_to_exitcode(status), report, time.perf_counter() - begin, used.ru_maxrss / 1024


def check(kind: str, reference: str, test: str) -> None:
    code, report, seconds, _ = compare(reference, reference)
    if code != 0 or report["layers"][0]["failing"]["pixels"] != 0:
        sys.exit(f"{kind}: a picture differs from itself")
    print(f"{kind}: the same in {seconds:.1f} s")
    code, report, seconds, megabytes = compare(reference, test)
    layer = report["layers"][0]
    found = layer["max_error"]
    if code != 2 or layer["failing"]["pixels"] != 1 or (found["x"], found["y"]) != (X, Y):
        sys.exit(f"{kind}: exit {code}, {layer['failing']}, {found}")
    flip = layer["hdr_flip"] or layer["ldr_flip"]
    if not 0 < flip["mean"] < 1e-4 or abs(flip["x"] - X) > 3 or abs(flip["y"] - Y) > 3:
        sys.exit(f"{kind}: {flip}")
    print(f"{kind}: one pixel found in {seconds:.1f} s, peak {megabytes:.0f} MB")


def main() -> None:
    random = np.random.default_rng(1)
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH].astype(np.float32)
    light = (0.1 + 0.6 * x / WIDTH + 0.2 * np.sin(y / 90)).astype(np.float32)
    picture = np.stack([light, 0.8 * light, 0.6 * light], -1)
    picture[::3, ::5] += random.random((HEIGHT // 3, WIDTH // 5, 1), np.float32) * 0.1
    other = picture.copy()
    other[Y, X] = 1
    with tempfile.TemporaryDirectory() as folder:
        path = [os.path.join(folder, name) for name in ("r", "t")]
        for name, image in zip(path, (picture, other)):
            Image.fromarray((np.clip(image, 0, 1) * 255 + 0.5).astype(np.uint8)).save(name + ".png", compress_level=1)
            write_hdr(name + ".hdr", np.clip(image, 0, 1))
        check("PNG", path[0] + ".png", path[1] + ".png")
        check("Radiance", path[0] + ".hdr", path[1] + ".hdr")
        if shutil.which("oiiotool"):
            for name in path:
                subprocess.run(["oiiotool", name + ".hdr", "-d", "half", "-o", name + ".exr"], check=True)
            check("OpenEXR", path[0] + ".exr", path[1] + ".exr")


if __name__ == "__main__":
    main()
