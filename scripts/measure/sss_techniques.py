"""The techniques of subsurface scattering that this tree has, and how to run them."""
from collections.abc import Sequence
from pathlib import Path

import numpy

from measure.exr import read_exr, read_rgb64
from measure.measures import Array
from measure.tree import AFTERSHADE, EXACT, ROOT, Document, command, write_look

WORK = ROOT / "build/quality-sss"

Technique = tuple[str, str, Document]
# Label, effect, parameters; what is not in effects/ is left out. REFERENCE is what the others are measured against.
REFERENCE: Technique = ("sss_exact", "sss_exact", {})
ALL: list[Technique] = [
    REFERENCE,
    ("sss_exact, axes", "sss_exact", {"geometry": "axes"}),
    ("sss_exact, normalize all", "sss_exact", {"normalize": "all"}),
    ("sss_burley, 16 samples", "sss_burley", {"samples": 16}),
    ("sss_burley, 64 samples", "sss_burley", {"samples": 64}),
    ("sss_burley, 256 samples", "sss_burley", {"samples": 256}),
    ("sss_burley, 64 samples, axes", "sss_burley", {"samples": 64, "geometry": "axes"}),
    ("sss_burley, 64 samples, normalize all", "sss_burley", {"samples": 64, "normalize": "all"}),
    ("sss_burley, 64 samples, channels", "sss_burley", {"samples": 64, "sampling": "channels"}),
    ("sss_burley, 64 samples, widest_fit", "sss_burley", {"samples": 64, "sampling": "widest_fit"}),
    ("sss_separable, preintegrated", "sss_separable", {"kernel": "preintegrated"}),
    ("sss_separable, preintegrated, 63 samples", "sss_separable", {"kernel": "preintegrated", "samples": 63}),
    ("sss_separable, gaussian_fit", "sss_separable", {"kernel": "gaussian_fit"}),
    ("sss_separable, artist", "sss_separable", {"kernel": "artist"}),
    ("sss_gaussian", "sss_gaussian", {}),
    ("sss_preintegrated", "sss_preintegrated", {}),
]
# Of Cycles' head: subsurface radius (1.0, 0.4, 0.25) m; Cycles' mean free path is the radius * 0.25 / pi.
HEAD_PROFILE = {"type": "burley", "albedo": [0.8, 0.5, 0.4], "mean_free_path_mm": [79.577, 31.831, 19.894], "mapping": "diffuse"}


def present(techniques: Sequence[Technique] = ALL) -> list[Technique]:
    return [t for t in techniques if any((ROOT / "effects").glob(f"**/{t[1]}/effect.json"))]


def scatter(capture: Path, out: Path, technique: Technique, profile: Document, more: Document | tuple[()] = (), options: Sequence[str] = ()) -> Array:
    """Irradiance of the first frame of a capture, RGB float64; made once for each name of `out`."""
    _, effect, params = technique
    if not out.exists():
        look = write_look(out.with_suffix(".json"), {"effect": effect, "params": {"scattering_profile": profile} | dict(more) | params})
        command([AFTERSHADE, "run", look, capture, "-o", out, "--output-roles", "irradiance", *EXACT, *options])
    return read_rgb64(out, "irradiance")


def incoming(file: Path) -> Array:
    """Light before scattering."""
    return read_rgb64(file, "irradiance")


def scattering(file: Path) -> Array:
    """Pixels of the object that scatters."""
    return read_exr(file, ["object_id.I"]) == 1


def cycles_light(file: Path) -> Array:
    """Diffuse light of a layer of Cycles', before the albedo."""
    return read_rgb64(file, "ViewLayer.DiffDir") + read_rgb64(file, "ViewLayer.DiffInd")


def cycles_head(file: Path) -> Array:
    return numpy.round(read_exr(file, ["ViewLayer.IndexOB.X"])) == 1
