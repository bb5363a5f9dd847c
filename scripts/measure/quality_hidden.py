"""How far the effects of the depth-of-field family are from the lens where thin near things hide what is behind: the figures and
pictures of docs/quality-hidden.md. Scenes are rendered once and kept in build/quality-hidden.

    AFTERSHADE=FILE            another executable, and no build
    AFTERSHADE_EFFECTS=A:B     further folders of effects, before this tree's own
"""
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import numpy
from PIL import Image

from measure import scenes
from measure.dof_family import Effect, effects, run_effect
from measure.exr import RGB, read_all, read_exr, write_exr
from measure.measures import LUMINANCE, Array, bytes_of, coc_px, near_band, psnr_db, srgb
from measure.pages import Blocks, Page, table
from measure.tree import AFTERSHADE, ROOT, Document, command

WORK = ROOT / "build/quality-hidden"
IMAGES = ROOT / "docs/images/hidden"
SAMPLES = 1024  # at 256, the noise of the truth of `fence` is 44 dB
SMOOTH = 0.03  # a step of the truth's sRGB luminance below this is no edge
CROPS = {"fence": (0, 60, 240, 135), "leaves": (120, 100, 240, 135)}  # x, y, w, h
SHOWN = ["dof_layered", "dof"]
FRAME, REACH = 4, 3  # the camera of both scenes moves sideways; frames before and after that effects read
MORE: dict[str, list[object]] = {"2 layers": ["--layers", 2], "4 layers": ["--layers", 4], "deep": ["--deep"]}
NEIGHBOURS = "one ray a pixel, neighbours"


def rendered(name: str) -> dict[str, tuple[Path, Path, Path]]:
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
    channels, _ = read_all(flat(folder))
    color = read_exr(truth("antialias"))
    write_exr(flat(mixed), channels | {c: color[..., i].astype(channels[c].dtype) for i, c in enumerate(RGB)})
    kinds = {"one ray a pixel": (folder / "capture.json", flat(folder), truth("lens")),
             "antialiased": (mixed / "capture.json", flat(mixed), truth("lens_antialias"))}
    for kind, words in {NEIGHBOURS: [], **MORE}.items():
        more = WORK / f"{name}_{f'neighbours_{REACH}' if kind == NEIGHBOURS else kind.replace(' ', '_')}"
        frames = f"{FRAME - REACH}-{FRAME + REACH}" if kind == NEIGHBOURS else FRAME
        if not (more / "capture.json").exists():
            command([AFTERSHADE, "render", ROOT / "scenes" / name, "-o", more, "--frames", frames, "--quiet", *words])
        # Deep samples are averaged over a pixel, as antialiased colour is.
        kinds[kind] = (more / "capture.json", flat(mixed if kind == "deep" else folder),
                       truth("lens_antialias" if kind == "deep" else "lens"))
    return kinds


def largest_step(picture: Array, truth: Array, band: Array) -> float:
    """Of luminance between neighbours inside the near blur, where the truth is smooth: its 99.9th percentile."""
    own, true, steps = srgb(picture) @ LUMINANCE, srgb(truth) @ LUMINANCE, []
    for axis in 0, 1:
        true_step = numpy.abs(numpy.diff(true, axis=axis))
        inside = numpy.take(band, range(true_step.shape[axis]), axis=axis)
        steps.append(numpy.abs(numpy.diff(own, axis=axis))[inside & (true_step < SMOOTH)])
    return float(numpy.percentile(numpy.concatenate(steps), 99.9))


def measured(name: str, family: list[Effect]) -> dict[str, Document]:
    scene = scenes.load(name)
    rows, pictures = {}, {}
    for kind, (capture, data, truth_file) in rendered(name).items():
        sharp, truth = read_exr(data), read_exr(truth_file)
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
    pixels = bytes_of(strip)
    Image.fromarray(pixels).resize((2 * pixels.shape[1], 2 * pixels.shape[0]), Image.NEAREST).save(IMAGES / f"{name}.jpg", quality=86)
    return rows


def best_in(row: Document, ids: list[str], index: int, digits: int, pick: Callable[[Iterable[float]], float]) -> Iterator[str]:
    """The cells of one row; the best effect's is bold."""
    best = pick(row[i][index] for i in ids if i in row)
    for name in ["sharp", *ids]:
        text = f"{row[name][index]:.{digits}f}" if name in row else ""
        yield f"**{text}**" if name in ids and name in row and row[name][index] == best else text


def tables() -> Blocks:
    family = [e for e in effects() if e.id != "bokeh_disk"]
    ids = [e.id for e in family]
    rows = [(f"`{name}`, {kind}", row) for name in CROPS for kind, row in measured(name, family).items()]
    head = ["", "sharp", *(f"`{i}`" for i in ids)]
    return {block: table(head, [[label, *best_in(row, ids, index, digits, pick)] for label, row in rows])
            for index, (block, digits, pick) in enumerate((("all", 2, max), ("near", 2, max), ("step", 1, min)))}


def main() -> None:
    page = Page("quality-hidden.md", "scripts/quality hidden", ["all", "near", "step"])
    for folder in WORK, IMAGES:
        folder.mkdir(parents=True, exist_ok=True)
    page.make({"scenes": tables})


if __name__ == "__main__":
    main()
