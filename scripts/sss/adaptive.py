"""Makes docs/quality-sss-adaptive.md and its plots; started by scripts/quality-sss-adaptive, which says what it needs."""
import json
import shutil

import matplotlib
import numpy

matplotlib.use("svg")
from matplotlib import pyplot

from family import AFTERSHADE, CAPTURES, ROOT, command, read_exr
from quality import HEAD_PROFILE, WORK, table
from techniques import EXACT, LUMINANCE, psnr_db, scale_of, scatter

IMAGES = ROOT / "docs/images/sss"
TEXTS = ROOT / "scripts/sss"
SIZE = "240x135"
VARIATES = ["none", "constant", "online"]
RGB = "RGB"


def scene_profile(scene):
    text = "\n".join(l for l in (ROOT / "scenes" / scene / "scene.json").read_text().splitlines() if not l.lstrip().startswith("//"))
    materials = json.loads(text)["materials"].values()
    return next(m["scattering_profile"] for m in materials if "scattering_profile" in m)


def scene_capture(scene, frames):
    folder = WORK / f"{scene}_small"
    if not (folder / "capture.json").exists():
        command([AFTERSHADE, "render", ROOT / "scenes" / scene, "-o", folder, "--size", SIZE, "--frames", frames, "--quiet"])
    return folder / "capture.json"


def still(file, profile, frames):
    """A sequence whose frames are all one file."""
    folder = WORK / f"still_{file.parent.name}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for i in range(1, frames + 1):
        (folder / f"gbuffer_{i:04}.exr").symlink_to(file.resolve())
    document = folder / "capture.json"
    document.write_text(json.dumps({"aftershade": 1, "frames": "gbuffer_####.exr", "range": f"1-{frames}", "fps": 24, "profile": profile}))
    return document


# Textures of fewer than four channels.
TAP_CHANNELS = {"sampled": ["Y"], "tile_class": ["R", "G"], "tile_range": ["Y"]}


def run(name, capture, profile, params, frames, effect="sss_adaptive", taps=("estimate", "history", "plan"), after=(), roles="irradiance"):
    """Pictures and taps of all frames: {"irradiance": frames x h x w x 3, "estimate": ... x 4}."""
    folder = WORK / "adaptive" / name
    folder.mkdir(parents=True, exist_ok=True)
    look = folder / "look.json"
    look.write_text(json.dumps({"aftershade": 1, "steps": [
        {"effect": effect, "params": {"scattering_profile": profile, "object_ids": [1]} | params}, *after]}))
    words = [AFTERSHADE, "run", look, capture, "--frames", f"1-{frames}", "-o", folder / "out_####.exr", "--output-roles", roles,
             "--pixel-type", "float", "--compression", "none", "--progress", "none", "--backend", "osmesa"]
    for tap in taps:
        words += ["--tap", f"{effect}.{tap}"]
    command(words)
    names = [f"irradiance.{c}" for c in RGB] if roles == "irradiance" else list(RGB)
    result = {roles: numpy.stack([read_exr(folder / f"out_{i:04}.exr", names) for i in range(1, frames + 1)])}
    for tap in taps:
        result[tap] = numpy.stack([read_exr(folder / f"out.{effect}.{tap}.{i:04}.exr", TAP_CHANNELS.get(tap, list("RGBA")))
                                   for i in range(1, frames + 1)])
    shutil.rmtree(folder)
    return result


def telemetry(result, frame):
    """What a frame cost and knows, of the pixels that scatter."""
    where = result["history"][frame][..., 3] > 0
    counts = result["estimate"][frame][..., 3][where]
    return {"frame": frame + 1, "samples": {"mean": float(counts.mean()), "max": float(counts.max()),
                                            "histogram": numpy.histogram(counts, bins=range(0, 73, 8))[0].tolist()},
            "with_history": float((result["plan"][frame][..., 1][where] > 0).mean()),
            "deviation": float(result["history"][frame][..., 1][where].mean())}


