"""Makes docs/quality-dof.md and its pictures; started by scripts/quality-dof, which says what it needs."""
import json
import os
import shutil

import numpy
from PIL import Image

import scenes
from bands import near_band
from family import (CAPTURES, FAMILY, ROOT, coc_px, command, effects, iou, polygon_coverage, psnr_db, read_exr, run_effect, srgb)

WORK = ROOT / "build/quality-dof"
IMAGES = ROOT / "docs/images/dof"
# Measured once, outside this script, and cited.
CITED = [("Blender's Defocus node at f-stops tried by hand, cited", "20.3 to 21.1"), ("30 depth layers by FFT in double precision, cited", "30.2")]
SUZANNE = {"focus_distance": 6.4, "focal_length": 50, "f_number": 0.25, "sensor_width": 36, "lens_model": "pinhole"}
UNSEEN = (slice(0, 20), slice(0, 60))  # rows, columns that a bulb beyond the frame's edge lights in the lens' picture
CROPS = {"bulbs": (560, 40, 240, 150), "head": (300, 150, 240, 150)}  # x, y, w, h


# ---- measures ----

def leakage(sharp, truth, picture):
    """Each is (as it is, with what is in focus glowing). The share of the glow that an effect puts where the truth has none of
    it, out of all that the sharp picture has."""
    glow = [(pair[1].astype(numpy.float64) - pair[0]).sum(axis=-1) for pair in (sharp, truth, picture)]
    none = numpy.abs(glow[1]) < 1e-4 * sum(scenes.GLOW)
    return float(numpy.abs(glow[2][none]).sum() / numpy.abs(glow[0]).sum())


