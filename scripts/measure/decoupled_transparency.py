"""The part of docs/quality-decoupled.md on transparent surfaces: stochastic transparency and lists against sorted blending."""
import json
from pathlib import Path
from typing import Any

import numpy

from measure.decoupled_rates import MB, TRUTH_SAMPLES, WORK, strip
from measure.exr import read_exr
from measure.measures import Array, bytes_of, psnr_db
from measure.pages import Blocks, table
from measure.tree import AFTERSHADE, ROOT, Document, command

FRAME = 4
COUNTS = [4, 8, 16, 32, 64]


def rendered(name: str, kind: str, samples: int, *words: object) -> tuple[Array, Document]:
    folder = WORK / "picture"
    told = json.loads(command([AFTERSHADE, "render", ROOT / "scenes" / name, "-o", folder, "--frames", FRAME, "--truth-only", "--quiet", "--json",
                               "--visibility", kind, "--visibility-samples", samples, *words]))["visibility"][0]
    return read_exr(folder / f"{kind}_{FRAME:04}.exr"), told


def truth(name: str) -> Array:
    folder = WORK / f"{name}_truth"
    file = folder / f"truth_lens_shutter_antialias_{FRAME:04}.exr"
    if not file.exists():
        command([AFTERSHADE, "render", ROOT / "scenes" / name, "-o", folder, "--frames", FRAME, "--truth-only", "--quiet", "--seed", 7,
                 "--truth", "lens+shutter+antialias", "--truth-method", "interleaved", "--samples", TRUTH_SAMPLES])
    return read_exr(file)


def memory(told: Any) -> float:
    return (told["bytes"]["visibility"] + told["bytes"]["lists"] + told["bytes"]["shading"]) / MB


def on_transparent(images: Path) -> Blocks:
    rows, shown = [], []
    for name in "panes", "smoke":
        expected = truth(name)
        for count in COUNTS:
            chance, of_chance = rendered(name, "memoised", count, "--transparency", "stochastic")
            lists, of_lists = rendered(name, "memoised", count, "--transparency", "lists")
            fine = [rendered(name, "memoised", count, "--transparency", way, "--shading-rate", 2)[0] for way in ("stochastic", "lists")]
            by_order, _ = rendered(name, "supersampled", count, "--transparency", "sorted")
            error = numpy.sqrt(numpy.mean((chance - expected) ** 2))
            rows.append([f"`{name}`", count, *(f"{psnr_db(expected, p):.2f}" for p in (chance, lists, *fine, by_order)),
                         f"{error * count**0.5:.3f}", f"{of_chance['shading_rate']['mean']:.2f}", f"{of_lists['shading_rate']['mean']:.2f}",
                         f"{memory(of_chance):.0f}", f"{memory(of_lists):.0f}", of_lists["lists"]["overflows"]])
            print(*rows[-1], flush=True)
            if count in (8, 64):
                shown.append(chance)
        shown.append(expected)
    crop = lambda p: bytes_of(p[50:230, 90:400])
    strip([[crop(p) for p in shown[:3]], [crop(p) for p in shown[3:]]]).save(images / "transparency.jpg", quality=88)
    head = ["scene", "samples", "stochastic, dB", "lists, dB", "stochastic at shading rate 2, dB", "lists at shading rate 2, dB", "sorted, dB",
            "error of stochastic times the root of the samples", "rate, stochastic", "rate, lists", "memory, stochastic, MB", "memory, lists, MB",
            "lists, overflows"]
    return {"transparency": table(head, rows)}
