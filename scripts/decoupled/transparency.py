"""The part of docs/quality-decoupled.md on transparent surfaces: stochastic transparency and lists against sorted blending."""
import json

import numpy

from family import AFTERSHADE, ROOT, command, psnr_db, read_exr, srgb
from rates import MB, RGB, TRUTH_SAMPLES, WORK, strip

FRAME = 4
COUNTS = [4, 8, 16, 32, 64]


def rendered(name, kind, samples, *words):
    folder = WORK / "picture"
    told = json.loads(command([AFTERSHADE, "render", ROOT / "scenes" / name, "-o", folder, "--frames", FRAME, "--truth-only", "--quiet", "--json",
                               "--visibility", kind, "--visibility-samples", samples, *words]))["visibility"][0]
    return read_exr(folder / f"{kind}_{FRAME:04}.exr", RGB), told


def truth(name):
    folder = WORK / f"{name}_truth"
    file = folder / f"truth_lens_shutter_antialias_{FRAME:04}.exr"
    if not file.exists():
        command([AFTERSHADE, "render", ROOT / "scenes" / name, "-o", folder, "--frames", FRAME, "--truth-only", "--quiet", "--seed", 7,
                 "--truth", "lens+shutter+antialias", "--truth-method", "interleaved", "--samples", TRUTH_SAMPLES])
    return read_exr(file, RGB)


def memory(told):
    return (told["bytes"]["visibility"] + told["bytes"]["lists"] + told["bytes"]["shading"]) / MB


def on_transparent(table, text, images):
    """Words, table and pictures of the section."""
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
    crop = lambda p: numpy.round(255 * srgb(p[50:230, 90:400])).astype(numpy.uint8)
    strip([[crop(p) for p in shown[:3]], [crop(p) for p in shown[3:]]]).save(images / "transparency.jpg", quality=88)
    return [text("transparency"),
            table(["scene", "samples", "stochastic, dB", "lists, dB", "stochastic at shading rate 2, dB", "lists at shading rate 2, dB", "sorted, dB",
                   "error of stochastic times the root of the samples", "rate, stochastic", "rate, lists", "memory, stochastic, MB", "memory, lists, MB",
                   "lists, overflows"], rows),
            "![stochastic transparency](images/decoupled/transparency.jpg)",
            "Stochastic transparency with 8 samples and with 64, and the truth."]
