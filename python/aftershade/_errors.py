"""Exceptions of the package: one class for each kind of error of the host API."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Diagnostic:
    """One fault, and where it is."""

    severity: str  #: "error" or "warning"
    message: str
    file: str  #: a path, or what the caller named, such as "bokeh.f_number"; "" where there is no place
    line: int  #: from 1; 0 for the whole file
    column: int  #: from 1, in bytes; 0 for the whole line


class Error(Exception):
    """Base of all errors that Aftershade reports. `str()` has every fault, one a line."""

    kind = "effect"

    def __init__(self, text: str, diagnostics: tuple[Diagnostic, ...] = ()) -> None:
        super().__init__(text)
        self.diagnostics = diagnostics  #: every fault and warning, in the order found

    @property
    def _first(self) -> Diagnostic:
        errors = [one for one in self.diagnostics if one.severity == "error"]
        return (errors or list(self.diagnostics) or [Diagnostic("error", str(self), "", 0, 0)])[0]

    @property
    def message(self) -> str:
        """The first fault, without its place."""
        return self._first.message

    @property
    def file(self) -> str:
        return self._first.file

    @property
    def line(self) -> int:
        return self._first.line

    @property
    def column(self) -> int:
        return self._first.column


class UsageError(Error, ValueError):
    """A wrong argument, or a value out of its range."""

    kind = "usage"


class DocumentError(Error):
    """A look, manifest, profile or capture.json does not parse or does not fit its effects."""

    kind = "document"


class CaptureError(Error):
    """A file of pixels cannot be read, or an image that the look needs is missing or unfit."""

    kind = "capture"


class GlError(Error):
    """No usable GL."""

    kind = "gl"


class EffectError(Error):
    """A shader, a plug-in or a pass failed."""

    kind = "effect"


class OutputError(Error, OSError):
    """A file cannot be written."""

    kind = "output"

    def __str__(self) -> str:
        return str(self.args[0])


class OutOfMemoryError(Error, MemoryError):
    """Memory ran out; the host is closed then."""

    kind = "memory"


class RenderInterrupted(Error):
    """A stop was requested."""

    kind = "interrupted"


_CLASSES: dict[str, type[Error]] = {
    one.kind: one
    for one in (UsageError, DocumentError, CaptureError, GlError, EffectError, OutputError, OutOfMemoryError, RenderInterrupted)
}


def exception(kind: str, text: str, diagnostics: list[dict[str, Any]]) -> Error:
    """The exception for an error of the host API; called by the extension."""
    return _CLASSES.get(kind, Error)(text, tuple(Diagnostic(**one) for one in diagnostics))
