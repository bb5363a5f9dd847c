"""What FLIP costs here and in NVIDIA's flip-evaluator (C++ with OpenMP): both in memory on all cores, in turns in one run, so that the
machine's noise meets both alike; medians and their ratio. Exits 1 where LDR-FLIP is slower than theirs.

    SIZE=1920x1080 RUNS=5      half as many of HDR-FLIP; `scripts/check compare-8k` has 7680x4320
"""
import os
import statistics
import subprocess
import sys
import tempfile
import time

import flip_evaluator
import numpy as np
from PIL import Image

from measure.measures import Array
from measure.radiance import write_hdr

BENCH = "build/release/tests/bench/flip_bench"


def pictures(width: int, height: int) -> tuple[Array, Array]:
    """Soft shapes, hard bars and noise as light, and the same a little shifted with other noise."""
    random = np.random.default_rng(1)
    y, x = np.mgrid[0:height, 0:width].astype(np.float32)

    def scene(shift: int) -> Array:
        light = 0.05 + 0.3 * ((x + shift) / width) + 20 * np.exp(-((x + shift - width / 3) ** 2 + (y - height / 3) ** 2) / 2e4)
        light += 0.4 * (((x + shift) // 40) % 2) * (y > height / 2)
        color = np.stack([light, 0.8 * light, 0.6 * light], -1)
        return (color * random.uniform(0.9, 1.1, color.shape)).astype(np.float32)

    return scene(0), scene(3)


def ours(kind: str, reference: str, test: str) -> tuple[float, ...]:
    line = subprocess.run([BENCH, kind, reference, test, "1"], capture_output=True, text=True, check=True).stdout
    return tuple(float(word) for word in line.split())


def theirs(kind: str, reference: Array, test: Array) -> tuple[float, float]:
    begin = time.perf_counter()
    _, mean, _ = flip_evaluator.evaluate(reference, test, kind.upper(), applyMagma=False)
    return (time.perf_counter() - begin) * 1000, mean


def main() -> None:
    width, height = (int(n) for n in os.environ.get("SIZE", "1920x1080").split("x"))
    runs = int(os.environ.get("RUNS", "5"))
    reference, test = pictures(width, height)
    slower = False
    with tempfile.TemporaryDirectory() as folder:
        for kind in ("ldr", "hdr"):
            paths, images = [], []
            for name, image in (("r", reference), ("t", test)):
                path = os.path.join(folder, f"{name}.{'png' if kind == 'ldr' else 'hdr'}")
                if kind == "ldr":
                    bytes_ = (np.clip(image, 0, 1) ** (1 / 2.2) * 255 + 0.5).astype(np.uint8)
                    Image.fromarray(bytes_).save(path, compress_level=1)
                    images.append(bytes_.astype(np.float32) / 255)
                else:
                    images.append(write_hdr(path, image))
                paths.append(path)
            ours(kind, *paths)
            theirs(kind, *images)
            count = runs if kind == "ldr" else (runs + 1) // 2
            pairs = [(ours(kind, *paths), theirs(kind, *images)) for _ in range(count)]
            a, b = (statistics.median(pair[i][0] for pair in pairs) for i in (0, 1))
            print(f"{kind.upper()}-FLIP {width}x{height}: aftershade {a:.0f} ms, flip-evaluator {b:.0f} ms, ratio "
                  f"{b / a:.2f}; means {pairs[0][0][1]:.6f} and {pairs[0][1][1]:.6f}")
            slower = slower or (kind == "ldr" and a > b)
            if kind == "ldr":
                milliseconds = statistics.median(ours("ssim", *paths)[0] for _ in range(min(runs, 3)))
                print(f"SSIM and MS-SSIM {width}x{height}: aftershade {milliseconds:.0f} ms")
    if slower:
        sys.exit("LDR-FLIP is slower than flip-evaluator")


if __name__ == "__main__":
    main()
