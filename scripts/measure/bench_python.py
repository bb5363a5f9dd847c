"""What Python adds to a frame: renders one of 960x540 from arrays, and the same with the command, in turns, and compares
the time of a call with the command's table (upload, passes, readback). Ends with 1 above 1.05. Needs the package aftershade
(pip install .) in $PYTHON (python3), and this tree's program.

    scripts/bench python [AFTERSHADE [ROUNDS]]      build/release/aftershade, 9
"""
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import aftershade
import numpy as np

from measure.measures import Array
from measure.tree import ROOT

FRAMES = 5  # a round; the first of each side, which compiles, does not count
GOAL = 1.05
LOOK = {"aftershade": 1, "steps": [{"effect": "bokeh", "params": {"f_number": 1.4, "focus_distance": "6.4 m"}}, {"effect": "vignette"}]}


def frame_arrays() -> dict[str, Array]:
    """Twice as large as the scene's frame, by repeating pixels."""
    capture = aftershade.Capture(ROOT / "scenes/suzanne/gbuffer_0003.exr", roles=["color", "depth"])
    return {role: np.repeat(np.repeat(capture[role], 2, axis=0), 2, axis=1) for role in ("color", "depth")}


def of_python(look: Any, session: Any, capture: Any, first: int) -> list[float]:
    times_ms = []
    for frame in range(first, first + FRAMES):
        capture.frame = frame
        begin = time.perf_counter()
        session.render(capture)["color"]
        times_ms.append(1000 * (time.perf_counter() - begin))
    return times_ms[1:]


def of_command(program: Path, folder: Path) -> list[float]:
    command = [str(program), "run", "look.json", "in_####.exr", "-o", "out_####.exr", "--telemetry", "stats_####.json", "--no-journal", "--progress", "none"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    tables = [json.loads(path.read_text())["passes_ms"] for path in sorted(folder.glob("stats_*.json"))]
    return [sum(table.values()) for table in tables][1:]


def main() -> int:
    program = Path(sys.argv[1] if len(sys.argv) > 1 else "build/release/aftershade").resolve()
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 9
    backend = os.environ.setdefault("AFTERSHADE_BACKEND", "software")
    os.environ["AFTERSHADE_CACHE"] = "off"
    host = aftershade.Host(backend=backend)
    look = aftershade.Look(LOOK, host=host)
    capture, session = aftershade.Capture(frame_arrays()), look.session()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "look.json").write_text(json.dumps(LOOK))
        identity = aftershade.Look({"aftershade": 1, "steps": [{"effect": "vignette", "params": {"strength": 0}}]}, host=host)
        identity.render(capture).write(folder / "in_0001.exr", roles=["color", "depth"], half=False)
        for frame in range(2, FRAMES + 1):
            os.link(folder / "in_0001.exr", folder / f"in_{frame:04}.exr")
        in_python, in_command = [], []
        for one in range(rounds):
            in_python += of_python(look, session, capture, 1 + one * FRAMES)
            in_command += of_command(program, folder)
    ratio = statistics.median(in_python) / statistics.median(in_command)
    print(f"{len(in_python)} frames of 960x540, {backend}: a call of render() {statistics.median(in_python):.1f} ms, "
          f"upload + passes + readback of the command {statistics.median(in_command):.1f} ms: {ratio:.3f}; "
          f"least {min(in_python):.1f} and {min(in_command):.1f} ms: {min(in_python) / min(in_command):.3f}")
    return 0 if ratio <= GOAL else 1


if __name__ == "__main__":
    sys.exit(main())
