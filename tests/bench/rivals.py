"""Rivals from PyPI over Suzanne's frame 4 at 1080p, in turns: Vector Blur of the newest Blender (the package bpy) on each of its
compositor's devices against `motion_blur`, and a short OpenCV script against `dof`; whole processes, EXR to EXR, and the effect (upload
to readback, warm program cache) against the node. Writes its figures to $FIGURES. Started by scripts/bench."""
import json
import os
import pathlib
import re
import subprocess
import sys

import numpy

from dof_against_blender import LENS
from measure.blender_turns import halved, in_turns, suzanne_1080p
from measure.dof_family import run_effect
from measure.exr import read_exr
from measure.measures import psnr_db
from measure.tree import AFTERSHADE, CAPTURES, ROOT

WORK = ROOT / "build/bench-rivals"
BENCH = ROOT / "tests/bench"
BPY, OPENCV = ROOT / "build/bpy-venv/bin/python", sys.executable
PASS = re.compile(r"^(?:upload|readback|motion_blur\.\w+)\s+([\d.]+)", re.M)
COMPOSITOR = re.compile(r"compositor: ([\d.]+) s with the node, ([\d.]+) s without")


def ours(effect, source, params):
    """Words of a run whose program cache is warm."""
    target = WORK / f"{effect}.exr"
    run_effect(effect, source, target, params, WORK)
    return [AFTERSHADE, "run", WORK / f"{effect}.json", source, "-o", target, "--backend", "software", "--overwrite"]


def against_truth(name, files):
    truth = read_exr(CAPTURES / f"suzanne/truth/{name}_0004.exr")
    for file in files:
        picture = halved(read_exr(WORK / f"{file}.exr"))
        print(f"{file} against the renderer's {name}, at 960x540: {psnr_db(truth, picture):.2f} dB", flush=True)


def vector_blur(source):
    def words(mode, device):
        return [BPY, BENCH / "motion_bpy.py", "--", mode, source, WORK / f"bpy_{device}.exr", 32, 1920, 1080, os.cpu_count(), device]

    devices = ["CPU", "GPU"]
    sides = {"motion_blur": ours("motion_blur", source, {})}
    sides |= {f"{mode} {device}": words(mode, device) for device in devices for mode in ("whole", "node")}
    walls, said = in_turns(sides)
    nodes = {}
    for device in devices:
        spent = [tuple(map(float, COMPOSITOR.search(text).groups())) for text in said[f"node {device}"]]
        nodes[device] = float(numpy.median([with_node - without for with_node, without in spent]))
    effect = float(numpy.median([sum(map(float, PASS.findall(text))) for text in said["motion_blur"]])) / 1000
    whole = min(walls[f"whole {device}"] for device in devices)
    print(f"motion_blur {walls['motion_blur']:.2f} s, {effect:.3f} s alone; bpy {walls}; its node {nodes}", flush=True)
    against_truth("motion", ["motion_blur", *(f"bpy_{device}" for device in devices)])
    version = subprocess.run([str(BPY), "-c", "import bpy; print(bpy.app.version_string)"], capture_output=True, text=True, check=True)
    blender = f"Blender {version.stdout.split()[-1]}'s Vector Blur, best device"
    return {f"`motion_blur`, whole process at 1080p: times as fast as {blender}": round(whole / walls["motion_blur"], 1),
            f"`motion_blur` alone: times as fast as the node of {blender}": round(min(nodes.values()) / effect, 1)}


def depth_layers(source):
    walls, _ = in_turns({"dof": ours("dof", source, LENS | {"blades": 6}),
                         "opencv": [OPENCV, BENCH / "dof_opencv.py", source, WORK / "opencv.exr"]})
    print(f"dof {walls['dof']:.2f} s, OpenCV {walls['opencv']:.2f} s", flush=True)
    against_truth("dof", ["dof", "opencv"])
    return {"`dof`, whole process at 1080p: times as fast as OpenCV blurring 16 layers of depth": round(walls["opencv"] / walls["dof"], 2)}


def main():
    source = suzanne_1080p(ROOT / "build/bench-roofline")
    WORK.mkdir(parents=True, exist_ok=True)
    figures = vector_blur(source) | depth_layers(source)
    print(figures)
    if "FIGURES" in os.environ:
        pathlib.Path(os.environ["FIGURES"]).write_text(json.dumps(figures))


main()
