"""Frames a second of every shipped scene at 480x270: rendered, and written as ZIP float EXR. Exits 1 where the median scene is below
10, or 2.5 written.

    FRAMES=8     of each scene
"""
import json
import os
import pathlib
import statistics
import sys
import tempfile

from measure.tree import AFTERSHADE, ROOT, command


def main() -> None:
    rendered, written, frames = [], [], int(os.environ.get("FRAMES", "8"))
    for scene in sorted(ROOT.glob("scenes/*/scene.json")):
        with tempfile.TemporaryDirectory() as out:
            report = json.loads(command([AFTERSHADE, "render", scene, "-o", out, "--json", "--quiet", "--size", "480x270", "--frames", f"1-{frames}"]))
            megabytes = sum(pathlib.Path(file).stat().st_size for file in report["files"]) / 1e6 / frames
        rendered.append(frames / report["render_s"])
        written.append(frames / report["total_s"])
        print(f"{scene.parent.name:16} {rendered[-1]:7.1f} frames/s rendered {written[-1]:7.2f} frames/s written, {megabytes:.1f} MB a frame", flush=True)
    median, median_written = statistics.median(rendered), statistics.median(written)
    print(f"median           {median:7.1f}                   {median_written:7.2f}")
    sys.exit("below 10 frames a second, or 2.5 written" if median < 10 or median_written < 2.5 else 0)


if __name__ == "__main__":
    main()
