"""Makes docs/quality-hidden.md and its pictures; started by scripts/quality-hidden, which says what it needs."""
import json

import numpy
import OpenEXR
from PIL import Image

import scenes
from bands import near_band
from family import AFTERSHADE, ROOT, coc_px, command, effects, psnr_db, read_exr, run_effect, srgb, write_exr

WORK = ROOT / "build/quality-hidden"
IMAGES = ROOT / "docs/images/hidden"
SAMPLES = 1024  # at 256, the noise of the truth of `fence` is 44 dB
SMOOTH = 0.03  # a step of the truth's sRGB luminance below this is no edge
CROPS = {"fence": (0, 60, 240, 135), "leaves": (120, 100, 240, 135)}  # x, y, w, h
SHOWN = ["dof_layered", "dof"]
FRAME, REACH = 4, 3  # the camera of both scenes moves sideways; frames before and after that effects read
MORE = {"2 layers": ["--layers", 2], "4 layers": ["--layers", 4], "deep": ["--deep"]}
NEIGHBOURS = "one ray a pixel, neighbours"


def rendered(name):
    """By kind: capture, file of its flat picture, truth. One ray a pixel; the same with antialiased colour and one sample of depth
    a pixel; with what lies behind; with the frames beside."""
    folder = WORK / name
    truth = lambda kind: folder / f"truth_{kind}_{FRAME:04}.exr"
    flat = lambda path: path / f"gbuffer_{FRAME:04}.exr"
    if not truth("lens_antialias").exists():
        command([AFTERSHADE, "render", ROOT / "scenes" / name, "-o", folder, "--frames", FRAME, "--samples", SAMPLES, "--quiet",
                 "--truth", "lens", "--truth", "antialias", "--truth", "lens+antialias"])
    mixed = WORK / f"{name}_antialiased"
    mixed.mkdir(exist_ok=True)
    (mixed / "capture.json").write_text((folder / "capture.json").read_text())
    with OpenEXR.File(str(flat(folder)), separate_channels=True) as file:
        channels = {channel: file.channels()[channel].pixels for channel in file.channels()}
    color = read_exr(truth("antialias"), ["R", "G", "B"])
    write_exr(flat(mixed), channels | {c: color[..., i].astype(channels[c].dtype) for i, c in enumerate("RGB")})
    kinds = {"one ray a pixel": (folder / "capture.json", flat(folder), truth("lens")),
             "antialiased": (mixed / "capture.json", flat(mixed), truth("lens_antialias"))}
    for kind, words in ({NEIGHBOURS: []} | MORE).items():
        more = WORK / f"{name}_{f'neighbours_{REACH}' if kind == NEIGHBOURS else kind.replace(' ', '_')}"
        frames = f"{FRAME - REACH}-{FRAME + REACH}" if kind == NEIGHBOURS else FRAME
        if not (more / "capture.json").exists():
            command([AFTERSHADE, "render", ROOT / "scenes" / name, "-o", more, "--frames", frames, "--quiet", *words])
        # Deep samples are averaged over a pixel, as antialiased colour is.
        kinds[kind] = (more / "capture.json", flat(mixed if kind == "deep" else folder),
                       truth("lens_antialias" if kind == "deep" else "lens"))
    return kinds


def largest_step(picture, truth, band):
    """Of luminance between neighbours inside the near blur, where the truth is smooth: its 99.9th percentile."""
    luminance = lambda p: srgb(p) @ numpy.array([0.2126, 0.7152, 0.0722])
    own, true, steps = luminance(picture), luminance(truth), []
    for axis in 0, 1:
        true_step = numpy.abs(numpy.diff(true, axis=axis))
        inside = numpy.take(band, range(true_step.shape[axis]), axis=axis)
        steps.append(numpy.abs(numpy.diff(own, axis=axis))[inside & (true_step < SMOOTH)])
    return float(numpy.percentile(numpy.concatenate(steps), 99.9))


