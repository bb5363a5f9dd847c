"""sss_adaptive under light that changes, and its samples as --telemetry has them; part of `scripts/quality sss-adaptive`."""
from pathlib import Path
from typing import Any

import numpy

from measure.measures import Array, luminance_psnr_db, scale_of
from measure.pages import Rows
from measure.plots import pyplot, save_plot
from measure.sss_sequences import run, scene_capture, scene_profile
from measure.sss_techniques import WORK
from measure.tree import Document

ABSOLUTE = {"guiding": False, "target": "absolute", "target_variance": 0.001}
WAYS = {variate: ABSOLUTE | {"control_variate": variate} for variate in ("none", "constant", "online")} | {"guiding": {}}
FRAMES = 24
# Frames with other light than the one before.
CHANGES = {"light_toggle": [9, 17], "light_flash": [7, 8, 13, 14, 19, 20]}
COMBINE = [{"effect": "sss_combine"}]
AFTER = {"step": COMBINE, "taa": COMBINE + [{"effect": "taa"}]}


def reference_of(scene: str, capture: Path, profile: Document) -> Array:
    file = WORK / f"{scene}_reference.npy"
    if not file.exists():
        numpy.save(file, run(f"{scene}_reference", capture, profile, {"samples": 1024}, FRAMES, "sss_burley", (), COMBINE, "color")["color"])
    return numpy.load(file)


def under_changing_light(scene: str, images: Path) -> Rows:
    """Per variate: telemetry of each frame, and PSNR of each frame of the step alone and through taa."""
    capture, profile = scene_capture(scene, f"1-{FRAMES}"), scene_profile(scene)
    reference = reference_of(scene, capture, profile)
    told, db = {}, {}
    for variate, params in WAYS.items():
        for chain, after in AFTER.items():
            result = run(f"{scene}_{variate}", capture, profile, params, FRAMES,
                         taps=("history",), after=after, roles="color", telemetry=True)
            where = result["history"][0][..., 3] > 0
            scale = scale_of(reference[1], where)
            db[variate, chain] = [luminance_psnr_db(reference[i], result["color"][i], where, scale) for i in range(FRAMES)]
        told[variate] = result["telemetry"]
    plot(scene, told, db, images)
    return rows_of(scene, told, db)


def samples_of(told: Any) -> list[float]:
    return [frame["steps"]["sss_adaptive"]["samples"]["mean"] for frame in told]


def sampling_ms(told: Any) -> list[float]:
    return [frame["passes_ms"]["sss_adaptive.scatter"] for frame in told]


def rows_of(scene: str, told: Any, db: dict[tuple[str, str], list[float]]) -> Rows:
    rows = []
    for variate in WAYS:
        means, ms = samples_of(told[variate]), sampling_ms(told[variate])
        row = [variate, f"{max(means[6:]):.1f}", f"{numpy.mean(means[6:]):.1f}", f"{numpy.median(ms[10:]):.0f}"]
        for chain in AFTER:
            for offset in (0, 1):
                loss = [db["none", chain][c - 1 + offset] - db[variate, chain][c - 1 + offset] for c in CHANGES[scene]]
                row.append("" if variate == "none" else f"{max(loss):.1f}")
        rows.append(row)
        print(scene, row, flush=True)
    for variate in ("none", "guiding"):
        for chain in AFTER:
            print(scene, variate, chain, " ".join(f"{v:.1f}" for v in db[variate, chain]), flush=True)
    return rows


def plot(scene: str, told: Any, db: dict[tuple[str, str], list[float]], images: Path) -> None:
    figure, axes = pyplot.subplots(3, 1, figsize=(5.4, 6.6), sharex=True)
    frames = range(1, FRAMES + 1)
    for variate in WAYS:
        style = {"marker": "o", "markersize": 2.5, "linewidth": 1.2, "label": variate}
        axes[0].plot(frames, samples_of(told[variate]), **style)
        axes[1].plot(frames[1:], sampling_ms(told[variate])[1:], **style)
        axes[2].plot(frames, db[variate, "step"], **style)
    axes[0].set(ylabel="samples a pixel, mean", ylim=(0, 68), title=scene)
    axes[1].set(ylabel="sampling, ms", ylim=(0, None))
    axes[2].set(ylabel="PSNR, dB", xlabel="frame")
    for axis in axes:
        axis.grid(alpha=0.3)
    axes[0].legend(fontsize=8, title="control_variate", title_fontsize=8)
    save_plot(figure, images / f"adaptive_{scene}.svg")
