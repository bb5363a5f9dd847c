"""Radiance pictures out."""
import pathlib

import numpy as np

from measure.measures import Array


def write_hdr(path: pathlib.Path | str, image: Array) -> Array:
    """RGBE without run lengths; what a reader gets."""
    largest = image.max(-1)
    exponent = np.where(largest > 0, np.floor(np.log2(np.maximum(largest, 1e-30))) + 1, 0)
    scale = np.exp2(8 - exponent)[..., None]
    rgbe = np.concatenate([np.clip(image * scale, 0, 255), (exponent + 128)[..., None]], -1).astype(np.uint8)
    with open(path, "wb") as out:
        out.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % image.shape[:2])
        out.write(rgbe.tobytes())
    return rgbe[..., :3].astype(np.float32) * np.exp2(rgbe[..., 3:].astype(np.float32) - 136)
