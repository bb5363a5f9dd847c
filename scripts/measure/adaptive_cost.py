"""Cost at equal quality: sss_adaptive beside sss_burley with 64 samples; part of `scripts/quality sss-adaptive`."""
import os
from pathlib import Path
from typing import Any

import OpenEXR

from measure.measures import Array, luminance_psnr_db, scale_of
from measure.pages import Rows
from measure.sss_sequences import run, scene_profile, still
from measure.sss_techniques import WORK, Technique, incoming, scatter, scattering
from measure.tree import AFTERSHADE, ROOT, Document, command

SCENE, SIZE = "skin_front", os.environ.get("SIZE", "1920x1080")
READ = {"R", "G", "B", "A", "irradiance", "Z", "object_id", "velocity"}
FRAMES, SETTLED = 32, 24  # times are the least of the frames after SETTLED
COLUMNS = {"setup": ["scatters", "scattering_tiles", "surface", "unscattered"],
           "blurs": ["kernel", "settings", "tile_state", "stale_rows", "stale_row_tiles", "stale_columns", "stale_column_tiles",
                     "rows_before", "rows", "blurred_before", "columns"],
           "sampling": ["scatter", "gather"]}
FIXED = ("`sss_burley`, 64 samples", "sss_burley", {"samples": 64})
LONG = {"guiding_weight": 0.05}
FEW = LONG | {"min_samples": 2, "target_variance": 0.05}
WAYS: list[Technique] = [FIXED, ("adaptive", "sss_adaptive", LONG), ("adaptive, `min_samples` 2, `target_variance` 0.05", "sss_adaptive", FEW)]


def passes_of(told: Any, effect: str) -> dict[str, float]:
    times: dict[str, list[float]] = {}
    for frame in told[SETTLED:]:
        for name, ms in frame["passes_ms"].items():
            if name.startswith(effect + "."):
                times.setdefault(name.split(".")[1], []).append(ms)
    return {name: min(ms) for name, ms in times.items()}


def uncompressed(file: Path) -> Path:
    """The channels that the effects read, uncompressed: to inflate all of the next frame while one is drawn takes one of two cores."""
    with OpenEXR.File(str(file), separate_channels=True) as source:
        part = source.parts[0]
        channels = {name: part.channels[name].pixels for name in part.channels if name.split(".")[0] in READ}
        plain = file.parent / "uncompressed" / "gbuffer_0001.exr"
        plain.parent.mkdir(exist_ok=True)
        OpenEXR.File(part.header | {"compression": OpenEXR.NO_COMPRESSION}, channels).write(str(plain))
    return plain


def cost() -> Rows:
    folder = WORK / f"{SCENE}_{SIZE}"
    if not (folder / "capture.json").exists():
        command([AFTERSHADE, "render", ROOT / "scenes" / SCENE, "-o", folder, "--size", SIZE, "--frames", "1", "--quiet"])
    file, profile = folder / "gbuffer_0001.exr", scene_profile(SCENE)
    sequence = still(uncompressed(file), "native", FRAMES)
    where = scattering(file)
    scale = scale_of(incoming(file), where)
    reference = scatter(sequence, WORK / f"{SCENE}_{SIZE}_ref.exr", ("", "sss_burley", {"samples": 4096}), profile, {"object_ids": [1]}, ["--frames", "1"])
    rows, fixed = [], None
    for label, effect, params in WAYS:
        # The pictures of 32 frames of this size would not fit into memory: the last alone.
        last, told = settled(label, effect, params, sequence, profile)
        times = passes_of(told, effect)
        sums = {column: sum(times.get(name, 0) for name in names) for column, names in COLUMNS.items()}
        total = sum(sums.values())
        fixed = fixed or total
        statistic = told[-1]["steps"].get("sss_adaptive", {}).get("samples")
        rows.append([label, f"{statistic['mean']:.1f}" if statistic else "64", f"{luminance_psnr_db(reference, last, where, scale):.2f}",
                     *[f"{ms:.0f}" for ms in sums.values()], f"{total:.0f}", f"{fixed / total:.2f}"])
        print("cost", rows[-1], flush=True)
    return rows


def settled(label: str, effect: str, params: Document, sequence: Path, profile: Document) -> tuple[Array, Any]:
    frames = FRAMES if effect == "sss_adaptive" else SETTLED + 4
    result = run("cost", sequence, profile, params, frames, effect, (), telemetry=True, keep=[frames])
    return result["irradiance"][-1], result["telemetry"]
