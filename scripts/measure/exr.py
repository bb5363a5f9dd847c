"""OpenEXR in and out."""
import pathlib
from collections.abc import Mapping, Sequence

import numpy
import OpenEXR

from measure.measures import Array

RGB = ["R", "G", "B"]


def read_exr(path: pathlib.Path | str, names: Sequence[str] = RGB) -> Array:
    """H x W x channels, float32; one name gives H x W."""
    with OpenEXR.File(str(path), separate_channels=True) as file:
        channels = file.channels()
        planes = [numpy.asarray(channels[name].pixels, dtype=numpy.float32) for name in names]
    return planes[0] if len(names) == 1 else numpy.stack(planes, axis=-1)


def read_rgb64(path: pathlib.Path | str, layer: str) -> Array:
    """R, G and B of a layer, in double precision."""
    return read_exr(path, [f"{layer}.{c}" for c in RGB]).astype(numpy.float64)


def write_exr(path: pathlib.Path | str, channels: Mapping[str, Array], compression: object = OpenEXR.NO_COMPRESSION) -> None:
    """Planes of float32, float16 or uint32 by channel name."""
    planes = {name: numpy.ascontiguousarray(plane) for name, plane in channels.items()}
    OpenEXR.File({"compression": compression, "type": OpenEXR.scanlineimage}, planes).write(str(path))


def read_all(path: pathlib.Path | str) -> tuple[dict[str, Array], dict[str, object]]:
    """Every channel as it is stored, and the header's attributes."""
    with OpenEXR.File(str(path), separate_channels=True) as file:
        return {name: channel.pixels for name, channel in file.channels().items()}, dict(file.header())


def write_trimmed(source: pathlib.Path | str, target: pathlib.Path | str, kinds: Mapping[str, str]) -> None:
    """The channels alone that `kinds` has, by the letter of their numpy type; the header as it is."""
    planes, header = read_all(source)
    kept = {name: numpy.ascontiguousarray(planes[name]).astype(kind) for name, kind in kinds.items()}
    OpenEXR.File({name: value for name, value in header.items() if name != "channels"}, kept).write(str(target))
