"""Sequences for the studies of sss_adaptive: scenes rendered small, frames at rest, and runs over them with taps and telemetry."""
import json
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy

from measure.exr import RGB, read_exr
from measure.scenes import load
from measure.sss_techniques import WORK
from measure.tree import AFTERSHADE, EXACT, ROOT, Document, command, write_json, write_look

SIZE = "240x135"


def scene_profile(scene: str) -> Document:
    materials = load(scene)["materials"].values()
    return next(m["scattering_profile"] for m in materials if "scattering_profile" in m)


def scene_capture(scene: str, frames: str) -> Path:
    folder = WORK / f"{scene}_small"
    if not (folder / "capture.json").exists():
        command([AFTERSHADE, "render", ROOT / "scenes" / scene, "-o", folder, "--size", SIZE, "--frames", frames, "--quiet"])
    return folder / "capture.json"


def still(file: Path, profile: str, frames: int) -> Path:
    """A sequence whose frames are all one file."""
    folder = WORK / f"still_{file.parent.name}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for i in range(1, frames + 1):
        (folder / f"gbuffer_{i:04}.exr").symlink_to(file.resolve())
    return write_json(folder / "capture.json",
                      {"aftershade": 1, "frames": "gbuffer_####.exr", "range": f"1-{frames}", "fps": 24, "profile": profile})


# Textures of fewer than four channels.
TAP_CHANNELS = {"sampled": ["Y"]}


def run(name: str, capture: Path, profile: Document, params: Document, frames: int, effect: str = "sss_adaptive",
        taps: Sequence[str] = ("estimate", "history", "plan"), after: Sequence[Document] = (), roles: str = "irradiance", telemetry: bool = False,
        region: str = "", keep: Sequence[int] = ()) -> dict[str, Any]:
    """Pictures and taps of all frames, or of those of `keep` alone: {"irradiance": frames x h x w x 3, "estimate": ... x 4}; what
    telemetry tells of all."""
    folder = WORK / "adaptive" / name
    look = write_look(folder / "look.json", {"effect": effect, "params": {"scattering_profile": profile, "object_ids": [1]} | params}, *after)
    words = [AFTERSHADE, "run", look, capture, "--frames", f"1-{frames}", "-o", folder / "out_####.exr", "--output-roles", roles, *EXACT]
    for tap in taps:
        words += ["--tap", f"{effect}.{tap}"]
    if region:
        words += ["--region", region, "--region-margin", 0]
    if telemetry:
        words += ["--telemetry", folder / "told_####.json"]
    command(words)
    read = keep or range(1, frames + 1)
    names = [f"irradiance.{c}" for c in RGB] if roles == "irradiance" else RGB
    result: dict[str, Any] = {roles: numpy.stack([read_exr(folder / f"out_{i:04}.exr", names) for i in read])}
    for tap in taps:
        result[tap] = numpy.stack([read_exr(folder / f"out.{effect}.{tap}.{i:04}.exr", TAP_CHANNELS.get(tap, list("RGBA")))
                                   for i in read])
    if telemetry:
        result["telemetry"] = [json.loads((folder / f"told_{i:04}.json").read_text()) for i in range(1, frames + 1)]
    shutil.rmtree(folder)
    return result
