"""Makes docs/quality-decoupled.md and its pictures; started by scripts/quality-decoupled, which says what it needs."""
import json

import numpy
from PIL import Image

from family import AFTERSHADE, CAPTURES, ROOT, command, psnr_db, read_exr, srgb
from hidden import NEIGHBOURS, rendered
from rates import on_triangles
from transparency import on_transparent

WORK = ROOT / "build/quality-decoupled"
IMAGES = ROOT / "docs/images/decoupled"
TEXTS = ROOT / "scripts/decoupled"
RGB = ["R", "G", "B"]
FRAME, SAMPLES = 4, 128
LENS = {"focus_distance": 6.4, "focal_length": 50, "f_number": 0.25, "sensor_width": 36, "lens_model": "pinhole", "blades": 6}
NO_LENS = {"focal_length": 1, "f_number": 1000}
DOF, BLUR = {"effect": "dof"}, {"effect": "motion_blur"}
COUNTS = [8, 16, 32, 64, 256]
BOTH = {"toys": (100, 60, 240, 150), "leaves": (120, 100, 240, 150)}  # x, y, w, h


def decoupled(**params):
    return {"effect": "decoupled", "params": params}


def through(steps, capture, frames=FRAME):
    """The picture of the steps, and their telemetry."""
    look, out, telemetry = WORK / "look.json", WORK / "out_####.exr", WORK / "out_####.json"
    look.write_text(json.dumps({"aftershade": 1, "steps": steps}))
    command([AFTERSHADE, "run", look, capture, "--frames", frames, "-o", out, "--telemetry", telemetry, "--overwrite", "--pixel-type", "float",
             "--compression", "none", "--progress", "none", "--backend", "software", "--no-journal"])
    last = int(str(frames).split("-")[-1])
    numbered = lambda path: path.parent / path.name.replace("####", f"{last:04}")
    return read_exr(numbered(out), RGB), json.loads(numbered(telemetry).read_text())


def changed_pixels(sharp, truth):
    """docs/measures.md: where the mean over the 18 x 18 window x-8..x+9 of the mean difference as sRGB is above 0.02."""
    difference = numpy.abs(srgb(truth) - srgb(sharp)).mean(axis=-1)
    sums = numpy.pad(numpy.pad(difference, ((8, 9), (8, 9)), mode="edge").cumsum(0).cumsum(1), ((1, 0), (1, 0)))
    return (sums[18:, 18:] - sums[:-18, 18:] - sums[18:, :-18] + sums[:-18, :-18]) / 18**2 > 0.02


def table(head, rows):
    return "\n".join("| " + " | ".join(map(str, row)) + " |" for row in [head, ["---"] * len(head), *rows])


def save(name, tiles, scale=1):
    tiles = [numpy.pad(t, ((0, 4), (0, 4), (0, 0)), constant_values=1) for t in tiles]
    strip = numpy.concatenate([numpy.concatenate(tiles[i:i + 2], axis=1) for i in range(0, len(tiles), 2)])[:-4, :-4]
    pixels = Image.fromarray(numpy.round(255 * srgb(strip)).astype(numpy.uint8))
    pixels.resize((scale * pixels.width, scale * pixels.height), Image.NEAREST).save(IMAGES / f"{name}.jpg", quality=86)


def on_suzanne():
    folder = CAPTURES / "suzanne"
    capture = WORK / "suzanne.json"
    capture.write_text(json.dumps({"aftershade": 1, "frames": str((folder / "large/gbuffer_####.exr").resolve()), "range": "3-5", "fps": 24,
                                   "profile": "blender"}))
    sharp = read_exr(folder / f"large/gbuffer_{FRAME:04}.exr", [f"ViewLayer.Combined.{c}" for c in RGB])
    lens, shutter = read_exr(folder / "truth/dof_0004.exr", RGB), read_exr(folder / "truth/motion_0004.exr", RGB)
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
    return table(["", "lens, dB", "shutter, dB", "shutter, changed pixels, dB"], rows)


