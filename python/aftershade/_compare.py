"""How far two pictures are apart: what `aftershade compare` computes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike as OsPathLike
from pathlib import Path
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._capture import host_array
from ._host import PathLike

Picture = Union[PathLike, ArrayLike]


@dataclass(frozen=True)
class Layer:
    """Figures of one layer: channels of one name."""

    label: str  #: "RGB", "Z", "diffuse.RGB"; of arrays the role
    role: str
    channels: list[str]
    pixels: int
    failing: int  #: pixels above the tolerance's limit
    warning: int
    bits_equal: bool
    mean_absolute: float
    rmse: float
    psnr_db: float  #: infinity for equal images
    mean_pixel: float
    largest: float  #: the largest absolute difference
    largest_px: tuple[int, int]
    ldr_flip: float | None  #: mean, from 0 to 1
    hdr_flip: float | None
    ssim: float | None
    ms_ssim: float | None
    verdict: str
    reasons: list[str]
    is_judged: bool  #: False: no limit holds this layer, so that any difference passes
    flip_map: NDArray[np.float32] | None  #: (height, width), from 0 to 1; with maps=True
    ssim_map: NDArray[np.float32] | None  #: likewise, from -1 to 1; NaN at the border, which no window covers


@dataclass(frozen=True)
class Comparison:
    verdict: str  #: "same", "warning", "failure", "different size or channels" or "file error"
    faults: list[str]
    warnings: list[str]  #: what is not compared, or has equal numbers and is another picture
    notes: list[str]  #: how the files were read
    layers: list[Layer]
    not_judged: list[str]  #: labels of what the verdict does not depend on: without a limit, or ignored

    def __bool__(self) -> bool:
        """Whether the pictures are the same, within the tolerance."""
        return self.verdict == "same"

    def __getitem__(self, label: str) -> Layer:
        for layer in self.layers:
            if layer.label == label:
                return layer
        raise KeyError(f"no layer '{label}'; there are {', '.join(layer.label for layer in self.layers)}")


def compare(
    reference: Picture,
    test: Picture,
    *,
    role: str = "color",
    limit: float = 1e-6,
    relative: float = 0,
    ulp: float = 0,
    percent: float = 0,
    allowed: int = 0,
    fail_flip: float | None = None,
    fail_ssim: float | None = None,
    nan_equal: bool = False,
    flip: str = "auto",
    ssim: bool = True,
    maps: bool = False,
    pixels_per_degree: float = 67.020643,
    roles: Mapping[str, str] | None = None,
) -> Comparison:
    """Compares two files (.exr, .png, .hdr) layer by layer, or two arrays as one layer.

    :param role: of arrays: color, display, alpha, depth, velocity, id or data
    :param limit: of a pixel's difference; more than `percent` of the pixels and more than `allowed` above it fail
    :param relative: a difference above `limit` counts where it is also more than this part of its value
    :param ulp: a difference counts where it is more than this many units in the last place of the coarser file's stored type
    :param fail_flip, fail_ssim: fails where the mean FLIP is above, or the SSIM below
    :param maps: fill Layer.flip_map and Layer.ssim_map
    :param roles: of files: how layers are compared, by label
    """
    options = _native.CompareOptions(
        limit,
        relative,
        ulp,
        percent,
        allowed,
        fail_flip,
        fail_ssim,
        nan_equal,
        flip,
        ssim,
        maps,
        pixels_per_degree,
        dict(roles or {}),
    )
    are_files = [isinstance(one, (str, OsPathLike)) for one in (reference, test)]
    if all(are_files):
        found: dict[str, Any] = _native.compare_files(Path(reference), Path(test), options)  # type: ignore[arg-type]
    elif any(are_files):
        raise TypeError("compare takes two files or two arrays")
    else:
        found = _native.compare_arrays(host_array(reference), host_array(test), role, options)  # type: ignore[arg-type]
    return Comparison(**{**found, "layers": [Layer(**one) for one in found["layers"]]})
