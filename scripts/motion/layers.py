"""What layers of a capture give motion blur: a section of docs/quality-motion.md; alone: scripts/motion/layers.py WORK."""
import json
import pathlib
import sys

import numpy
import OpenEXR

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "dof"))
from camera import sideways  # noqa: E402
from family import AFTERSHADE, ROOT, command, psnr_db, read_exr  # noqa: E402
from scenes import load  # noqa: E402

SAMPLES = 256  # of the truths
TIMES = 32
ONE, TWO, MIXED, DEEP = "one ray a pixel", "2 layers", "antialiased", "deep"
MORE = {TWO: ["--layers", 2], DEEP: ["--deep"]}


def uncovered(gbuffer, exposure):
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

    def __init__(self, work, name, source, frame, effect):
        self.folder, self.frame, self.effect = pathlib.Path(work) / "layers" / name, frame, effect
        frames = f"{frame - 1}-{frame}"  # the one before for the camera's motion
        if not (self.folder / "one/capture.json").exists():
            truths = [word for kind in ("shutter", "shutter+antialias", "antialias") for word in ("--truth", kind)]
            command([AFTERSHADE, "render", source, "-o", self.folder / "one", "--frames", frames, "--samples", SAMPLES, "--quiet", *truths])
            for kind, words in MORE.items():
                command([AFTERSHADE, "render", source, "-o", self.folder / kind.split()[-1], "--frames", frames, "--quiet", *words])
            self.mix(frame - 1), self.mix(frame)
        self.uncovered = uncovered(self.folder / f"one/gbuffer_{frame:04}.exr", 0.5)

    def mix(self, frame):
        """Antialiased colour and one sample of depth and motion a pixel."""
        one, mixed = self.folder / "one", self.folder / "antialiased"
        mixed.mkdir(exist_ok=True)
        (mixed / "capture.json").write_text((one / "capture.json").read_text())
        with OpenEXR.File(str(one / f"gbuffer_{frame:04}.exr"), separate_channels=True) as file:
            channels = {name: file.channels()[name].pixels for name in file.channels()}
            header = {k: v for k, v in file.header().items() if k in ("worldToCamera", "worldToNDC") or k.startswith("aftershade/")}
        color = read_exr(one / f"truth_antialias_{frame:04}.exr", ["R", "G", "B"])
        planes = channels | {c: numpy.ascontiguousarray(color[..., i].astype(channels[c].dtype)) for i, c in enumerate("RGB")}
        header |= {"compression": OpenEXR.NO_COMPRESSION, "type": OpenEXR.scanlineimage}
        OpenEXR.File(header, planes).write(str(mixed / f"gbuffer_{frame:04}.exr"))

    def through(self, effect, kind):
        capture = self.folder / ("one" if kind == ONE else kind.split()[-1]) / "capture.json"
        look = self.folder / "look.json"
        look.write_text(json.dumps({"aftershade": 1, "steps": [{"effect": effect}]}))
        command([AFTERSHADE, "run", look, capture, "-o", self.folder / "out_####.exr", "--pixel-type", "float", "--compression", "none",
                 "--progress", "none", "--backend", "software"])
        return read_exr(self.folder / f"out_{self.frame:04}.exr", ["R", "G", "B"])

    def truth(self, kind):
        return read_exr(self.folder / f"one/truth_{kind}_{self.frame:04}.exr", ["R", "G", "B"])

    def figures(self, kind):
        """dB of all pixels, and of the uncovered ones."""
        true, own = self.truth("shutter_antialias" if kind in (MIXED, DEEP) else "shutter"), self.through(self.effect, kind)
        return psnr_db(true, own), psnr_db(true, own, self.uncovered)

    def deep_sharp_db(self):
        return psnr_db(self.truth("antialias"), self.through("sanitize", DEEP))  # which leaves it as it is


def section(work):
    hall = pathlib.Path(work) / "layers/hall"
    hall.mkdir(parents=True, exist_ok=True)
    (hall / "scene.json").write_text(json.dumps(sideways(load(ROOT / "scenes/camera_checker/scene.json"))))
    cases = [Case(work, "toys", ROOT / "scenes/toys", 7, "motion_blur"), Case(work, "hall", hall, 6, "camera_motion_blur")]
    lines = ["| | `motion_blur` on `toys` | uncovered | `camera_motion_blur` in the hall sideways | uncovered |", "|---|---|---|---|---|"]
    for kind in (ONE, TWO, MIXED, DEEP):
        lines.append(f"| {kind} | " + " | ".join(f"{db:.2f}" for case in cases for db in case.figures(kind)) + " |")
    shares = [f"{100 * case.uncovered.mean():.1f} %" for case in cases]
    return "\n\n".join([
        "## Layers",
        "A capture with [layers](captures.md#what-lies-behind) shows what a moving thing uncovers. Uncovered are the pixels to which, at one of "
        f"{TIMES} times of the exposure, nothing that the frame shows has moved: {shares[0]} of `toys` and {shares[1]} of the hall. dB against "
        f"the renderer's shutter of {SAMPLES} moments. The antialiased and the deep captures are compared with the truth of shutter and "
        "antialiasing; deep samples say which share of a pixel each surface has, and one sample of depth does not. The deep capture of the hall "
        "has its loss where floor and wall meet: a deep sample's colour is the mean of all that the rays of a pixel meet of an object, also of "
        f"what another one hides, so that its sharp picture is {cases[1].deep_sharp_db():.1f} dB from an antialiased one.",
        "\n".join(lines)]) + "\n"


if __name__ == "__main__":
    print(section(sys.argv[1]))
