"""What the camera's motion does to a hall at rest, against the renderer's shutter: camera_motion_blur by its samples, accumulate
by its sub-frames. A section of docs/quality-motion.md; alone: scripts/motion/camera.py WORK IMAGES."""
import copy
import json
import pathlib
import sys

import numpy
from PIL import Image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "dof"))
from family import AFTERSHADE, ROOT, command, psnr_db, read_exr, srgb  # noqa: E402
from scenes import load  # noqa: E402

FRAME = 6  # and the one before it, for the camera's motion
SAMPLES = 256  # of the truth
CROP = (120, 20, 200, 230)  # x, y, w, h


def sideways(scene):
    """The same hall from a camera that goes sideways, 0.31 m a frame: near things pass before far ones."""
    scene = copy.deepcopy(scene)
    scene["camera"]["position"] = {"keys": {"0": [-2, 0.1, 4.2], "13": [2, 0.05, 3.8]}}
    scene["camera"]["target"] = {"keys": {"0": [-2.3, 0, 0], "13": [2.3, 0, 0]}}
    return scene


def picture(path):
    return read_exr(path, ["R", "G", "B"])


class Hall:
    def __init__(self, name, scene, work):
        self.folder = pathlib.Path(work) / name
        self.folder.mkdir(parents=True, exist_ok=True)
        self.scene = self.folder / "scene.json"
        self.scene.write_text(json.dumps(scene))
        self.capture = self.render("frames", f"{FRAME - 1}-{FRAME}", "--truth", "shutter", "--samples", SAMPLES)
        self.truth = picture(self.capture / f"truth_shutter_{FRAME:04}.exr")
        self.sharp = picture(self.capture / f"gbuffer_{FRAME:04}.exr")

    def render(self, name, frames, *options):
        command([AFTERSHADE, "render", self.scene, "-o", self.folder / name, "--frames", frames, "--quiet", *options])
        return self.folder / name

    def run(self, capture, effect, params):
        look = self.folder / "look.json"
        look.write_text(json.dumps({"aftershade": 1, "steps": [{"effect": effect, "params": params}]}))
        command([AFTERSHADE, "run", look, capture, "-o", self.folder / "out_####.exr", "--pixel-type", "float", "--compression",
                 "none", "--progress", "none", "--backend", "software"])
        return picture(self.folder / f"out_{FRAME:04}.exr")

    def camera_motion_blur(self, **params):
        return self.run(self.capture, "camera_motion_blur", params)

    def accumulate(self, subframes):
        capture = self.render(f"subframes_{subframes}", str(FRAME), "--subframes", subframes)
        return self.run(capture, "accumulate", {})


def pictures(hall_of):
    """By the words of the table's first column, in its order."""
    found = {"sharp": hall_of.sharp}
    for samples in 4, 8, 16, 32, 64:
        for occlusion in False, True:
            name = f"`camera_motion_blur`, {samples} samples" + ("" if occlusion else ", `occlusion` off")
            found[name] = hall_of.camera_motion_blur(samples=samples, occlusion=occlusion)
    for subframes in 4, 16, 64:
        found[f"`accumulate`, {subframes} sub-frames"] = hall_of.accumulate(subframes)
    return found


def save_strip(shown, path):
    """Crops side by side at one size of pixel."""
    x, y, w, h = CROP
    gap = numpy.ones((h, 4, 3))
    parts = [part for image in shown for part in (gap, srgb(image[y:y + h, x:x + w]))][1:]
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(numpy.round(255 * numpy.concatenate(parts, axis=1)).astype(numpy.uint8)).save(path, quality=88)


def section(work, images):
    hall = load(ROOT / "scenes/camera_checker/scene.json")
    halls = [Hall("camera_checker", hall, work), Hall("camera_sideways", sideways(hall), work)]
    found = [pictures(one) for one in halls]
    rows = [[name, *(f"{psnr_db(one.truth, shown[name]):.2f}" for one, shown in zip(halls, found))] for name in found[0]]
    table = "\n".join("| " + " | ".join(row) + " |" for row in
                      [["", "`camera_checker`, dB", "sideways, dB"], ["---"] * 3, *rows])
    side, shown = halls[1], found[1]
    save_strip([side.sharp, shown["`camera_motion_blur`, 16 samples, `occlusion` off"], shown["`camera_motion_blur`, 16 samples"],
                side.truth], pathlib.Path(images) / "camera_sideways.jpg")
    return "\n\n".join([
        "## A camera that moves",
        f"Frame {FRAME} of `scenes/camera_checker`, where the camera turns and walks, and of the same hall with a camera that goes "
        f"sideways by 0.31 m a frame, against the renderer's shutter of 180 degrees ({SAMPLES} moments). A capture has one ray a "
        "pixel, so most of what is left of `camera_checker` is stairs on the floor's lines that time does not smooth.",
        table,
        "The hall sideways: sharp; `camera_motion_blur` with `occlusion` off, where the wall beside a post ignores that the post passes before it; with it; the truth.",
        "![a camera that goes sideways](images/motion/camera_sideways.jpg)"]) + "\n"


if __name__ == "__main__":
    print(section(sys.argv[1], sys.argv[2]))
