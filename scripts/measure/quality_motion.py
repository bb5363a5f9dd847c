"""How far motion blur and antialiasing over frames are from the truth: the figures and pictures of docs/quality-motion.md; those of
its section Cost come from tests/bench/motion-against-blender. Scenes are rendered once and kept in build/quality-motion. With
blender installed, its Vector Blur node stands beside. About 10 minutes.

    PARTS="suzanne scenes camera layers taa"   these alone; the others stay as they are
    AFTERSHADE=FILE            another executable, and no build
    AFTERSHADE_CAPTURES=DIR    where suzanne lies (docs/measures.md)
"""
import os
import shutil
from pathlib import Path

import numpy
from PIL import Image

from measure import motion_camera, motion_layers, motion_taa
from measure.exr import RGB, read_exr
from measure.measures import Array, bytes_of, changed_pixels, psnr_db
from measure.pages import Blocks, Page, table
from measure.tree import AFTERSHADE, CAPTURES, EXACT, ROOT, Document, command, write_json, write_look

WORK = ROOT / "build/quality-motion"
IMAGES = ROOT / "docs/images/motion"
METHODS = ["bowles_2012", "jimenez_2014", "guertin_2014", "mcguire_2012"]
SCENES = {"moving_box": "one box before a wall at rest", "wheel": "30 degrees a frame", "camera_checker": "only the camera moves",
          "bats": "336 things of about 2 px each", "toys": "a blade, a ball that rolls and spins, and lights at rest"}
FRAME, SAMPLES = 7, 256
CROPS = {"ball": (90, 200, 220, 200), "cube": (640, 170, 270, 160)}  # x, y, w, h


def blurred(capture: Path, frame: int, params: Document) -> Array:
    look, out = write_look(WORK / "look.json", {"effect": "motion_blur", "params": params}), WORK / "out.exr"
    command([AFTERSHADE, "run", look, capture, "--frames", frame, "-o", out, *EXACT])
    return read_exr(out)


def vector_blur(source: Path) -> Array | None:
    """Blender's node at its best factor; None without blender."""
    if not shutil.which("blender"):
        return None
    out = WORK / "blender.exr"
    command(["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python", ROOT / "tests/bench/motion_blender.py",
             "--", "whole", source, out, 32, 960, 540, os.cpu_count()])
    return read_exr(out)


def on_suzanne() -> Blocks:
    folder = CAPTURES / "suzanne"
    document = write_json(WORK / "suzanne/capture.json", {"aftershade": 1, "frames": str((folder / "large/gbuffer_####.exr").resolve()),
                                                          "range": "3-5", "fps": 24, "profile": "blender"})
    sharp = read_exr(folder / "large/gbuffer_0004.exr", [f"ViewLayer.Combined.{c}" for c in RGB])
    pictures: dict[str, Array | None] = {"the sharp input": sharp}
    for method in METHODS:
        pictures[f"`motion_blur`, `{method}`"] = blurred(document, 4, {"method": method})
    pictures["`motion_blur`, `background` neighbours"] = blurred(document, 4, {"background": "neighbours"})
    for samples in 4, 8, 16:
        pictures[f"`motion_blur`, {samples} samples"] = blurred(document, 4, {"samples": samples})
    pictures["`motion_blur`, `curve` off"] = blurred(document, 4, {"curve": False})
    pictures["Blender's Vector Blur, 32 samples, factor 1"] = vector_blur(folder / "large/gbuffer_0004.exr")
    truth = read_exr(folder / "truth/motion_0004.exr")
    changed = changed_pixels(sharp, truth)
    rows = [[name, f"{psnr_db(truth, p):.2f}", f"{psnr_db(truth, p, changed):.2f}"] for name, p in pictures.items() if p is not None]
    labels = ["the sharp input", *(f"`motion_blur`, {way}" for way in ("`bowles_2012`", "`background` neighbours", "`jimenez_2014`"))]
    shown = [picture for picture in map(pictures.get, labels) if picture is not None] + [truth]
    for name, (x, y, w, h) in CROPS.items():
        row = numpy.concatenate([p[y:y + h, x:x + w] for p in shown], axis=1)
        Image.fromarray(bytes_of(row)).save(IMAGES / f"suzanne_{name}.jpg", quality=88)
    print(*rows, sep="\n", flush=True)
    return {"suzanne": table(["", "all pixels, dB", "changed pixels, dB"], rows)}


def on_scenes() -> Blocks:
    rows = []
    for name, what in SCENES.items():
        folder = WORK / name
        if not (folder / f"truth_shutter_{FRAME:04}.exr").exists():
            command([AFTERSHADE, "render", ROOT / "scenes" / name, "-o", folder, "--frames", f"{FRAME - 1}-{FRAME + 1}", "--truth",
                     "shutter", "--samples", SAMPLES, "--quiet"])
        truth = read_exr(folder / f"truth_shutter_{FRAME:04}.exr")
        variants: list[Document] = [{"method": m} for m in METHODS] + [{"curve": False}, {"background": "neighbours"}]
        figures = [psnr_db(truth, read_exr(folder / f"gbuffer_{FRAME:04}.exr"))]
        figures += [psnr_db(truth, blurred(folder / "capture.json", FRAME, v)) for v in variants]
        rows.append([f"`{name}`: {what}", *(f"{v:.2f}" for v in figures)])
        print(rows[-1], flush=True)
    return {"scenes": table(["", "sharp", *(f"`{m}`" for m in METHODS), "`curve` off", "`neighbours`"], rows)}


def main() -> None:
    page = Page("quality-motion.md", "scripts/quality motion",
                ["suzanne", "scenes", "camera", "layers", "layers-toys", "layers-hall", "layers-sharp", "taa"])
    for folder in WORK, IMAGES:
        folder.mkdir(parents=True, exist_ok=True)
    os.environ.setdefault("AFTERSHADE_CACHE", str(WORK / "programs"))
    page.make({"suzanne": on_suzanne, "scenes": on_scenes, "camera": lambda: motion_camera.section(WORK, IMAGES),
               "layers": lambda: motion_layers.section(WORK), "taa": lambda: motion_taa.section(WORK, IMAGES)})


if __name__ == "__main__":
    main()
