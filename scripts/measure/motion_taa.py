"""What the antialiasing over frames gains, for docs/quality-motion.md: shipped scenes at rest, frames jittered, against
`--truth antialias`; the trail behind a moving box; a moving camera."""
import json
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy
from PIL import Image

from measure.exr import read_exr
from measure.measures import Array, bytes_of, psnr_db
from measure.pages import Blocks, table
from measure.scenes import load
from measure.tree import AFTERSHADE, EXACT, Document, command, link_meshes, write_look

STILLS = ["camera_checker", "wheel", "bats", "point_grid"]
STILL_MOMENT = 6
COUNTS = [1, 4, 8, 16]
MOVING_FRAMES = [6, 9, 12]  # history has filled by then
TRAIL_TOLERANCE = 0.002
Variant = dict[str, Any] | str  # parameters, or the name of a preset
VARIANTS: list[tuple[str, Variant]] = [
    ("rejection variance_clip (default)", {}),
    ("rejection clip", {"rejection": "clip"}),
    ("rejection clamp", {"rejection": "clamp"}),
    ("rejection none", {"rejection": "none"}),
    ("reconstruction none", {"reconstruction": "none"}),
    ("reconstruction blackman_harris", {"reconstruction": "blackman_harris"}),
    ("filter_width 3.3", {"filter_width": 3.3}),
    ("hdr_weighting", {"hdr_weighting": True}),
    ("history_filter bilinear", {"history_filter": "bilinear"}),
    ("disocclusion none", {"disocclusion": "none"}),
    ("preset karis_2014", "karis_2014"),
    ("preset salvi_2016", "salvi_2016"),
]


def at_frame(value: Any, frame: int) -> Any:
    """The scene as it is at a frame, without keys."""
    if isinstance(value, dict) and "keys" in value:
        keys = sorted((float(k), numpy.array(v, dtype=float)) for k, v in value["keys"].items())
        times = [k for k, _ in keys]
        flat = numpy.stack([v.ravel() for _, v in keys], axis=-1)
        return numpy.array([numpy.interp(frame, times, row) for row in flat]).reshape(keys[0][1].shape).tolist()
    if isinstance(value, dict):
        return {key: at_frame(item, frame) for key, item in value.items()}
    return [at_frame(item, frame) for item in value] if isinstance(value, list) else value


def rendered(work: Path, name: str, scene: Document, frames: str, jitter: bool = True, truth: str | None = None, size: str = "480x270") -> Path:
    """A folder with the capture, and truth/: not jittered, as the truth of a pixel is its own square."""
    folder = work / f"taa-{name}"
    source = work / "scenes" / f"taa-{name}"
    source.mkdir(parents=True, exist_ok=True)
    link_meshes(work / "scenes")
    text = json.dumps(scene | {"frames": frames})
    document = source / "scene.json"
    if (folder / "done").exists() and document.exists() and document.read_text() == text:
        return folder
    document.write_text(text)
    words = [AFTERSHADE, "render", document, "--size", size, "--quiet"]
    command([*words, "-o", folder, "--frames", frames, *(["--jitter", "halton"] if jitter else [])])
    if truth:
        command([*words, "-o", folder / "truth", "--frames", truth, "--truth", "antialias", "--truth-only"])
    (folder / "done").touch()
    return folder


def ran(work: Path, folder: Path, variant: Variant, frames: str) -> Callable[[int], Array]:
    """The effect's pictures by frame."""
    step: Document = {"effect": "taa", "preset": variant} if isinstance(variant, str) else {"effect": "taa", "params": variant}
    look, out = write_look(work / "taa-look.json", step), work / "taa-out"
    out.mkdir(exist_ok=True)
    command([AFTERSHADE, "run", look, folder / "capture.json", "--frames", frames, "-o", out / "####.exr", *EXACT])
    return lambda frame: read_exr(out / f"{frame:04d}.exr")


def truth_of(folder: Path, frame: int) -> Array:
    return read_exr(folder / f"truth/truth_antialias_{frame:04d}.exr")


def color_of(folder: Path, frame: int) -> Array:
    return read_exr(folder / f"gbuffer_{frame:04d}.exr")


def mean(values: Iterable[float]) -> float:
    return float(numpy.mean(list(values)))


