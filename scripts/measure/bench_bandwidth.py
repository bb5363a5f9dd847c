"""What the samples of subsurface scattering fetch, replayed through models of the caches of two GPUs (tests/bench/cache_model.h): the
figures of docs/bandwidth.md. Every fetch of the sampling passes is recorded on software GL by a copy of their shaders. About eight
minutes.

    SIZE=1920x1080
"""
import json
import os
import subprocess
from pathlib import Path

from measure.pages import Page, Rows, table
from measure.plots import pyplot, save_plot
from measure.sss_sequences import scene_profile
from measure.traced_shaders import traced_copy
from measure.tree import AFTERSHADE, ROOT, Document, command

BENCH = ROOT / "build/release/tests/bench/fetch_bench"
WORK, IMAGES = ROOT / "build/bandwidth", ROOT / "docs/images/speed"
SCENE, SIZE = "skin_front", os.environ.get("SIZE", "1920x1080")
ROLES = ["irradiance", "depth", "object_id", "normal", "color"]
BYTES = {"r8": 1, "r32f": 4, "rg32f": 8, "rg32ui": 8, "rgba32f": 16, "rgba32ui": 16}
SETTLED = 25  # frames, of what has a history
LEVELS = {"prefilter": True}
FIXED = {"min_samples": 64, "max_samples": 64, "distant_share": 0}
# Name, effect, shader, where it is traced by the preprocessor, parameters, frames before.
WAYS: list[tuple[str, str, list[tuple[str, str]], Document, int]] = [
    ("fixed, 64 samples", "sss_burley", [("gather.frag", "1")], {"samples": 64}, 1),
    ("fixed, 64 samples, mip levels", "sss_adaptive", [("scatter.frag", "1")], FIXED | LEVELS, 3),
    ("adaptive, 8 to 64", "sss_adaptive", [("scatter.frag", "1")], {}, SETTLED),
    ("adaptive, 8 to 64, mip levels", "sss_adaptive", [("scatter.frag", "1")], LEVELS, SETTLED),
    ("separable, 25 taps twice", "sss_separable", [("blur.frag", "ALONG_ROWS"), ("blur.frag", "!ALONG_ROWS")], {}, 1),
]
SHORT = ["fixed", "fixed,\nmips", "adaptive", "adaptive,\nmips", "separable"]


def bytes_of(name: str, effect: str) -> int:
    """A texel's; what the capture gives is float, as it is uploaded."""
    for file in ROOT / "effects" / effect / "effect.json", ROOT / "glsl/scattering/module.json":
        texture = json.loads(file.read_text()).get("textures", {}).get(name.removesuffix("_prev"))
        if texture:
            return BYTES[texture["format"]]
    return {"irradiance": 16, "normal": 16, "SOURCE": 16, "velocity": 8}.get(name, 4)


def capture() -> Path:
    folder = WORK / f"{SCENE}_{SIZE}"
    if not (folder / "capture.json").exists():
        command([AFTERSHADE, "render", ROOT / "scenes" / SCENE, "-o", folder, "--size", SIZE, "--frames", "1", "--quiet"])
    return folder / "gbuffer_####.exr"


def replayed(effect: str, shader: str, where: str, params: Document, settled: int) -> list[Document]:
    folder = WORK / "shaders"
    names = traced_copy(effect, shader, folder, where)
    job = {"size": [int(n) for n in SIZE.split("x")], "data": str(folder), "effects": str(folder / "effects"), "capture": str(capture()),
           "roles": ROLES, "role": "irradiance", "settled": settled, "records": 272,
           "textures": [{"name": n, "bytes": bytes_of(n, effect)} for n in names],
           "look": {"aftershade": 1, "steps": [{"effect": effect, "params": {"scattering_profile": scene_profile(SCENE), "object_ids": [1]} | params}]}}
    done = subprocess.run([BENCH], input=json.dumps(job), stdout=subprocess.PIPE, text=True, env=os.environ | {"AFTERSHADE_CACHE": "off"})
    if done.returncode:
        raise SystemExit(f"fetch_bench ended with {done.returncode}")
    return json.loads(done.stdout)["gpus"]


