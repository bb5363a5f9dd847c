"""Makes docs/quality-motion.md and its pictures; started by scripts/quality-motion, which says what it needs."""
import json
import os
import shutil

import numpy
from PIL import Image

import camera
import layers
import taa
from family import AFTERSHADE, CAPTURES, ROOT, command, psnr_db, read_exr, srgb

WORK = ROOT / "build/quality-motion"
IMAGES = ROOT / "docs/images/motion"
TEXTS = ROOT / "scripts/motion"
RGB = ["R", "G", "B"]
METHODS = ["bowles_2012", "jimenez_2014", "guertin_2014", "mcguire_2012"]
SCENES = {"moving_box": "one box before a wall at rest", "wheel": "30 degrees a frame", "camera_checker": "only the camera moves",
          "bats": "336 things of about 2 px each", "toys": "a blade, a ball that rolls and spins, and lights at rest"}
FRAME, SAMPLES = 7, 256
CROPS = {"ball": (90, 200, 220, 200), "cube": (640, 170, 270, 160)}  # x, y, w, h


def changed_pixels(sharp, truth):
    """docs/measures.md: where the mean over the 18 x 18 window x-8..x+9 of the mean difference as sRGB is above 0.02."""
    difference = numpy.abs(srgb(truth) - srgb(sharp)).mean(axis=-1)
    sums = numpy.pad(numpy.pad(difference, ((8, 9), (8, 9)), mode="edge").cumsum(0).cumsum(1), ((1, 0), (1, 0)))
    return (sums[18:, 18:] - sums[:-18, 18:] - sums[18:, :-18] + sums[:-18, :-18]) / 18**2 > 0.02


def blurred(capture, frame, params):
    look, out = WORK / "look.json", WORK / "out.exr"
    look.write_text(json.dumps({"aftershade": 1, "steps": [{"effect": "motion_blur", "params": params}]}))
    command([AFTERSHADE, "run", look, capture, "--frames", frame, "-o", out, "--pixel-type", "float", "--compression", "none",
             "--progress", "none", "--backend", "software"])
    return read_exr(out, RGB)


def vector_blur(source):
    """Blender's node at its best factor; None without blender."""
    if not shutil.which("blender"):
        return None
    out = WORK / "blender.exr"
    command(["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python", ROOT / "tests/bench/motion_blender.py",
             "--", "whole", source, out, 32, 960, 540, os.cpu_count()])
    return read_exr(out, RGB)


def on_suzanne():
    folder = CAPTURES / "suzanne"
    document = WORK / "suzanne/capture.json"
    document.parent.mkdir(parents=True, exist_ok=True)
    document.write_text(json.dumps({"aftershade": 1, "frames": str((folder / "large/gbuffer_####.exr").resolve()), "range": "3-5",
                                    "fps": 24, "profile": "blender"}))
    sharp = read_exr(folder / "large/gbuffer_0004.exr", [f"ViewLayer.Combined.{c}" for c in RGB])
    pictures = {"the sharp input": sharp}
    for method in METHODS:
        pictures[f"`motion_blur`, `{method}`"] = blurred(document, 4, {"method": method})
    pictures["`motion_blur`, `background` neighbours"] = blurred(document, 4, {"background": "neighbours"})
    for samples in 4, 8, 16:
        pictures[f"`motion_blur`, {samples} samples"] = blurred(document, 4, {"samples": samples})
    pictures["`motion_blur`, `curve` off"] = blurred(document, 4, {"curve": False})
    pictures["Blender's Vector Blur, 32 samples, factor 1"] = vector_blur(folder / "large/gbuffer_0004.exr")
    truth = read_exr(folder / "truth/motion_0004.exr", RGB)
    changed = changed_pixels(sharp, truth)
    rows = [[name, f"{psnr_db(truth, p):.2f}", f"{psnr_db(truth, p, changed):.2f}"] for name, p in pictures.items() if p is not None]
    shown = [pictures[n] for n in ("the sharp input", "`motion_blur`, `bowles_2012`", "`motion_blur`, `background` neighbours",
                                   "`motion_blur`, `jimenez_2014`")] + [truth]
    for name, (x, y, w, h) in CROPS.items():
        row = numpy.concatenate([p[y:y + h, x:x + w] for p in shown], axis=1)
        Image.fromarray((srgb(row) * 255 + 0.5).astype(numpy.uint8)).save(IMAGES / f"suzanne_{name}.jpg", quality=88)
    return rows


def on_scenes():
    rows = []
    for name, what in SCENES.items():
        folder = WORK / name
        if not (folder / f"truth_shutter_{FRAME:04}.exr").exists():
            command([AFTERSHADE, "render", ROOT / "scenes" / name, "-o", folder, "--frames", f"{FRAME - 1}-{FRAME + 1}", "--truth",
                     "shutter", "--samples", SAMPLES, "--quiet"])
        truth = read_exr(folder / f"truth_shutter_{FRAME:04}.exr", RGB)
        variants = [{"method": m} for m in METHODS] + [{"curve": False}, {"background": "neighbours"}]
        figures = [psnr_db(truth, read_exr(folder / f"gbuffer_{FRAME:04}.exr", RGB))]
        figures += [psnr_db(truth, blurred(folder / "capture.json", FRAME, v)) for v in variants]
        rows.append([f"`{name}`: {what}", *(f"{v:.2f}" for v in figures)])
        print(rows[-1], flush=True)
    return rows


def table(head, rows):
    return "\n".join("| " + " | ".join(row) + " |" for row in [head, ["---"] * len(head), *rows])


def main():
    WORK.mkdir(parents=True, exist_ok=True)
    IMAGES.mkdir(parents=True, exist_ok=True)
    os.environ.setdefault("AFTERSHADE_CACHE", str(WORK / "programs"))
    text = lambda name: (TEXTS / f"quality-{name}.md").read_text().strip()
    suzanne = on_suzanne()
    for row in suzanne:
        print(row, flush=True)
    pictures = "\n\n".join(f"![{name}: sharp, bowles_2012, neighbours, jimenez_2014, truth](images/motion/suzanne_{name}.jpg)" for name in CROPS)
    parts = [text("head"), "## A renderer's frame", text("suzanne"), table(["", "all pixels, dB", "changed pixels, dB"], suzanne), pictures,
             "## Scenes", text("scenes"), table(["", "sharp", *(f"`{m}`" for m in METHODS), "`curve` off", "`neighbours`"], on_scenes())]
    parts.append(camera.section(WORK, IMAGES).strip())
    parts.append(layers.section(WORK).strip())
    parts.append(taa.section(WORK, IMAGES).strip())
    if (TEXTS / "cost-table.md").exists():
        parts += ["## Cost", text("cost"), (TEXTS / "cost-table.md").read_text().strip()]
    (ROOT / "docs/quality-motion.md").write_text("\n\n".join(parts) + "\n")
    print("docs/quality-motion.md")


main()