def measured(name, family):
    scene = scenes.load(ROOT / f"scenes/{name}/scene.json")
    rows, pictures = {}, {}
    for kind, (capture, data, truth_file) in rendered(name).items():
        sharp, truth = scenes.picture(data), scenes.picture(truth_file)
        band = near_band(coc_px(read_exr(data, ["Z"]), *scenes.lens_of(scene), sharp.shape[1]))
        shown = {"sharp": sharp}
        for effect in family:
            params = effect.closest_to_hexagon()
            if kind == NEIGHBOURS and "background" not in effect.params:
                continue
            if kind == NEIGHBOURS:
                params = params | {"background": "neighbours"}
            shown[effect.id] = run_effect(effect.id, capture, WORK / "out.exr", params, WORK, FRAME)
        true_step = largest_step(truth, truth, band)
        rows[kind] = {label: (psnr_db(truth, p), psnr_db(truth, p, band), largest_step(p, truth, band) / true_step)
                      for label, p in shown.items()}
        rows[kind]["band"] = 100 * band.mean()
        for label, values in rows[kind].items():
            print(f"{name:8} {kind:16} {label:14}", values, flush=True)
        pictures[kind] = shown | {"truth": truth}
    x, y, w, h = CROPS[name]
    shown = pictures["antialiased"]
    tiles = [shown[label][y:y + h, x:x + w] for label in ("sharp", *SHOWN, "truth") if label in shown]
    tiles = [numpy.pad(t, ((0, 4), (0, 4), (0, 0)), constant_values=1) for t in tiles]
    strip = numpy.concatenate([numpy.concatenate(tiles[i:i + 2], axis=1) for i in range(0, len(tiles), 2)])[:-4, :-4]
    pixels = numpy.round(255 * srgb(strip)).astype(numpy.uint8)
    Image.fromarray(pixels).resize((2 * pixels.shape[1], 2 * pixels.shape[0]), Image.NEAREST).save(IMAGES / f"{name}.jpg", quality=86)
    return rows


def document(results, ids):
    parts = [(ROOT / "scripts/dof/hidden-head.md").read_text().strip()]
    head = ["", *(f"`{i}`" if i != "sharp" else i for i in ["sharp", *ids])]
    for index, title, digits, pick in ((0, "PSNR of all pixels, dB", 2, max), (1, "PSNR around near silhouettes, dB", 2, max),
                                       (2, "Largest step inside the near blur, times the truth's", 1, min)):
        lines = ["| " + " | ".join(head) + " |", "| " + " | ".join(["---"] * len(head)) + " |"]
        for name, kinds in results.items():
            for kind, row in kinds.items():
                best = pick(row[i][index] for i in ids if i in row)
                cell = lambda i: "" if i not in row else f"{row[i][index]:.{digits}f}"
                cells = [f"**{cell(i)}**" if i in ids and i in row and row[i][index] == best else cell(i) for i in ["sharp", *ids]]
                lines.append(f"| `{name}`, {kind} | " + " | ".join(cells) + " |")
        parts.append(f"**{title}**\n\n" + "\n".join(lines))
    for name in results:
        parts.append(f"`{name}`, antialiased: sharp, `dof_layered`, `dof`, the lens.\n\n![{name}](images/hidden/{name}.jpg)")
    parts.append((ROOT / "scripts/dof/hidden-faults.md").read_text().strip())
    return "\n\n".join(parts) + "\n"


def main():
    for folder in WORK, IMAGES:
        folder.mkdir(parents=True, exist_ok=True)
    family = [e for e in effects() if e.id != "bokeh_disk"]
    results = {name: measured(name, family) for name in CROPS}
    (WORK / "figures.json").write_text(json.dumps(results, indent=1))
    (ROOT / "docs/quality-hidden.md").write_text(document(results, [e.id for e in family]))
    print("docs/quality-hidden.md")


if __name__ == "__main__":
    main()