def groups_of(effect: str, shaders: list[tuple[str, str]], params: Document, settled: int) -> dict[str, list[Document]]:
    """By GPU, the groups of all traced passes."""
    by_gpu: dict[str, list[Document]] = {}
    for shader, where in shaders:
        for one in replayed(effect, shader, where, params, settled):
            by_gpu.setdefault(one["gpu"], []).extend(one["groups"])
    return by_gpu


def total(groups: list[Document], key: str) -> int:
    return sum(group[key] for group in groups)


def share(part: int, whole: int) -> str:
    return f"{100 * part / whole:.1f}" if whole else "0"


def row_of(groups: list[Document], pixels: int) -> list[str]:
    texels, sectors, hits = (total(groups, key) for key in ("texels", "sectors", "l1_hits"))
    reads, l2_hits, dram = (total(groups, key) for key in ("l2_reads", "l2_hits", "dram_bytes"))
    return [f"{texels / pixels:.1f}", f"{sectors / pixels:.2f}", share(sectors - hits, sectors), f"{32 * reads / pixels:.0f}",
            share(reads - l2_hits, reads), f"{dram / pixels:.1f}"]


def by_level(groups: list[Document], pixels: int) -> Rows:
    rows = []
    for level in sorted({g["level"] for g in groups if g["texture"] == "light"}):
        mine = [g for g in groups if g["texture"] == "light" and g["level"] == level]
        rows.append([level, *row_of(mine, pixels)])
    return rows


def draw(results: list[dict[str, list[Document]]], pixels: int) -> None:
    IMAGES.mkdir(parents=True, exist_ok=True)
    figure, axes = pyplot.subplots(1, 3, figsize=(11, 3.2), layout="constrained")
    measures = [("bytes read from L2, a pixel", lambda g: 32 * total(g, "l2_reads") / pixels),
                ("misses of L1, %", lambda g: 100 * total(g, "l2_reads") / total(g, "sectors")),
                ("misses of L2, %", lambda g: 100 * (1 - total(g, "l2_hits") / max(total(g, "l2_reads"), 1)))]
    for axis, (title, measure) in zip(axes, measures):
        for i, gpu in enumerate(results[0]):
            axis.bar([k + 0.4 * i - 0.2 for k in range(len(results))], [measure(r[gpu]) for r in results], 0.38, label=gpu)
        axis.set_title(title, fontsize=10)
        axis.set_xticks(range(len(results)), SHORT, fontsize=8)
    axes[0].legend(frameon=False, fontsize=8)
    save_plot(figure, IMAGES / "bandwidth.svg")


def main() -> None:
    page = Page("bandwidth.md", "scripts/bench bandwidth", ["tables", "size"])
    WORK.mkdir(parents=True, exist_ok=True)
    width, height = (int(n) for n in SIZE.split("x"))
    results = []
    for name, effect, shaders, params, settled in WAYS:
        results.append(groups_of(effect, shaders, params, settled))
        print(name, {gpu: row_of(groups, width * height) for gpu, groups in results[-1].items()}, flush=True)
    head = ["", "fetches a pixel", "reads of L1", "missed, %", "bytes from L2", "missed, %", "bytes from DRAM"]
    parts = []
    for gpu in results[0]:
        parts += [f"**{gpu}**", "", table(head, [[way[0], *row_of(r[gpu], width * height)] for way, r in zip(WAYS, results)]), ""]
    for i in (1, 3):
        for gpu in results[0]:
            parts += [f"Levels of `light`, {WAYS[i][0]}, {gpu}:", "", table(["level", *head[1:]], by_level(results[i][gpu], width * height)), ""]
    draw(results, width * height)
    page.fill({"tables": "\n".join(parts).rstrip(), "size": SIZE.replace("x", " x ")})


if __name__ == "__main__":
    main()
