"""sss_adaptive where light, shadows and the camera move, and in its first frame; part of `scripts/quality sss-adaptive`."""
import functools
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy

from measure.exr import read_rgb64
from measure.measures import LUMINANCE, Array, luminance_psnr_db, scale_of
from measure.pages import Rows
from measure.scenes import load
from measure.sss_sequences import SIZE, run, scene_profile
from measure.sss_techniques import WORK, incoming, scattering
from measure.tree import AFTERSHADE, Document, command, link_meshes, write_json

FRAMES, FIRST = 24, 9
PX_PER_M = 555  # of shadow_edge's slab, in its middle, 240 px wide


LONG = 100  # frames of a slow fade, whose changes would add up


def scene_of(name: str, frames: int = FRAMES) -> Document:
    return load(name) | {"frames": f"1-{frames}"}


def shadow(px_per_frame: float) -> Document:
    """The bar goes to and fro over 0.32 m."""
    scene, x, way = scene_of("shadow_edge"), -0.16, 1
    keys = {}
    for frame in range(FRAMES + 2):
        keys[str(frame)] = [x, 0.04, 0]
        x += way * px_per_frame / PX_PER_M
        way = -1 if x > 0.16 else 1 if x < -0.16 else way
    scene["objects"][1]["position"] = {"keys": keys}
    return scene


def colours() -> Document:
    scene = scene_of("shadow_edge")
    sun = scene["lights"][0]
    keys = [{"0": 3, "8": 1.2, "16": 3, "25": 1.5}, {"0": 2.7, "8": 1.8, "16": 0.9, "25": 3}, {"0": 2.4, "8": 3, "16": 0.6, "25": 1.8}]
    scene["lights"] = [sun | {"name": f"sun{i}", "color": [float(i == c) for c in range(3)], "intensity": {"keys": keys[i]}} for i in range(3)]
    return scene


def fading() -> Document:
    scene = scene_of("shadow_edge", LONG)
    scene["lights"][0]["intensity"] = {"keys": {str(f): 3 * 0.99**f for f in range(LONG + 2)}}
    return scene


def panning() -> Document:
    scene = scene_of("head")
    scene["lights"][0]["position"] = [-0.3, 0.4, 0.5]
    scene["camera"]["position"] = {"keys": {"0": [0.05, 0.02, 0.72], "25": [0.25, 0.08, 0.68]}}
    return scene


SCENES: dict[str, tuple[str, Callable[[], Document]]] = {
    "`head`: a light that goes round it": ("head", functools.partial(scene_of, "head")),
    **{f"`shadow_edge`: its bar at {v:g} px a frame": ("shadow_edge", functools.partial(shadow, v)) for v in (0.4, 1.6, 6.5, 26)},
    "`shadow_edge`: light that changes its colour": ("shadow_edge", colours),
    "`shadow_edge`: light that fades by 1 % a frame, 100 frames": ("shadow_edge", fading),
    "`head`: a camera that pans": ("head", panning)}
STILLS = ("skin_patch", "skin_ear", "skin_front")


def rendered(name: str, scene: Document, frames: str) -> Path:
    folder = WORK / f"moving_{name}"
    if not (folder / "capture.json").exists():
        link_meshes(WORK / "moving_scenes")
        source = write_json(WORK / "moving_scenes" / name / "scene.json", scene)
        command([AFTERSHADE, "render", source, "-o", folder, "--size", SIZE, "--frames", frames, "--quiet"])
    return folder / "capture.json"


def frames_of(capture: Path) -> tuple[list[Array], float]:
    files = sorted(capture.parent.glob("*.exr"))
    where = [scattering(f) for f in files]
    middle = len(files) // 3
    return where, scale_of(incoming(files[middle]), where[middle])


def largest_step(picture: Array, where: Array, scale: float) -> float:
    """Between neighbours that both scatter."""
    light = picture @ LUMINANCE * scale
    return max(numpy.abs(numpy.diff(light, axis=a))[(where & numpy.roll(where, -1, a))[tuple(slice(-1) if i == a else slice(None) for i in (0, 1))]].max()
               for a in (0, 1))