def lamp_shape(sharp_lamp, radius, blades, near, picture, window):
    """IoU of a lamp's picture with the lamp's own pixels spread by the polygon, both cut at half their plateau, and its energy
    over the lamp's own."""
    size = 2 * int(numpy.ceil(radius)) + 5
    spread = numpy.zeros(numpy.array(sharp_lamp.shape) + size - 1)
    kernel = polygon_coverage(blades, radius, near, size)
    for y, x in numpy.argwhere(sharp_lamp > 0):
        spread[y:y + size, x:x + size] += kernel * sharp_lamp[y, x]
    expected = spread[size // 2:-(size // 2), size // 2:-(size // 2)][window]
    got = picture[window]
    middle = expected >= 0.999 * expected.max()
    shape = iou(expected >= 0.5 * expected.max(), got >= 0.5 * numpy.median(got[middle]))
    return shape, float(got.sum() / sharp_lamp.sum())


# ---- sections ----

def suzanne(family):
    capture = CAPTURES / "suzanne/large/gbuffer_0004.exr"
    sharp = read_exr(capture, [f"ViewLayer.Combined.{c}" for c in "RGB"])
    truth = read_exr(CAPTURES / "suzanne/truth/dof_0004.exr", ["R", "G", "B"])
    pictures = {"sharp": sharp}
    for effect in family:
        pictures[effect.id] = run_effect(effect.id, capture, WORK / f"suzanne-{effect.id}.exr",
                                         SUZANNE | effect.closest_to_hexagon(), WORK)
    seen = numpy.ones(truth.shape[:2], dtype=bool)
    seen[UNSEEN] = False
    measure = lambda picture: (psnr_db(truth, picture), psnr_db(truth, picture, seen))
    values = {name: measure(picture) for name, picture in pictures.items()}
    if shutil.which("blender"):
        defocused = WORK / "suzanne-blender.exr"
        if not defocused.exists():
            command(["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python", ROOT / "tests/bench/dof_blender.py",
                     "--", capture, defocused, 960, 540, os.cpu_count()])
        values["Blender's Defocus node at the f-stop that gives the lens's radii"] = measure(read_exr(defocused, ["R", "G", "B"]))
    pictures["truth"] = truth
    for crop, (x, y, w, h) in CROPS.items():
        for name, picture in pictures.items():
            save(picture[y:y + h, x:x + w], f"suzanne_{crop}_{name}")
    three(pictures["sharp"], pictures.get("dof", truth), truth)
    return values, list(pictures)


def three(*pictures):
    """The strip at the head of docs/depth-of-field.md, at half size."""
    x, y, w, h = 330, 30, 630, 400
    small = [p[y:y + h, x:x + w].reshape(h // 2, 2, w // 2, 2, 3).mean(axis=(1, 3)) for p in pictures]
    gap = numpy.full((h // 2, 7, 3), 1.0)
    save(numpy.concatenate([small[0], gap, small[1], gap, small[2]], axis=1), "three")


def save(linear, name, exposure=1.6):
    pixels = numpy.round(255 * srgb(exposure * linear)).astype(numpy.uint8)
    Image.fromarray(pixels).save(IMAGES / f"{name}.jpg", quality=88)


def one_scene(name, scene, frame, focused, family):
    capture, truth_file = scenes.rendered(name, scene, frame, WORK)
    sharp, truth = scenes.picture(capture), scenes.picture(truth_file)
    coc = coc_px(read_exr(capture, ["Z"]), *scenes.lens_of(scene), sharp.shape[1])
    band = near_band(coc)
    assert not focused or (numpy.abs(coc) < 0.5).any(), f"{name}: nothing is in focus"
    shown = {"sharp": sharp}
    twin_files = scenes.rendered(name + "_glowing", scenes.glowing(scene, focused), frame, WORK) if focused else None
    twins = [scenes.picture(file) for file in twin_files] if focused else None
    result = {"band_percent": 100 * band.mean(), "near_px": -coc.min(), "far_px": coc.max(), "effects": {}}
    for effect in [None, *family]:
        label = effect.id if effect else "sharp"
        if effect:
            params = effect.closest_to_hexagon()
            shown[label] = run_effect(label, capture, WORK / "out.exr", params, WORK)
        values = {"all": psnr_db(truth, shown[label]), "band": psnr_db(truth, shown[label], band)}
        if focused and effect:
            glowing = run_effect(label, twin_files[0], WORK / "out.exr", params, WORK)
            values["leak"] = 100 * leakage((sharp, twins[0]), (truth, twins[1]), (shown[label], glowing))
        result["effects"][label] = values
    shown["truth"] = truth
    tiles = [shown[n] for n in shown]
    half = [t.reshape(135, 2, 240, 2, 3).mean(axis=(1, 3)) for t in tiles]
    half += [numpy.ones_like(half[0])] * (-len(half) % min(len(half), 4))  # rows of four
    padded = [numpy.pad(t, ((0, 4), (0, 4), (0, 0)), constant_values=1) for t in half]
    rows = [numpy.concatenate(padded[i:i + 4], axis=1) for i in range(0, len(padded), 4)]
    save(numpy.concatenate(rows)[:-4, :-4], f"scene_{name}", 0.9)
    result["shown"] = list(shown)
    return result


def shapes(family):
    """{(effect, blades, side): (IoU of the worst lamp, its energy)}; effects that have no such aperture are left out."""
    found = {}
    whole = dict((n, s) for n, s, *_ in scenes.all_scenes())["point_grid"]
    for side in "near", "far":
        scene = dict(whole, objects=[o for o in whole["objects"] if o["name"] == side])
        for blades in 3, 5, 7:
            scene["camera"] = dict(scene["camera"], blades=blades)
            capture, truth_file = scenes.rendered(f"points_{side}", scene, 1, WORK, samples=1024)
            sharp, depth = scenes.picture(capture).sum(axis=-1), read_exr(capture, ["Z"])
            coc = coc_px(depth, *scenes.lens_of(scene), sharp.shape[1])
            pictures = {"truth": scenes.picture(truth_file)}
            for effect in family:
                params = effect.with_blades(blades)
                if params is not None:
                    pictures[effect.id] = run_effect(effect.id, capture, WORK / "out.exr", params, WORK)
            for name, picture in pictures.items():
                found[name, blades, side] = worst_lamp(sharp, coc, blades, side == "near", picture.sum(axis=-1))
    return found


def worst_lamp(sharp, coc, blades, near, picture):
    worst = (2.0, 0.0)
    left = sharp > 0
    while left.any():
        y, x = numpy.argwhere(left)[0]
        around = (slice(max(y - 3, 0), y + 12), slice(max(x - 8, 0), x + 9))  # a lamp is at most 8 px wide
        lamp = numpy.zeros_like(sharp)
        lamp[around] = numpy.where(left[around], sharp[around], 0)
        left[around] = False
        radius = float(numpy.abs(coc[lamp > 0]).mean())
        reach = int(radius) + 10
        window = (slice(max(y - reach, 0), y + reach + 4), slice(max(x - reach, 0), x + reach))
        if window[0].stop > sharp.shape[0] or window[1].stop > sharp.shape[1]:
            continue
        worst = min(worst, lamp_shape(lamp, radius, blades, near, picture, window))
    return worst


# ---- the document ----

def table(head, rows):
    return "\n".join("| " + " | ".join(row) + " |" for row in [head, ["---"] * len(head), *rows])


def cell(value, digits=2, best=None):
    if value is None or value != value:
        return "n/a"
    text = f"{value:.{digits}f}"
    return f"**{text}**" if best is not None and text == f"{best:.{digits}f}" else text


def document(family, on_suzanne, shown, on_scenes, bokeh_shapes):
    ids = [e.id for e in family]
    names = lambda name: f"`{name}`" if name in ids else name
    parts = [(ROOT / "scripts/dof/quality-head.md").read_text()]
    best = [max(on_suzanne[i][k] for i in ids) for k in (0, 1)]
    parts.append("## A renderer's frame\n\n" + (ROOT / "scripts/dof/quality-suzanne.md").read_text() + "\n" + table(
        ["", "PSNR, dB", "without that corner, dB"],
        [[names(n), *(cell(v, best=b) for v, b in zip(pair, best))] for n, pair in on_suzanne.items()] + [[*row, ""] for row in CITED]))
    for crop in CROPS:
        cells = [f"![{n}](images/dof/suzanne_{crop}_{n}.jpg)<br>{names(n)}" for n in shown]
        rows = [cells[i:i + 3] for i in range(0, len(cells), 3)]
        rows[-1] += [""] * (3 - len(rows[-1]))
        parts.append(table(rows[0], rows[1:]))
    parts.append("## Scenes\n\n" + (ROOT / "scripts/dof/quality-scenes.md").read_text())
    for measure, title, digits, pick in (("all", "PSNR of all pixels, dB", 2, max), ("band", "PSNR around near silhouettes, dB", 2, max),
                                         ("leak", "Leakage, % of the focused light", 3, min)):
        columns = (["sharp"] if measure != "leak" else []) + ids
        rows = []
        for name, result in on_scenes.items():
            values = [result["effects"][c].get(measure) for c in columns]
            known = [v for v, c in zip(values, columns) if v is not None and v == v and c != "sharp"]
            rows.append([f"`{name}`"] + [cell(v, digits, pick(known) if known and len(ids) > 1 else None) for v in values])
        parts.append(f"**{title}**\n\n" + table(["scene", *map(names, columns)], rows))
    for name, result in on_scenes.items():
        order = ", ".join(names(n) for n in result["shown"])
        parts.append(f"`{name}`: {result['for']}; CoC {result['near_px']:.0f} px near, {result['far_px']:.0f} px far, band "
                     f"{result['band_percent']:.0f} % of the frame. Row by row: {order}.\n\n![{name}](images/dof/scene_{name}.jpg)")
    parts.append("## Bokeh shape\n\n" + (ROOT / "scripts/dof/quality-shape.md").read_text() + "\n" + table(
        ["", *(f"{b} blades {s}" for s in ("near", "far") for b in (3, 5, 7))],
        [[names(n) if n != "truth" else "the renderer's lens, 1024 samples"] + [
            "n/a" if (n, b, s) not in bokeh_shapes else "%.3f, %.2f" % bokeh_shapes[n, b, s]
            for s in ("near", "far") for b in (3, 5, 7)] for n in [*ids, "truth"]]))
    cost = ROOT / "scripts/dof/cost-table.md"  # of scripts/bench-dof
    if cost.exists():
        parts.append("## Cost\n\n" + (ROOT / "scripts/dof/quality-cost.md").read_text() + "\n" + cost.read_text())
        parts.append(table(["over radius", "over the part out of focus"],
                           [[f"![{n}](images/dof/{n}.svg)" for n in ("cost_radius", "cost_fraction")]]))
    parts.append((ROOT / "scripts/dof/quality-faults.md").read_text())
    return "\n\n".join(p.strip() for p in parts) + "\n"


def main():
    WORK.mkdir(parents=True, exist_ok=True)
    IMAGES.mkdir(parents=True, exist_ok=True)
    family = effects()
    print("effects:", ", ".join(e.id for e in family), "| not here:",
          ", ".join(n for n in FAMILY if n not in [e.id for e in family]) or "none")
    on_suzanne, shown = suzanne(family)
    for name, pair in on_suzanne.items():
        print("suzanne         %-14s %6.2f dB, %6.2f without the corner" % (name, *pair))
    on_scenes = {}
    for name, scene, frame, focused, what in scenes.all_scenes():
        on_scenes[name] = one_scene(name, scene, frame, focused, family) | {"for": what}
        for label, v in on_scenes[name]["effects"].items():
            leak = f"{v['leak']:.3f} % leaks" if "leak" in v else ""
            print(f"{name:15} {label:14} {v['all']:6.2f} dB, {v['band']:6.2f} dB around near silhouettes {leak}", flush=True)
    bokeh_shapes = shapes(family)
    for (name, blades, side), (shape, energy) in bokeh_shapes.items():
        print(f"shape           {name:14} {blades} blades {side:4} IoU {shape:.3f} energy {energy:.3f}")
    (ROOT / "docs/quality-dof.md").write_text(document(family, on_suzanne, shown, on_scenes, bokeh_shapes))
    (WORK / "figures.json").write_text(json.dumps({"suzanne": on_suzanne, "scenes": on_scenes}, indent=1, default=float))
    print("docs/quality-dof.md")


main()
