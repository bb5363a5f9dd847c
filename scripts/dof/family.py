"""What scripts/quality-dof, scripts/bench-dof and tests/bench/dof-against-blender share: the effects of the depth-of-field
family that this tree has, EXR in and out, and the measures of docs/measures.md in numpy, independent of the C++ ones."""
import json
import os
import pathlib
import subprocess

import numpy
import OpenEXR

ROOT = pathlib.Path(__file__).resolve().parents[2]
AFTERSHADE = pathlib.Path(os.environ.get("AFTERSHADE", ROOT / "build/release/aftershade"))
CAPTURES = pathlib.Path(os.environ.get("AFTERSHADE_CAPTURES", ROOT / "../shared/captures"))
# In the order of the documents; what is not in effects/ yet is left out.
FAMILY = ["dof_simple", "bokeh", "bokeh_gather", "dof_scatter", "bokeh_hexagon", "bokeh_disk", "dof_layered", "dof"]


class Effect:
    def __init__(self, folder):
        self.id = folder.name
        self.manifest = json.loads((folder / "effect.json").read_text())
        self.params = self.manifest["params"]

    def with_blades(self, blades):
        """Parameters of an aperture with so many blades; None where the effect cannot have it."""
        if "blades" in self.params:
            highest = self.params["blades"].get("max", 12)
            return {"blades": blades} if blades <= highest else None
        if "shape" in self.params:
            shape = {4: "square", 6: "hexagon", 8: "octagon"}.get(blades)
            return {"shape": shape} if shape in self.params["shape"]["values"] else None
        return {} if blades == 6 and "hexagon" in self.id else None

    def closest_to_hexagon(self):
        return self.with_blades(6) or {}


def effect_folders():
    extra = os.environ.get("AFTERSHADE_EFFECTS", "")
    return [pathlib.Path(p) for p in extra.split(":") if p] + [ROOT / "effects"]


def effects():
    found = {}
    for folder in effect_folders():
        for name in FAMILY:
            if name not in found and (folder / name / "effect.json").exists():
                found[name] = Effect(folder / name)
    return [found[name] for name in FAMILY if name in found]


def run_effect(effect, capture, out, params, work, frame=None):
    """The effect's picture of one capture file, or of one frame of a sequence, RGB float32."""
    look = pathlib.Path(work) / f"{effect}.json"
    look.write_text(json.dumps({"aftershade": 1, "steps": [{"effect": effect, "params": params}]}))
    paths = [word for folder in effect_folders()[:-1] for word in ("--effect-path", str(folder))]
    command([AFTERSHADE, "run", look, capture, "-o", out, "--pixel-type", "float", "--compression", "none",
             "--progress", "none", "--backend", "software", "--no-journal", *(["--frames", frame] if frame else []), *paths])
    return read_exr(out, ["R", "G", "B"])


def command(words, **more):
    result = subprocess.run([str(w) for w in words], capture_output=True, text=True, cwd=ROOT, **more)
    if result.returncode:
        raise SystemExit(f"{' '.join(map(str, words))}\nended with {result.returncode}:\n{result.stderr}")
    return result.stdout


def read_exr(path, names):
    """H x W x channels, float32; one name gives H x W."""
    with OpenEXR.File(str(path), separate_channels=True) as file:
        channels = file.channels()
        planes = [numpy.asarray(channels[name].pixels, dtype=numpy.float32) for name in names]
    return planes[0] if len(names) == 1 else numpy.stack(planes, axis=-1)


def write_exr(path, channels, compression=OpenEXR.NO_COMPRESSION):
    """float32 or float16 planes by channel name."""
    planes = {name: numpy.ascontiguousarray(plane) for name, plane in channels.items()}
    OpenEXR.File({"compression": compression, "type": OpenEXR.scanlineimage}, planes).write(str(path))


def srgb(linear):
    v = numpy.clip(linear.astype(numpy.float64), 0, 1)
    return numpy.where(v <= 0.0031308, 12.92 * v, 1.055 * numpy.maximum(v, 0.0031308) ** (1 / 2.4) - 0.055)


def psnr_db(truth, picture, where=None):
    """docs/measures.md: clamped, piecewise sRGB, no 8-bit step, mean over all pixels (or `where`) and R, G, B."""
    error = (srgb(truth) - srgb(picture)) ** 2
    mse = error.mean() if where is None else error[where].mean() if where.any() else float("nan")
    return float("inf") if mse == 0 else float(-10 * numpy.log10(mse))


def polygon_corners(blades, radius, near):
    """Circumradius `radius`, the middle of a straight edge at +x (y down); turned by 180 degrees in front of the focus."""
    angles = (2 * numpy.arange(blades) + 1) * numpy.pi / blades + (numpy.pi if near else 0)
    return numpy.stack([numpy.cos(angles), numpy.sin(angles)], axis=-1) * radius


def polygon_coverage(blades, radius, near, size, samples=32):
    """Of each pixel of a size x size picture by a polygon around its middle pixel, by counting samples a side."""
    at = (numpy.arange(size * samples) + 0.5) / samples - 0.5 - size // 2
    inside = numpy.ones((size * samples, size * samples), dtype=bool)
    corners = polygon_corners(blades, radius, near)
    for a, b in zip(corners, numpy.roll(corners, -1, axis=0)):
        inside &= (b[0] - a[0]) * (at[:, None] - a[1]) - (b[1] - a[1]) * (at[None, :] - a[0]) >= 0
    return inside.reshape(size, samples, size, samples).mean(axis=(1, 3))


def iou(a, b):
    return float((a & b).sum() / (a | b).sum())


def coc_px(depth_m, focus_m, focal_mm, f_number, sensor_mm, width_px):
    """Signed radius of lens_model pinhole: A f / S1 * (S2 - S1) / S2 / 2, negative in front of the focus."""
    at_infinity = 0.5 * focal_mm / f_number * focal_mm / (focus_m * 1000) * width_px / sensor_mm
    with numpy.errstate(divide="ignore", invalid="ignore"):
        return at_infinity * numpy.where(numpy.isinf(depth_m), 1.0, (depth_m - focus_m) / depth_m)
