"""What the camera's motion does to a hall at rest, against the renderer's shutter: camera_motion_blur by its samples, accumulate
by its sub-frames. A section of docs/quality-motion.md."""
import copy
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy
from PIL import Image

from measure.exr import read_exr
from measure.measures import Array, bytes_of, psnr_db
from measure.pages import Blocks, table
from measure.scenes import load
from measure.tree import AFTERSHADE, EXACT, Document, command, write_json, write_look

FRAME = 6  # and the one before it, for the camera's motion
SAMPLES = 256  # of the truth
CROP = (120, 20, 200, 230)  # x, y, w, h


def sideways(scene: Document) -> Document:
    """The same hall from a camera that goes sideways, 0.31 m a frame: near things pass before far ones."""
    scene = copy.deepcopy(scene)
    scene["camera"]["position"] = {"keys": {"0": [-2, 0.1, 4.2], "13": [2, 0.05, 3.8]}}
    scene["camera"]["target"] = {"keys": {"0": [-2.3, 0, 0], "13": [2.3, 0, 0]}}
    return scene


class Hall:
    def __init__(self, name: str, scene: Document, work: Path) -> None:
        self.folder = work / name
        self.scene = write_json(self.folder / "scene.json", scene)
        self.capture = self.render("frames", f"{FRAME - 1}-{FRAME}", "--truth", "shutter", "--samples", SAMPLES)
        self.truth = read_exr(self.capture / f"truth_shutter_{FRAME:04}.exr")
        self.sharp = read_exr(self.capture / f"gbuffer_{FRAME:04}.exr")

    def render(self, name: str, frames: str, *options: object) -> Path:
        command([AFTERSHADE, "render", self.scene, "-o", self.folder / name, "--frames", frames, "--quiet", *options])
        return self.folder / name

    def run(self, capture: Path, effect: str, params: Document) -> Array:
        look = write_look(self.folder / "look.json", {"effect": effect, "params": params})
        command([AFTERSHADE, "run", look, capture, "-o", self.folder / "out_####.exr", *EXACT])
        return read_exr(self.folder / f"out_{FRAME:04}.exr")

    def camera_motion_blur(self, **params: Any) -> Array:
        return self.run(self.capture, "camera_motion_blur", params)

    def accumulate(self, subframes: int) -> Array:
        capture = self.render(f"subframes_{subframes}", str(FRAME), "--subframes", subframes)
        return self.run(capture, "accumulate", {})


def pictures(hall_of: Hall) -> dict[str, Array]:
    """By the words of the table's first column, in its order."""
    found = {"sharp": hall_of.sharp}
    for samples in 4, 8, 16, 32, 64:
        for occlusion in False, True:
            name = f"`camera_motion_blur`, {samples} samples" + ("" if occlusion else ", `occlusion` off")
            found[name] = hall_of.camera_motion_blur(samples=samples, occlusion=occlusion)
    for subframes in 4, 16, 64:
        found[f"`accumulate`, {subframes} sub-frames"] = hall_of.accumulate(subframes)
    return found


def save_strip(shown: Sequence[Array], path: Path) -> None:
    """Crops side by side at one size of pixel."""
    x, y, w, h = CROP
    gap = numpy.ones((h, 4, 3))
    parts = [part for image in shown for part in (gap, image[y:y + h, x:x + w])][1:]
    Image.fromarray(bytes_of(numpy.concatenate(parts, axis=1))).save(path, quality=88)


def section(work: Path, images: Path) -> Blocks:
    hall = load("camera_checker")
    halls = [Hall("camera_checker", hall, work), Hall("camera_sideways", sideways(hall), work)]
    found = [pictures(one) for one in halls]
    rows = [[name, *(f"{psnr_db(one.truth, shown[name]):.2f}" for one, shown in zip(halls, found))] for name in found[0]]
    side, shown = halls[1], found[1]
    save_strip([side.sharp, shown["`camera_motion_blur`, 16 samples, `occlusion` off"], shown["`camera_motion_blur`, 16 samples"],
                side.truth], images / "camera_sideways.jpg")
    return {"camera": table(["", "`camera_checker`, dB", "sideways, dB"], rows)}
