"""Holds the effects of OpenColorIO to the CPU processor of PyPI's OpenColorIO, on each software backend."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy
import PyOpenColorIO as ocio

from measure.exr import RGB, read_exr, write_exr
from measure.measures import Array
from measure.ocio_bake import PATCHES, applied

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("AFTERSHADE", str(ROOT / "build/release/aftershade"))
BUILTIN = ROOT / "framework/color/builtin.ocio"
DISPLAY_LIMIT, LINEAR_LIMIT = 1 / 1023, 1e-3
BACKENDS = ("osmesa", "egl-software")
CLF = """<ProcessList compCLFversion="3" id="steps">
<Matrix inBitDepth="32f" outBitDepth="32f"><Array dim="3 3">0.8 0.2 0 0.1 0.9 0 0 0.1 0.9</Array></Matrix>
<Log inBitDepth="32f" outBitDepth="32f" style="linToLog"><LogParams base="2" linSideSlope="1" linSideOffset="0.01"
logSideSlope="0.1" logSideOffset="0.7"/></Log></ProcessList>"""
CC = """<ColorCorrection id="day"><SOPNode><Slope>1.2 1 0.9</Slope><Offset>0 0.01 0</Offset><Power>1 1.1 0.9</Power></SOPNode>
<SatNode><Saturation>0.7</Saturation></SatNode></ColorCorrection>"""


def light() -> Array:
    """A ramp over 24 stops in grey and red, the chart at four exposures, and Suzanne; linear Rec. 709."""
    ramp = numpy.repeat(2.0 ** numpy.linspace(-16, 8, 96)[:, None], 3, 1)
    chart = numpy.repeat(numpy.concatenate([numpy.asarray(PATCHES)] * 4), 1, 0) * numpy.repeat(2.0 ** numpy.arange(-3, 5, 2), 24)[:, None]
    suzanne = read_exr(ROOT / "scenes/suzanne/gbuffer_0003.exr", [f"ViewLayer.Combined.{c}" for c in RGB])[100:164:2, 200:296]
    rows = numpy.stack([ramp, ramp * [1, 0.3, 0.3], chart])
    return numpy.concatenate([rows, suzanne]).astype(numpy.float32)


def write_luts(folder: pathlib.Path) -> None:
    axis = numpy.linspace(0, 1, 17)
    b, g, r = numpy.meshgrid(axis, axis, axis, indexing="ij")
    cube = numpy.stack([r ** 0.6 * 0.9 + g * b / 10, g ** 0.7, 0.05 + b * (1 - r / 2)], -1).reshape(-1, 3)
    (folder / "cube.cube").write_text("LUT_3D_SIZE 17\n" + "\n".join(" ".join(f"{v:.7f}" for v in row) for row in cube) + "\n")
    curve = numpy.stack([numpy.linspace(0, 1, 33) ** p for p in (0.5, 0.8, 1)], -1)
    (folder / "curve.cube").write_text("LUT_1D_SIZE 33\n" + "\n".join(" ".join(f"{v:.7f}" for v in row) for row in curve) + "\n")
    (folder / "steps.clf").write_text(CLF)
    (folder / "day.cc").write_text(CC)


def cases(config: ocio.Config, folder: pathlib.Path) -> list[tuple[str, str, dict[str, object], ocio.Processor]]:
    """Name, effect, parameters and the processor that they stand for."""
    found: list[tuple[str, str, dict[str, object], ocio.Processor]] = []
    for display in config.getDisplays():
        for view in config.getViews(display):
            if view == "Raw":
                continue
            transform = ocio.DisplayViewTransform(src="Linear Rec.709 (sRGB)", display=display, view=view)
            found.append((f"{view} on {display}", "ocio_view", {"display": display, "view": view}, config.getProcessor(transform)))
    look = ocio.GroupTransform([
        ocio.LookTransform(src="Linear Rec.709 (sRGB)", dst="ACES2065-1", looks="ACES 1.3 Reference Gamut Compression"),
        ocio.DisplayViewTransform(src="ACES2065-1", display="sRGB - Display", view="Un-tone-mapped")])
    found.append(("look before a view", "ocio_view", {"view": "Un-tone-mapped", "looks": "ACES 1.3 Reference Gamut Compression"},
                  config.getProcessor(look)))
    for space in ("ACES2065-1", "ACEScg", "ACEScct", "ACEScc", "sRGB - Texture"):
        found.append((f"to {space}", "color_convert", {"destination": space}, config.getProcessor("Linear Rec.709 (sRGB)", space)))
    for name in ("cube.cube", "curve.cube", "steps.clf", "day.cc"):
        for inverse in (False, True):
            transform = ocio.FileTransform(src=str(folder / name), interpolation=ocio.INTERP_BEST)
            direction = ocio.TRANSFORM_DIR_INVERSE if inverse else ocio.TRANSFORM_DIR_FORWARD
            found.append((name + (", inverse" if inverse else ""), "ocio_file_transform", {"file": name, "inverse": inverse},
                          config.getProcessor(transform, direction)))
    return found


def drawn(folder: pathlib.Path, effect: str, params: dict[str, object], backend: str) -> Array:
    look, out = folder / "look.json", folder / f"{backend}.exr"
    look.write_text(json.dumps({"aftershade": 1, "steps": [{"effect": effect, "params": params}]}))
    role = "display" if effect == "ocio_view" else "color"
    words = [PROGRAM, "run", str(look), str(folder / "in.exr"), "-o", str(out), "--output-roles", role, "--pixel-type", "float",
             "--backend", backend]
    environment = {name: value for name, value in os.environ.items() if name != "OCIO"}
    result = subprocess.run(words, capture_output=True, text=True, env=environment)
    if result.returncode != 0:
        sys.exit(f"{' '.join(words)}:\n{result.stderr}")
    return read_exr(out, RGB if role == "color" else [f"display.{c}" for c in RGB])


def main() -> None:
    folder = pathlib.Path(tempfile.mkdtemp())
    write_luts(folder)
    colors = light()
    write_exr(folder / "in.exr", {c: colors[:, :, i] for i, c in enumerate(RGB)})
    failed = 0
    for name, effect, params, processor in cases(ocio.Config.CreateFromFile(str(BUILTIN)), folder):
        images = [drawn(folder, effect, params, backend) for backend in BACKENDS]
        expected = applied(processor, colors).reshape(colors.shape)
        if effect == "ocio_view":
            error, limit = float(numpy.abs(images[0] - numpy.clip(expected, 0, 1)).max()), DISPLAY_LIMIT
        else:
            # The inverse of a logarithm leaves the range of floats.
            finite = numpy.isfinite(expected) & (numpy.abs(expected) < 1e30)
            apart = numpy.abs(numpy.subtract(images[0], expected, where=finite, out=numpy.zeros_like(expected)))
            error, limit = float((apart / numpy.maximum(numpy.abs(expected), 0.01))[finite].max()), LINEAR_LIMIT
        same = numpy.array_equal(images[0], images[1], equal_nan=True)
        failed += not same or not error <= limit
        print(f"{name:60} {error / limit:8.4f} of the limit, {'equal' if same else 'other'} bits on both backends", flush=True)
    print("1 is 1/1023 of display values; of linear ones 0.001 of the value, or of 0.01 where the value is smaller")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
