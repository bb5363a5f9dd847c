"""How far each technique of subsurface scattering is from closed forms, from the exact sum and from a path tracer: the figures and
pictures of docs/quality-sss.md; those of its section Cost come from `scripts/bench sss`. Scenes and exact sums are made once and kept
in build/quality-sss. About 20 minutes, most of them sums.

    PARTS="closed head views"  these alone; the others stay as they are
    AFTERSHADE=FILE            another executable, and no build
    AFTERSHADE_CAPTURES=DIR    where head lies (docs/measures.md)
"""
from collections.abc import Sequence
from pathlib import Path

import numpy
from PIL import Image

from measure.exr import read_exr, read_rgb64
from measure.measures import Array, bytes_of, edge_response, luminance_psnr_db, modulation, scale_of
from measure.pages import Blocks, Page, table
from measure.plots import pyplot, save_plot
from measure.sss_light import found_light
from measure.sss_techniques import HEAD_PROFILE, REFERENCE, WORK, cycles_head, cycles_light, incoming, present, scatter, scattering
from measure.tree import AFTERSHADE, CAPTURES, ROOT, command, read_json, write_json

IMAGES = ROOT / "docs/images/sss"
# The same with albedo 0.8 in all channels.
HEAD_PROFILE_08 = HEAD_PROFILE | {"albedo": 0.8}
VIEWS = {"skin_patch": ("close patch", 37.46), "skin_ear": ("ear", 40.28), "skin_front": ("front", 42.95)}
VIEW_PROFILE = {"type": "burley", "d_mm": [0.4445, 0.0987, 0.0595]}
COUNTS = [4, 8, 16, 32, 64, 128, 256, 512, 1024]


def file_name(label: str) -> str:
    return label.replace(", ", "_").replace(" ", "_")


def save_strip(path: Path, pictures: Sequence[Array], scale: float, crop: tuple[int, int, int, int], columns: int | None = None) -> None:
    x, y, w, h = crop
    cut = [bytes_of(p[y:y + h, x:x + w] * scale * 1.2) for p in pictures]
    columns = columns or len(cut)
    cut += [numpy.zeros_like(cut[0])] * (-len(cut) % columns)
    rows = [numpy.concatenate(cut[i:i + columns], axis=1) for i in range(0, len(cut), columns)]
    Image.fromarray(numpy.concatenate(rows, axis=0)).save(path, quality=88)


# ---- closed forms ----

def rendered(scene: str, *options: object) -> Path:
    folder = WORK / scene
    if not (folder / "gbuffer_0001.exr").exists():
        command([AFTERSHADE, "render", ROOT / "scenes" / scene, "-o", folder, "--frames", 1, "--quiet", *options])
    return folder / "capture.json"


