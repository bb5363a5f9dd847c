"""Looks: chains of effects, and what they make of frames."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._capture import Capture, Sequence, read_options
from ._errors import Diagnostic
from ._host import Host, Param, PathLike, default_host, param_of

Frame = Union[Capture, PathLike, Mapping[str, ArrayLike]]


def _render_options(
    roles: Iterable[str] = (),
    timed: bool = False,
    telemetry: bool = False,
    non_finite: str = "report",
    previous: Capture | None = None,
    next: Capture | None = None,
    begins_shot: bool = False,
    fps: float = 24,
) -> _native.RenderOptions:
    before, after = (one._native if one is not None else None for one in (previous, next))
    return _native.RenderOptions(list(roles), timed, telemetry, non_finite, before, after, begins_shot, fps)


class Result:
    """The result of a look for one frame: images by role. A notebook displays it as a picture."""

    def __init__(self, native: _native.Result) -> None:
        self._native = native

    def __getitem__(self, role: str) -> NDArray[Any]:
        """The image of a role: a read-only array that shares the result's pixels."""
        return np.asarray(self._native.image(role))

    def __contains__(self, role: str) -> bool:
        return role in self._native.roles

    @property
    def roles(self) -> list[str]:
        return self._native.roles

    @property
    def frame(self) -> int:
        return self._native.frame

    @property
    def is_pending(self) -> bool:
        """Whether a further sub-frame is needed before there are images."""
        return self._native.is_pending

    def tap(self, name: str) -> NDArray[Any]:
        """An intermediate texture that the look was loaded with: "bokeh.coc"."""
        return np.asarray(self._native.tap(name))

    @property
    def taps(self) -> list[str]:
        return self._native.taps

    @property
    def times_ms(self) -> list[tuple[str, float]]:
        """Passes in order with their times; empty unless rendered with timed=True."""
        return self._native.times_ms

    @property
    def statistics(self) -> list[dict[str, Any]]:
        """The effects' statistics; empty unless rendered with telemetry=True."""
        return self._native.statistics

    @property
    def non_finite(self) -> list[dict[str, Any]]:
        """Images with NaN or infinite pixels."""
        return self._native.non_finite

    @property
    def messages(self) -> list[str]:
        """Messages of plug-ins."""
        return self._native.messages

    @property
    def notes(self) -> list[str]:
        """How its capture was read: Capture.notes."""
        return self._native.notes

    @property
    def history_reset(self) -> str:
        """Why history began with this frame; "" if it continued, or if the look has none."""
        return self._native.history_reset

    @property
    def gpu_bytes(self) -> int:
        return self._native.gpu_bytes

    def write(
        self,
        path: PathLike,
        *,
        roles: Iterable[str] = ("color",),
        half: bool = True,
        crop_to_display: bool = False,
        compression: str = "zip",
    ) -> None:
        """Writes a .exr or .png, as `aftershade run` does; "####" stands for the frame's number."""
        self._native.write(Path(path), list(roles), half, crop_to_display, compression)

    def _repr_png_(self) -> bytes | None:
        if self.is_pending:
            return None
        with tempfile.TemporaryDirectory() as folder:
            self.write(Path(folder) / "result.png")
            return (Path(folder) / "result.png").read_bytes()

    def __repr__(self) -> str:
        return f"<aftershade.Result frame {self.frame}: {', '.join(self.roles)}>"


class Params(Mapping[str, Param]):
    """The parameters of a look by their names: "bokeh.f_number". `look.params[name].value` reads, `look[name] = value` sets."""

    def __init__(self, params: list[Param]) -> None:
        self._params = {param.name: param for param in params}

    def __getitem__(self, name: str) -> Param:
        return self._params[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._params)

    def __len__(self) -> int:
        return len(self._params)


class Session:
    """Renders frames in order, with the history that effects keep from one frame to the next."""

    def __init__(self, look: Look) -> None:
        self._look = look
        self._native = look._native.session()

    def render(self, frame: Frame, **options: Any) -> Result:
        """The next frame; options are those of Look.render, and begins_shot=True after a cut."""
        return self._look._keep(self._native.render(self._look._capture(frame)._native, _render_options(**options)))

    def render_subframe(self, frame: Frame, index: int, count: int, **options: Any) -> Result:
        """The index-th of the captures that make up a frame; the result of the last has the images."""
        native = self._look._capture(frame)._native
        return self._look._keep(self._native.render_subframe(native, index, count, _render_options(**options)))

    def render_frame(self, sequence: Sequence, frame: int, **options: Any) -> Result:
        """A frame of a sequence with its sub-frames, neighbours and cuts, as `aftershade run` renders it."""
        return self._look._keep(self._native.render_frame(sequence._native, frame, _render_options(**options)))

    def reset(self) -> None:
        """Forgets every frame."""
        self._native.reset()

    def save_history(self, path: PathLike) -> None:
        self._native.save_history(Path(path))

    def load_history(self, path: PathLike) -> None:
        self._native.load_history(Path(path))


