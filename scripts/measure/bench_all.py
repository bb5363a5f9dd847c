"""The benches against their rivals in one go, their figures in docs/speed.md and as a history; started by scripts/bench."""
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
from collections.abc import Sequence
from pathlib import Path

from measure import focus
from measure.blender_turns import suzanne_1080p
from measure.pages import Figures, Page, table
from measure.tree import AFTERSHADE, ROOT, Document

WORK = ROOT / "build/bench"
HISTORY = ROOT / "scripts/measure/history.json"
PARTS = os.environ.get("PARTS", "frames exr start film dof focus motion rivals roofline").split()
ROUNDS = os.environ.get("ROUNDS", "5")
TAIL = ["chromatic_aberration", "vignette", "film_grain", "color_grade", "view_transform"]


def said(words: Sequence[object], **environment: str) -> str:
    done = subprocess.run([str(w) for w in words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=ROOT,
                          env=os.environ | environment)
    if done.returncode:
        raise SystemExit(f"{words[0]} ended with {done.returncode}:\n{done.stdout[-2000:]}")
    print(done.stdout[-600:], flush=True)
    return done.stdout


def by_file(*words: object) -> Figures:
    """Of a bench that writes its figures."""
    file = WORK / "figures.json"
    said([sys.executable, *words], FIGURES=str(file), AFTERSHADE=str(AFTERSHADE))
    return json.loads(file.read_text())


def start() -> Figures:
    """The first picture of a look from empty caches, after `warm`, and once more."""
    look, capture = ROOT / "scenes/looks/portrait.json", ROOT / "scenes/suzanne/capture.json"
    figures = {}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def seconds(cache: Path, verb: str = "run") -> float:
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


def passes_ms(look: Path, source: Path) -> dict[str, float]:
    """By step, the least of three frames."""
    lines = said([AFTERSHADE, "run", look, source, "--profile", "blender", "--backend", "software", "--overwrite", "--verbose", "-o", WORK / "out.exr"])
    steps: dict[str, float] = {}
    for step, ms in re.findall(r"^(\w+)\.\S+ +([\d.]+)", lines, re.M):
        steps[step] = steps.get(step, 0) + float(ms)
    return steps


def film() -> Figures:
    """Absolute times: they compare with another run on the same machine alone."""
    source = suzanne_1080p(ROOT / "build/bench-roofline")
    runs = [passes_ms(ROOT / "scenes/looks/film.json", source) for _ in range(4)][1:]
    tail = min(sum(ms for step, ms in run.items() if step in TAIL) for run in runs)
    return {"film look at 1080p, all passes, ms": round(min(sum(run.values()) for run in runs)),
            "tail of the film look at 1080p, chromatic aberration to view transform, ms": round(tail)}


def number(pattern: str, text: str) -> float:
    return float(re.findall(pattern, text)[0])


def dof() -> Figures:
    text = said(["tests/bench/dof-against-blender", "dof"])
    return {"`dof`, whole process at 1080p: times as fast as Blender's Defocus": number(r"([\d.]+) times as fast", text)}


def motion() -> Figures:
    text = said(["tests/bench/motion-against-blender"])
    still, moving = (float(ms) for ms in re.findall(r"at rest (\d+) ms, one that moves everywhere by 40 px .* (\d+) ms: ", text)[0])
    return {"`motion_blur`, whole process at 1080p: times as fast as Blender's Vector Blur": number(r"whole process.*\| ([\d.]+) \|", text),
            "`motion_blur` alone: times as fast as the node alone": number(r"upload to readback.*\| ([\d.]+) \|", text),
            "`motion_blur`, passes alone: a frame at rest, of one that moves everywhere by 40 px": round(still / moving, 3)}


def roofline() -> Figures:
    said(["scripts/bench", "roofline"])
    return {}


WORKS = {"frames": lambda: by_file("-m", "measure.bench_frames", ROUNDS), "exr": lambda: by_file("-m", "measure.bench_exr"),
         "start": start, "film": film, "dof": dof, "focus": focus.figures,
         "motion": motion, "rivals": lambda: by_file("tests/bench/rivals.py"), "roofline": roofline}


def commit() -> str:
    return subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True, cwd=ROOT, check=True).stdout.strip()


def measured(name: str) -> tuple[str, str]:
    """What a figure measures, and its unit: a time, or a ratio to what."""
    if match := re.fullmatch(r"(.*?):? times as fast as (.*)", name):
        return match[1], f"times as fast as {match[2]}"
    if match := re.fullmatch(r"(.*), ms", name):
        return match[1], "ms"
    what, of = name.rsplit(", of ", 1)
    return what, f"ratio to {of}"


def write_page(page: Page, history: list[Document]) -> None:
    """Of each figure the newest."""
    newest = {}
    for run in history:
        for name, value in run["figures"].items():
            newest[name] = (value, run["commit"], run["day"])
    rows = [[*measured(name), value, f"{commit}, {day}"] for name, (value, commit, day) in newest.items()]
    page.fill({"figures": table(["what", "unit", "figure", "measured at"], rows), "machine": history[-1]["machine"]})


def machine() -> str:
    model = re.search(r"model name\s*: (.+)", pathlib.Path("/proc/cpuinfo").read_text())
    return f"{os.cpu_count()} cores of {model.group(1).strip() if model else 'an unknown processor'}"


def main() -> None:
    page = Page("speed.md", "scripts/bench", ["figures", "machine"])
    WORK.mkdir(parents=True, exist_ok=True)
    figures: Figures = {}
    for part in PARTS:
        print(f"== {part}", flush=True)
        figures |= WORKS[part]()
    history = json.loads(HISTORY.read_text()) if HISTORY.exists() else []
    history.append({"commit": commit(), "day": datetime.date.today().isoformat(), "machine": machine(), "figures": figures})
    HISTORY.write_text("[\n" + ",\n".join(map(json.dumps, history)) + "\n]\n")  # a run a line
    write_page(page, history)
    print("\n".join(f"{name}: {value}" for name, value in figures.items()))


if __name__ == "__main__":
    main()
