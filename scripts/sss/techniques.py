"""What scripts/quality-sss and scripts/bench-sss share: the techniques that this tree has, how to run them, and the measure."""
import json
import pathlib

import numpy

from family import AFTERSHADE, ROOT, command, read_exr

# Label, effect, parameters; what is not in effects/ is left out. EXACT is what the others are measured against.
EXACT = ("sss_exact", "sss_exact", {})
ALL = [
    EXACT,
    ("sss_exact, axes", "sss_exact", {"geometry": "axes"}),
    ("sss_exact, normalize all", "sss_exact", {"normalize": "all"}),
    ("sss_burley, 16 samples", "sss_burley", {"samples": 16}),
    ("sss_burley, 64 samples", "sss_burley", {"samples": 64}),
    ("sss_burley, 256 samples", "sss_burley", {"samples": 256}),
    ("sss_burley, 64 samples, axes", "sss_burley", {"samples": 64, "geometry": "axes"}),
    ("sss_burley, 64 samples, normalize all", "sss_burley", {"samples": 64, "normalize": "all"}),
    ("sss_burley, 64 samples, channels", "sss_burley", {"samples": 64, "sampling": "channels"}),
    ("sss_burley, 64 samples, widest_fit", "sss_burley", {"samples": 64, "sampling": "widest_fit"}),
    ("sss_separable, preintegrated", "sss_separable", {"kernel": "preintegrated"}),
    ("sss_separable, preintegrated, 63 samples", "sss_separable", {"kernel": "preintegrated", "samples": 63}),
    ("sss_separable, gaussian_fit", "sss_separable", {"kernel": "gaussian_fit"}),
    ("sss_separable, artist", "sss_separable", {"kernel": "artist"}),
    ("sss_gaussian", "sss_gaussian", {}),
    ("sss_preintegrated", "sss_preintegrated", {}),
]
LUMINANCE = numpy.array([0.2126, 0.7152, 0.0722])


def present(techniques=ALL):
    return [t for t in techniques if (ROOT / "effects" / t[1] / "effect.json").exists()]


def scatter(capture, out, technique, profile, more=(), options=()):
    """Irradiance of the first frame of a capture, RGB float64; made once for each name of `out`."""
    _, effect, params = technique
    out = pathlib.Path(out)
    if not out.exists():
        look = out.with_suffix(".json")
        look.write_text(json.dumps({"aftershade": 1, "steps": [
            {"effect": effect, "params": {"scattering_profile": profile} | dict(more) | params}]}))
        command([AFTERSHADE, "run", look, capture, "-o", out, "--output-roles", "irradiance", "--pixel-type", "float",
                 "--compression", "none", "--progress", "none", "--backend", "software", *options])
    return read_exr(out, [f"irradiance.{c}" for c in "RGB"]).astype(numpy.float64)


def scale_of(unscattered, where):
    """Light is scaled so that the 90th percentile of what does not scatter yet, of all channels, is a half."""
    return 0.5 / numpy.percentile(unscattered[where], 90)


def psnr_db(truth, picture, where, scale):
    """docs/measures.md: of luminance over the scattering pixels alone; both clamped to 0..1 after the scale."""
    error = (numpy.clip(truth[where] * scale, 0, 1) - numpy.clip(picture[where] * scale, 0, 1)) @ LUMINANCE
    mse = float((error**2).mean())
    return float("inf") if mse == 0 else -10 * numpy.log10(mse)
