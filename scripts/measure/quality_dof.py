"""How far each effect of the depth-of-field family in effects/ is from the lens: the figures and pictures of docs/quality-dof.md.
Scenes are rendered once and kept in build/quality-dof. With blender installed, its Defocus node stands beside.

    PARTS="suzanne scenes edges shape"   these alone; the others stay as they are
    AFTERSHADE=FILE                another executable, and no build
    AFTERSHADE_CAPTURES=DIR        where suzanne lies (docs/measures.md)
    AFTERSHADE_EFFECTS=A:B         further folders of effects, before this tree's own
"""
import os
import shutil
from collections.abc import Sequence
from pathlib import Path

import numpy
from PIL import Image

from measure import scenes
from measure.dof_family import FAMILY, Effect, effects, run_effect
from measure.exr import RGB, read_exr
from measure.make_starter_capture import through_lens
from measure.measures import Array, bytes_of, coc_px, iou, near_band, polygon_coverage, psnr_db
from measure.pages import Blocks, Page, table
from measure.tree import CAPTURES, ROOT, Document, command

WORK = ROOT / "build/quality-dof"
IMAGES = ROOT / "docs/images/dof"
# Measured once, outside this script, and cited.
CITED = [("Blender's Defocus node at f-stops tried by hand, cited", "20.3 to 21.1"), ("30 depth layers by FFT in double precision, cited", "30.2")]
SUZANNE = {"focus_distance": 6.4, "focal_length": 50, "f_number": 0.25, "sensor_width": 36, "lens_model": "pinhole"}
UNSEEN = (slice(0, 20), slice(0, 60))  # rows, columns that a bulb beyond the frame's edge lights in the lens' picture
# Focus distance in m, f-number of the 50 mm lens: in front of all balls, on three of them, behind.
STARTER_LENSES = [(2.6, 0.5), (3.05, 0.25), (3.6, 0.5), (5.0, 0.25), (8.0, 0.5)]
STARTER_CROP = (slice(55, 120), slice(95, 215))
CROPS = {"bulbs": (560, 40, 240, 150), "head": (300, 150, 240, 150)}  # x, y, w, h


Pair = tuple[Array, Array]


# ---- measures ----

def leakage(sharp: Pair, truth: Pair, picture: Pair) -> float:
    """Each is (as it is, with what is in focus glowing). The share of the glow that an effect puts where the truth has none of
    it, out of all that the sharp picture has."""
    glow = [(pair[1].astype(numpy.float64) - pair[0]).sum(axis=-1) for pair in (sharp, truth, picture)]
    none = numpy.abs(glow[1]) < 1e-4 * sum(scenes.GLOW)
    return float(numpy.abs(glow[2][none]).sum() / numpy.abs(glow[0]).sum())


def lamp_shape(sharp_lamp: Array, radius: float, blades: int, near: bool, picture: Array, window: tuple[slice, slice]) -> tuple[float, float]:
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

def suzanne(family: list[Effect]) -> tuple[dict[str, tuple[float, float]], list[str]]:
    capture = CAPTURES / "suzanne/large/gbuffer_0004.exr"
    sharp = read_exr(capture, [f"ViewLayer.Combined.{c}" for c in RGB])
    truth = read_exr(CAPTURES / "suzanne/truth/dof_0004.exr")
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
        values["Blender's Defocus node at the f-stop that gives the lens's radii"] = measure(read_exr(defocused))
    pictures["truth"] = truth
    for crop, (x, y, w, h) in CROPS.items():
        for name, picture in pictures.items():
            save(picture[y:y + h, x:x + w], f"suzanne_{crop}_{name}")
    three(pictures["sharp"], pictures.get("dof", truth), truth)
    return values, list(pictures)