def best_single_db(folder: Path) -> float:
    return max(psnr_db(truth_of(folder, 1), color_of(folder, frame)) for frame in range(1, 17))


def still_gains(work: Path, folders: dict[str, Path], singles: dict[str, float], variant: Variant) -> Array:
    """dB above the best single frame of the 16, by count of frames; the mean over the scenes."""
    gains = []
    for name, folder in folders.items():
        truth, out = truth_of(folder, 1), ran(work, folder, variant, "1-16")
        gains.append([psnr_db(truth, out(count)) - singles[name] for count in COUNTS])
    return numpy.mean(gains, axis=0)


def moving_db(work: Path, folder: Path, variant: Variant) -> float:
    out = ran(work, folder, variant, "1-12")
    return mean(psnr_db(truth_of(folder, frame), out(frame)) for frame in MOVING_FRAMES)


def trail_px(work: Path, box: Path, wall: Path, variant: Variant) -> int:
    """How far from the box, in px, the picture differs from that of the wall alone; without jitter, so that a wall without
    history looks the same as one with."""
    out = ran(work, box, variant, "1-12")
    pictures = {frame: out(frame) for frame in MOVING_FRAMES}
    out, longest = ran(work, wall, variant, "1-12"), 0
    for frame, picture in pictures.items():
        wrong = numpy.abs(picture - out(frame)).max(axis=-1) > TRAIL_TOLERANCE
        reached = read_exr(box / f"gbuffer_{frame:04d}.exr", ["object_id.I"]) == 2
        for distance in range(200):
            if not (wrong & ~reached).any():
                break
            padded = numpy.pad(reached, 1)
            reached = numpy.any([padded[1 + y:1 + y + reached.shape[0], 1 + x:1 + x + reached.shape[1]]
                                 for y in (-1, 0, 1) for x in (-1, 0, 1)], axis=0)
            longest = max(longest, distance + 1)
    return longest


def strip(work: Path, folder: Path, images: Path) -> None:
    """One frame, 16 frames and the truth of a part of the checkered hall, four times as large."""
    out = ran(work, folder, {}, "1-16")
    crops = [picture[150:230, 200:320] for picture in (color_of(folder, 16), out(16), truth_of(folder, 1))]
    gap = numpy.ones((crops[0].shape[0], 1, 3))
    row = numpy.concatenate([crops[0], gap, crops[1], gap, crops[2]], axis=1)
    picture = Image.fromarray(bytes_of(row))
    picture.resize((picture.width * 4, picture.height * 4), Image.NEAREST).save(images / "taa_static.png")


def section(work: Path, images: Path) -> Blocks:
    scenes = {name: load(name) for name in STILLS + ["moving_box"]}
    stills = {name: rendered(work, f"{name}-still", at_frame(scenes[name], STILL_MOMENT), "1-16", truth="1") for name in STILLS}
    checker = rendered(work, "camera_checker", scenes["camera_checker"], "1-12", truth="6-12x3")
    box = rendered(work, "moving_box", scenes["moving_box"], "1-12", truth="6-12x3")
    box_alone = rendered(work, "moving_box-unjittered", scenes["moving_box"], "1-12", jitter=False)
    without_box = scenes["moving_box"] | {"objects": scenes["moving_box"]["objects"][:1]}
    wall = rendered(work, "moving_box-wall", without_box, "1-12", jitter=False)
    still_singles = {name: best_single_db(folder) for name, folder in stills.items()}
    singles = [mean(psnr_db(truth_of(f, n), color_of(f, n)) for n in MOVING_FRAMES) for f in (box, checker)]
    rows = [["the frame alone", 0, 0, 0, 0, f"{singles[0]:.2f}", 0, f"{singles[1]:.2f}"]]
    for name, variant in VARIANTS:
        rows.append([name, *(f"{gain:+.1f}" for gain in still_gains(work, stills, still_singles, variant)), f"{moving_db(work, box, variant):.2f}",
                     trail_px(work, box_alone, wall, variant), f"{moving_db(work, checker, variant):.2f}"])
    strip(work, stills["camera_checker"], images)
    return {"taa": table(["", "1 frame", 4, 8, 16, "moving_box dB", "trail px", "camera_checker dB"], rows)}