# ---- light that changes ----

def under_changing_light(scene, title):
    capture, profile = scene_capture(scene, "1-24"), scene_profile(scene)
    figure, axes = pyplot.subplots(figsize=(5.4, 3))
    rows, told, reference = [], {}, None
    for variate in VARIATES:
        result = run(f"{scene}_{variate}", capture, profile, {"control_variate": variate}, 24)
        frames = [telemetry(result, i) for i in range(24)]
        told[variate] = frames
        means = [f["samples"]["mean"] for f in frames]
        axes.plot(range(1, 25), means, marker="o", markersize=2.5, linewidth=1.2, label=variate)
        if reference is None:
            reference = run(f"{scene}_reference", capture, profile, {"samples": 1024}, 24, "sss_burley", ())["irradiance"]
            where = result["history"][0][..., 3] > 0
            scale = scale_of(reference[1], where)
        db = [psnr_db(reference[i], result["irradiance"][i], where, scale) for i in range(24)]
        # From where history has settled; both scenes change for the first time after frame 6.
        rows.append([variate, f"{max(means[6:]):.1f}", f"{numpy.mean(means[6:]):.1f}", f"{min(db[6:]):.2f}", f"{numpy.mean(db[6:]):.2f}"])
        print(scene, rows[-1], flush=True)
    axes.set(xlabel="frame", ylabel="samples a pixel, mean", title=title, ylim=(0, None))
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8, title="control_variate", title_fontsize=8)
    figure.tight_layout()
    figure.savefig(IMAGES / f"adaptive_{scene}.svg", metadata={"Date": None})
    (WORK / f"telemetry_{scene}.json").write_text(json.dumps(told, indent=1))
    return rows


# ---- where samples go ----

def block_rmse(error, where, side=8):
    worst = []
    for y in range(0, error.shape[0] - side + 1, side):
        for x in range(0, error.shape[1] - side + 1, side):
            inside = where[y:y + side, x:x + side]
            if inside.all():
                worst.append(float(numpy.sqrt((error[y:y + side, x:x + side] ** 2).mean())))
    return max(worst)


def at_equal_count():
    capture, profile = scene_capture("shadow_edge", "1"), scene_profile("shadow_edge")
    file = WORK / "shadow_edge_small/gbuffer_0001.exr"
    exact = scatter(capture, WORK / "shadow_edge_small_exact.exr", EXACT, profile, {"object_ids": [1]})
    frames, rows = 24, []
    sequence = still(file, "native", frames)
    for controller in ("ratio", "sqrt", "difference"):
        result = run(f"equal_{controller}", sequence, profile, {"controller": controller, "guiding": False, "prefilter": False,
                                                                "target_variance": 0.0003, "max_samples": 256}, frames)
        where = result["history"][-1][..., 3] > 0
        mean = float(result["estimate"][-8:, ..., 3][:, where].mean())
        fixed = run(f"fixed_{controller}", sequence, profile, {"samples": max(1, round(mean))}, frames, "sss_burley", ())["irradiance"]
        worst = [numpy.mean([block_rmse((pictures[i] - exact) @ LUMINANCE, where) for i in range(frames - 8, frames)])
                 for pictures in (result["irradiance"], fixed)]
        rows.append([controller, f"{mean:.1f}", f"{worst[0]:.4f}", f"{worst[1]:.4f}", f"{worst[0] / worst[1]:.2f}"])
        print("equal count", rows[-1], flush=True)
    return rows


# ---- guiding ----

