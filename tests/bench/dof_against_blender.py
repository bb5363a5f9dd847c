"""Whole processes, EXR to EXR, in turns: `aftershade run` with one effect against Blender's Defocus node over the same file.
Started by tests/bench/dof-against-blender."""
import sys

from measure.blender_turns import blender_words, halved, in_turns, suzanne_1080p
from measure.dof_family import effect_folders, effects, run_effect
from measure.exr import read_exr
from measure.measures import psnr_db
from measure.tree import AFTERSHADE, CAPTURES, ROOT

WORK = ROOT / "build/dof-against-blender"
LENS = {"focus_distance": 6.4, "focal_length": 50, "f_number": 0.25, "sensor_width": 36, "lens_model": "pinhole"}


def main():
    here = {e.id: e for e in effects()}
    name = sys.argv[1] if len(sys.argv) > 1 else "dof" if "dof" in here else "bokeh"
    effect = here.get(name) or sys.exit(f"no effect '{name}' here (known: {', '.join(here)})")
    source = suzanne_1080p(WORK)
    params = LENS | effect.closest_to_hexagon()
    ours, theirs = WORK / "aftershade.exr", WORK / "blender.exr"
    run_effect(name, source, ours, params, WORK)  # fills the program cache and the file cache
    extra = [w for folder in effect_folders()[:-1] for w in ("--effect-path", str(folder))]
    walls, _ = in_turns({
        "aftershade": [AFTERSHADE, "run", WORK / f"{name}.json", source, "-o", ours, "--backend", "software", "--progress", "none", *extra],
        "blender": blender_words("dof_blender.py", source, theirs)})
    truth = read_exr(CAPTURES / "suzanne/truth/dof_0004.exr")
    for label, file in ("aftershade", ours), ("blender", theirs):
        print(f"{label:10} against the renderer's lens, at 960x540: {psnr_db(truth, halved(read_exr(file))):.2f} dB")
    print(f"suzanne frame 4 at 1920x1080, whole process, EXR to EXR: `{name}` {walls['aftershade']:.2f} s, "
          f"Blender's Defocus {walls['blender']:.2f} s: {walls['blender'] / walls['aftershade']:.1f} times as fast")


if __name__ == "__main__":
    main()
