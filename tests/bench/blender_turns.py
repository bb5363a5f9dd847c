"""What the comparisons with Blender's nodes share: the 1080p file, and whole processes in turns."""
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import time

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts/dof"))
from family import CAPTURES, ROOT


def doubled(source, target):
    """Each pixel four times, every channel; vectors twice as long."""
    import OpenEXR
    with OpenEXR.File(str(source), separate_channels=True) as file:
        planes = {}
        for name, channel in file.channels().items():
            plane = numpy.asarray(channel.pixels).repeat(2, axis=0).repeat(2, axis=1)
            planes[name] = plane * 2 if ".Vector." in name else plane
        kept = {k: v for k, v in file.header().items() if k in ("compression", "type")}
        OpenEXR.File(kept, planes).write(str(target))


def suzanne_1080p(work):
    """Frame 4 of Suzanne at 1920x1080, made once."""
    work.mkdir(parents=True, exist_ok=True)
    os.environ.setdefault("AFTERSHADE_CACHE", str(work / "programs"))
    source = work / "suzanne_1080p_0004.exr"
    if not source.exists():
        doubled(CAPTURES / "suzanne/large/gbuffer_0004.exr", source)
    return source


def halved(picture):
    return picture.reshape(540, 2, 960, 2, 3).mean(axis=(1, 3))


def blender_words(script, *words):
    """Runs a script of this folder inside Blender, with the threads that the machine has at its end."""
    blender = shutil.which("blender")
    if not blender:
        raise SystemExit("blender is not installed (apt-get install blender)")
    return [blender, "-b", "--factory-startup", "--python-exit-code", "1", "--python", ROOT / "tests/bench" / script, "--",
            *words, 1920, 1080, os.cpu_count()]


def seconds(words):
    """(wall, processor of all threads, what it said)"""
    start, before = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, cwd=ROOT)
    if done.returncode:
        raise SystemExit(f"{words[0]} ended with {done.returncode}:\n{done.stdout[-1000:]}{done.stderr[-2000:]}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return (time.monotonic() - start, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime,
            done.stdout + done.stderr)


def in_turns(commands):
    """The median wall time of each by name; $REPETITIONS turns. And all that each said."""
    times = {name: [] for name in commands}
    for i in range(int(os.environ.get("REPETITIONS", "3"))):
        for name, words in commands.items():
            times[name].append(seconds(words))
        print(f"turn {i + 1}: " + ", ".join("%s %.2f s (%.2f s of processor)" % (k, *v[-1][:2]) for k, v in times.items()), flush=True)
    return ({name: float(numpy.median([t[0] for t in ts])) for name, ts in times.items()},
            {name: [t[2] for t in ts] for name, ts in times.items()})
