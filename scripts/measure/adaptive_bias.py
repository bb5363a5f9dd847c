"""Bias of sss_adaptive: means of many frames against the exact sum; part of `scripts/quality sss-adaptive`."""
import itertools
import os
from pathlib import Path

import numpy

from measure.measures import LUMINANCE, Array, scale_of
from measure.pages import Rows
from measure.sss_sequences import run, scene_capture, scene_profile, still
from measure.sss_techniques import WORK, incoming, scatter, scattering
from measure.tree import Document

FRAMES = int(os.environ.get("FRAMES", "1000"))
CHUNK = 250  # frames whose pictures are held at once
REGION = "110,30,64,64"  # the ball's shadow
UNBIASED = {"min_samples": 1, "prefilter": False, "normalize": "none", "distant_share": 0, "guiding": False}
MODES: dict[str, Document] = {"`prefilter`": {"prefilter": True}, "`normalize` missing": {"normalize": "missing"}, "`normalize` all": {"normalize": "all"},
         "`sampling` widest_fit": {"sampling": "widest_fit"}, "`sampling` widest_fit_unbiased": {"sampling": "widest_fit_unbiased"},
         "`sampling` channels": {"sampling": "channels"}, "`distant_share` 0.05": {"distant_share": 0.05},
         "the defaults without `guiding`": {"min_samples": 8, "normalize": "missing", "distant_share": 0.05}}


class Moments:
    """Of luminance, pixel by pixel and of the whole picture."""

    def __init__(self) -> None:
        self.frames = 0
        self.sum = self.squares = numpy.zeros(())

    def add(self, pictures: Array) -> None:
        self.frames += len(pictures)
        self.sum = self.sum + pictures.sum(axis=0)
        self.squares = self.squares + (pictures**2).sum(axis=0)

    def mean(self) -> Array:
        return self.sum / self.frames

    def sigma_of_mean(self) -> Array:
        return numpy.sqrt(numpy.maximum(self.squares / self.frames - self.mean()**2, 0) / (self.frames - 1))


def moments_of(name: str, params: Document, profile: Document, sequence: Path, where: Array) -> tuple[Moments, Array]:
    moments = Moments()
    means: list[float] = []
    result = run(name, sequence, profile, params, FRAMES, taps=(), region=REGION)["irradiance"]
    for first in range(0, FRAMES, CHUNK):
        light = result[first:first + CHUNK].astype(numpy.float64) @ LUMINANCE
        moments.add(light)
        means += [float(frame[where].mean()) for frame in light]
    return moments, numpy.array(means)


def bias() -> tuple[Rows, Rows]:
    capture, profile = scene_capture("shadow_edge", "1"), scene_profile("shadow_edge")
    file = capture.parent / "gbuffer_0001.exr"
    sequence = still(file, "native", FRAMES)
    x, y, w, h = (int(n) for n in REGION.split(","))
    cut = (slice(y, y + h), slice(x, x + w))
    where = scattering(file)[cut]
    scale = scale_of(incoming(file)[cut], where)
    options = ["--frames", "1", "--region", REGION, "--region-margin", "0"]
    exact = {n: scatter(sequence, WORK / f"shadow_edge_crop_{n}.exr", ("", "sss_exact", {"normalize": n}), profile, {"object_ids": [1]}, options)
             @ LUMINANCE for n in ("none", "missing", "all")}
    unbiased, modes = [], []
    for controller, variate in itertools.product(("ratio", "sqrt", "difference"), ("none", "constant", "online")):
        moments, means = moments_of("bias", UNBIASED | {"controller": controller, "control_variate": variate}, profile, sequence, where)
        within = (numpy.abs(moments.mean() - exact["none"]) <= 3 * moments.sigma_of_mean() + 1e-5)[where].mean()
        off = (means.mean() - exact["none"][where].mean()) * scale
        sigma = means.std(ddof=1) / numpy.sqrt(FRAMES) * scale
        unbiased.append([controller, variate, f"{100 * within:.2f}", f"{off:+.6f}", f"{abs(off) / sigma:.1f}"])
        print("unbiased", unbiased[-1], flush=True)
    for label, params in MODES.items():
        moments, means = moments_of("bias", UNBIASED | {"controller": "ratio"} | params, profile, sequence, where)
        truth = exact[params.get("normalize", "none")]
        error = (moments.mean() - truth)[where] * scale
        noise = float((moments.sigma_of_mean()[where] * scale).mean())
        modes.append([label, f"{error.mean():+.5f}", f"{numpy.sqrt((error**2).mean()):.5f}", f"{noise:.5f}"])
        print("bias", modes[-1], flush=True)
    return unbiased, modes
