"""Makes docs/quality-sss.md and its pictures; started by scripts/quality-sss, which says what it needs."""
import json

import matplotlib
import numpy
from PIL import Image

matplotlib.use("svg")
from matplotlib import pyplot

from family import AFTERSHADE, CAPTURES, ROOT, command, read_exr, srgb
from point_light import found_light
from techniques import EXACT, psnr_db, present, scale_of, scatter

WORK = ROOT / "build/quality-sss"
IMAGES = ROOT / "docs/images/sss"
TEXTS = ROOT / "scripts/sss"
RGB = "RGB"
# Of Cycles' head: subsurface radius (1.0, 0.4, 0.25) m; Cycles' mean free path is the radius * 0.25 / pi.
HEAD_PROFILE = {"type": "burley", "albedo": [0.8, 0.5, 0.4], "mean_free_path_mm": [79.577, 31.831, 19.894], "mapping": "diffuse"}
# The same with albedo 0.8 in all channels.
HEAD_PROFILE_08 = HEAD_PROFILE | {"albedo": 0.8}
VIEWS = {"skin_patch": ("close patch", 37.46), "skin_ear": ("ear", 40.28), "skin_front": ("front", 42.95)}
VIEW_PROFILE = {"type": "burley", "d_mm": [0.4445, 0.0987, 0.0595]}
COUNTS = [4, 8, 16, 32, 64, 128, 256, 512, 1024]


def table(heads, rows):
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]) + "\n"


def file_name(label):
    return label.replace(", ", "_").replace(" ", "_")


def save_strip(path, pictures, scale, crop, columns=None):
    x, y, w, h = crop
    cut = [(srgb(p[y:y + h, x:x + w] * scale * 1.2) * 255 + 0.5).astype(numpy.uint8) for p in pictures]
    columns = columns or len(cut)
    cut += [numpy.zeros_like(cut[0])] * (-len(cut) % columns)
    rows = [numpy.concatenate(cut[i:i + columns], axis=1) for i in range(0, len(cut), columns)]
    Image.fromarray(numpy.concatenate(rows, axis=0)).save(path, quality=88)


# ---- closed forms ----

def edge_response(x_over_d):
    """Light at x from a straight edge of light: of what Burley's profile sends to distance r, 2 / pi * asin(x / r) lies within x."""
    edges = numpy.linspace(0, 8, 8001) ** 2
    share = numpy.diff(1 - numpy.exp(-edges) / 4 - 0.75 * numpy.exp(-edges / 3))
    radii = 0.5 * (edges[1:] + edges[:-1])
    within = [(share * 2 / numpy.pi * numpy.arcsin(numpy.minimum(1, abs(x) / radii))).sum() for x in x_over_d]
    return 0.5 + 0.5 * numpy.sign(x_over_d) * numpy.array(within)


def modulation(w_d):
    return 0.25 / numpy.sqrt(1 + w_d**2) + 0.75 / numpy.sqrt(1 + 9 * w_d**2)


def rendered(scene, *options):
    folder = WORK / scene
    if not (folder / "gbuffer_0001.exr").exists():
        command([AFTERSHADE, "render", ROOT / "scenes" / scene, "-o", folder, "--frames", 1, "--quiet", *options])
    return folder / "capture.json"


def on_closed_forms():
    """Of a row of plane_edge and plane_cosine: largest distance from the edge response within 60 px, and of the amplitude."""
    edge, cosine = rendered("plane_edge"), rendered("plane_cosine")
    edge_d_mm, rows = [120, 90, 60], []
    cosine_scene = json.loads("\n".join(l for l in (ROOT / "scenes/plane_cosine/scene.json").read_text().splitlines()
                                        if not l.lstrip().startswith("//")))
    cosine_d_mm = cosine_scene["materials"]["wax"]["scattering_profile"]["d_mm"]
    pattern = cosine_scene["lights"][0]["pattern"]
    period_m = float(pattern["period"].split()[0]) / 1000
    for technique in present():
        if technique[1] == "sss_exact" and technique != EXACT:
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
        before = read_exr(WORK / "plane_cosine/gbuffer_0001.exr", [f"irradiance.{c}" for c in RGB])
        for c in range(3):
            w_d = 2 * numpy.pi * cosine_d_mm[c] / 1000 / period_m
            wave = lambda p: (p[middle, 120:360, c].mean(axis=0) - p[middle, 120:360, c].mean()).std()
            row.append(f"{abs(wave(light) / wave(before) - modulation(w_d)):.4f} (w d {w_d:.2f})")
        rows.append([f"`{technique[0]}`", *row])
        print(rows[-1], flush=True)
    return rows


# ---- Cycles' head ----

def head_capture(file, light, where):
    """With the light that sss_preintegrated must know: the file does not say, so it is found from the picture."""
    vector = lambda kind: read_exr(file, [f"ViewLayer.{kind}.{c}" for c in "XYZ"]).astype(numpy.float64)[where]
    position_m, intensity, _ = found_light(light[where], vector("Position"), vector("Normal"))
    print("Cycles' light at", position_m, "m, W/sr", intensity, flush=True)
    document = WORK / "head.json"
    document.write_text(json.dumps({
        "aftershade": 1, "frames": str((file.parent / "gbuffer_####.exr").resolve()), "range": "1", "profile": "blender",
        "lights": [{"type": "point", "name": "found", "position": list(position_m), "intensity": list(intensity)}]}))
    return document


