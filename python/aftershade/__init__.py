"""Chains of shader effects over frames with depth, motion vectors and more, on OpenGL, without a display.

    import aftershade

    look = aftershade.Look("bokeh.json")
    look["bokeh.f_number"] = 2.0
    result = look.render("frame_0001.exr")
    result["color"]             # a NumPy array, float32, (height, width, 4)
    result.write("out.exr")
"""

from ._capture import Capture, Sequence
from ._compare import Comparison, Layer, compare
from ._errors import (
    CaptureError,
    Diagnostic,
    DocumentError,
    EffectError,
    Error,
    GlError,
    OutOfMemoryError,
    OutputError,
    RenderInterrupted,
    UsageError,
)
from ._host import Effect, Host, Param, Port, default_host
from ._look import Look, Params, Result, Session
from ._native import library_version
from ._velocity import VelocityCheck, VelocitySettings, check_velocity

__version__ = library_version()


def effects() -> list[Effect]:
    """Every shipped effect, sorted by id."""
    return default_host().effects()


__all__ = [
    "Capture",
    "CaptureError",
    "Comparison",
    "Diagnostic",
    "DocumentError",
    "Effect",
    "EffectError",
    "Error",
    "GlError",
    "Host",
    "Layer",
    "Look",
    "OutOfMemoryError",
    "OutputError",
    "Param",
    "Params",
    "Port",
    "RenderInterrupted",
    "Result",
    "Sequence",
    "Session",
    "UsageError",
    "VelocityCheck",
    "VelocitySettings",
    "check_velocity",
    "compare",
    "default_host",
    "effects",
    "__version__",
]
