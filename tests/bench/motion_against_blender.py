"""motion_blur against Blender's Vector Blur node with 32 samples over the same 1080p file: whole processes, EXR to EXR, in turns,
and the effect (upload to readback, warm program cache) against the node's own time. And what a frame at rest costs against one
that moves everywhere. Started by tests/bench/motion-against-blender."""
import re

import numpy

from blender_turns import CAPTURES, ROOT, blender_words, halved, in_turns, seconds, suzanne_1080p
from family import AFTERSHADE, psnr_db, read_exr, run_effect, write_exr

WORK = ROOT / "build/motion-against-blender"
PASS = re.compile(r"^(upload|readback|motion_blur\.\w+)\s+([\d.]+)", re.M)


def effect_ms(said):
    """All that the run's table of passes has, ms."""
    return sum(float(ms) for _, ms in PASS.findall(said))


def run_words(source, target):
    return [AFTERSHADE, "run", WORK / "motion_blur.json", source, "-o", target, "--backend", "osmesa"]


def flat(name, speed_px):
    """1920x1080 of noise that moves as one; a checker of two depths, whose halves move apart, so that no tile is simple."""
    path = WORK / f"{name}.exr"
    rng = numpy.random.default_rng(1)
    planes = {c: rng.random((1080, 1920), numpy.float32) for c in "RGB"} | {"A": numpy.ones((1080, 1920), numpy.float32)}
    ys, xs = numpy.mgrid[0:1080, 0:1920]
    near = (xs // 64 + ys // 64) % 2 == 0
    planes["Z"] = numpy.where(near, 2, 5).astype(numpy.float32)
    for role in "velocity", "velocity_next":
        planes[f"{role}.X"] = numpy.where(near, speed_px, -speed_px).astype(numpy.float32)
        planes[f"{role}.Y"] = numpy.zeros_like(planes["Z"])
    write_exr(path, planes)
    return path


def main():
    source = suzanne_1080p(WORK)
    ours, theirs = WORK / "aftershade.exr", WORK / "blender.exr"
    run_effect("motion_blur", source, ours, {}, WORK)  # fills the program cache and the file cache
    walls, said = in_turns({"aftershade": run_words(source, ours),
                            "blender": blender_words("motion_blender.py", "whole", source, theirs, 32),
                            "node": blender_words("motion_blender.py", "node", source, theirs, 32)})
    truth = read_exr(CAPTURES / "suzanne/truth/motion_0004.exr", ["R", "G", "B"])
    for label, file in ("aftershade", ours), ("blender", theirs):
        print(f"{label:10} against the renderer's shutter, at 960x540: {psnr_db(truth, halved(read_exr(file, ['R', 'G', 'B']))):.2f} dB")
    print(f"suzanne frame 4 at 1920x1080, whole process, EXR to EXR: `motion_blur` {walls['aftershade']:.2f} s, Blender's Vector Blur "
          f"{walls['blender']:.2f} s: {walls['blender'] / walls['aftershade']:.1f} times as fast")
    effect = numpy.median([effect_ms(s) for s in said["aftershade"]]) / 1000
    spent = [tuple(map(float, re.search(r"compositor: ([\d.]+) s with the node, ([\d.]+) s without", s).groups())) for s in said["node"]]
    node = numpy.median([with_node - without for with_node, without in spent])
    print(f"upload to readback {effect:.3f} s, the node alone {node:.2f} s: {node / effect:.1f} times as fast")
    speeds = {}
    for name, speed_px in ("still", 0), ("moving", 40):
        file = flat(name, speed_px)
        speeds[name] = float(numpy.median([effect_ms(seconds(run_words(file, ours))[2]) for _ in range(3)]))
    print(f"a frame at rest {speeds['still']:.0f} ms, one that moves everywhere by 20 px {speeds['moving']:.0f} ms: "
          f"{100 * speeds['still'] / speeds['moving']:.1f} %")


main()