def on_head():
    file = CAPTURES / "head/gbuffer_0001.exr"
    names = lambda kind: [f"ViewLayer.{kind}.{c}" for c in RGB]
    light = lambda file: sum(read_exr(file, names(kind)).astype(numpy.float64) for kind in ("DiffDir", "DiffInd"))
    truth_file = CAPTURES / "head/truth_sss_0001.exr"
    # The truth has the albedo twice.
    truth = light(truth_file) * read_exr(truth_file, names("DiffCol")) / numpy.maximum(read_exr(file, names("DiffCol")), 1e-9)
    before = light(file)
    where = numpy.round(read_exr(file, ["ViewLayer.IndexOB.X"])) == 1
    capture = head_capture(file, before, where)
    scale = scale_of(before, where)
    made = {t[0]: scatter(capture, WORK / f"head_{file_name(t[0])}.exr", t, HEAD_PROFILE, {"object_ids": [1]})
            for t in present()}
    wider = {t[0]: scatter(capture, WORK / f"head08_{file_name(t[0])}.exr", t, HEAD_PROFILE_08, {"object_ids": [1]})
             for t in present() if t[1] != "sss_exact" or "normalize" not in t[2]}
    rows = [["what came in", f"{psnr_db(truth, before, where, scale):.2f}", "", f"{psnr_db(made['sss_exact'], before, where, scale):.2f}"]]
    for label, picture in made.items():
        rows.append([f"`{label}`", f"{psnr_db(truth, picture, where, scale):.2f}",
                     f"{psnr_db(truth, wider[label], where, scale):.2f}" if label in wider else "",
                     "" if label == EXACT[0] else f"{psnr_db(made[EXACT[0]], picture, where, scale):.2f}"])
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
        errors.append(psnr_db(made[EXACT[0]], picture, where, scale))
    rmse = 10 ** (-numpy.array(errors) / 20)
    figure, axes = pyplot.subplots(figsize=(5.4, 3.2))
    axes.loglog(COUNTS, rmse, marker="o", markersize=3, label="sss_burley against sss_exact")
    axes.loglog(COUNTS, rmse[0] * (numpy.array(COUNTS) / COUNTS[0]) ** -0.5, linestyle="--", linewidth=1, label="N^-0.5")
    axes.set(xlabel="samples", ylabel="RMSE of luminance")
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(IMAGES / "convergence.svg", metadata={"Date": None})
    slope = numpy.polyfit(numpy.log(COUNTS), numpy.log(rmse), 1)[0]
    counts = [[n, f"{e:.2f}"] for n, e in zip(COUNTS, errors)]
    return rows, counts, slope


# ---- the three views ----

def on_views():
    results = {}
    for scene, (view, published) in VIEWS.items():
        capture = rendered(scene)
        file = WORK / scene / "gbuffer_0001.exr"
        before = read_exr(file, [f"irradiance.{c}" for c in RGB]).astype(numpy.float64)
        where = read_exr(file, ["object_id.I"]) == 1
        scale = scale_of(before, where)
        made = {t[0]: scatter(capture, WORK / f"{scene}_{file_name(t[0])}.exr", t, VIEW_PROFILE, {"object_ids": [1]})
                for t in present() if t[1] != "sss_exact" or t == EXACT}
        results[scene] = {label: psnr_db(made[EXACT[0]], p, where, scale) for label, p in made.items()} | {
            "what came in": psnr_db(made[EXACT[0]], before, where, scale)}
        print(scene, results[scene], flush=True)
        shown = [before, made[EXACT[0]]] + [made[n] for n in ("sss_burley, 64 samples", "sss_separable, preintegrated") if n in made]
        save_strip(IMAGES / f"{scene}.jpg", shown, scale, (100, 20, 280, 230))
    labels = ["what came in"] + [l for l in results["skin_ear"] if l not in (EXACT[0], "what came in")]
    rows = [[f"`{l}`" if l.startswith("sss") else l, *(f"{results[s][l]:.2f}" for s in VIEWS)] for l in labels]
    rows.append(["separable, as Xie 2020 has it on other models", *(f"{p:.2f}" for _, p in VIEWS.values())])
    return rows


def main():
    for folder in WORK, IMAGES:
        folder.mkdir(parents=True, exist_ok=True)
    parts = [(TEXTS / "quality-head.md").read_text()]
    rows = on_closed_forms()
    parts.append((TEXTS / "quality-closed.md").read_text() + "\n" +
                 table(["", "edge, d 16 px", "12 px", "8 px", "cosine, red", "green", "blue"], rows))
    rows, counts, slope = on_head()
    parts.append((TEXTS / "quality-cycles.md").read_text() + "\n" +
                 table(["", "Cycles, dB", "Cycles, d of albedo 0.8, dB", "`sss_exact`, dB"], rows))
    parts.append((TEXTS / "quality-convergence.md").read_text().replace("SLOPE", f"{slope:.2f}") + "\n" +
                 table(["samples", "`sss_exact`, dB"], counts))
    parts.append((TEXTS / "quality-views.md").read_text() + "\n" +
                 table(["", *(f"`{s}`: {v}" for s, (v, _) in VIEWS.items())], on_views()))
    cost = TEXTS / "cost-table.md"
    parts.append((TEXTS / "quality-cost.md").read_text() + "\n" + (cost.read_text() if cost.exists() else ""))
    (ROOT / "docs/quality-sss.md").write_text("\n".join(parts))


if __name__ == "__main__":
    main()
