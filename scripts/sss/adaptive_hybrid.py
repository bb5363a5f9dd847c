"""Samples, blurs, and both by tiles; part of scripts/quality-sss-adaptive."""
import numpy
from PIL import Image

from family import read_exr, srgb
from quality import WORK
from sequences import RGB, run, scene_capture, scene_profile, still
from techniques import LUMINANCE, psnr_db, scale_of, scatter

FRAMES = 48
# With a long average: what each way comes to, rather than its noise.
SETTLED = {"guiding_weight": 0.02}


def seam(picture, exact, sampled, scale):
    """Largest difference between the step over a tile's border, a mean of its 8 px, and the exact one, where a side is not all sampled."""
    error = (picture - exact) @ LUMINANCE * scale
    worst = 0.0
    for turned, share in ((error, sampled), (error.T, sampled.T)):
        rows, columns = (n // 8 * 8 for n in turned.shape)
        for x in range(8, columns, 8):
            jump = (turned[:rows, x] - turned[:rows, x - 1]).reshape(-1, 8).mean(axis=1)
            mixed = (numpy.minimum(share[:rows, x], share[:rows, x - 1]) < 1).reshape(-1, 8).all(axis=1)
            worst = max([worst, *numpy.abs(jump[mixed])])
    return worst


def hybrid(images):
    capture, profile = scene_capture("shadow_edge", "1"), scene_profile("shadow_edge")
    file = capture.parent / "gbuffer_0001.exr"
    # The slab shows all of itself: with normalize all the sum over its pixels, of 2.6 mm, is that of the plane.
    exact = scatter(capture, WORK / "shadow_edge_small_exact_all.exr", ("", "sss_exact", {"normalize": "all"}), profile, {"object_ids": [1]})
    sequence = still(file, "native", FRAMES)
    light = read_exr(file, [f"irradiance.{c}" for c in RGB]).astype(numpy.float64)
    where = read_exr(file, ["object_id.I"]) == 1
    scale = scale_of(light, where)
    rows = []
    for label, params in (("samples: `hybrid` off", {}), ("`hybrid` auto", {"hybrid": "auto"}), ("blurs: `hybrid` separable", {"hybrid": "separable"})):
        result = run("hybrid", sequence, profile, params | SETTLED, FRAMES, taps=("sampled", "estimate") if params else ("estimate",), telemetry=True)
        last = result["irradiance"][-1].astype(numpy.float64)
        told = result["telemetry"][-1]["steps"]["sss_adaptive"]
        tiles = [f"{told[name]['sum']:.0f}" if name in told else "" for name in ("sampled_tiles", "blurred_tiles")]
        at_seams = f"{255 * seam(last, exact, result['sampled'][-1], scale):.2f}" if params else ""
        count = result["estimate"][-8:, ..., 3][:, where].mean()
        rows.append([label, *tiles, f"{count:.1f}", f"{psnr_db(exact, last, where, scale):.2f}", at_seams if "auto" in label else ""])
        print("hybrid", rows[-1], flush=True)
        if "auto" in label:
            picture = numpy.clip(last / numpy.percentile(light[where], 99), 0, 1)
            share = result["sampled"][-1][..., None] * where[..., None]
            classes = numpy.concatenate([share, 0.5 * where[..., None] * numpy.ones_like(share), (1 - share) * where[..., None]], axis=-1)
            counts = numpy.repeat(result["estimate"][-1][..., 3:] / 64, 3, axis=-1)
            pair = numpy.concatenate([srgb(picture), classes, numpy.clip(counts, 0, 1)], axis=1)
            Image.fromarray((255 * pair + 0.5).astype(numpy.uint8)).save(images / "adaptive_hybrid.png")
    return rows
