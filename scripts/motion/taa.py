"""What the antialiasing over frames gains, for docs/quality-motion.md: shipped scenes at rest, frames jittered, against
`--truth antialias`; the trail behind a moving box; a moving camera."""
import json
import pathlib
import sys

import numpy
from PIL import Image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "dof"))
from family import AFTERSHADE, ROOT, command, psnr_db, read_exr, srgb  # noqa: E402
from scenes import load  # noqa: E402

RGB = ["R", "G", "B"]
STILLS = ["camera_checker", "wheel", "bats", "point_grid"]
STILL_MOMENT = 6
COUNTS = [1, 4, 8, 16]
MOVING_FRAMES = [6, 9, 12]  # history has filled by then
TRAIL_TOLERANCE = 0.002
VARIANTS = [
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


def at_frame(value, frame):
    """The scene as it is at a frame, without keys."""
    if isinstance(value, dict) and "keys" in value:
        keys = sorted((float(k), numpy.array(v, dtype=float)) for k, v in value["keys"].items())
        times = [k for k, _ in keys]
        flat = numpy.stack([v.ravel() for _, v in keys], axis=-1)
        return numpy.array([numpy.interp(frame, times, row) for row in flat]).reshape(keys[0][1].shape).tolist()
    if isinstance(value, dict):
        return {key: at_frame(item, frame) for key, item in value.items()}
    return [at_frame(item, frame) for item in value] if isinstance(value, list) else value


def rendered(work, name, scene, frames, jitter=True, truth=None, size="480x270"):
    """A folder with the capture, and truth/: not jittered, as the truth of a pixel is its own square."""
    folder = work / f"taa-{name}"
    source = work / "scenes" / f"taa-{name}"
    source.mkdir(parents=True, exist_ok=True)
    meshes = work / "scenes/meshes"  # where the scenes' "../meshes" leads
    if not meshes.exists():
        meshes.symlink_to(ROOT / "scenes/meshes")
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


def ran(work, folder, variant, frames):
    """The effect's pictures by frame."""
    step = {"effect": "taa"} | ({"preset": variant} if isinstance(variant, str) else {"params": variant})
    look, out = work / "taa-look.json", work / "taa-out"
    out.mkdir(exist_ok=True)
    look.write_text(json.dumps({"aftershade": 1, "steps": [step]}))
    command([AFTERSHADE, "run", look, folder / "capture.json", "--frames", frames, "-o", out / "####.exr", "--pixel-type",
             "float", "--compression", "none", "--progress", "none", "--backend", "software"])
    return lambda frame: read_exr(out / f"{frame:04d}.exr", RGB)


def truth_of(folder, frame):
    return read_exr(folder / f"truth/truth_antialias_{frame:04d}.exr", RGB)


def color_of(folder, frame):
    return read_exr(folder / f"gbuffer_{frame:04d}.exr", RGB)


def mean(values):
    return float(numpy.mean(list(values)))


def best_single_db(folder):
    return max(psnr_db(truth_of(folder, 1), color_of(folder, frame)) for frame in range(1, 17))


def still_gains(work, folders, singles, variant):
    """dB above the best single frame of the 16, by count of frames; the mean over the scenes."""
    gains = []
    for name, folder in folders.items():
        truth, out = truth_of(folder, 1), ran(work, folder, variant, "1-16")
        gains.append([psnr_db(truth, out(count)) - singles[name] for count in COUNTS])
    return numpy.mean(gains, axis=0)


def moving_db(work, folder, variant):
    out = ran(work, folder, variant, "1-12")
    return mean(psnr_db(truth_of(folder, frame), out(frame)) for frame in MOVING_FRAMES)


def trail_px(work, box, wall, variant):
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


def strip(work, folder, images):
    """One frame, 16 frames and the truth of a part of the checkered hall, four times as large."""
    out = ran(work, folder, {}, "1-16")
    crops = [picture[150:230, 200:320] for picture in (color_of(folder, 16), out(16), truth_of(folder, 1))]
    gap = numpy.ones((crops[0].shape[0], 1, 3))
    row = numpy.concatenate([crops[0], gap, crops[1], gap, crops[2]], axis=1)
    picture = Image.fromarray((srgb(row) * 255 + 0.5).astype(numpy.uint8))
    picture.resize((picture.width * 4, picture.height * 4), Image.NEAREST).save(images / "taa_static.png")


def section(work, images):
    work, images = pathlib.Path(work), pathlib.Path(images)
    work.mkdir(parents=True, exist_ok=True)
    images.mkdir(parents=True, exist_ok=True)
    scenes = {name: load(ROOT / f"scenes/{name}/scene.json") for name in STILLS + ["moving_box"]}
    stills = {name: rendered(work, f"{name}-still", at_frame(scenes[name], STILL_MOMENT), "1-16", truth="1") for name in STILLS}
    checker = rendered(work, "camera_checker", scenes["camera_checker"], "1-12", truth="6-12x3")
    box = rendered(work, "moving_box", scenes["moving_box"], "1-12", truth="6-12x3")
    box_alone = rendered(work, "moving_box-unjittered", scenes["moving_box"], "1-12", jitter=False)
    without_box = scenes["moving_box"] | {"objects": scenes["moving_box"]["objects"][:1]}
    wall = rendered(work, "moving_box-wall", without_box, "1-12", jitter=False)
    lines = ["| | 1 frame | 4 | 8 | 16 | moving_box dB | trail px | camera_checker dB |", "|---|---|---|---|---|---|---|---|"]
    still_singles = {name: best_single_db(folder) for name, folder in stills.items()}
    singles = [mean(psnr_db(truth_of(f, n), color_of(f, n)) for n in MOVING_FRAMES) for f in (box, checker)]
    lines.append(f"| the frame alone | 0 | 0 | 0 | 0 | {singles[0]:.2f} | 0 | {singles[1]:.2f} |")
    for name, variant in VARIANTS:
        gains = " | ".join(f"{gain:+.1f}" for gain in still_gains(work, stills, still_singles, variant))
        lines.append(f"| {name} | {gains} | {moving_db(work, box, variant):.2f} | {trail_px(work, box_alone, wall, variant)} "
                     f"| {moving_db(work, checker, variant):.2f} |")
    strip(work, stills["camera_checker"], images)
    return "\n".join([
        "## taa", "",
        f"At rest: {', '.join(STILLS)} at 480x270, jittered by `--jitter halton`; dB above the best of their 16 single frames, the "
        "mean over the scenes. In motion: dB of frames 6, 9 and 12. Trail: how far behind the box the picture differs from that of "
        f"the wall alone by more than {TRAIL_TOLERANCE}. In moving_box single frames are near their truth but for the box: the "
        "wall's edges lie between pixels.", "", *lines, "",
        f"![One frame, 16 frames, the truth](images/motion/taa_static.png)", "",
        "One frame, 16 frames, the truth: camera_checker at rest.", ""])


if __name__ == "__main__":
    print(section(ROOT / "build/quality-motion", ROOT / "build/quality-motion/images"))
