"""All benches in one go, their figures as a page and as a history; started by scripts/bench."""
import datetime
import json
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

import focus
from blender_turns import suzanne_1080p
from family import ROOT
from roofline import table

WORK = ROOT / "build/bench"
PAGE, HISTORY = ROOT / "docs/speed.md", ROOT / "scripts/speed/history.json"
PARTS = os.environ.get("PARTS", "frames exr start film dof focus motion rivals roofline").split()
ROUNDS = os.environ.get("ROUNDS", "5")
RIVAL_PYTHON = ROOT / "build/bench-venv/bin/python"
AFTERSHADE = os.environ["AFTERSHADE"]
TAIL = ["chromatic_aberration", "vignette", "film_grain", "color_grade", "view_transform"]


def said(words, **environment):
    done = subprocess.run([str(w) for w in words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=ROOT,
                          env=os.environ | environment)
    if done.returncode:
        raise SystemExit(f"{words[0]} ended with {done.returncode}:\n{done.stdout[-2000:]}")
    print(done.stdout[-600:], flush=True)
    return done.stdout


def by_file(script, *words):
    """Of a bench that writes its figures."""
    file = WORK / "figures.json"
    said([RIVAL_PYTHON, ROOT / "scripts" / script, *words], FIGURES=str(file))
    return json.loads(file.read_text())


def start():
    """The first picture of a look from empty caches, after `warm`, and once more."""
    look, capture = ROOT / "scenes/looks/portrait.json", ROOT / "scenes/suzanne/capture.json"
    figures = {}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def seconds(cache, verb="run"):
            words = [AFTERSHADE, verb, look, capture, "--frames", "4", "--backend", "software"]
            if verb == "run":
                words += ["--progress", "none", "--overwrite", "-o", folder / "out_####.exr"]
            begin = time.perf_counter()
            subprocess.run([str(w) for w in words], check=True, capture_output=True, env=os.environ | {"AFTERSHADE_CACHE": str(cache)})
            return time.perf_counter() - begin

        rounds = []
        for i in range(7):
            cold, warmed = folder / f"cold_{i}", folder / f"warmed_{i}"
            seconds(warmed, "warm")
            rounds.append((seconds(cold), seconds(cold), seconds(warmed)))
            shutil.rmtree(cold)
        cold, warm, after = (statistics.median(side) for side in zip(*rounds))
        figures["first picture from empty caches, of a warm one"] = round(cold / warm, 2)
        figures["first picture after `aftershade warm`, of a warm one"] = round(after / warm, 2)
    return figures


def passes_ms(look, source):
    """By step, the least of three frames."""
    lines = said([AFTERSHADE, "run", look, source, "--profile", "blender", "--backend", "software", "--overwrite", "--verbose", "-o", WORK / "out.exr"])
    steps = {}
    for step, ms in re.findall(r"^(\w+)\.\S+ +([\d.]+)", lines, re.M):
        steps[step] = steps.get(step, 0) + float(ms)
    return steps


def film():
    """Absolute times: they compare with another run on the same machine alone."""
    source = suzanne_1080p(ROOT / "build/bench-roofline")
    runs = [passes_ms(ROOT / "scenes/looks/film.json", source) for _ in range(4)][1:]
    tail = min(sum(ms for step, ms in run.items() if step in TAIL) for run in runs)
    return {"film look at 1080p, all passes, ms": round(min(sum(run.values()) for run in runs)),
            "its tail, chromatic aberration to view transform, ms": round(tail)}


def number(pattern, text):
    return float(re.search(pattern, text).group(1))


def dof():
    text = said(["tests/bench/dof-against-blender", "dof"])
    return {"`dof`, whole process at 1080p: times as fast as Blender's Defocus": number(r"([\d.]+) times as fast", text)}


def motion():
    text = said(["tests/bench/motion-against-blender"])
    still, moving = (float(ms) for ms in re.search(r"at rest (\d+) ms, one that moves everywhere by 40 px .* (\d+) ms: ", text).groups())
    return {"`motion_blur`, whole process at 1080p: times as fast as Blender's Vector Blur": number(r"whole process.*\| ([\d.]+) \|", text),
            "`motion_blur` alone: times as fast as the node alone": number(r"upload to readback.*\| ([\d.]+) \|", text),
            "`motion_blur`, passes alone: a frame at rest, of one that moves everywhere by 40 px": round(still / moving, 3)}


def rivals():
    file = WORK / "figures.json"
    said([sys.executable, ROOT / "tests/bench/rivals.py"], FIGURES=str(file))
    return json.loads(file.read_text())


def roofline():
    said(["scripts/bench-roofline"])
    return {}


WORKS = {"frames": lambda: by_file("bench-frames", ROUNDS), "exr": lambda: by_file("bench-exr"), "start": start, "film": film, "dof": dof, "focus": focus.figures,
         "motion": motion, "rivals": rivals, "roofline": roofline}


def commit():
    return subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True, cwd=ROOT, check=True).stdout.strip()


def write_page(history):
    """Of each figure the newest."""
    newest = {}
    for run in history:
        for name, value in run["figures"].items():
            newest[name] = (value, run["commit"], run["day"])
    rows = [[name, value, f"{commit}, {day}"] for name, (value, commit, day) in newest.items()]
    words = (ROOT / "scripts/speed/speed.md").read_text()
    PAGE.write_text(words.replace("FIGURES", table(["", "figure", "measured at"], rows)).replace(
        "ROOFLINE", (ROOT / "scripts/speed/roofline.md").read_text().rstrip()).replace("MACHINE", history[-1]["machine"]))


def machine():
    model = re.search(r"model name\s*: (.+)", pathlib.Path("/proc/cpuinfo").read_text())
    return f"{os.cpu_count()} cores of {model.group(1).strip() if model else 'an unknown processor'}"


def main():
    WORK.mkdir(parents=True, exist_ok=True)
    figures = {}
    for part in PARTS:
        print(f"== {part}", flush=True)
        figures |= WORKS[part]()
    history = json.loads(HISTORY.read_text()) if HISTORY.exists() else []
    history.append({"commit": commit(), "day": datetime.date.today().isoformat(), "machine": machine(), "figures": figures})
    HISTORY.write_text(json.dumps(history, indent=1) + "\n")
    write_page(history)
    print("\n".join(f"{name}: {value}" for name, value in figures.items()))


main()
