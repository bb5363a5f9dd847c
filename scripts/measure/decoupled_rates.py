"""The part of docs/quality-decoupled.md on `render --visibility`: rates, memory and pictures of the scenes' own triangles."""
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy
from PIL import Image

from measure.exr import read_exr
from measure.measures import Array, bytes_of, psnr_db
from measure.pages import Blocks, Rows, table
from measure.tree import AFTERSHADE, ROOT, command, read_json, write_json

WORK = ROOT / "build/quality-decoupled/visibility"
FRAMES = {"bats": 6, "camera_checker": 6, "toys": 4}
COUNTS = [8, 27, 64]
TRUTH_SAMPLES = 512
MB = 1e6


class Rendered:
    """One picture by `render --visibility`, with its report."""

    def __init__(self, scene: Path, frame: int, kind: str, samples: int, *words: object) -> None:
        folder = WORK / "picture"
        told = json.loads(command([AFTERSHADE, "render", scene, "-o", folder, "--frames", frame, "--truth-only", "--quiet", "--json",
                                   "--visibility", kind, "--visibility-samples", samples, *words]))["visibility"][0]
        self.rate, self.bytes = told["shading_rate"], told["bytes"]
        self.hits, self.misses = told["hits"], told["misses"]
        self.color = read_exr(folder / f"{kind}_{frame:04}.exr")
        self.heat = numpy.asarray(Image.open(folder / f"{kind}_rate_{frame:04}.png"))

    @property
    def of_covered(self) -> str:
        return f"{self.rate['of_covered_pixels']:.2f}"


def memoised(name: str, samples: int, *words: object) -> Rendered:
    return Rendered(ROOT / "scenes" / name, FRAMES[name], "memoised", samples, *words)


def truth(name: str) -> Array:
    """Of the CPU renderer's own shapes, with samples that no picture here has."""
    folder = WORK / f"{name}_truth"
    file = folder / f"truth_lens_shutter_antialias_{FRAMES[name]:04}.exr"
    if not file.exists():
        command([AFTERSHADE, "render", ROOT / "scenes" / name, "-o", folder, "--frames", FRAMES[name], "--truth-only", "--quiet", "--seed", 7,
                 "--truth", "lens+shutter+antialias", "--truth-method", "interleaved", "--samples", TRUTH_SAMPLES])
    return read_exr(file)


def shading_rates() -> str:
    rows = []
    for name in FRAMES:
        for count in COUNTS:
            whole = memoised(name, count)
            tiles = [memoised(name, count, "--shading-cache", "tile", "--shading-tile", tile).of_covered for tile in (16, 32)]
            published = memoised(name, count, "--shading-grid", "picture").of_covered
            memory = (whole.bytes["visibility"] + whole.bytes["shading"]) / MB
            rows.append([f"`{name}`", count, whole.of_covered, *tiles, published, f"{whole.rate['multisampled']:.2f}", count, f"{whole.rate['p95']:.1f}",
                         f"{memory:.0f}", f"{whole.bytes['supersampled'] / MB:.0f}"])
            print(*rows[-1], flush=True)
    return table(["scene", "samples", "global", "tiles of 16 px", "32 px", "global, grid of the picture", "MSAA", "supersampling", "global, p95 of the pixels",
                  "memory, MB", "supersampling, MB"], rows)


def variant(name: str, label: str, f_number: float, angle: float) -> Path:
    """The scene with another lens and shutter."""
    scene = read_json(ROOT / f"scenes/{name}/scene.json")
    scene["camera"]["f_number"] = f_number
    scene["shutter"]["angle"] = angle
    for mesh in scene.get("meshes", {}).values():
        mesh["file"] = str((ROOT / "scenes" / name / mesh["file"]).resolve())
    return write_json(WORK / f"{name}_{label}.json", scene)


