"""Sequences for the studies of sss_adaptive: scenes rendered small, frames at rest, and runs over them with taps and telemetry."""
import json
import shutil

from family import AFTERSHADE, ROOT, command, read_exr
from quality import WORK

import numpy

SIZE = "240x135"
RGB = "RGB"


def scene_document(scene):
    text = "\n".join(l for l in (ROOT / "scenes" / scene / "scene.json").read_text().splitlines() if not l.lstrip().startswith("//"))
    return json.loads(text)


def scene_profile(scene):
    materials = scene_document(scene)["materials"].values()
    return next(m["scattering_profile"] for m in materials if "scattering_profile" in m)


def scene_capture(scene, frames):
    folder = WORK / f"{scene}_small"
    if not (folder / "capture.json").exists():
        command([AFTERSHADE, "render", ROOT / "scenes" / scene, "-o", folder, "--size", SIZE, "--frames", frames, "--quiet"])
    return folder / "capture.json"


def still(file, profile, frames):
    """A sequence whose frames are all one file."""
    folder = WORK / f"still_{file.parent.name}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for i in range(1, frames + 1):
        (folder / f"gbuffer_{i:04}.exr").symlink_to(file.resolve())
    document = folder / "capture.json"
    document.write_text(json.dumps({"aftershade": 1, "frames": "gbuffer_####.exr", "range": f"1-{frames}", "fps": 24, "profile": profile}))
    return document


# Textures of fewer than four channels.
TAP_CHANNELS = {"sampled": ["Y"]}


def run(name, capture, profile, params, frames, effect="sss_adaptive", taps=("estimate", "history", "plan"), after=(), roles="irradiance",
        telemetry=False, region="", keep=()):
    """Pictures and taps of all frames, or of those of `keep` alone: {"irradiance": frames x h x w x 3, "estimate": ... x 4}; what
    telemetry tells of all."""
    folder = WORK / "adaptive" / name
    folder.mkdir(parents=True, exist_ok=True)
    look = folder / "look.json"
    look.write_text(json.dumps({"aftershade": 1, "steps": [
        {"effect": effect, "params": {"scattering_profile": profile, "object_ids": [1]} | params}, *after]}))
    words = [AFTERSHADE, "run", look, capture, "--frames", f"1-{frames}", "-o", folder / "out_####.exr", "--output-roles", roles,
             "--pixel-type", "float", "--compression", "none", "--progress", "none", "--backend", "software"]
    for tap in taps:
        words += ["--tap", f"{effect}.{tap}"]
    if region:
        words += ["--region", region, "--region-margin", 0]
    if telemetry:
        words += ["--telemetry", folder / "told_####.json"]
    command(words)
    read = keep or range(1, frames + 1)
    names = [f"irradiance.{c}" for c in RGB] if roles == "irradiance" else list(RGB)
    result = {roles: numpy.stack([read_exr(folder / f"out_{i:04}.exr", names) for i in read])}
    for tap in taps:
        result[tap] = numpy.stack([read_exr(folder / f"out.{effect}.{tap}.{i:04}.exr", TAP_CHANNELS.get(tap, list("RGBA")))
                                   for i in read])
    if telemetry:
        result["telemetry"] = [json.loads((folder / f"told_{i:04}.json").read_text()) for i in range(1, frames + 1)]
    shutil.rmtree(folder)
    return result