def with_taa():
    """Standard deviation over frames, of luminance, in all that scatters, in shadow and in even light."""
    profile = scene_profile("shadow_edge")
    scene_capture("shadow_edge", "1")
    file = WORK / "shadow_edge_small/gbuffer_0001.exr"
    frames, rows, deviations = 64, [], {}
    sequence = still(file, "native", frames)
    after = [{"effect": "sss_combine"}, {"effect": "taa", "params": {"static_frames": 10}}]
    for label, params in (("`taa` alone", {"guiding": False}), ("guiding and `taa`", {"guiding": True, "guiding_weight": 0.1})):
        color = run(f"taa_{params['guiding']}", sequence, profile, params | {"target_variance": 0.001}, frames, after=after, taps=(),
                    roles="color")["color"]
        deviations[label] = (color[frames // 2:] @ LUMINANCE).std(axis=0)
    light = read_exr(file, [f"irradiance.{c}" for c in RGB]) @ LUMINANCE
    where = read_exr(file, ["object_id.I"]) == 1
    exact = scatter(WORK / "shadow_edge_small/capture.json", WORK / "shadow_edge_small_exact.exr", EXACT, profile, {"object_ids": [1]})
    lit = light > 0.5 * numpy.percentile(light[where], 90)
    changed = numpy.abs(exact @ LUMINANCE - light) > 0.02 * numpy.percentile(light[where], 90)
    areas = {"shadow and its edge": where & (~lit | changed), "even light": where & lit & ~changed}
    for name, area in areas.items():
        alone, guided = (deviations[l][area].mean() for l in deviations)
        rows.append([name, f"{alone:.5f}", f"{guided:.5f}", f"{alone / guided:.1f}"])
        print("guiding", rows[-1], flush=True)
    return rows


# ---- Cycles' head ----

def on_head():
    file = CAPTURES / "head/gbuffer_0001.exr"
    names = lambda kind: [f"ViewLayer.{kind}.{c}" for c in RGB]
    before = sum(read_exr(file, names(kind)).astype(numpy.float64) for kind in ("DiffDir", "DiffInd"))
    where = numpy.round(read_exr(file, ["ViewLayer.IndexOB.X"])) == 1
    scale = scale_of(before, where)
    sequence, frames, rows = still(file, "blender", 16), 16, []
    exact = scatter(sequence, WORK / "head_exact_still.exr", EXACT, HEAD_PROFILE, {"object_ids": [1]}, ["--frames", "1"])
    fixed = run("head_fixed", sequence, HEAD_PROFILE, {"samples": 64}, frames, "sss_burley", ())["irradiance"]
    rows.append(["`sss_burley`, 64 samples", "64", f"{psnr_db(exact, fixed[-1], where, scale):.2f}"])
    for label, params in (("as published: no guiding, target 0.001", {"guiding": False}), ("guiding, target 0.001", {}),
                          ("guiding, target 0.0005", {"target_variance": 0.0005}), ("guiding, target 0.0003", {"target_variance": 0.0003})):
        result = run("head", sequence, HEAD_PROFILE, params, frames)
        mean = result["estimate"][-1][..., 3][where].mean()
        rows.append([label, f"{mean:.1f}", f"{psnr_db(exact, result['irradiance'][-1], where, scale):.2f}"])
        print("head", rows[-1], flush=True)
    return rows


def main():
    for folder in WORK, IMAGES:
        folder.mkdir(parents=True, exist_ok=True)
    word = lambda name: (TEXTS / f"adaptive-{name}.md").read_text() + "\n"
    changing = ["control_variate", "samples, peak", "mean", "worst frame, dB", "mean, dB"]
    parts = [word("head"),
             word("light") + table(changing, under_changing_light("light_toggle", "light_toggle: a tenth of the light from 9 to 16")) +
             "\n" + table(changing, under_changing_light("light_flash", "light_flash: flashes at 7, 13 and 19")),
             word("count") + table(["controller", "samples, mean", "adaptive", "fixed", "ratio"], at_equal_count()),
             word("guiding") + table(["", "`taa` alone", "guiding and `taa`", "ratio"], with_taa()),
             word("cycles") + table(["", "samples, mean", "`sss_exact`, dB"], on_head())]
    (ROOT / "docs/quality-sss-adaptive.md").write_text("\n".join(parts))


if __name__ == "__main__":
    main()