def over_blur() -> str:
    rows = []
    for label, (f_number, angle) in {"none": (1000, 0), "the scene's": (0.5, 180), "lens x2": (0.25, 180), "lens x4": (0.125, 180),
                                     "lens x8": (0.0625, 180), "shutter x2": (0.5, 360), "lens x4, shutter x2": (0.125, 360)}.items():
        path = variant("bats", label.replace(" ", "_").replace(",", "").replace("'", ""), f_number, angle)
        rates = [Rendered(path, 6, "memoised", 27, *words).of_covered for words in ((), ("--shading-cache", "tile"))]
        rows.append([label, *rates])
        print(*rows[-1], flush=True)
    return table(["blur", "global", "tiles of 16 px"], rows)


def finite_caches() -> str:
    rows = []
    for name in "bats", "toys":
        for kind in "lru", "fifo":
            rates = [memoised(name, 64, "--shading-cache", kind, "--cache-entries", size).of_covered for size in (64, 256, 1024, 4096, 16384)]
            rows.append([f"`{name}`", kind.upper(), *rates])
            print(*rows[-1], flush=True)
    return table(["scene", "", "64 entries", "256", "1024", "4096", "16384"], rows)


def pictures() -> tuple[str, dict[Any, tuple[Rendered, ...]]]:
    """Both shading grids and the rivals against the truth, and against light at the same samples."""
    rows: Rows = []
    shown: dict[Any, tuple[Rendered, ...]] = {}
    for name in FRAMES:
        expected = truth(name)
        for count in COUNTS:
            plain = Rendered(ROOT / "scenes" / name, FRAMES[name], "supersampled", count)
            stacked = Rendered(ROOT / "scenes" / name, FRAMES[name], "accumulation", count)
            even, coarse = memoised(name, count), memoised(name, count, "--anisotropic-shading")
            fine = memoised(name, count, "--shading-rate", 2)
            lower = 100 * (1 - coarse.misses / even.misses)
            rows.append([f"`{name}`", count, *(f"{psnr_db(expected, p.color):.2f}" for p in (stacked, plain, even, fine, coarse)),
                         f"{psnr_db(plain.color, even.color):.1f}", even.of_covered, fine.of_covered, coarse.of_covered, f"{lower:.0f}"])
            print(*rows[-1], flush=True)
            shown[name, count] = (stacked, even, plain)
            if count == 64:
                shown[name] = (even, coarse)
    return table(["scene", "samples", "accumulation, dB", "supersampling, dB", "decoupled, dB", "shading rate 2, dB", "anisotropic, dB",
                  "decoupled against supersampling, dB",
                  "rate", "at shading rate 2", "anisotropic", "lower by, %"], rows), shown


def strip(rows: Sequence[Sequence[Array]]) -> Image.Image:
    """Rows of 8-bit tiles, 4 px of white between them."""
    padded = [numpy.concatenate([numpy.pad(t, ((0, 4), (0, 4), (0, 0)), constant_values=255) for t in row], axis=1) for row in rows]
    return Image.fromarray(numpy.concatenate(padded)[:-4, :-4])


def save_pictures(shown: dict[Any, tuple[Rendered, ...]], images: Path) -> None:
    crop = lambda rendered, x, y, w, h: bytes_of(rendered.color[y:y + h, x:x + w])
    grown = lambda tile: tile.repeat(2, axis=0).repeat(2, axis=1)
    strip([[grown(crop(p, 80, 120, 150, 90)) for p in shown["toys", count]] for count in COUNTS]).save(images / "figure_3_6.jpg", quality=88)
    even, coarse = shown["toys"]
    strip([[crop(even, 0, 0, 480, 270), even.heat], [crop(coarse, 0, 0, 480, 270), coarse.heat]]).save(images / "rates.png")
    bats = shown["bats"][0]
    strip([[crop(bats, 0, 0, 480, 270), bats.heat]]).save(images / "rates_bats.png")


def on_triangles(images: Path) -> Blocks:
    WORK.mkdir(parents=True, exist_ok=True)
    blocks = {"rates": shading_rates(), "blur": over_blur(), "caches": finite_caches()}
    blocks["pictures"], shown = pictures()
    save_pictures(shown, images)
    return blocks
