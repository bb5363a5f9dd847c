"""Whole processes, EXR to EXR, in turns: `aftershade run` with one effect against Blender's Defocus node over the same file.
Started by tests/bench/dof-against-blender."""
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import time

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts/dof"))
import family
from family import AFTERSHADE, CAPTURES, ROOT, effects, psnr_db, read_exr, run_effect

WORK = ROOT / "build/dof-against-blender"
LENS = {"focus_distance": 6.4, "focal_length": 50, "f_number": 0.25, "sensor_width": 36, "lens_model": "pinhole"}


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


def seconds(words, **more):
    """(wall, processor of all threads)"""
    start, before = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, cwd=ROOT, **more)
    if done.returncode:
        raise SystemExit(f"{words[0]} ended with {done.returncode}:\n{done.stdout[-1000:]}{done.stderr[-2000:]}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.monotonic() - start, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    blender = shutil.which("blender")
    if not blender:
        raise SystemExit("blender is not installed (apt-get install blender)")
    here = {e.id: e for e in effects()}
    name = sys.argv[1] if len(sys.argv) > 1 else "dof" if "dof" in here else "bokeh"
    effect = here.get(name) or sys.exit(f"no effect '{name}' here (known: {', '.join(here)})")
    WORK.mkdir(parents=True, exist_ok=True)
    os.environ.setdefault("AFTERSHADE_CACHE", str(WORK / "programs"))
    source = WORK / "suzanne_1080p_0004.exr"
    if not source.exists():
        doubled(CAPTURES / "suzanne/large/gbuffer_0004.exr", source)
    params = LENS | effect.closest_to_hexagon()
    ours, theirs = WORK / "aftershade.exr", WORK / "blender.exr"
    run_effect(name, source, ours, params, WORK)  # fills the program cache and the file cache
    extra = [w for folder in family.effect_folders()[:-1] for w in ("--effect-path", str(folder))]
    run_words = [AFTERSHADE, "run", WORK / f"{name}.json", source, "-o", ours, "--backend", "osmesa", "--progress", "none", *extra]
    blender_words = [blender, "-b", "--factory-startup", "--python-exit-code", "1", "--python",
                     ROOT / "tests/bench/dof_blender.py", "--", source, theirs, 1920, 1080, os.cpu_count()]
    times = {"aftershade": [], "blender": []}
    for i in range(int(os.environ.get("REPETITIONS", "3"))):
        times["aftershade"].append(seconds(run_words))
        times["blender"].append(seconds(blender_words))
        print(f"turn {i + 1}: " + ", ".join("%s %.2f s (%.2f s of processor)" % (k, *v[-1]) for k, v in times.items()), flush=True)
    truth = read_exr(CAPTURES / "suzanne/truth/dof_0004.exr", ["R", "G", "B"])
    for label, file in ("aftershade", ours), ("blender", theirs):
        at_half = read_exr(file, ["R", "G", "B"]).reshape(540, 2, 960, 2, 3).mean(axis=(1, 3))
        print(f"{label:10} against the renderer's lens, at 960x540: {psnr_db(truth, at_half):.2f} dB")
    a, b = (float(numpy.median([wall for wall, _ in times[k]])) for k in ("aftershade", "blender"))
    print(f"suzanne frame 4 at 1920x1080, whole process, EXR to EXR, median of {len(times['blender'])}: `{name}` {a:.2f} s, "
          f"Blender's Defocus {b:.2f} s: {b / a:.1f} times as fast")


main()
