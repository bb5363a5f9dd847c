"""motion_blur against Blender's Vector Blur node with 32 samples over the same 1080p file: whole processes, EXR to EXR, in turns,
and the effect (upload to readback, warm program cache) against the node's own time. And what a frame at rest costs against one
that moves everywhere. Started by tests/bench/motion-against-blender."""
import re

import numpy

from measure.blender_turns import blender_words, halved, in_turns, seconds, suzanne_1080p
from measure.dof_family import run_effect
from measure.exr import read_exr, write_exr
from measure.measures import psnr_db
from measure.pages import Page, table
from measure.tree import AFTERSHADE, CAPTURES, ROOT

WORK = ROOT / "build/motion-against-blender"
PASS = re.compile(r"^(upload|readback|motion_blur\.\w+)\s+([\d.]+)", re.M)


def effect_ms(said, with_transfers=True):
    """All that the run's table of passes has, ms; else without upload and readback."""
    return sum(float(ms) for name, ms in PASS.findall(said) if with_transfers or name.startswith("motion_blur"))


def run_words(source, target):
    return [AFTERSHADE, "run", WORK / "motion_blur.json", source, "-o", target, "--backend", "software"]


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


def passes_ms(file, target):
    return float(numpy.median([effect_ms(seconds(run_words(file, target))[2], False) for _ in range(3)]))


def main():
    page = Page("quality-motion.md", "tests/bench/motion-against-blender", ["cost"])
    source = suzanne_1080p(WORK)
    ours, theirs = WORK / "aftershade.exr", WORK / "blender.exr"
    run_effect("motion_blur", source, ours, {}, WORK)  # fills the program cache and the file cache
    walls, said = in_turns({"aftershade": run_words(source, ours),
                            "blender": blender_words("motion_blender.py", "whole", source, theirs, 32),
                            "node": blender_words("motion_blender.py", "node", source, theirs, 32)})
    truth = read_exr(CAPTURES / "suzanne/truth/motion_0004.exr")
    db = {name: psnr_db(truth, halved(read_exr(file))) for name, file in (("aftershade", ours), ("blender", theirs))}
    effect = numpy.median([effect_ms(s) for s in said["aftershade"]]) / 1000
    spent = [tuple(map(float, re.search(r"compositor: ([\d.]+) s with the node, ([\d.]+) s without", s).groups())) for s in said["node"]]
    node = numpy.median([with_node - without for with_node, without in spent])
    lines = [table(["", "`motion_blur`", "Vector Blur, 32 samples", "times as fast"], [
        ["whole process, EXR to EXR, s", *(f"{walls[side]:.2f}" for side in ("aftershade", "blender")), f"{walls['blender'] / walls['aftershade']:.1f}"],
        ["upload to readback; the node alone, s", f"{effect:.3f}", f"{node:.2f}", f"{node / effect:.1f}"],
        ["all pixels at 960x540, dB", f"{db['aftershade']:.2f}", f"{db['blender']:.2f}", ""]]), ""]
    still = passes_ms(flat("still", 0), ours)
    for speed_px in 40, 80:
        moving = passes_ms(flat(f"moving_{speed_px}", speed_px), ours)
        lines.append(f"A frame at rest {still:.0f} ms, one that moves everywhere by {speed_px // 2} px while the shutter is open {moving:.0f} ms: "
                     f"{100 * still / moving:.1f} % (passes alone).")
    print("\n".join(lines))
    page.fill({"cost": "\n".join(lines)})


main()
