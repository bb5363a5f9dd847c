"""How far `decoupled` is from a renderer's lens, from its shutter and from both at once, what is hidden included, and what it costs;
and how often `render --visibility` computes light: the figures and pictures of docs/quality-decoupled.md. Captures and truths are
rendered once and kept in build/quality-decoupled. About an hour.

    PARTS="suzanne both hidden triangles transparency times adaptive temporal"   these alone; the others stay as they are
    AFTERSHADE=FILE            another executable, and no build
    AFTERSHADE_CAPTURES=DIR    where suzanne lies (docs/measures.md)
"""
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy
from PIL import Image

from measure.decoupled_rates import on_triangles
from measure.decoupled_temporal import over_frames
from measure.decoupled_times import adaptive, in_time
from measure.decoupled_transparency import on_transparent
from measure.exr import RGB, read_exr
from measure.measures import Array, bytes_of, changed_pixels, psnr_db
from measure.pages import Blocks, Page, table
from measure.quality_hidden import NEIGHBOURS, rendered
from measure.tree import AFTERSHADE, CAPTURES, EXACT, ROOT, Document, command, write_json, write_look

WORK = ROOT / "build/quality-decoupled"
IMAGES = ROOT / "docs/images/decoupled"
FRAME, SAMPLES = 4, 128
LENS = {"focus_distance": 6.4, "focal_length": 50, "f_number": 0.25, "sensor_width": 36, "lens_model": "pinhole", "blades": 6}
NO_LENS = {"focal_length": 1, "f_number": 1000}
DOF, BLUR = {"effect": "dof"}, {"effect": "motion_blur"}
IN_TURN = {"color": "capture.color", "in_turn": "motion_blur.color"}
COUNTS = [8, 16, 32, 64, 256]
BOTH = {"toys": (100, 60, 240, 150), "leaves": (120, 100, 240, 150)}  # x, y, w, h


def decoupled(**params: Any) -> Document:
    return {"effect": "decoupled", "params": params}


def through(steps: Sequence[Document], capture: Path) -> tuple[Array, Document]:
    """The picture of the steps, and their telemetry."""
    look = write_look(WORK / "look.json", *steps)
    command([AFTERSHADE, "run", look, capture, "--frames", FRAME, "-o", WORK / "out_####.exr", "--telemetry", WORK / "out_####.json", *EXACT])
    return read_exr(WORK / f"out_{FRAME:04}.exr"), json.loads((WORK / f"out_{FRAME:04}.json").read_text())


def save(name: str, tiles: Sequence[Array], scale: int = 1) -> None:
    tiles = [numpy.pad(t, ((0, 4), (0, 4), (0, 0)), constant_values=1) for t in tiles]
    strip = numpy.concatenate([numpy.concatenate(tiles[i:i + 2], axis=1) for i in range(0, len(tiles), 2)])[:-4, :-4]
    pixels = Image.fromarray(bytes_of(strip))
    pixels.resize((scale * pixels.width, scale * pixels.height), Image.NEAREST).save(IMAGES / f"{name}.jpg", quality=86)


def on_suzanne() -> Blocks:
    folder = CAPTURES / "suzanne"
    capture = write_json(WORK / "suzanne.json", {"aftershade": 1, "frames": str((folder / "large/gbuffer_####.exr").resolve()), "range": "3-5",
                                                 "fps": 24, "profile": "blender"})
    sharp = read_exr(folder / f"large/gbuffer_{FRAME:04}.exr", [f"ViewLayer.Combined.{c}" for c in RGB])
    lens, shutter = read_exr(folder / "truth/dof_0004.exr"), read_exr(folder / "truth/motion_0004.exr")
    changed = changed_pixels(sharp, shutter)
    rows, shown = [], []
    steps = {"the sharp input": None, "`dof`, `motion_blur`": ([DOF | {"params": LENS}], [BLUR])}
    steps |= {f"`decoupled`, {count} samples": ([decoupled(samples=count, shutter_angle=0, **LENS)], [decoupled(samples=count, **NO_LENS)])
              for count in COUNTS}
    for label, step in steps.items():
        by_lens, by_shutter = [through(s, capture)[0] for s in step] if step else [sharp, sharp]
        rows.append([label, *(f"{v:.2f}" for v in (psnr_db(lens, by_lens), psnr_db(shutter, by_shutter), psnr_db(shutter, by_shutter, changed)))])
        print(*rows[-1], flush=True)
        if "64" in label:
            shown = [by_lens[60:330, 480:900], lens[60:330, 480:900]]
    save("suzanne", shown)
    return {"suzanne": table(["", "lens, dB", "shutter, dB", "shutter, changed pixels, dB"], rows)}


