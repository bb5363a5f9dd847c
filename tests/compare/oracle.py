"""Figures of other people's tools for pairs of pictures, as JSON on stdout: python oracle.py FOLDER

FOLDER holds <pair>.ref.exr and <pair>.test.exr (scene-linear RGB floats), or .png (8 bits). FLIP is NVIDIA's
flip-evaluator, SSIM scikit-image's; MS-SSIM is put together from SciPy's Gaussian filter by Wang, Simoncelli and Bovik
2003; errors are those of OpenImageIO's idiff, where it is installed.
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys

import flip_evaluator
import numpy as np
from PIL import Image
from scipy.ndimage import gaussian_filter
from skimage.metrics import structural_similarity

WEIGHTS = (0.0448, 0.2856, 0.3001, 0.2363, 0.1333)
IDIFF = {"mean": r"Mean error = (\S+)", "rms": r"RMS error = (\S+)", "max": r"Max error  = (\S+)"}


# FLIP's parameters other than its own, of the pairs named here.
VARIANTS = {
    "far": {"ppd": 110.0},
    "reinhard": {"tonemapper": "reinhard"},
    "hable": {"tonemapper": "hable"},
    "exposed": {"startExposure": -1.0, "stopExposure": 2.0, "numExposures": 5},
}
WITH_VARIANTS = ("ldr_room_shifted", "hdr_sun_noisy", "hdr_blender_frames")


def flip(reference, test, dynamic_range, parameters):
    error, _, used = flip_evaluator.evaluate(
        reference, test, dynamic_range, applyMagma=False, parameters=dict(parameters))
    # Its own mean is a sum in single precision.
    figures = {"mean": float(np.asarray(error, np.float64).mean()), "max": float(np.asarray(error).max())}
    if dynamic_range == "HDR":
        figures |= {"start": used["startExposure"], "stop": used["stopExposure"], "exposures": used["numExposures"]}
    return figures


def encoded(path):
    if path.suffix == ".png":
        return np.asarray(Image.open(path), np.float64)[..., :3] / 255
    linear = np.clip(np.asarray(flip_evaluator.load(str(path)), np.float64), 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def local_means(a, b):
    def mean(x):
        return gaussian_filter(x, 1.5, truncate=3.5)[5:-5, 5:-5]

    ma, mb = mean(a), mean(b)
    va, vb, cov = mean(a * a) - ma * ma, mean(b * b) - mb * mb, mean(a * b) - ma * mb
    contrast = (2 * cov + 9e-4) / (va + vb + 9e-4)
    return contrast.mean(), (contrast * (2 * ma * mb + 1e-4) / (ma * ma + mb * mb + 1e-4)).mean()


def ms_ssim(a, b):
    if min(a.shape[:2]) < 176:
        return None
    products = []
    for c in range(3):
        x, y, product = a[..., c], b[..., c], 1.0
        for scale, weight in enumerate(WEIGHTS):
            contrast, ssim = local_means(x, y)
            product *= max(ssim if scale == 4 else contrast, 0) ** weight
            h, w = x.shape[0] // 2 * 2, x.shape[1] // 2 * 2
            x, y = ((z[:h:2, :w:2] + z[1:h:2, :w:2] + z[:h:2, 1:w:2] + z[1:h:2, 1:w:2]) / 4 for z in (x, y))
        products.append(product)
    return float(np.mean(products))


def idiff(reference, test):
    if not shutil.which("idiff"):
        return None
    # The short report comes for differences alone.
    text = subprocess.run(["idiff", "-v", reference, test], capture_output=True, text=True).stdout
    found = {name: re.search(pattern, text) for name, pattern in IDIFF.items()}
    return {name: float(match[1]) if match else 0.0 for name, match in found.items()}


def figures(reference, test):
    r, t = str(reference), str(test)
    a, b = encoded(reference), encoded(test)
    kind = "LDR" if reference.suffix == ".png" else "HDR"
    result = {"flip": {"default": flip(r, t, kind, {})}, "idiff": idiff(r, t), "ms_ssim": ms_ssim(a, b)}
    if reference.name.split(".")[0] in WITH_VARIANTS:
        for name, parameters in VARIANTS.items():
            if kind == "HDR" or name == "far":
                result["flip"][name] = flip(r, t, kind, parameters)
    result["ssim"] = float(structural_similarity(
        a, b, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=1, channel_axis=-1))
    return result


if __name__ == "__main__":
    pairs = sorted(p for p in pathlib.Path(sys.argv[1]).iterdir() if ".ref." in p.name)
    if not pairs:
        sys.exit(f"{sys.argv[1]}: no <pair>.ref.* in it")
    json.dump({p.name.split(".")[0]: figures(p, p.with_name(p.name.replace(".ref.", ".test."))) for p in pairs}, sys.stdout, indent=1)
    print()
