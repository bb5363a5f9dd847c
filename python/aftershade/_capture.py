"""Captures: one frame of images by role, with its camera; and sequences of them on disk."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._host import Host, PathLike, default_host

Window = tuple[int, int, int, int]  # x, y, width, height in px


def host_array(pixels: ArrayLike) -> NDArray[Any]:
    """float32, or uint32 for whole numbers, with interleaved pixels; the array itself where it is so already."""
    array = np.asarray(pixels)
    if array.dtype not in (np.float32, np.uint32):
        if not np.issubdtype(array.dtype, np.number):
            raise TypeError(f"pixels of the type {array.dtype} are not numbers")
        is_whole = np.issubdtype(array.dtype, np.integer)
        if is_whole and array.size and (array.min() < 0 or array.max() > np.iinfo(np.uint32).max):
            raise ValueError("whole numbers must fit into uint32; for others give floats")
        array = array.astype(np.uint32 if is_whole else np.float32)
    interleaved = (array.strides[-1] == 4 if array.ndim == 2 else array.strides[1:] == (4 * array.shape[-1], 4)) if array.ndim in (2, 3) else True
    rows_fit = array.ndim == 0 or array.strides[0] % 4 == 0 and abs(array.strides[0]) >= array.nbytes // max(array.shape[0], 1)
    return array if interleaved and rows_fit else np.ascontiguousarray(array)


def read_options(
    profile: str = "auto",
    view: str = "",
    layer: str = "",
    color_space: str = "auto",
    alpha: str = "keep",
    roles: Iterable[str] = (),
    scale_divisor: int = 1,
) -> _native.CaptureOptions:
    if alpha not in ("keep", "opaque"):
        raise ValueError(f"alpha '{alpha}' is unknown; it is keep or opaque")
    return _native.CaptureOptions(profile, view, layer, color_space, alpha == "opaque", list(roles), scale_divisor)


class Capture:
    """One frame: images by role (docs/conventions.md), and the camera.

    `Capture("frame.exr")` reads a file as `aftershade run` does; keyword arguments are `profile`, `view`, `layer`,
    `color_space`, `alpha` ("keep" or "opaque"), `roles` and `scale_divisor`. `Capture({"color": array, "depth": array})`
    takes arrays of the shape (height, width) or (height, width, channels), float32 or uint32; others are converted.
    """

    def __init__(
        self,
        source: Union[PathLike, Mapping[str, ArrayLike]],
        *,
        camera: Mapping[str, Any] | None = None,
        frame: int | None = None,
        host: Host | None = None,
        **options: Any,
    ) -> None:
        self._native: _native.Capture
        if isinstance(source, Mapping):
            if options:
                raise TypeError(f"{', '.join(sorted(options))}: for files only, and these are arrays")
            self._native = _of_arrays(source)
        else:
            self._native = _native.Capture.read((host or default_host())._native, Path(source), read_options(**options))
        if camera is not None:
            self.camera = dict(camera)
        if frame is not None:
            self.frame = frame

    @classmethod
    def _of(cls, native: _native.Capture) -> Capture:
        capture = cls.__new__(cls)
        capture._native = native
        return capture

    def copy(self) -> Capture:
        """Shares the images until one of the two changes."""
        return self._of(self._native.copy())

    @property
    def roles(self) -> list[str]:
        return self._native.roles

    def __contains__(self, role: str) -> bool:
        return self._native.has_image(role)

    def __getitem__(self, role: str) -> NDArray[Any]:
        """The image of a role: a read-only view of its pixels."""
        return np.asarray(self._native.image(role))

    def __setitem__(self, role: str, pixels: ArrayLike) -> None:
        self._native.set_image(role, host_array(pixels))

    def __delitem__(self, role: str) -> None:
        self._native.remove_image(role)

    @property
    def camera(self) -> dict[str, Any]:
        """focus_distance_m, focal_length_mm, sensor_width_mm, f_number, camera_from_world, ...: what is known."""
        return self._native.camera

    @camera.setter
    def camera(self, fields: Mapping[str, Any]) -> None:
        self._native.camera = dict(fields)

    @property
    def frame(self) -> int:
        return self._native.frame

    @frame.setter
    def frame(self, number: int) -> None:
        self._native.frame = number

    @property
    def color_space(self) -> str:
        return self._native.color_space

    @color_space.setter
    def color_space(self, name: str) -> None:
        self._native.color_space = name

    @property
    def pixel_aspect(self) -> float:
        """Width of a pixel over its height: 2 for those of an anamorphic lens. 1 of arrays unless it is set."""
        return self._native.pixel_aspect

    @pixel_aspect.setter
    def pixel_aspect(self, aspect: float) -> None:
        self._native.pixel_aspect = aspect

    @property
    def scale(self) -> float:
        """Size of the pixels against those that values in px are meant for."""
        return self._native.scale

    @scale.setter
    def scale(self, scale: float) -> None:
        self._native.scale = scale

    @property
    def data_window(self) -> Window:
        x, y, width, height = self._native.data_window
        return x, y, width, height

    @property
    def display_window(self) -> Window:
        x, y, width, height = self._native.display_window
        return x, y, width, height

    def set_windows(self, data: Window, display: Window) -> None:
        self._native.set_windows(data, display)

    @property
    def profile(self) -> str:
        return self._native.profile

    @property
    def path(self) -> str:
        return self._native.path

    @property
    def notes(self) -> list[str]:
        """Choices of the reader, possible faults, and differences from the sequence's first frame."""
        return self._native.notes

    def __repr__(self) -> str:
        width, height = self.data_window[2:]
        return f"<aftershade.Capture frame {self.frame}, {width} x {height} px: {', '.join(self.roles)}>"


def _of_arrays(images: Mapping[str, ArrayLike]) -> _native.Capture:
    arrays = {role: host_array(pixels) for role, pixels in images.items()}
    if not arrays:
        raise ValueError("a capture needs an image, such as {'color': array}")
    first = next(iter(arrays.values()))
    if first.ndim not in (2, 3):
        raise ValueError(f"an array of the shape {first.shape} is not an image: (height, width) or (height, width, channels)")
    native = _native.Capture(first.shape[1], first.shape[0])
    for role, pixels in arrays.items():
        native.set_image(role, pixels)
    return native


class Sequence:
    """Ordered frames on disk: a capture.json, a pattern such as frame_####.exr, or a folder. Options are those of Capture."""

    def __init__(self, path: PathLike, *, host: Host | None = None, **options: Any) -> None:
        self._native = _native.Sequence.open((host or default_host())._native, Path(path), read_options(**options))

    @property
    def frames(self) -> list[int]:
        return self._native.frames

    @property
    def fps(self) -> float:
        return self._native.fps

    @property
    def subframes(self) -> int:
        """Captures that make up a frame."""
        return self._native.subframes

    @property
    def cuts(self) -> list[int]:
        """Frames that begin a shot."""
        return self._native.cuts

    def read(self, frame: int, subframe: int = 0) -> Capture:
        return Capture._of(self._native.read(frame, subframe))

    def __len__(self) -> int:
        return len(self.frames)

    def __repr__(self) -> str:
        frames = self.frames
        return f"<aftershade.Sequence of {len(frames)} frames{f', {frames[0]} to {frames[-1]}' if frames else ''}>"
