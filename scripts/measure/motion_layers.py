"""What layers of a capture give motion blur: a section of docs/quality-motion.md."""
from pathlib import Path

import numpy
import OpenEXR

from measure.exr import RGB, read_all, read_exr
from measure.measures import Array, psnr_db
from measure.motion_camera import sideways
from measure.pages import Blocks, table
from measure.scenes import load
from measure.tree import AFTERSHADE, EXACT, ROOT, command, write_json, write_look

SAMPLES = 256  # of the truths
TIMES = 32
ONE, TWO, MIXED, DEEP = "one ray a pixel", "2 layers", "antialiased", "deep"
MORE: dict[str, list[object]] = {TWO: ["--layers", 2], DEEP: ["--deep"]}


def uncovered(gbuffer: Path, exposure: float) -> Array:
    """Pixels to which, at one of TIMES times of the exposure, nothing of the frame has moved; a pixel covers the four around its place."""
    since = read_exr(gbuffer, ["velocity.X", "velocity.Y"]).astype(float)
    after = read_exr(gbuffer, ["velocity_next.X", "velocity_next.Y"]).astype(float)
    height, width = since.shape[:2]
    place = numpy.stack(numpy.meshgrid(numpy.arange(width), numpy.arange(height)), axis=-1)
    found = numpy.zeros((height, width), bool)
    for i in range(TIMES):
        t = exposure * ((i + 0.5) / TIMES - 0.5)
        corner = numpy.floor(place + 0.5 * (since + after) * t + 0.5 * (after - since) * t * t).astype(int)
        covered = numpy.zeros((height + 1, width + 1), bool)  # the last row and column take what lies outside
        for x, y in ((0, 0), (1, 0), (0, 1), (1, 1)):
            u, v = corner[..., 0] + x, corner[..., 1] + y
            outside = (u < 0) | (u >= width) | (v < 0) | (v >= height)
            covered[numpy.where(outside, height, v), numpy.where(outside, width, u)] = True
        found |= ~covered[:height, :width]
    found[:2], found[-2:], found[:, :2], found[:, -2:] = False, False, False, False  # what came from outside the picture
    return found


class Case:
    """A scene's captures by kind, and the truths that they are compared with."""

    def __init__(self, work: Path, name: str, source: Path, frame: int, effect: str) -> None:
        self.folder, self.frame, self.effect = work / "layers" / name, frame, effect
        frames = f"{frame - 1}-{frame}"  # the one before for the camera's motion
        if not (self.folder / "one/capture.json").exists():
            truths = [word for kind in ("shutter", "shutter+antialias", "antialias") for word in ("--truth", kind)]
            command([AFTERSHADE, "render", source, "-o", self.folder / "one", "--frames", frames, "--samples", SAMPLES, "--quiet", *truths])
            for kind, words in MORE.items():
                command([AFTERSHADE, "render", source, "-o", self.folder / kind.split()[-1], "--frames", frames, "--quiet", *words])
            for each in frame - 1, frame:
                self.mix(each)
        self.uncovered = uncovered(self.folder / f"one/gbuffer_{frame:04}.exr", 0.5)

    def mix(self, frame: int) -> None:
        """Antialiased colour and one sample of depth and motion a pixel."""
        one, mixed = self.folder / "one", self.folder / "antialiased"
        mixed.mkdir(exist_ok=True)
        (mixed / "capture.json").write_text((one / "capture.json").read_text())
        channels, whole = read_all(one / f"gbuffer_{frame:04}.exr")
        color = read_exr(one / f"truth_antialias_{frame:04}.exr")
        planes = channels | {c: numpy.ascontiguousarray(color[..., i].astype(channels[c].dtype)) for i, c in enumerate(RGB)}
        header = {k: v for k, v in whole.items() if k in ("worldToCamera", "worldToNDC") or k.startswith("aftershade/")}
        header |= {"compression": OpenEXR.NO_COMPRESSION, "type": OpenEXR.scanlineimage}
        OpenEXR.File(header, planes).write(str(mixed / f"gbuffer_{frame:04}.exr"))

    def through(self, effect: str, kind: str) -> Array:
        capture = self.folder / ("one" if kind == ONE else kind.split()[-1]) / "capture.json"
        look = write_look(self.folder / "look.json", {"effect": effect})
        command([AFTERSHADE, "run", look, capture, "-o", self.folder / "out_####.exr", *EXACT])
        return read_exr(self.folder / f"out_{self.frame:04}.exr")

    def truth(self, kind: str) -> Array:
        return read_exr(self.folder / f"one/truth_{kind}_{self.frame:04}.exr")

    def figures(self, kind: str) -> tuple[float, float]:
        """dB of all pixels, and of the uncovered ones."""
        true, own = self.truth("shutter_antialias" if kind in (MIXED, DEEP) else "shutter"), self.through(self.effect, kind)
        return psnr_db(true, own), psnr_db(true, own, self.uncovered)

    def deep_sharp_db(self) -> float:
        return psnr_db(self.truth("antialias"), self.through("sanitize", DEEP))  # which leaves it as it is


def section(work: Path) -> Blocks:
    hall = write_json(work / "layers/hall/scene.json", sideways(load("camera_checker")))
    cases = [Case(work, "toys", ROOT / "scenes/toys", 7, "motion_blur"), Case(work, "hall", hall.parent, 6, "camera_motion_blur")]
    toys, in_hall = (f"{100 * case.uncovered.mean():.1f} %" for case in cases)
    rows = [[kind, *(f"{db:.2f}" for case in cases for db in case.figures(kind))] for kind in (ONE, TWO, MIXED, DEEP)]
    return {"layers": table(["", "`motion_blur` on `toys`", "uncovered", "`camera_motion_blur` in the hall sideways", "uncovered"], rows),
            "layers-toys": toys, "layers-hall": in_hall, "layers-sharp": f"{cases[1].deep_sharp_db():.1f} dB"}
