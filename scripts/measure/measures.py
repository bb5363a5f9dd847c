"""The measures of docs/measures.md in numpy, independent of the C++ ones. measures_test.py holds them to closed forms."""
from typing import Any

import numpy

Array = numpy.ndarray[Any, numpy.dtype[Any]]
LUMINANCE = numpy.array([0.2126, 0.7152, 0.0722])


def srgb(linear: Array) -> Array:
    v = numpy.clip(linear.astype(numpy.float64), 0, 1)
    return numpy.where(v <= 0.0031308, 12.92 * v, 1.055 * numpy.maximum(v, 0.0031308) ** (1 / 2.4) - 0.055)


def bytes_of(linear: Array) -> Array:
    """8-bit sRGB."""
    return numpy.round(255 * srgb(linear)).astype(numpy.uint8)


def decibels(squared_error: Array) -> float:
    mse = float(squared_error.mean()) if squared_error.size else float("nan")
    return float("inf") if mse == 0 else float(-10 * numpy.log10(mse))


def psnr_db(truth: Array, picture: Array, where: Array | None = None) -> float:
    """docs/measures.md: clamped, piecewise sRGB, no 8-bit step, mean over all pixels (or `where`) and R, G, B."""
    error = (srgb(truth) - srgb(picture)) ** 2
    return decibels(error if where is None else error[where])


def scale_of(unscattered: Array, where: Array) -> float:
    """Light is scaled so that the 90th percentile of what does not scatter yet, of all channels, is a half."""
    return float(0.5 / numpy.percentile(unscattered[where], 90))


def luminance_psnr_db(truth: Array, picture: Array, where: Array, scale: float) -> float:
    """docs/measures.md: of luminance over the scattering pixels alone; both clamped to 0..1 after the scale."""
    error = (numpy.clip(truth[where] * scale, 0, 1) - numpy.clip(picture[where] * scale, 0, 1)) @ LUMINANCE
    return decibels(error**2)


def changed_pixels(sharp: Array, truth: Array) -> Array:
    """docs/measures.md: where the mean over the 18 x 18 window x-8..x+9 of the mean difference as sRGB is above 0.02."""
    difference = numpy.abs(srgb(truth) - srgb(sharp)).mean(axis=-1)
    sums = numpy.pad(numpy.pad(difference, ((8, 9), (8, 9)), mode="edge").cumsum(0).cumsum(1), ((1, 0), (1, 0)))
    return (sums[18:, 18:] - sums[:-18, 18:] - sums[18:, :-18] + sums[:-18, :-18]) / 18**2 > 0.02


def polygon_corners(blades: int, radius: float, near: bool) -> Array:
    """Circumradius `radius`, the middle of a straight edge at +x (y down); turned by 180 degrees in front of the focus."""
    angles = (2 * numpy.arange(blades) + 1) * numpy.pi / blades + (numpy.pi if near else 0)
    return numpy.stack([numpy.cos(angles), numpy.sin(angles)], axis=-1) * radius


def polygon_coverage(blades: int, radius: float, near: bool, size: int, samples: int = 32) -> Array:
    """Of each pixel of a size x size picture by a polygon around its middle pixel, by counting samples a side."""
    at = (numpy.arange(size * samples) + 0.5) / samples - 0.5 - size // 2
    inside = numpy.ones((size * samples, size * samples), dtype=bool)
    corners = polygon_corners(blades, radius, near)
    for a, b in zip(corners, numpy.roll(corners, -1, axis=0)):
        inside &= (b[0] - a[0]) * (at[:, None] - a[1]) - (b[1] - a[1]) * (at[None, :] - a[0]) >= 0
    return inside.reshape(size, samples, size, samples).mean(axis=(1, 3))


def iou(a: Array, b: Array) -> float:
    return float((a & b).sum() / (a | b).sum())


def coc_px(depth_m: Array, focus_m: float, focal_mm: float, f_number: float, sensor_mm: float, width_px: int) -> Array:
    """Signed radius of lens_model pinhole: A f / S1 * (S2 - S1) / S2 / 2, negative in front of the focus."""
    at_infinity = 0.5 * focal_mm / f_number * focal_mm / (focus_m * 1000) * width_px / sensor_mm
    with numpy.errstate(divide="ignore", invalid="ignore"):
        return at_infinity * numpy.where(numpy.isinf(depth_m), 1.0, (depth_m - focus_m) / depth_m)


def near_band(coc: Array) -> Array:
    """Where a near object's blur covers what is behind it: pixels within R of a depth edge whose near side, of radius R, is in front
    of the focus. An edge is where neighbours' CoC differ by more than 1 px and the nearer one's is below -1 px."""
    height, width = coc.shape
    radius = numpy.zeros_like(coc)
    for axis in 0, 1:
        a, b = (coc[:-1], coc[1:]) if axis == 0 else (coc[:, :-1], coc[:, 1:])
        nearer = numpy.minimum(a, b)
        reach = numpy.where((numpy.abs(a - b) > 1) & (nearer < -1), -nearer, 0)
        for part in (radius[:-1], radius[1:]) if axis == 0 else (radius[:, :-1], radius[:, 1:]):
            numpy.maximum(part, reach, out=part)
    band = numpy.zeros(coc.shape, dtype=bool)
    ys, xs = numpy.mgrid[0:height, 0:width]
    for y, x in numpy.argwhere(radius > 0):
        r = radius[y, x]
        low_y, high_y, low_x, high_x = (int(max(v, 0)) for v in (y - r, y + r + 1, x - r, x + r + 1))
        window = (slice(low_y, high_y), slice(low_x, high_x))
        band[window] |= (ys[window] - y) ** 2 + (xs[window] - x) ** 2 <= r * r
    return band


def edge_response(x_over_d: Array) -> Array:
    """Light at x from a straight edge of light: of what Burley's profile sends to distance r, 2 / pi * asin(x / r) lies within x."""
    edges = numpy.linspace(0, 8, 8001) ** 2
    share = numpy.diff(1 - numpy.exp(-edges) / 4 - 0.75 * numpy.exp(-edges / 3))
    radii = 0.5 * (edges[1:] + edges[:-1])
    within = [(share * 2 / numpy.pi * numpy.arcsin(numpy.minimum(1, abs(x) / radii))).sum() for x in x_over_d]
    return 0.5 + 0.5 * numpy.sign(x_over_d) * numpy.array(within)


def modulation(w_d: float) -> float:
    """What Burley's profile leaves of the amplitude of a cosine of light."""
    return float(0.25 / numpy.sqrt(1 + w_d**2) + 0.75 / numpy.sqrt(1 + 9 * w_d**2))