def on_closed_forms() -> Blocks:
    """Of a row of plane_edge and plane_cosine: largest distance from the edge response within 60 px, and of the amplitude."""
    edge, cosine = rendered("plane_edge"), rendered("plane_cosine")
    edge_d_mm, rows = [120, 90, 60], []
    cosine_scene = read_json(ROOT / "scenes/plane_cosine/scene.json")
    cosine_d_mm = cosine_scene["materials"]["wax"]["scattering_profile"]["d_mm"]
    pattern = cosine_scene["lights"][0]["pattern"]
    period_m = float(pattern["period"].split()[0]) / 1000
    for technique in present():
        if technique[1] == "sss_exact" and technique != REFERENCE:
            continue
        name = file_name(technique[0])
        lit = scatter(edge, WORK / f"edge_{name}.exr", technique, {"type": "burley", "d_mm": edge_d_mm})
        position = read_exr(WORK / "plane_edge/gbuffer_0001.exr", ["position.X"])
        middle = slice(lit.shape[0] // 2 - 16, lit.shape[0] // 2 + 16)
        near = numpy.abs(numpy.arange(lit.shape[1]) + 0.5 - lit.shape[1] / 2) < 60
        row = []
        for c in range(3):
            expected = edge_response(position[middle].mean(axis=0) * 1000 / edge_d_mm[c])
            row.append(f"{numpy.abs(lit[middle, :, c].mean(axis=0) - expected)[near].max():.4f}")
        light = scatter(cosine, WORK / f"cosine_{name}.exr", technique, {"type": "burley", "d_mm": cosine_d_mm})
        before = incoming(WORK / "plane_cosine/gbuffer_0001.exr")
        for c in range(3):
            w_d = 2 * numpy.pi * cosine_d_mm[c] / 1000 / period_m
            wave = lambda p: (p[middle, 120:360, c].mean(axis=0) - p[middle, 120:360, c].mean()).std()
            row.append(f"{abs(wave(light) / wave(before) - modulation(w_d)):.4f} (w d {w_d:.2f})")
        rows.append([f"`{technique[0]}`", *row])
        print(rows[-1], flush=True)
    return {"closed": table(["", "edge, d 16 px", "12 px", "8 px", "cosine, red", "green", "blue"], rows)}


# ---- Cycles' head ----

def head_capture(file: Path, light: Array, where: Array) -> Path:
    """With the light that sss_preintegrated must know: the file does not say, so it is found from the picture."""
    vector = lambda kind: read_exr(file, [f"ViewLayer.{kind}.{c}" for c in "XYZ"]).astype(numpy.float64)[where]
    position_m, intensity, _ = found_light(light[where], vector("Position"), vector("Normal"))
    print("Cycles' light at", position_m, "m, W/sr", intensity, flush=True)
    return write_json(WORK / "head.json", {
        "aftershade": 1, "frames": str((file.parent / "gbuffer_####.exr").resolve()), "range": "1", "profile": "blender",
        "lights": [{"type": "point", "name": "found", "position": list(position_m), "intensity": list(intensity)}]})


def on_head() -> Blocks:
    file = CAPTURES / "head/gbuffer_0001.exr"
    truth_file = CAPTURES / "head/truth_sss_0001.exr"
    # The truth has the albedo twice.
    color = "ViewLayer.DiffCol"
    truth = cycles_light(truth_file) * read_rgb64(truth_file, color) / numpy.maximum(read_rgb64(file, color), 1e-9)
    before, where = cycles_light(file), cycles_head(file)
    capture = head_capture(file, before, where)
    scale = scale_of(before, where)
    made = {t[0]: scatter(capture, WORK / f"head_{file_name(t[0])}.exr", t, HEAD_PROFILE, {"object_ids": [1]})
            for t in present()}
    wider = {t[0]: scatter(capture, WORK / f"head08_{file_name(t[0])}.exr", t, HEAD_PROFILE_08, {"object_ids": [1]})
             for t in present() if t[1] != "sss_exact" or "normalize" not in t[2]}
    rows = [["what came in", f"{luminance_psnr_db(truth, before, where, scale):.2f}", "", f"{luminance_psnr_db(made['sss_exact'], before, where, scale):.2f}"]]
    for label, picture in made.items():
        rows.append([f"`{label}`", f"{luminance_psnr_db(truth, picture, where, scale):.2f}",
                     f"{luminance_psnr_db(truth, wider[label], where, scale):.2f}" if label in wider else "",
                     "" if label == REFERENCE[0] else f"{luminance_psnr_db(made[REFERENCE[0]], picture, where, scale):.2f}"])
        print(rows[-1], flush=True)
    dark = numpy.where(where[..., None], 1.0, 0.0)
    shown = [before, truth, wider["sss_exact, axes"]] + [made[n] for n in (
        "sss_exact", "sss_exact, axes", "sss_burley, 64 samples", "sss_separable, preintegrated", "sss_separable, artist", "sss_gaussian", "sss_preintegrated")
        if n in made]
    save_strip(IMAGES / "head.jpg", [p * dark for p in shown], scale, (60, 60, 370, 250), 3)
    errors = []
    for count in COUNTS:
        technique = (f"sss_burley, {count}", "sss_burley", {"samples": count})
        picture = scatter(capture, WORK / f"head_count_{count}.exr", technique, HEAD_PROFILE, {"object_ids": [1]})
        errors.append(luminance_psnr_db(made[REFERENCE[0]], picture, where, scale))
    rmse = 10 ** (-numpy.array(errors) / 20)
    figure, axes = pyplot.subplots(figsize=(5.4, 3.2))
    axes.loglog(COUNTS, rmse, marker="o", markersize=3, label="sss_burley against sss_exact")
    axes.loglog(COUNTS, rmse[0] * (numpy.array(COUNTS) / COUNTS[0]) ** -0.5, linestyle="--", linewidth=1, label="N^-0.5")
    axes.set(xlabel="samples", ylabel="RMSE of luminance")
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
    save_plot(figure, IMAGES / "convergence.svg")
    slope = numpy.polyfit(numpy.log(COUNTS), numpy.log(rmse), 1)[0]
    counts = [[n, f"{e:.2f}"] for n, e in zip(COUNTS, errors)]
    return {"cycles": table(["", "Cycles, dB", "Cycles, d of albedo 0.8, dB", "`sss_exact`, dB"], rows), "slope": f"{slope:.2f}",
            "samples": table(["samples", "`sss_exact`, dB"], counts)}


# ---- the three views ----

def on_views() -> Blocks:
    results = {}
    for scene in VIEWS:
        capture = rendered(scene)
        file = WORK / scene / "gbuffer_0001.exr"
        before, where = incoming(file), scattering(file)
        scale = scale_of(before, where)
        made = {t[0]: scatter(capture, WORK / f"{scene}_{file_name(t[0])}.exr", t, VIEW_PROFILE, {"object_ids": [1]})
                for t in present() if t[1] != "sss_exact" or t == REFERENCE}
        results[scene] = {label: luminance_psnr_db(made[REFERENCE[0]], p, where, scale) for label, p in made.items()} | {
            "what came in": luminance_psnr_db(made[REFERENCE[0]], before, where, scale)}
        print(scene, results[scene], flush=True)
        shown = [before, made[REFERENCE[0]]] + [made[n] for n in ("sss_burley, 64 samples", "sss_separable, preintegrated") if n in made]
        save_strip(IMAGES / f"{scene}.jpg", shown, scale, (100, 20, 280, 230))
    labels = ["what came in"] + [l for l in results["skin_ear"] if l not in (REFERENCE[0], "what came in")]
    rows = [[f"`{l}`" if l.startswith("sss") else l, *(f"{results[s][l]:.2f}" for s in VIEWS)] for l in labels]
    rows.append(["separable, as Xie 2020 has it on other models", *(f"{p:.2f}" for _, p in VIEWS.values())])
    return {"views": table(["", *(f"`{s}`: {v}" for s, (v, _) in VIEWS.items())], rows)}


def main() -> None:
    page = Page("quality-sss.md", "scripts/quality sss", ["closed", "cycles", "slope", "samples", "views"])
    for folder in WORK, IMAGES:
        folder.mkdir(parents=True, exist_ok=True)
    page.make({"closed": on_closed_forms, "head": on_head, "views": on_views})


if __name__ == "__main__":
    main()
