"""What each effect of the depth-of-field family in effects/ costs on OSMesa: wall time around glFinish of its passes alone, from a
warm program cache, in turns, the median; texel fetches a pixel as counted by its own shaders with a counter in every fetch; at
constant CoC of 16 px far and near, over radius, and over the part of the frame that is out of focus. Prints the figures, draws
docs/images/dof/cost_*.svg and fills the section Cost of docs/quality-dof.md.

    SIZE=1920x1080 REPETITIONS=5 ONLY=bokeh,dof VERBOSE=1
    AFTERSHADE_EFFECTS=A:B     further folders of effects, before this tree's own
"""
import json
import os
from typing import Any

import numpy

from measure.dof_family import FAMILY, Effect, effect_folders, effects, run_effect
from measure.effect_bench import run_bench
from measure.exr import write_exr
from measure.measures import iou, polygon_coverage
from measure.pages import Page, table
from measure.plots import pyplot, save_plot
from measure.tree import ROOT, Document

WORK = ROOT / "build/bench-dof"
IMAGES = ROOT / "docs/images/dof"
SIZE = [int(n) for n in os.environ.get("SIZE", "1920x1080").split("x")]
REPETITIONS = int(os.environ.get("REPETITIONS", "5"))
RADII = [2, 4, 8, 16, 32, 64]
FRACTIONS = [0, 0.1, 0.25, 0.5, 0.75, 1]
FOCUS_M, FOCAL_MM, SENSOR_MM = 2, 200, 36
ENOUGH_IOU = 0.97  # docs/measures.md
SLOW_MS = 8000  # of one frame: such an effect is timed once, far at R = 16 and no more


def lens(radius_px: float, width: int, **more: Any) -> Document:
    """A pinhole lens of this CoC radius at infinity and, with the other sign, at half the focus distance."""
    aperture_mm = 2 * radius_px * SENSOR_MM / width * FOCUS_M * 1000 / FOCAL_MM
    return {"focus_distance": FOCUS_M, "focal_length": FOCAL_MM, "sensor_width": SENSOR_MM, "lens_model": "pinhole",
            "f_number": FOCAL_MM / aperture_mm, "max_coc_radius": 64} | more


def case(effect: Effect, radius: float, blurred: float = 1.0, near: bool = False, **more: Any) -> Document:
    params = lens(radius, SIZE[0], **effect.closest_to_hexagon()) | more
    return {"name": f"{effect.id} R {radius} blurred {blurred:g}{' near' if near else ''} {json.dumps(more) if more else ''}".strip(),
            "effect": effect.id, "params": params, "blurred": blurred, "depth_m": FOCUS_M / 2 if near else None}


def bench(cases: list[Document], repetitions: int = REPETITIONS, counting: bool = False) -> Document:
    return run_bench({"size": SIZE, "repetitions": repetitions, "cases": cases}, FAMILY, effect_folders(), WORK, counting)


# ---- what is asked ----

def plots(family: list[Effect], by_radius: dict[str, list[float]], by_fraction: dict[str, list[float]]) -> None:
    for name, values, label, ticks in (("cost_radius", by_radius, "CoC radius, px", RADII),
                                       ("cost_fraction", by_fraction, "% of the frame out of focus", [100 * f for f in FRACTIONS])):
        figure, axes = pyplot.subplots(figsize=(6, 3.4))
        for effect in family:
            axes.plot(ticks, values[effect.id], marker="o", markersize=3, linewidth=1.2, label=effect.id)
        if name == "cost_radius":
            axes.set_xscale("log", base=2)
        axes.set_yscale("log")
        axes.set(xlabel=label, ylabel=f"ms, {SIZE[0]} x {SIZE[1]}", xticks=ticks, xticklabels=[f"{t:g}" for t in ticks])
        axes.grid(alpha=0.3)
        axes.legend(fontsize=7)
        save_plot(figure, IMAGES / f"{name}.svg")