def inner(where: Array) -> Array:
    """Pixels whose 5 x 5 px all scatter: elsewhere taa smooths outlines, which the reference does not."""
    padded = numpy.pad(where, 2, constant_values=True)
    height, width = where.shape
    return numpy.all([padded[y:y + height, x:x + width] for y in range(5) for x in range(5)], axis=0)


def lost_to_taa(capture: Path, profile: Document, exact: Array, shown: range, scale: float, where: Sequence[Array]) -> list[float]:
    """dB of each frame: the picture with scattered light against the same after taa."""
    colors = lambda *after: run("taa", capture, profile, {}, len(where), taps=(), after=({"effect": "sss_combine"}, *after), roles="color")["color"]
    light = run("taa", capture, profile, {}, len(where), taps=())["irradiance"]
    alone, followed = colors(), colors({"effect": "taa"})
    lost = []
    for i, file in enumerate(sorted(capture.parent.glob("*.exr"))):
        if i not in shown:
            continue
        truth = alone[i] + read_rgb64(file, "albedo") * (exact[i] - light[i])
        lost.append(luminance_psnr_db(truth, alone[i], inner(where[i]), scale) - luminance_psnr_db(truth, followed[i], inner(where[i]), scale))
    return lost


def moving() -> Rows:
    rows = []
    for index, (label, (scene, make)) in enumerate(SCENES.items()):
        document = make()
        capture, profile = rendered(str(index), document, document["frames"]), scene_profile(scene)
        where, scale = frames_of(capture)
        frames = len(where)
        shown = range(FIRST - 1, frames)
        pictures = lambda name, effect, params, taps=(): run(f"moving_{name}", capture, profile, params, frames, effect, taps)
        exact = pictures("reference", "sss_burley", {"samples": 2048})["irradiance"]
        own, alone = (pictures(n, "sss_adaptive", p, ("estimate",)) for n, p in (("own", {}), ("alone", {"guiding": False})))
        count = numpy.mean([own["estimate"][i][..., 3][where[i]].mean() for i in shown])
        fixed = pictures("fixed", "sss_burley", {"samples": round(count)})
        decibels = lambda result: [luminance_psnr_db(exact[i], result["irradiance"][i], where[i], scale) for i in shown]
        of_own, of_fixed, of_alone = decibels(own), decibels(fixed), decibels(alone)
        step = max(largest_step(own["irradiance"][i], where[i], scale) / largest_step(exact[i], where[i], scale) for i in shown)
        lost = lost_to_taa(capture, profile, exact, shown, scale, where)
        rows.append([label, f"{count:.1f}", *[f"{numpy.mean(d):.1f}" for d in (of_own, of_fixed, of_alone)],
                     f"{min(a - b for a, b in zip(of_own, of_fixed)):.1f}", f"{min(a - b for a, b in zip(of_own, of_alone)):.1f}", f"{step:.2f}",
                     f"{numpy.mean(lost):.2f}", f"{max(lost):.2f}"])
        print("moving", rows[-1], flush=True)
    return rows


def first_frames() -> Rows:
    rows = []
    for name in STILLS:
        capture, profile = rendered(name, scene_of(name), "1-16"), scene_profile(name)
        where, scale = frames_of(capture)
        exact = run("still_reference", capture, profile, {"samples": 4096}, 1, "sss_burley", ())["irradiance"][0]
        blurred = run("still_blurred", capture, profile, {}, 1, "sss_separable", ())["irradiance"][0]
        own = run("still_own", capture, profile, {}, 16, taps=())["irradiance"]
        rows.append([f"`{name}`", *[f"{luminance_psnr_db(exact, p, where[0], scale):.1f}" for p in (blurred, own[0], own[15])]])
        print("first", rows[-1], flush=True)
    return rows