class Look:
    """A chain of effects, from a file or from a dict with the content of such a file.

    :param source: path of a look, or its content
    :param host: the default host unless another is given
    :param taps: "step.texture": intermediate textures that each result has too
    :param variables: above the look's own "vars"
    :param folder: that files named in a dict are named from; by default the working directory

    In a notebook a look shows the last picture that it made.
    """

    def __init__(
        self,
        source: Union[PathLike, Mapping[str, Any]],
        *,
        host: Host | None = None,
        taps: Iterable[str] = (),
        variables: Mapping[str, Any] | None = None,
        folder: PathLike = "",
    ) -> None:
        self.host = host or default_host()
        options = _native.LookOptions(list(taps), dict(variables or {}), folder)
        if isinstance(source, Mapping):
            self._native = _native.Look.parse(self.host._native, json.dumps(source), options)
        else:
            self._native = _native.Look.load(self.host._native, Path(source), options)
        self._last: Result | None = None

    @property
    def steps(self) -> list[str]:
        """Names of the steps that run, in order."""
        return self._native.steps

    @property
    def inputs(self) -> list[str]:
        """Roles that the look takes from captures, required or not."""
        return self._native.inputs

    @property
    def outputs(self) -> list[str]:
        """Roles that some step makes."""
        return self._native.outputs

    @property
    def has_history(self) -> bool:
        """Whether a frame depends on those before it: then use session() or frames()."""
        return self._native.has_history

    @property
    def warnings(self) -> list[Diagnostic]:
        return [Diagnostic(**one) for one in self._native.warnings]

    @property
    def params(self) -> Params:
        """Every parameter of every step, with unit, range, doc and its value now."""
        return Params([param_of(one) for one in self._native.params])

    def __getitem__(self, name: str) -> Any:
        return self._native.get(name)

    def __setitem__(self, name: str, value: Any) -> None:
        self._native.set({name: value})

    def set(self, values: Mapping[str, Any]) -> None:
        """Several parameters at once, so that relations between them hold after all are set."""
        self._native.set(dict(values))

    def reset(self, name: str) -> None:
        """Sets a parameter to the value of the look, its preset or the manifest."""
        self._native.reset(name)

    def render(self, frame: Frame, **options: Any) -> Result:
        """Renders a frame by itself: history begins with it.

        :param frame: a Capture, a path, or arrays by role
        :param roles: to be given back; by default every role that some step makes, else color
        :param timed: measure each pass
        :param telemetry: compute the effects' statistics
        :param non_finite: "report" NaN and infinite pixels, "ignore", "fail" or "mend" them
        :param previous, next: captures of the neighbouring frames, for effects that look at them
        """
        return self._keep(self._native.render(self._capture(frame)._native, _render_options(**options)))

    def session(self) -> Session:
        return Session(self)

    def frames(self, sequence: Union[Sequence, PathLike], frames: Iterable[int] | None = None, **options: Any) -> Iterator[Result]:
        """Renders a sequence in order, with history, a frame at a time; `frames` chooses some of its frames."""
        opened = sequence if isinstance(sequence, Sequence) else Sequence(sequence, host=self.host)
        session = self.session()
        for frame in opened.frames if frames is None else frames:
            yield session.render_frame(opened, frame, **options)

    def _capture(self, frame: Frame) -> Capture:
        if isinstance(frame, Capture):
            return frame
        if isinstance(frame, Mapping):
            return Capture(frame, host=self.host)
        return Capture._of(self._native.read(Path(frame), read_options()))

    def _keep(self, native: _native.Result) -> Result:
        result = Result(native)
        if not result.is_pending:
            self._last = result
        return result

    def _repr_png_(self) -> bytes | None:
        return self._last._repr_png_() if self._last else None

    def __repr__(self) -> str:
        return f"<aftershade.Look: {' -> '.join(self.steps) or 'no steps'}>"