def point_iou(effect: Effect, radius: float, params: Document) -> float:
    """IoU of a bright point with a hexagon, at constant CoC."""
    size = 2 * int(radius) + 33
    color = numpy.zeros((size, size), numpy.float32)
    color[size // 2, size // 2] = 1000
    write_exr(WORK / "point.exr", {c: color for c in "RGB"} | {"A": numpy.ones_like(color),
                                                               "Z": numpy.full_like(color, numpy.inf)})
    out = run_effect(effect.id, WORK / "point.exr", WORK / "point-out.exr",
                     lens(radius, size, **effect.closest_to_hexagon()) | params, WORK)[..., 0]
    coverage = polygon_coverage(6, radius, False, size)
    return iou(out >= 0.5 * out[size // 2, size // 2], coverage >= 0.5) if out.max() > 0 else 0.0


def fewest_taps(gather: Effect, radius: float, more: Document) -> tuple[Document, float] | None:
    """(parameters, IoU) of the cheapest setting, beside `more`, with a hexagon's IoU of ENOUGH_IOU."""
    for name in ("taps", "samples", "rings"):
        spec = gather.params.get(name)
        if not spec or spec["type"] != "int":
            continue
        low, high = max(spec.get("min", 1), 1), spec["max"]
        while low < high:  # more taps are never worse by much: a search by halves
            middle = (low + high) // 2
            low, high = (low, middle) if point_iou(gather, radius, {name: middle} | more) >= ENOUGH_IOU else (middle + 1, high)
        return {name: low} | more, point_iou(gather, radius, {name: low} | more)
    return None


def hexagon_against_gather(family: list[Effect]) -> str:
    by_id = {e.id: e for e in family}
    if not {"bokeh_hexagon", "bokeh_gather"} <= by_id.keys():
        return "bokeh_hexagon against bokeh_gather: n/a, not both are in effects/"
    gather = by_id["bokeh_gather"]
    samplers = gather.params.get("sampler", {}).get("values", [])
    found = [f for f in (fewest_taps(gather, 16, {"sampler": s}) for s in samplers) if f and f[1] >= ENOUGH_IOU]
    if not found:
        return "bokeh_hexagon against bokeh_gather: n/a, no number of taps of bokeh_gather reaches the IoU"
    cases = [case(by_id["bokeh_hexagon"], 16), *(case(gather, 16, **params) for params, _ in found)]
    times, counts = bench(cases), bench(cases, 1, True)
    hexagon, *gathers = [(times[c["name"]]["ms"], counts[c["name"]]["fetches_per_pixel"]) for c in cases]
    lines = [f"bokeh_hexagon {hexagon[0]:.0f} ms, {hexagon[1]:.1f} fetches a pixel"]
    for (params, reached), (ms, fetches) in zip(found, gathers):
        lines.append("bokeh_gather with " + ", ".join(f"{k} {v}" for k, v in params.items()) +
                     f" (IoU {reached:.3f}) {ms:.0f} ms, {fetches:.1f} fetches: {ms / hexagon[0]:.2f} times the time")
    return "\n".join(f"- {line}" for line in lines)


def main() -> None:
    page = Page("quality-dof.md", "scripts/bench dof", ["cost"])
    WORK.mkdir(parents=True, exist_ok=True)
    IMAGES.mkdir(parents=True, exist_ok=True)
    os.environ.setdefault("AFTERSHADE_CACHE", str(WORK / "programs"))
    family = effects()
    only = os.environ.get("ONLY", "").split(",")
    family = [e for e in family if only == [""] or e.id in only]
    full = {e.id: case(e, 16) for e in family}
    near = {e.id: case(e, 16, near=True) for e in family}
    ninety = {e.id: case(e, 16, blurred=0.1) for e in family}
    once = bench(list(full.values()), 1)
    slow = {e.id for e in family if once[full[e.id]["name"]]["ms"] > SLOW_MS}
    fast = [e for e in family if e.id not in slow]
    counts = bench([*full.values(), *(near[e.id] for e in fast)], 1, True)
    times = once | bench([c[e.id] for e in fast for c in (full, near, ninety)])
    rows = []
    for e in family:
        of = lambda results, wanted, key: results.get(wanted[e.id]["name"], {}).get(key, float("nan"))
        ms = [of(times, wanted, "ms") for wanted in (full, near, ninety)]
        fetches = [of(counts, wanted, "fetches_per_pixel") for wanted in (full, near)]
        rows.append((e.id, ms[0], fetches[0], ms[1], fetches[1], ms[2] / ms[0]))
        print(f"{e.id:14} far {ms[0]:7.1f} ms, {fetches[0]:6.1f} fetches a pixel; near {ms[1]:7.1f} ms, {fetches[1]:6.1f}; "
              f"90 % in focus {ms[2] / ms[0]:.3f} of the time", flush=True)
        print("    " + ", ".join(f"{p['pass']} {p['ms']:.1f}" for p in times[full[e.id]["name"]]["passes"]))
    cases = [case(e, r) for r in RADII for e in fast] + [case(e, 16, blurred=f) for f in FRACTIONS for e in fast]
    unique = list({c["name"]: c for c in cases}.values())
    sweep = bench(unique, max(1, REPETITIONS * 3 // 5))
    ms_of = lambda wanted: sweep[wanted["name"]]["ms"]
    by_radius = {e.id: [ms_of(case(e, r)) for r in RADII] for e in fast}
    by_fraction = {e.id: [ms_of(case(e, 16, blurred=f)) for f in FRACTIONS] for e in fast}
    plots(fast, by_radius, by_fraction)
    for e in fast:
        print(f"{e.id:14} ms at R {RADII}: " + " ".join(f"{v:.0f}" for v in by_radius[e.id])
              + f"; blurred {FRACTIONS}: " + " ".join(f"{v:.0f}" for v in by_fraction[e.id]))
    against = hexagon_against_gather(family)
    print(against)
    cell = lambda value, digits: "" if value != value else f"{value:.{digits}f}"
    costs = table(["", "far, ms", "fetches a pixel", "near, ms", "fetches a pixel", "90 % in focus, of the time"],
                  [[f"`{r[0]}`", *(cell(v, d) for v, d in zip(r[1:], (0, 1, 0, 1, 2)))] for r in rows])
    page.fill({"cost": f"{costs}\n\n{against}."})


if __name__ == "__main__":
    main()
