"""Whether motion vectors mean what the profile declares: what `aftershade inspect --check-velocity` computes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike as OsPathLike
from pathlib import Path
from typing import Any, Union

from numpy.typing import ArrayLike

from . import _native
from ._capture import Capture, read_options
from ._host import Host, PathLike, default_host

Frame = Union[PathLike, Capture, Mapping[str, ArrayLike]]


@dataclass(frozen=True)
class VelocitySettings:
    """How stored vectors are read, in the words of a profile."""

    delta: str  #: cur-prev, prev-cur, next-cur or cur-next
    y_axis: str  #: down or up
    unit: str  #: px, uv or ndc
    scale: tuple[float, float]
    exchange_channels: bool


@dataclass(frozen=True)
class VelocityCheck:
    """The check of one motion role over two frames. True if they confirm the claim."""

    role: str  #: velocity or velocity_next
    verdict: str  #: "confirmed", "undecided", "wrong", "no_fit" or "untestable"
    sentence: str  #: the verdict, its reason and the remedy
    score: float  #: share of the difference between the frames that the vectors remove, by the claim
    rival_score: float  #: by the best other reading
    settings: VelocitySettings  #: the claim
    suggested: VelocitySettings  #: the same where nothing better is known
    untold: list[str]  #: settings that these frames do not tell
    longest_px: float  #: the longest vector of both frames

    def __bool__(self) -> bool:
        return self.verdict == "confirmed"


def check_velocity(frame: Frame, next_frame: Frame, *, host: Host | None = None, **options: Any) -> list[VelocityCheck]:
    """Warps one of two consecutive frames by its motion vectors, in each of the ways in which a profile can be wrong,
    and compares it with the other.

    Two files: the claim is their profile's, and keyword arguments are those of `Capture`. Two captures, or dicts of
    arrays: the claim is that velocity is the pixel's movement since the previous frame, in px, with y down.

    :returns: a check for each of the roles velocity and velocity_next that the frames have
    """
    are_files = [isinstance(one, (str, OsPathLike)) for one in (frame, next_frame)]
    if all(are_files):
        native = (host or default_host())._native
        found: list[dict[str, Any]] = _native.check_velocity_of_files(native, Path(frame), Path(next_frame), read_options(**options))  # type: ignore[arg-type]
    elif any(are_files):
        raise TypeError("check_velocity takes two files or two captures")
    else:
        if options:
            raise TypeError(f"{', '.join(sorted(options))}: for files only, and these are captures")
        first, second = (one if isinstance(one, Capture) else Capture(one) for one in (frame, next_frame))
        found = _native.check_velocity_of_captures(first._native, second._native)
    return [_check_of(one) for one in found]


def _check_of(found: dict[str, Any]) -> VelocityCheck:
    settings = {key: VelocitySettings(**found[key]) for key in ("settings", "suggested")}
    return VelocityCheck(**{**found, **settings})