def both_at_once():
    rows, pictures = [], []
    for name, (x, y, w, h) in BOTH.items():
        folder, truth_folder = WORK / name, WORK / f"{name}_truth"
        if not (truth_folder / f"truth_lens_shutter_{FRAME:04}.exr").exists():
            command([AFTERSHADE, "render", ROOT / "scenes" / name, "-o", folder, "--frames", "3-5", "--quiet"])
            command([AFTERSHADE, "render", ROOT / "scenes" / name, "-o", truth_folder, "--frames", FRAME, "--samples", SAMPLES, "--quiet",
                     "--truth", "lens", "--truth", "shutter", "--truth", "lens+shutter"])
        lens, shutter, truth = (read_exr(truth_folder / f"truth_{kind}_{FRAME:04}.exr", RGB) for kind in ("lens", "shutter", "lens_shutter"))
        meet = changed_pixels(lens, truth) & changed_pixels(shutter, truth)
        if not (WORK / f"{name}_4_layers/capture.json").exists():
            command([AFTERSHADE, "render", ROOT / "scenes" / name, "-o", WORK / f"{name}_4_layers", "--frames", "3-5", "--quiet", "--layers", 4])
        crops = []
        for kind in "1 layer", "4 layers":
            capture = (folder if kind == "1 layer" else WORK / f"{name}_4_layers") / "capture.json"
            for label, steps in {"`dof`, then `motion_blur`": [DOF, BLUR], "`motion_blur`, then `dof`": [BLUR, DOF],
                                 "`decoupled`, 64 samples": [decoupled()], "`decoupled`, 256 samples": [decoupled(samples=256)]}.items():
                picture, told = through(steps, capture)
                shares = told["steps"].get("decoupled", {})
                percent = lambda key: f"{100 * shares[key]['mean']:.1f}" if shares else ""
                at_both = f"{psnr_db(truth, picture, meet):.2f}" if meet.any() else ""
                rows.append([f"`{name}`, {kind}", label, f"{psnr_db(truth, picture):.2f}", at_both, percent("estimated"), percent("holes")])
                print(*rows[-1], flush=True)
                crops.append(picture[y:y + h, x:x + w])
        save(name, [crops[0], crops[1], crops[2], truth[y:y + h, x:x + w]], 2)
        pictures.append(f"`{name}`: `dof` then `motion_blur`, `motion_blur` then `dof`, `decoupled`, lens and shutter.\n\n"
                        f"![{name}](images/decoupled/{name}.jpg)")
    return table(["scene", "", "all pixels, dB", "where both meet, dB", "estimated, %", "holes, %"], rows), pictures


def kinds_of(name):
    """Captures of what near things hide, as scripts/quality-hidden makes them, and the truth of each."""
    return {kind: (capture.parent, read_exr(truth, RGB)) for kind, (capture, _, truth) in rendered(name).items() if kind != NEIGHBOURS}


def hidden():
    rows = []
    steps = [[decoupled(shutter_angle=0)], [decoupled(samples=256, shutter_angle=0)]]
    for name in "fence", "leaves":
        for kind, (folder, truth) in kinds_of(name).items():
            db = [psnr_db(truth, through(step, folder / "capture.json")[0]) for step in steps]
            rows.append([f"`{name}`, {kind}", *(f"{v:.2f}" for v in db)])
            print(*rows[-1], flush=True)
    return table(["", "`decoupled`, 64 samples", "256 samples"], rows)


def main():
    for folder in WORK, IMAGES:
        folder.mkdir(parents=True, exist_ok=True)
    text = lambda name: (TEXTS / f"{name}.md").read_text().strip()
    suzanne = on_suzanne()
    scenes, pictures = both_at_once()
    parts = [text("head"), "## A renderer's frame", text("suzanne"), suzanne, "![suzanne](images/decoupled/suzanne.jpg)",
             "## Lens and shutter at once", text("both"), scenes, *pictures, "## Hidden surfaces", text("hidden"), hidden(), *on_triangles(table, text, IMAGES),
             *on_transparent(table, text, IMAGES), text("faults")]
    (ROOT / "docs/quality-decoupled.md").write_text("\n\n".join(parts) + "\n")
    print("docs/quality-decoupled.md")


main()
