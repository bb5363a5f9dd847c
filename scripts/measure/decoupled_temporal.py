"""The part of docs/quality-decoupled.md on `--keep-shading`: shading samples that live from frame to frame, against light for every frame."""
import json
import resource
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy
from PIL import Image

from measure.exr import read_exr
from measure.measures import Array, bytes_of, psnr_db
from measure.pages import Blocks, table
from measure.tree import AFTERSHADE, ROOT, Document, command, read_json, write_json

WORK = ROOT / "build/quality-decoupled/temporal"
SIZE, SAMPLES, TRUTH_SAMPLES = "160x90", 32, 128
# Scene, last frame, what changes.
SEQUENCES = [("camera_checker", 24, "the camera"), ("leaves", 24, "the camera"), ("toys", 8, "camera and objects"),
             ("light_toggle", 24, "a light, twice")]
CROP = ("toys", 4, (20, 34, 90, 50))  # x, y, w, h


def longer(value: Any, frames: int) -> Any:
    """Keys of two frames that continue at their speed to the last one; anything else stays."""
    if not isinstance(value, dict) or len(value.get("keys", {})) != 2:
        return value
    (first, a), (last, b) = ((int(frame), numpy.array(at)) for frame, at in value["keys"].items())
    end = max(last, frames + 1)
    return {**value, "keys": {str(first): a.tolist(), str(end): (a + (b - a) * (end - first) / (last - first)).tolist()}}


def sequence(name: str, frames: int, rays: int = 0) -> Path:
    """The scene with a camera that goes on, and so many rays of ambient light."""
    scene: Document = read_json(ROOT / f"scenes/{name}/scene.json")
    scene["frames"] = f"1-{frames}"
    scene["camera"] = {key: longer(value, frames) for key, value in scene["camera"].items()}
    if rays:
        scene["ambient_rays"] = rays
    for mesh in scene.get("meshes", {}).values():
        if "file" in mesh:
            mesh["file"] = str((ROOT / "scenes" / name / mesh["file"]).resolve())
    return write_json(WORK / f"{name}_{rays}.json", scene)


class Rendered:
    """The frames of a scene by `render --visibility memoised`, with their reports and the user time of the process."""

    def __init__(self, scene: Path, frames: int, *words: object) -> None:
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        self.frames: list[Document] = json.loads(
            command([AFTERSHADE, "render", scene, "-o", WORK / "picture", "--size", SIZE, "--truth-only", "--quiet", "--json",
                     "--visibility", "memoised", "--visibility-samples", SAMPLES, *words]))["visibility"]
        self.user_s = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        self.misses = [frame["misses"] for frame in self.frames]
        self.colors = [read_exr(WORK / "picture" / f"memoised_{frame:04}.exr") for frame in range(1, frames + 1)]

    @property
    def rate(self) -> float:
        return float(numpy.mean([frame["shading_rate"]["of_covered_pixels"] for frame in self.frames]))


def truth(scene: Path, name: str, frames: int) -> list[Array]:
    """Of the scene's own shapes: each frame with light at every sample, by other samples."""
    folder = WORK / f"{name}_truth"
    if not (folder / f"truth_lens_shutter_antialias_{frames:04}.exr").exists():
        command([AFTERSHADE, "render", scene, "-o", folder, "--size", SIZE, "--truth-only", "--quiet", "--seed", 7,
                 "--truth", "lens+shutter+antialias", "--truth-method", "interleaved", "--samples", TRUTH_SAMPLES])
    return [read_exr(folder / f"truth_lens_shutter_antialias_{frame:04}.exr") for frame in range(1, frames + 1)]


def db_of(truths: Sequence[Array], colors: Sequence[Array]) -> tuple[float, list[float]]:
    """Over all frames, and of each."""
    return psnr_db(numpy.concatenate(truths), numpy.concatenate(colors)), [psnr_db(a, b) for a, b in zip(truths, colors, strict=True)]


def save_picture(truths: Sequence[Array], fresh: Rendered, kept: Rendered, frame: int, box: tuple[int, int, int, int], path: Path) -> None:
    """Light for every frame, kept light, their difference eight times, and the truth."""
    x, y, w, h = box
    shown = [c[frame - 1][y:y + h, x:x + w] for c in (fresh.colors, kept.colors, truths)]
    tiles = [bytes_of(shown[0]), bytes_of(shown[1]), bytes_of(numpy.clip(8 * numpy.abs(shown[0] - shown[1]), 0, 1)), bytes_of(shown[2])]
    grown = [numpy.pad(t.repeat(3, axis=0).repeat(3, axis=1), ((0, 0), (0, 4), (0, 0)), constant_values=255) for t in tiles]
    Image.fromarray(numpy.concatenate(grown, axis=1)[:, :-4]).save(path, quality=88)


def kept_rates(images: Path) -> str:
    rows = []
    for name, frames, changes in SEQUENCES:
        scene = sequence(name, frames)
        expected = truth(scene, name, frames)
        fresh, kept = Rendered(scene, frames), Rendered(scene, frames, "--keep-shading")
        (fresh_db, fresh_frames), (kept_db, kept_frames) = db_of(expected, fresh.colors), db_of(expected, kept.colors)
        worst = max(a - b for a, b in zip(fresh_frames, kept_frames, strict=True))
        highlights = sum(frame["kept"]["highlights"] for frame in kept.frames) / sum(fresh.misses)
        rows.append([f"`{name}`", changes, frames, f"{fresh.rate:.2f}", f"{kept.rate:.2f}", f"{sum(kept.misses) / sum(fresh.misses):.2f}",
                     f"{highlights:.2f}", f"{fresh_db:.2f}", f"{kept_db:.2f}", f"{fresh_db - kept_db:.2f}", f"{worst:.2f}"])
        print(*rows[-1], flush=True)
        if name == CROP[0]:
            save_picture(expected, fresh, kept, CROP[1], CROP[2], images / "kept.png")
    return table(["scene", "changes", "frames", "rate", "rate, kept", "ratio of the shadings", "highlights alone", "light for every frame, dB", "kept, dB",
                  "lost, dB", "lost in the worst frame, dB"], rows)


def kept_times() -> str:
    rows = []
    for name, frames, changes in SEQUENCES[:3]:
        scene = sequence(name, frames, 16)
        fresh, kept = Rendered(scene, frames), Rendered(scene, frames, "--keep-shading")
        rows.append([f"`{name}`", changes, f"{fresh.user_s:.1f}", f"{kept.user_s:.1f}", f"{kept.user_s / fresh.user_s:.2f}",
                     f"{kept.frames[-1]['bytes']['kept'] / 1e6:.0f}"])
        print(*rows[-1], flush=True)
    return table(["scene", "changes", "light for every frame, s", "kept, s", "ratio", "memory of kept samples, MB"], rows)


def over_frames(images: Path) -> Blocks:
    WORK.mkdir(parents=True, exist_ok=True)
    return {"kept": kept_rates(images), "kept-times": kept_times()}
