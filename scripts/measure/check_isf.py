"""Renders every ISF file of a folder, and compares with the format's own renderer in Chromium on software GL.

    scripts/check isf [FOLDER]      FOLDER: of .fs files (default: $AFTERSHADE_ISF); ONLY=words names files

Each is rendered at 256x144 over one picture, with its default values and with a second set, in frames 0 to 10, of which 1 and 10
are compared: at most 2/255 in 99 % of the pixels. Writes the tables and the pictures of docs/isf.md. The npm package
interactive-shader-format is fetched for this alone. Ten minutes."""
import base64
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
from typing import Any

import numpy
from PIL import Image

from measure.exr import read_exr, write_exr
from measure.pages import Page, table
from measure.tree import ROOT

WIDTH, HEIGHT, FPS, FRAMES = 256, 144, 24, (1, 10)
PROGRAM = os.environ.get("AFTERSHADE", str(ROOT / "build/release/aftershade"))
MODULES = pathlib.Path(os.environ.get("AFTERSHADE_ISF_MODULES", ROOT / "build/isf-modules"))
CHANNELS = [f"display.{c}" for c in "RGBA"]
CLOSE, SHARE = 2, 0.99
Found = dict[str, Any]


def picture() -> numpy.ndarray:
    """Bars, a gradient, discs and a checker: 8 bits, opaque."""
    y, x = numpy.mgrid[0:HEIGHT, 0:WIDTH]
    u, v = (x + 0.5) / WIDTH, (y + 0.5) / HEIGHT
    image = numpy.stack([u, v, 1 - u * v], axis=-1)
    for cx, cy, radius, color in [(0.3, 0.4, 0.18, (0.9, 0.2, 0.1)), (0.7, 0.55, 0.25, (0.1, 0.3, 0.8)), (0.55, 0.2, 0.1, (1, 1, 0.7))]:
        inside = (u - cx) ** 2 + ((v - cy) * HEIGHT / WIDTH) ** 2 < (radius * HEIGHT / WIDTH) ** 2
        image[inside] = color
    checker = ((x // 12 + y // 12) % 2 == 0) & (v > 0.75)
    image[checker] *= 0.3
    return numpy.concatenate([numpy.round(image * 255), numpy.full((HEIGHT, WIDTH, 1), 255)], axis=-1).astype(numpy.uint8)


def header_of(text: str) -> Found:
    found = re.search(r"/\*(\s*\{.*?)\*/", text, re.S)
    return json.loads(found[1], strict=False) if found else {}


def second_value(entry: Found) -> Any:
    """Another value within the limits; None: as it is."""
    kind, default = entry["TYPE"], entry.get("DEFAULT")
    if kind == "float":
        low, high = entry.get("MIN", 0.0), entry.get("MAX", 1.0)
        return low + 0.7 * (high - low) if default is None or abs(default - (low + 0.7 * (high - low))) > 1e-6 else low + 0.4 * (high - low)
    if kind == "bool":
        return not default
    if kind == "long" and len(entry.get("VALUES", [])) > 1:
        values = entry["VALUES"]
        return values[(values.index(default) + 1) % len(values)] if default in values else values[-1]
    if kind == "color":
        return [1 - c for c in (default or [0.2, 0.4, 0.6])[:3]] + [1.0]
    if kind == "point2D":
        low, high = entry.get("MIN", [0, 0]), entry.get("MAX", [1, 1])
        return [low[i] + 0.35 * (high[i] - low[i]) for i in (0, 1)]
    return None


def ours_of(entry: Found, value: Any, params: dict[str, Found]) -> tuple[str, Any] | None:
    """The parameter and its value, as `describe --json` has them."""
    label = entry.get("LABEL", "").strip() or entry["NAME"]
    name = next((n for n, p in params.items() if p["doc"].startswith((label + ".", label + ":"))), None)
    if name is None:
        return None
    if params[name]["type"] == "enum":
        return name, params[name]["values"][entry["VALUES"].index(value)]
    return name, value


def run(command: list[str], **options: Any) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, capture_output=True, text=True, timeout=300, **options)


def render(file: pathlib.Path, params: dict[str, Any], source: pathlib.Path, folder: pathlib.Path) -> Found:
    look = folder / "look.json"
    look.write_text(json.dumps({"aftershade": 1, "steps": [{"effect": os.path.relpath(file, folder), "name": "filter", "params": params}]}))
    done = run([PROGRAM, "run", str(look), str(source), "-o", str(folder / "out.####.exr"), "--progress", "none", "--backend", "software",
                "--output-roles", "display", "--pixel-type", "float"])
    if done.returncode:
        lines = [line for line in done.stderr.splitlines() if "error" in line] or done.stderr.splitlines() or ["no message"]
        return {"reason": lines[0].strip(), "code": done.returncode}
    pictures = {}
    for frame in FRAMES:
        values = read_exr(folder / f"out.{frame:04}.exr", CHANNELS)
        pictures[frame] = numpy.round(numpy.clip(values, 0, 1) * 255).astype(numpy.uint8)
    return {"pictures": pictures}


def render_both(file: pathlib.Path, source: pathlib.Path, work: pathlib.Path) -> dict[str, Found]:
    header = header_of(file.read_text(errors="replace"))
    entries = [e for e in header.get("INPUTS", []) if e.get("TYPE") not in ("image", "audio", "audioFFT", "event")]
    results = {}
    described = run([PROGRAM, "describe", str(file), "--json"])
    params = json.loads(described.stdout)["params"] if described.returncode == 0 else {}
    for which in ("defaults", "second"):
        theirs = {e["NAME"]: v for e in entries if which == "second" and (v := second_value(e)) is not None}
        ours = dict(filter(None, (ours_of(e, theirs[e["NAME"]], params) for e in entries if e["NAME"] in theirs)))
        folder = work / f"{file.stem} {which}"
        folder.mkdir()
        results[which] = render(file, ours, source, folder) | {"values": theirs}
    return results


def imports_of(file: pathlib.Path) -> dict[str, str]:
    imports = header_of(file.read_text(errors="replace")).get("IMPORTED", {})
    return {name: base64.b64encode((file.parent / entry["PATH"]).read_bytes()).decode() for name, entry in imports.items()}


def reference(files: list[pathlib.Path], ours: dict[str, dict[str, Found]], work: pathlib.Path, fixes: bool, mesa: bool) -> dict[str, Found]:
    jobs = []
    for file in files:
        text, vertex = file.read_text(errors="replace"), file.with_suffix(".vs")
        images = [e["NAME"] for e in header_of(text).get("INPUTS", []) if e.get("TYPE") == "image"]
        for which, result in ours[file.name].items():
            jobs.append({"name": f"{file.name}|{which}", "fragment": text, "images": images, "values": result["values"],
                         "imports": imports_of(file), "vertex": vertex.read_text(errors="replace") if vertex.exists() else None})
    words = {"width": WIDTH, "height": HEIGHT, "fps": FPS, "frames": FRAMES, "fixes": fixes, "mesa": mesa, "jobs": jobs,
             "picture": base64.b64encode(picture().tobytes()).decode()}
    (work / "jobs.json").write_text(json.dumps(words))
    subprocess.run(["node", str(ROOT / "scripts/isf/reference.mjs"), str(work / "jobs.json"), str(work / "found.json")], check=True,
                   env=os.environ | {"AFTERSHADE_ISF_MODULES": str(MODULES)})
    found: dict[str, Found] = json.loads((work / "found.json").read_text())
    for result in found.values():
        if "pictures" in result:
            result["pictures"] = {int(frame): unpack(text) for frame, text in result["pictures"].items()}
    return found


def unpack(text: str) -> numpy.ndarray:
    return numpy.frombuffer(base64.b64decode(text), numpy.uint8).reshape(HEIGHT, WIDTH, 4)


def shares(mine: Found, theirs: Found) -> list[float]:
    """Of pixels that are close, by frame; none where one of them has no pictures."""
    found = []
    for frame in FRAMES if "pictures" in mine and "pictures" in theirs else ():
        difference = numpy.abs(mine["pictures"][frame].astype(int) - theirs["pictures"][frame].astype(int)).max(axis=-1)
        found.append(float((difference <= CLOSE).mean()))
    return found


def all_shares(mine: dict[str, Found], theirs: dict[str, Found], names: list[str]) -> list[float]:
    found = [shares(mine[name], theirs[name]) for name in names]
    return [s for each in found for s in each] if all(found) else [0.0] * len(FRAMES) * len(names)


def write_sheet(files: list[pathlib.Path], ours: dict[str, dict[str, Found]]) -> None:
    """Frame 10 of each file with its default values, at half the size, over grey where it is transparent."""
    columns = 10
    rows = -(-len(files) // columns)
    sheet = numpy.full((rows * HEIGHT // 2, columns * WIDTH // 2, 3), 255.0)
    for i, file in enumerate(files):
        image = ours[file.name]["defaults"]["pictures"][FRAMES[-1]].astype(float)
        alpha = image[..., 3:] / 255
        small = (image[..., :3] * alpha + 128 * (1 - alpha)).reshape(HEIGHT // 2, 2, WIDTH // 2, 2, 3).mean(axis=(1, 3))
        y, x = i // columns * HEIGHT // 2, i % columns * WIDTH // 2
        sheet[y:y + HEIGHT // 2, x:x + WIDTH // 2] = small
    Image.fromarray(sheet.round().astype(numpy.uint8)).save(ROOT / "docs/images/isf_filters.jpg", quality=75)


def fetch_modules() -> None:
    if not (MODULES / "node_modules/interactive-shader-format").exists():
        MODULES.mkdir(parents=True, exist_ok=True)
        (MODULES / "package.json").write_text("{}")
        subprocess.run(["npm", "install", "--silent", "--no-audit", "--no-fund", "--prefix", str(MODULES),
                        "interactive-shader-format@2.9.0", "playwright-core@1.60.0"], check=True)


# What nobody can reproduce, and what no other renderer has.
KNOWN = {
    "Boxinator.fs": "requests `mediump`, in which that renderer has no number so large as it computes",
    "Butterfly Wave Scrawler.fs": "`acos()` beyond 1 and `pow()` of negative numbers: no picture is defined",
    "Crazy Parametric Fun.fs": "divides by 0 at its defaults: no picture is defined",
    "FastMosh.fs": "feeds rounded differences back, which grow from frame to frame",
}


def why(file: pathlib.Path, right: list[float], itself: list[float]) -> str:
    if min(right) >= SHARE:
        return "alike once that renderer's faults are put right"
    if file.name in KNOWN:
        return KNOWN[file.name]
    if min(itself) < SHARE:
        return f"that renderer differs from itself between its two GLs: {100 * min(itself):.1f}"
    return "not explained"


def main() -> None:
    fetch_modules()
    page = Page("isf.md", "scripts/check isf", ["figures", "refused", "differences"])
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else os.environ["AFTERSHADE_ISF"])
    only = os.environ.get("ONLY", "").split(",")
    files = [f for f in sorted(folder.glob("*.fs")) if any(word in f.name for word in only)]
    with tempfile.TemporaryDirectory() as temporary:
        work = pathlib.Path(temporary)
        (work / "in").mkdir()
        display = picture().astype(numpy.float32) / 255
        for frame in range(max(FRAMES) + 1):
            write_exr(work / f"in/frame.{frame:04}.exr", {name: display[..., i % 4] for i, name in enumerate([*CHANNELS, *"RGBA"])})
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            source = work / "in/capture.json"
            source.write_text(json.dumps({"aftershade": 1, "frames": "frame.####.exr", "fps": FPS,
                                          "channels": {"display": {"channels": CHANNELS}}}))
            ours = dict(zip([f.name for f in files], pool.map(lambda f: render_both(f, source, work), files)))
        rendered = [f for f in files if all("pictures" in r for r in ours[f.name].values())]
        found = {(fixes, mesa): reference(rendered, ours, work, fixes, mesa) for fixes in (False, True) for mesa in (False, True)}
    refused, absent, rows, alike, itself_alike = [], [], [], [0, 0], 0
    for file in files:
        mine = {f"{file.name}|{which}": result for which, result in ours[file.name].items()}
        names = list(mine)
        if file not in rendered:
            reason = next(r["reason"] for r in mine.values() if "reason" in r)
            refused.append([file.name, reason.replace(str(folder) + "/", "")])
            continue
        raw = found[False, False]
        if any("pictures" not in raw[name] for name in names):
            reason = next(raw[n]["reason"] for n in names if "reason" in raw[n]).splitlines()[0]
            absent.append([file.name, "`" + reason.rstrip("\0").strip()[:100] + "`"])
            continue
        plain, right = (max((all_shares(mine, found[fixes, mesa], names) for mesa in (False, True)), key=min) for fixes in (False, True))
        itself = all_shares(found[True, False], found[True, True], names)
        itself_alike += min(itself) >= SHARE
        alike[0] += min(plain) >= SHARE
        alike[1] += max(min(plain), min(right)) >= SHARE
        if min(plain) < SHARE:
            rows.append([file.name, *(f"{100 * s:.1f}" for s in plain), f"{100 * min(right):.1f}", why(file, right, itself)])
    both = len(rendered) - len(absent)
    figures = table(["files", "rendered here", "by that renderer too", "of these alike", "alike with its faults put right",
                     "that renderer on one GL and on the other alike"],
                    [[len(files), len(rendered), both, *(f"{n} ({100 * n / max(both, 1):.0f} %)" for n in [*alike, itself_alike])]])
    print(figures)
    for row in refused + absent + rows:
        print(*row, sep="  ")
    if os.environ.get("ONLY"):
        return
    write_sheet(rendered, ours)
    page.fill({"figures": figures,
               "refused": table(["file", "reason"], refused + [[name, "that renderer: " + reason] for name, reason in absent]),
               "differences": table(["file", "defaults, frame 1", "frame 10", "second set, 1", "10", "least, put right", "reason"], rows)})


if __name__ == "__main__":
    main()
