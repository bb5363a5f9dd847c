"""Where sss_adaptive's samples go, what guiding saves, and what it is worth on Cycles' head; part of `scripts/quality sss-adaptive`."""
import numpy

from measure.measures import LUMINANCE, Array, luminance_psnr_db, scale_of
from measure.pages import Rows
from measure.sss_sequences import run, scene_capture, scene_profile, still
from measure.sss_techniques import HEAD_PROFILE, REFERENCE, WORK, cycles_head, cycles_light, incoming, scatter, scattering
from measure.tree import CAPTURES, Document


def block_rmse(error: Array, where: Array, side: int = 8) -> float:
    worst = []
    for y in range(0, error.shape[0] - side + 1, side):
        for x in range(0, error.shape[1] - side + 1, side):
            inside = where[y:y + side, x:x + side]
            if inside.all():
                worst.append(float(numpy.sqrt((error[y:y + side, x:x + side] ** 2).mean())))
    return max(worst)


def at_equal_count() -> Rows:
    capture, profile = scene_capture("shadow_edge", "1"), scene_profile("shadow_edge")
    file = WORK / "shadow_edge_small/gbuffer_0001.exr"
    exact = scatter(capture, WORK / "shadow_edge_small_exact.exr", REFERENCE, profile, {"object_ids": [1]})
    frames, rows = 24, []
    sequence = still(file, "native", frames)
    for controller in ("ratio", "sqrt", "difference"):
        result = run(f"equal_{controller}", sequence, profile, {"controller": controller, "guiding": False, "prefilter": False, "target": "absolute",
                                                                "target_variance": 0.0003, "max_samples": 256}, frames)
        where = result["history"][-1][..., 3] > 0
        mean = float(result["estimate"][-8:, ..., 3][:, where].mean())
        fixed = run(f"fixed_{controller}", sequence, profile, {"samples": max(1, round(mean))}, frames, "sss_burley", ())["irradiance"]
        worst = [numpy.mean([block_rmse((pictures[i] - exact) @ LUMINANCE, where) for i in range(frames - 8, frames)])
                 for pictures in (result["irradiance"], fixed)]
        rows.append([controller, f"{mean:.1f}", f"{worst[0]:.4f}", f"{worst[1]:.4f}", f"{worst[0] / worst[1]:.2f}"])
        print("equal count", rows[-1], flush=True)
    return rows


def with_taa() -> Rows:
    """Standard deviation over frames, of luminance, in all that scatters, in shadow and in even light."""
    profile = scene_profile("shadow_edge")
    scene_capture("shadow_edge", "1")
    file = WORK / "shadow_edge_small/gbuffer_0001.exr"
    frames, rows, deviations = 64, [], {}
    sequence = still(file, "native", frames)
    after: list[Document] = [{"effect": "sss_combine"}, {"effect": "taa", "params": {"static_frames": 10}}]
    for label, params in (("`taa` alone", {"guiding": False}), ("19 frames", {"guiding_weight": 0.1}), ("99 frames", {"guiding_weight": 0.02})):
        color = run("taa", sequence, profile, params, frames, after=after, taps=(),
                    roles="color")["color"]
        deviations[label] = (color[frames // 2:] @ LUMINANCE).std(axis=0)
    light = incoming(file) @ LUMINANCE
    where = scattering(file)
    exact = scatter(WORK / "shadow_edge_small/capture.json", WORK / "shadow_edge_small_exact.exr", REFERENCE, profile, {"object_ids": [1]})
    lit = light > 0.5 * numpy.percentile(light[where], 90)
    changed = numpy.abs(exact @ LUMINANCE - light) > 0.02 * numpy.percentile(light[where], 90)
    areas = {"shadow and its edge": where & (~lit | changed), "even light": where & lit & ~changed}
    for name, area in areas.items():
        alone, *guided = (deviations[l][area].mean() for l in deviations)
        rows.append([name, f"{alone:.5f}", *(text for d in guided for text in (f"{d:.5f}", f"{alone / d:.1f}"))])
        print("guiding", rows[-1], flush=True)
    return rows


def on_head() -> Rows:
    file = CAPTURES / "head/gbuffer_0001.exr"
    before, where = cycles_light(file), cycles_head(file)
    scale = scale_of(before, where)
    sequence, frames, rows = still(file, "blender", 16), 16, []
    exact = scatter(sequence, WORK / "head_exact_still.exr", REFERENCE, HEAD_PROFILE, {"object_ids": [1]}, ["--frames", "1"])
    fixed = run("head_fixed", sequence, HEAD_PROFILE, {"samples": 64}, frames, "sss_burley", ())["irradiance"]
    rows.append(["`sss_burley`, 64 samples", "64", f"{luminance_psnr_db(exact, fixed[-1], where, scale):.2f}"])
    for label, params in (("no guiding, target 0.003", {"guiding": False}), ("guiding, target 0.003", {}),
                          ("guiding, target 0.001", {"target_variance": 0.001}), ("guiding, target 0.0003", {"target_variance": 0.0003})):
        result = run("head", sequence, HEAD_PROFILE, params, frames)
        mean = result["estimate"][-1][..., 3][where].mean()
        rows.append([label, f"{mean:.1f}", f"{luminance_psnr_db(exact, result['irradiance'][-1], where, scale):.2f}"])
        print("head", rows[-1], flush=True)
    return rows
