"""Hosts: a GL context with the effects and profiles that it reads."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Union

from . import _native

PathLike = Union[str, "os.PathLike[str]"]


@dataclass(frozen=True)
class Param:
    """A parameter, as its effect declares it; of a look also its value now."""

    name: str  #: "f_number"; of a look "bokeh.f_number"
    type: str  #: "float", "int", "bool", "enum", "angle", "color", "vec2", "curve", ...
    unit: str  #: of default, min, max and value; "" for a pure number
    doc: str
    default: Any
    min: float | None  #: inclusive
    max: float | None  #: inclusive
    ui_range: tuple[float, float] | None  #: ends of a slider
    values: list[str]  #: of an enum
    from_: str  #: the default where the capture has it: "camera.focus_distance"
    identity: Any  #: the value that leaves the image as it is
    columns: list[Param]  #: of a table
    step: str = ""
    value: Any = None
    origin: str = ""  #: where the value is from: "the manifest", "preset fast", "the look", "set"


@dataclass(frozen=True)
class Port:
    """An input or an output of an effect."""

    name: str
    role: str
    doc: str
    optional: bool = False
    history: bool = False  #: the frame before is read too
    frame: int = 0  #: -1 and 1: of the capture before and after


@dataclass(frozen=True)
class Effect:
    """An effect, as `aftershade describe` prints it."""

    id: str
    version: str
    summary: str
    folder: str
    inputs: list[Port]
    outputs: list[Port]
    params: list[Param]
    textures: list[str]
    presets: dict[str, dict[str, Any]]
    sources: list[str]
    has_history: bool
    has_native_code: bool
    warmup_frames: int


def param_of(fields: dict[str, Any]) -> Param:
    return Param(**{**fields, "columns": [param_of(one) for one in fields["columns"]]})


def effect_of(fields: dict[str, Any]) -> Effect:
    ports = {key: [Port(**one) for one in fields[key]] for key in ("inputs", "outputs")}
    return Effect(**{**fields, **ports, "params": [param_of(one) for one in fields["params"]]})


def shipped_data() -> Path:
    """$AFTERSHADE_DATA, or the folder of effects, GLSL, looks and profiles inside this package."""
    return Path(os.environ.get("AFTERSHADE_DATA") or Path(__file__).parent / "data")


class Host:
    """A GL context with its effects and profiles. The functions of this package share one unless they are given another.

    Any thread may call a host: calls on one host wait for each other, and release the GIL meanwhile. For frames that
    render at the same time make a host for each thread.

    :param data: folder that holds effects/, glsl/ and profiles/; by default the package's own
    :param effect_paths: folders of effects, searched before the shipped ones
    :param profile_paths: folders of producers' profiles, likewise
    :param plugin_paths: folders of native plug-ins, whose code runs in this process
    :param backend: "auto", "egl", "software", "egl-software" or "osmesa"; by default $AFTERSHADE_BACKEND, else "auto"
    :param device: device to draw on, by a name that `aftershade doctor` lists, such as "0", "card0" or "cuda:0"; by
        default $AFTERSHADE_DEVICE, else the first that works
    :param cache: folder for compiled programs; by default nothing is kept
    :param max_side_px: images with a longer side are refused, from 1 to 65536
    :param max_image_bytes: likewise, of the channels of one file
    """

    def __init__(
        self,
        *,
        data: PathLike | None = None,
        effect_paths: Iterable[PathLike] = (),
        profile_paths: Iterable[PathLike] = (),
        plugin_paths: Iterable[PathLike] = (),
        backend: str | None = None,
        device: str | None = None,
        cache: PathLike = "",
        max_side_px: int = 16384,
        max_image_bytes: int = 512 * 1024 * 1024,
    ) -> None:
        backend = backend or os.environ.get("AFTERSHADE_BACKEND") or "auto"
        # The variable says nothing of backends that draw in software.
        usual = os.environ.get("AFTERSHADE_DEVICE", "") if backend in ("auto", "egl") else ""
        self._native = _native.Host(
            Path(data or shipped_data()),
            [Path(one) for one in effect_paths],
            [Path(one) for one in profile_paths],
            [Path(one) for one in plugin_paths],
            backend,
            device or usual,
            cache,
            max_side_px,
            max_image_bytes,
        )

    def close(self) -> None:
        """Frees the context and all that lies on the GPU; looks and sessions of this host are of no use then."""
        self._native.close()

    @property
    def is_closed(self) -> bool:
        return self._native.is_closed

    def gl(self) -> dict[str, Any]:
        """Backend, device, renderer, version and vendor of the context, and why "auto" took software, if it did. This
        makes the context if there is none yet."""
        return self._native.gl()

    def effects(self) -> list[Effect]:
        """Every effect, sorted by id."""
        return [effect_of(one) for one in self._native.effects()]

    def effect(self, id: str) -> Effect:
        return effect_of(self._native.effect(id))

    def profiles(self) -> dict[str, str]:
        """Summaries of the producers' profiles by id."""
        return self._native.profiles()

    def __enter__(self) -> Host:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


_default: Host | None = None
_default_lock = threading.Lock()


def default_host() -> Host:
    """The host that functions of this package use where none is given. Made when it is first needed."""
    global _default
    with _default_lock:
        if _default is None or _default.is_closed:
            _default = Host()
        return _default
