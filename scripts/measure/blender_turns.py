"""What the comparisons with Blender's nodes share: the 1080p file, and whole processes in turns."""
import os
import resource
import shutil
import subprocess
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy
import OpenEXR

from measure.exr import read_all
from measure.measures import Array
from measure.tree import CAPTURES, ROOT


def doubled(source: Path, target: Path) -> None:
    """Each pixel four times, every channel; vectors twice as long."""
    planes, header = read_all(source)
    for name, pixels in planes.items():
        plane = pixels.repeat(2, axis=0).repeat(2, axis=1)
        planes[name] = plane * 2 if ".Vector." in name else plane
    OpenEXR.File({name: header[name] for name in ("compression", "type")}, planes).write(str(target))


def suzanne_1080p(work: Path) -> Path:
    """Frame 4 of Suzanne at 1920x1080, made once."""
    work.mkdir(parents=True, exist_ok=True)
    os.environ.setdefault("AFTERSHADE_CACHE", str(work / "programs"))
    source = work / "suzanne_1080p_0004.exr"
    if not source.exists():
        doubled(CAPTURES / "suzanne/large/gbuffer_0004.exr", source)
    return source


def halved(picture: Array) -> Array:
    return picture.reshape(540, 2, 960, 2, 3).mean(axis=(1, 3))


def blender_words(script: str, *words: object) -> list[object]:
    """Runs a script of tests/bench inside Blender, with the threads that the machine has at its end."""
    blender = shutil.which("blender")
    if not blender:
        raise SystemExit("blender is not installed (apt-get install blender)")
    return [blender, "-b", "--factory-startup", "--python-exit-code", "1", "--python", ROOT / "tests/bench" / script, "--",
            *words, 1920, 1080, os.cpu_count()]


def seconds(words: Sequence[object]) -> tuple[float, float, str]:
    """(wall, processor of all threads, what it said)"""
    start, before = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, cwd=ROOT)
    if done.returncode:
        raise SystemExit(f"{words[0]} ended with {done.returncode}:\n{done.stdout[-1000:]}{done.stderr[-2000:]}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return (time.monotonic() - start, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime,
            done.stdout + done.stderr)


def in_turns(commands: Mapping[str, Sequence[object]]) -> tuple[dict[str, float], dict[str, list[str]]]:
    """The median wall time of each by name; $REPETITIONS turns. And all that each said."""
    times: dict[str, list[tuple[float, float, str]]] = {name: [] for name in commands}
    for i in range(int(os.environ.get("REPETITIONS", "3"))):
        for name, words in commands.items():
            times[name].append(seconds(words))
        print(f"turn {i + 1}: " + ", ".join("%s %.2f s (%.2f s of processor)" % (k, *v[-1][:2]) for k, v in times.items()), flush=True)
    return ({name: float(numpy.median([t[0] for t in ts])) for name, ts in times.items()},
            {name: [t[2] for t in ts] for name, ts in times.items()})
