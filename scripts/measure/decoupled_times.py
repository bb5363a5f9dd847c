"""The part of docs/quality-decoupled.md on time: light that costs, once for each shading sample and at every sample."""
import json
import resource
import statistics
from collections.abc import Callable
from pathlib import Path
from typing import Any

from measure.exr import read_exr
from measure.measures import Array, psnr_db
from measure.pages import Blocks, table
from measure.tree import AFTERSHADE, ROOT, command, read_json, write_json

WORK = ROOT / "build/quality-decoupled/times"
FRAMES = {"toys": 4, "bats": 6, "camera_checker": 6, "leaves": 4, "fence": 4}
ROUNDS = 3
FULL_SIZE, SIZE, GL_SIZE = "480x270", "240x135", "120x68"  # 64 samples take long, and longer on llvmpipe
GL = ["--visibility-on", "gl", "--backend", "software"]


def lit_by(name: str, rays: int, blur: bool = True) -> Path:
    """The scene with so many rays of ambient light; without blur its lens is a pinhole and its shutter an instant."""
    scene = read_json(ROOT / f"scenes/{name}/scene.json")
    scene["ambient_rays"] = rays
    if not blur:
        scene["camera"]["f_number"] = 1000
        scene.setdefault("shutter", {})["angle"] = 0
    for mesh in scene.get("meshes", {}).values():
        if "file" in mesh:
            mesh["file"] = str((ROOT / "scenes" / name / mesh["file"]).resolve())
    return write_json(WORK / f"{name}_{rays}{'' if blur else '_sharp'}.json", scene)


class Timed:
    """A picture by `render --visibility`: the user time of its process, its shadings and its light."""

    def __init__(self, scene: Path, kind: str, samples: int, *words: object, size: str = FULL_SIZE) -> None:
        frame = next(frame for name, frame in FRAMES.items() if scene.stem.startswith(name))
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        report: dict[str, Any] = json.loads(
            command([AFTERSHADE, "render", scene, "-o", WORK / "picture", "--frames", frame, "--size", size, "--truth-only", "--quiet", "--json",
                     "--visibility", kind, "--visibility-samples", samples, *words]))
        self.user_s = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        self.misses = report["visibility"][0]["misses"]
        self.color: Array = read_exr(WORK / "picture" / f"{kind}_{frame:04}.exr")


def in_turns(*pictures: Callable[[], Timed]) -> list[Timed]:
    """Each with its median time of some rounds. The machine may be busy, so that the pictures take turns."""
    rounds = [[picture() for picture in pictures] for _ in range(ROUNDS)]
    for index, timed in enumerate(rounds[0]):
        timed.user_s = statistics.median(of_round[index].user_s for of_round in rounds)
    return rounds[0]


def against_supersampling() -> str:
    rows = []
    for name in "toys", "bats", "camera_checker":
        scene = lit_by(name, 16)
        for device, words, size in ("CPU", [], SIZE), ("llvmpipe", GL, GL_SIZE):
            once, each = in_turns(*(lambda kind=kind: Timed(scene, kind, 64, *words, size=size) for kind in ("memoised", "supersampled")))
            rows.append([f"`{name}`", device, size, f"{each.misses / once.misses:.0f}", f"{once.user_s:.1f}", f"{each.user_s:.1f}",
                         f"{once.user_s / each.user_s:.2f}"])
            print(*rows[-1], flush=True)
    return table(["scene", "device", "px", "shadings, supersampled over memoised", "memoised, s", "supersampled, s", "ratio"], rows)


def over_blur() -> str:
    rows = []
    for name in "fence", "leaves", "toys":
        sharp, blurred = (lit_by(name, 36, blur) for blur in (False, True))
        times = in_turns(lambda: Timed(sharp, "memoised", 8, "--anisotropic-shading"), lambda: Timed(blurred, "memoised", 8, "--anisotropic-shading"),
                         lambda: Timed(blurred, "memoised", 8))
        rows.append([f"`{name}`", *(f"{t.user_s:.2f}" for t in times), f"{times[1].user_s / times[0].user_s:.2f}"])
        print(*rows[-1], flush=True)
    return table(["scene", "sharp, s", "blurred, s", "blurred without anisotropic shading, s", "blurred over sharp"], rows)


def anisotropic() -> str:
    rows = []
    for name in FRAMES:
        scene = lit_by(name, 36)
        even, coarse = in_turns(lambda: Timed(scene, "memoised", 8), lambda: Timed(scene, "memoised", 8, "--anisotropic-shading"))
        truth = Timed(scene, "supersampled", 32, "--seed", 7).color
        even_db, coarse_db = psnr_db(truth, even.color), psnr_db(truth, coarse.color)
        rows.append([f"`{name}`", f"{even.user_s:.2f}", f"{coarse.user_s:.2f}", f"{100 * (1 - coarse.user_s / even.user_s):.0f}",
                     f"{even_db:.2f}", f"{coarse_db:.2f}", f"{even_db - coarse_db:.2f}"])
        print(*rows[-1], flush=True)
    return table(["scene", "even, s", "anisotropic, s", "time saved, %", "even, dB", "anisotropic, dB", "lost, dB"], rows)


def in_time() -> Blocks:
    return {"times": against_supersampling()}


def adaptive() -> Blocks:
    return {"sharp": over_blur(), "anisotropic": anisotropic()}