def both_at_once() -> Blocks:
    rows = []
    for name, (x, y, w, h) in BOTH.items():
        folder, truth_folder = WORK / name, WORK / f"{name}_truth"
        if not (truth_folder / f"truth_lens_shutter_{FRAME:04}.exr").exists():
            command([AFTERSHADE, "render", ROOT / "scenes" / name, "-o", folder, "--frames", "3-5", "--quiet"])
            command([AFTERSHADE, "render", ROOT / "scenes" / name, "-o", truth_folder, "--frames", FRAME, "--samples", SAMPLES, "--quiet",
                     "--truth", "lens", "--truth", "shutter", "--truth", "lens+shutter"])
        lens, shutter, truth = (read_exr(truth_folder / f"truth_{kind}_{FRAME:04}.exr") for kind in ("lens", "shutter", "lens_shutter"))
        meet = changed_pixels(lens, truth) & changed_pixels(shutter, truth)
        if not (WORK / f"{name}_4_layers/capture.json").exists():
            command([AFTERSHADE, "render", ROOT / "scenes" / name, "-o", WORK / f"{name}_4_layers", "--frames", "3-5", "--quiet", "--layers", 4])
        crops = []
        for kind in "1 layer", "4 layers":
            capture = (folder if kind == "1 layer" else WORK / f"{name}_4_layers") / "capture.json"
            for label, steps in {"`dof`, then `motion_blur`": [DOF, BLUR], "`motion_blur`, then `dof`": [BLUR, DOF],
                                 "`decoupled`, 64 samples": [decoupled()], "`decoupled`, 256 samples": [decoupled(samples=256)],
                                 "`dof`, `motion_blur`, `decoupled`": [DOF, BLUR, decoupled() | {"in": IN_TURN}]}.items():
                picture, told = through(steps, capture)
                shares = told["steps"].get("decoupled", {})
                percent = lambda key: f"{100 * shares[key]['mean']:.1f}" if shares else ""
                at_both = f"{psnr_db(truth, picture, meet):.2f}" if meet.any() else ""
                rows.append([f"`{name}`, {kind}", label, f"{psnr_db(truth, picture):.2f}", at_both, percent("estimated"), percent("holes")])
                print(*rows[-1], flush=True)
                crops.append(picture[y:y + h, x:x + w])
        save(name, [crops[0], crops[1], crops[2], truth[y:y + h, x:x + w]], 2)
    return {"both": table(["scene", "", "all pixels, dB", "where both meet, dB", "estimated, %", "holes, %"], rows)}


def kinds_of(name: str) -> dict[str, tuple[Path, Array]]:
    """Captures of what near things hide, as `quality hidden` makes them, and the truth of each."""
    return {kind: (capture.parent, read_exr(truth)) for kind, (capture, _, truth) in rendered(name).items() if kind != NEIGHBOURS}


def hidden() -> Blocks:
    rows = []
    steps = [[decoupled(shutter_angle=0)], [decoupled(samples=256, shutter_angle=0)]]
    for name in "fence", "leaves":
        for kind, (folder, truth) in kinds_of(name).items():
            db = [psnr_db(truth, through(step, folder / "capture.json")[0]) for step in steps]
            rows.append([f"`{name}`, {kind}", *(f"{v:.2f}" for v in db)])
            print(*rows[-1], flush=True)
    return {"hidden": table(["", "`decoupled`, 64 samples", "256 samples"], rows)}


def main() -> None:
    blocks = ["suzanne", "both", "hidden", "rates", "blur", "caches", "pictures", "transparency", "times", "sharp", "anisotropic", "kept", "kept-times"]
    page = Page("quality-decoupled.md", "scripts/quality decoupled", blocks)
    for folder in WORK, IMAGES:
        folder.mkdir(parents=True, exist_ok=True)
    page.make({"suzanne": on_suzanne, "both": both_at_once, "hidden": hidden, "triangles": lambda: on_triangles(IMAGES),
               "transparency": lambda: on_transparent(IMAGES), "times": in_time, "adaptive": adaptive, "temporal": lambda: over_frames(IMAGES)})


if __name__ == "__main__":
    main()