def three(*pictures: Array) -> None:
    """The strip at the head of docs/depth-of-field.md, at half size."""
    x, y, w, h = 330, 30, 630, 400
    small = [p[y:y + h, x:x + w].reshape(h // 2, 2, w // 2, 2, 3).mean(axis=(1, 3)) for p in pictures]
    gap = numpy.full((h // 2, 7, 3), 1.0)
    save(numpy.concatenate([small[0], gap, small[1], gap, small[2]], axis=1), "three")


def save(linear: Array, name: str, exposure: float = 1.6) -> None:
    Image.fromarray(bytes_of(exposure * linear)).save(IMAGES / f"{name}.jpg", quality=88)


def one_scene(name: str, scene: Document, frame: int, focused: list[str], family: list[Effect]) -> Document:
    capture, truth_file = scenes.rendered(name, scene, frame, WORK)
    sharp, truth = read_exr(capture), read_exr(truth_file)
    coc = coc_px(read_exr(capture, ["Z"]), *scenes.lens_of(scene), sharp.shape[1])
    band = near_band(coc)
    assert not focused or (numpy.abs(coc) < 0.5).any(), f"{name}: nothing is in focus"
    shown = {"sharp": sharp}
    twin_files: Sequence[Path] = scenes.rendered(name + "_glowing", scenes.glowing(scene, focused), frame, WORK) if focused else ()
    twins = [read_exr(file) for file in twin_files]
    result: Document = {"band_percent": 100 * band.mean(), "near_px": -coc.min(), "far_px": coc.max(), "effects": {}}
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


def antialiased(family: list[Effect]) -> dict[tuple[float, float], dict[str, float]]:
    """The shipped starter capture, whose colour is antialiased and whose depth is one sample, against the lens of its own tracer."""
    capture, found = ROOT / "scenes/starter/gbuffer_0001.exr", {}
    for focus_m, f_number in STARTER_LENSES:
        truth = through_lens(1, focus_m, 0.05 / f_number / 2, 1024)
        params = {"focus_distance": focus_m, "f_number": f_number, "focal_length": 50, "sensor_width": 36, "lens_model": "pinhole"}
        shown = {"sharp": read_exr(capture)}
        for effect in family:
            aperture = effect.with_blades(0) or effect.closest_to_hexagon()
            shown[effect.id] = run_effect(effect.id, capture, WORK / "out.exr", params | aperture, WORK)
        found[focus_m, f_number] = {name: psnr_db(truth, picture) for name, picture in shown.items()}
        if (focus_m, f_number) == STARTER_LENSES[1]:
            tiles = [picture[STARTER_CROP].repeat(4, 0).repeat(4, 1) for picture in (shown["sharp"], shown["bokeh_gather"], shown["dof"], truth)]
            tiles = [numpy.pad(tile, ((0, 4), (0, 4), (0, 0)), constant_values=1) for tile in tiles]
            save(numpy.concatenate([numpy.concatenate(tiles[:2], axis=1), numpy.concatenate(tiles[2:], axis=1)])[:-4, :-4], "antialiased", 1)
    return found


def shapes(family: list[Effect]) -> dict[tuple[str, int, str], tuple[float, float]]:
    """{(effect, blades, side): (IoU of the worst lamp, its energy)}; effects that have no such aperture are left out."""
    found = {}
    whole = dict((n, s) for n, s, *_ in scenes.all_scenes())["point_grid"]
    for side in "near", "far":
        scene = dict(whole, objects=[o for o in whole["objects"] if o["name"] == side])
        for blades in 3, 5, 7:
            scene["camera"] = dict(scene["camera"], blades=blades)
            capture, truth_file = scenes.rendered(f"points_{side}", scene, 1, WORK, samples=1024)
            sharp, depth = read_exr(capture).sum(axis=-1), read_exr(capture, ["Z"])
            coc = coc_px(depth, *scenes.lens_of(scene), sharp.shape[1])
            pictures = {"truth": read_exr(truth_file)}
            for effect in family:
                params = effect.with_blades(blades)
                if params is not None:
                    pictures[effect.id] = run_effect(effect.id, capture, WORK / "out.exr", params, WORK)
            for name, picture in pictures.items():
                found[name, blades, side] = worst_lamp(sharp, coc, blades, side == "near", picture.sum(axis=-1))
    return found


def worst_lamp(sharp: Array, coc: Array, blades: int, near: bool, picture: Array) -> tuple[float, float]:
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


# ---- the page ----

def cell(value: float | None, digits: int = 2, best: float | None = None) -> str:
    if value is None or value != value:
        return "n/a"
    text = f"{value:.{digits}f}"
    return f"**{text}**" if best is not None and text == f"{best:.{digits}f}" else text


def named(name: str) -> str:
    return f"`{name}`" if name in FAMILY else name


def on_suzanne() -> Blocks:
    values, shown = suzanne(effects())
    for name, pair in values.items():
        print("suzanne         %-14s %6.2f dB, %6.2f without the corner" % (name, *pair))
    best = [max(pair[k] for name, pair in values.items() if name in FAMILY) for k in (0, 1)]
    rows = [[named(name), *(cell(v, best=b) for v, b in zip(pair, best))] for name, pair in values.items()]
    crops = []
    for crop in CROPS:
        cells = [f"![{n}](images/dof/suzanne_{crop}_{n}.jpg)<br>{named(n)}" for n in shown]
        lines = [cells[i:i + 3] for i in range(0, len(cells), 3)]
        lines[-1] += [""] * (3 - len(lines[-1]))
        crops.append(table(lines[0], lines[1:]))
    return {"suzanne": table(["", "PSNR, dB", "without that corner, dB"], rows + [[*row, ""] for row in CITED]), "crops": "\n\n".join(crops)}


def on_scenes() -> Blocks:
    family = effects()
    ids, results, blocks = [e.id for e in family], {}, {}
    for name, scene, frame, focused, what in scenes.all_scenes():
        results[name] = one_scene(name, scene, frame, focused, family) | {"for": what}
        for label, v in results[name]["effects"].items():
            leak = f"{v['leak']:.3f} % leaks" if "leak" in v else ""
            print(f"{name:15} {label:14} {v['all']:6.2f} dB, {v['band']:6.2f} dB around near silhouettes {leak}", flush=True)
    for measure, digits, pick in ("all", 2, max), ("band", 2, max), ("leak", 3, min):
        columns = (["sharp"] if measure != "leak" else []) + ids
        rows = []
        for name, result in results.items():
            values = [result["effects"][c].get(measure) for c in columns]
            known = [v for v, c in zip(values, columns) if v is not None and v == v and c != "sharp"]
            rows.append([f"`{name}`"] + [cell(v, digits, pick(known) if known and len(ids) > 1 else None) for v in values])
        blocks[measure] = table(["scene", *map(named, columns)], rows)
    blocks["pictures"] = "\n\n".join(
        f"`{name}`: {result['for']}; CoC {result['near_px']:.0f} px near, {result['far_px']:.0f} px far, band {result['band_percent']:.0f} % of "
        f"the frame. Row by row: {', '.join(map(named, result['shown']))}.\n\n![{name}](images/dof/scene_{name}.jpg)" for name, result in results.items())
    return blocks


def on_edges() -> Blocks:
    found = antialiased(effects())
    names = list(next(iter(found.values())))
    rows = []
    for (focus_m, f_number), values in found.items():
        print(f"starter {focus_m} m f/{f_number}", ", ".join(f"{name} {value:.2f}" for name, value in values.items()), flush=True)
        rows.append([f"{focus_m:g} m, f/{f_number:g}", *(cell(values[name], best=max(values.values())) for name in names)])
    return {"edges": table(["focus", *map(named, names)], rows)}


def on_shapes() -> Blocks:
    found = shapes(effects())
    for (name, blades, side), (shape, energy) in found.items():
        print(f"shape           {name:14} {blades} blades {side:4} IoU {shape:.3f} energy {energy:.3f}")
    columns = [(blades, side) for side in ("near", "far") for blades in (3, 5, 7)]
    rows = [[named(name) if name != "truth" else "the renderer's lens, 1024 samples",
             *("%.3f, %.2f" % found[name, *column] if (name, *column) in found else "n/a" for column in columns)]
            for name in [*(e.id for e in effects()), "truth"]]
    return {"shape": table(["", *(f"{blades} blades {side}" for blades, side in columns)], rows)}


def main() -> None:
    page = Page("quality-dof.md", "scripts/quality dof", ["suzanne", "crops", "all", "band", "leak", "pictures", "edges", "shape"])
    for folder in WORK, IMAGES:
        folder.mkdir(parents=True, exist_ok=True)
    page.make({"suzanne": on_suzanne, "scenes": on_scenes, "edges": on_edges, "shape": on_shapes})


if __name__ == "__main__":
    main()
