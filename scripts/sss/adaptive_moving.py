"""sss_adaptive where light, shadows and the camera move, and in its first frame; part of scripts/quality-sss-adaptive."""
import json

import numpy

from family import AFTERSHADE, ROOT, command, read_exr
from quality import WORK
from sequences import RGB, SIZE, run, scene_document, scene_profile
from techniques import LUMINANCE, psnr_db, scale_of

FRAMES, FIRST = 24, 9
PX_PER_M = 555  # of shadow_edge's slab, in its middle, 240 px wide


LONG = 100  # frames of a slow fade, whose changes would add up


def scene_of(name, frames=FRAMES):
    return scene_document(name) | {"frames": f"1-{frames}"}


def shadow(px_per_frame):
    """The bar goes to and fro over 0.32 m."""
    scene, x, way = scene_of("shadow_edge"), -0.16, 1
    keys = {}
    for frame in range(FRAMES + 2):
        keys[str(frame)] = [x, 0.04, 0]
        x += way * px_per_frame / PX_PER_M
        way = -1 if x > 0.16 else 1 if x < -0.16 else way
    scene["objects"][1]["position"] = {"keys": keys}
    return scene


def colours():
    scene = scene_of("shadow_edge")
    sun = scene["lights"][0]
    keys = [{"0": 3, "8": 1.2, "16": 3, "25": 1.5}, {"0": 2.7, "8": 1.8, "16": 0.9, "25": 3}, {"0": 2.4, "8": 3, "16": 0.6, "25": 1.8}]
    scene["lights"] = [sun | {"name": f"sun{i}", "color": [float(i == c) for c in range(3)], "intensity": {"keys": keys[i]}} for i in range(3)]
    return scene


def fading():
    scene = scene_of("shadow_edge", LONG)
    scene["lights"][0]["intensity"] = {"keys": {str(f): 3 * 0.99**f for f in range(LONG + 2)}}
    return scene


def panning():
    scene = scene_of("head")
    scene["lights"][0]["position"] = [-0.3, 0.4, 0.5]
    scene["camera"]["position"] = {"keys": {"0": [0.05, 0.02, 0.72], "25": [0.25, 0.08, 0.68]}}
    return scene


SCENES = {"`head`: a light that goes round it": ("head", lambda: scene_of("head")),
          **{f"`shadow_edge`: its bar at {v} px a frame": ("shadow_edge", lambda v=v: shadow(v)) for v in (0.4, 1.6, 6.5, 26)},
          "`shadow_edge`: light that changes its colour": ("shadow_edge", colours),
          "`shadow_edge`: light that fades by 1 % a frame, 100 frames": ("shadow_edge", fading),
          "`head`: a camera that pans": ("head", panning)}
STILLS = ("skin_patch", "skin_ear", "skin_front")


def rendered(name, scene, frames):
    folder = WORK / f"moving_{name}"
    if not (folder / "capture.json").exists():
        # Beside the shipped scenes' folder for their meshes.
        source = WORK / "moving_scenes" / name
        source.mkdir(parents=True, exist_ok=True)
        meshes = source.parent / "meshes"
        if not meshes.exists():
            meshes.symlink_to(ROOT / "scenes/meshes")
        (source / "scene.json").write_text(json.dumps(scene))
        command([AFTERSHADE, "render", source, "-o", folder, "--size", SIZE, "--frames", frames, "--quiet"])
    return folder / "capture.json"


def frames_of(capture):
    files = sorted(capture.parent.glob("*.exr"))
    where = [read_exr(f, ["object_id.I"]) == 1 for f in files]
    middle = len(files) // 3
    light = read_exr(files[middle], [f"irradiance.{c}" for c in RGB]).astype(numpy.float64)
    return where, scale_of(light, where[middle])


def largest_step(picture, where, scale):
    """Between neighbours that both scatter."""
    light = picture @ LUMINANCE * scale
    return max(numpy.abs(numpy.diff(light, axis=a))[(where & numpy.roll(where, -1, a))[tuple(slice(-1) if i == a else slice(None) for i in (0, 1))]].max()
               for a in (0, 1))


def moving():
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
        decibels = lambda result: [psnr_db(exact[i], result["irradiance"][i], where[i], scale) for i in shown]
        of_own, of_fixed, of_alone = decibels(own), decibels(fixed), decibels(alone)
        step = max(largest_step(own["irradiance"][i], where[i], scale) / largest_step(exact[i], where[i], scale) for i in shown)
        rows.append([label, f"{count:.1f}", *[f"{numpy.mean(d):.1f}" for d in (of_own, of_fixed, of_alone)],
                     f"{min(a - b for a, b in zip(of_own, of_fixed)):.1f}", f"{min(a - b for a, b in zip(of_own, of_alone)):.1f}", f"{step:.2f}"])
        print("moving", rows[-1], flush=True)
    return rows


def first_frames():
    rows = []
    for name in STILLS:
        capture, profile = rendered(name, scene_of(name), "1-16"), scene_profile(name)
        where, scale = frames_of(capture)
        exact = run("still_reference", capture, profile, {"samples": 4096}, 1, "sss_burley", ())["irradiance"][0]
        blurred = run("still_blurred", capture, profile, {}, 1, "sss_separable", ())["irradiance"][0]
        own = run("still_own", capture, profile, {}, 16, taps=())["irradiance"]
        rows.append([f"`{name}`", *[f"{psnr_db(exact, p, where[0], scale):.1f}" for p in (blurred, own[0], own[15])]])
        print("first", rows[-1], flush=True)
    return rows
