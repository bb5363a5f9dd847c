"""How far each effect is from what software GL can do on this machine, and what more cores would give: prints tables and fills them
into docs/speed.md. Suzanne's frame 4 at 1920x1080; each effect's shaders count their own fetches. Needs AFTERSHADE_CAPTURES. Some ten
minutes.

    REPETITIONS=3 ONLY=bloom,taa
"""
import json
import os
import threading
import time
from pathlib import Path

import numpy

from measure.blender_turns import suzanne_1080p
from measure.effect_bench import run_bench
from measure.measures import Array
from measure.pages import Page, table
from measure.tree import ROOT, Document

WORK = ROOT / "build/bench-roofline"
PIXELS = 1920 * 1080
REPETITIONS = int(os.environ.get("REPETITIONS", "3"))
ONLY = [name for name in os.environ.get("ONLY", "").split(",") if name]
ROLES = ["color", "depth", "velocity", "velocity_next", "irradiance", "albedo", "normal", "object_id"]
# Too slow for a table of defaults (minutes a frame), or without a picture of its own.
LEFT_OUT = {"accumulate", "sss_exact", "dof_scatter", "bokeh_gather", "dof_layered", "transmittance", "velocity_from_camera", "visualize",
            "sss_prepare", "sss_combine", "camera_motion_blur", "decoupled"}
PARAMS = {"sss": {"scattering_profile": {"type": "burley", "d_mm": [60, 25, 15]}, "object_ids": [1]},
          "lens": {"focus_distance": 6.4, "focal_length": 50, "f_number": 0.25, "sensor_width": 36, "lens_model": "pinhole"}}
PROBE = {"aftershade": 1, "version": "1.0.0", "summary": "Measures software GL.", "inputs": {"color": {"role": "color", "doc": "Any."}},
         "outputs": {"color": {"role": "color", "doc": "Of no use."}}}
PROBE_FETCHES = 64  # of probe_fetch, for each pixel
PROBES = {
    "probe_copy": "out_color = texelFetch(color, ivec2(gl_FragCoord.xy), 0);",
    "probe_fetch": """vec4 sum = vec4(0.0);
    for (int y = -4; y < 4; ++y)
        for (int x = -4; x < 4; ++x) sum += texelFetch(color, clamp(ivec2(gl_FragCoord.xy) + ivec2(x, y), ivec2(0), frame.size - 1), 0);
    out_color = sum;""",
}


def write_probes() -> Path:
    for name, body in PROBES.items():
        folder = WORK / "probes" / name
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "effect.json").write_text(json.dumps(PROBE | {"id": name, "passes": [{"name": "draw", "shader": "draw.frag"}]}))
        (folder / "draw.frag").write_text(f"#version 450 core\n#include <pass>\n\nvoid main() {{\n    {body}\n}}\n")
    return WORK / "probes"


def cases() -> list[Document]:
    found = []
    for file in sorted((ROOT / "effects").glob("**/effect.json")):
        manifest = json.loads(file.read_text())
        name = manifest["id"]
        if name in LEFT_OUT or (ONLY and name not in ONLY):
            continue
        role = next(iter(manifest["outputs"].values()))["role"]
        params = PARAMS["sss"] if "scattering_profile" in manifest.get("params", {}) or "scattering" in manifest.get("modules", []) else \
            PARAMS["lens"] if "lens" in manifest.get("modules", []) else {}
        found.append({"name": name, "effect": name, "params": params, "role": role})
    return found + [{"name": name, "effect": name, "params": {}, "role": "color"} for name in PROBES]


def bench(list_of_cases: list[Document], counting: bool = False, repetitions: int = REPETITIONS, threads: int | None = None) -> Document:
    if threads is not None:
        os.environ["LP_NUM_THREADS"] = str(threads)
    job = {"size": [1920, 1080], "repetitions": repetitions, "cases": list_of_cases, "capture": str(suzanne_1080p(WORK)).replace("_0004.", "_####."),
           "profile": "blender", "frame": 4, "roles": ROLES}
    names = [case["effect"] for case in list_of_cases]
    result = run_bench(job, names, [ROOT / "effects", write_probes()], WORK, counting)
    os.environ.pop("LP_NUM_THREADS", None)
    return result


def copy_gb_per_s(threads: int) -> float:
    """Read and written bytes; each thread copies its own 128 MiB."""
    pairs = [(numpy.ones(2**24), numpy.empty(2**24)) for _ in range(threads)]

    def copies(source: Array, target: Array) -> None:
        for _ in range(8):
            numpy.copyto(target, source)

    for pair in pairs:
        copies(*pair)
    workers = [threading.Thread(target=copies, args=pair) for pair in pairs]
    begin = time.perf_counter()
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    return threads * 8 * 2 * 2**27 / (time.perf_counter() - begin) / 1e9


def main() -> None:
    page = Page("speed.md", "scripts/bench roofline", ["roofline"])
    WORK.mkdir(parents=True, exist_ok=True)
    all_cases = cases()
    cores = os.cpu_count() or 1
    times = {threads: bench(all_cases, threads=threads) for threads in (1, cores)}
    counts = bench(all_cases, counting=True, repetitions=1)
    if round(counts["probe_fetch"]["fetches_per_pixel"]) != PROBE_FETCHES:
        raise SystemExit(f"the probe of {PROBE_FETCHES} fetches a pixel counts {counts['probe_fetch']['fetches_per_pixel']}: the host reads texels in a "
                         "way that scripts/measure/effect_bench.py does not count yet; extend PRELUDE")
    best = times[cores]
    copy_ms = best["probe_copy"]["ms"]
    ns_per_fetch = 1e6 * (best["probe_fetch"]["ms"] - copy_ms) / (PROBE_FETCHES - 1) / PIXELS
    rows = []
    for case in all_cases[:-len(PROBES)]:
        name = case["name"]
        ms, fetches = best[name]["ms"], counts[name]["fetches_per_pixel"]
        bound = max(fetches * ns_per_fetch * PIXELS / 1e6, copy_ms)
        one, two = times[1][name]["ms"], ms
        # t(n) = serial + rest / n (Amdahl 1967).
        serial = max((cores * two - one) / (cores - 1), 0) if cores > 1 else one
        more = [f"{one / (serial + (one - serial) / n):.1f}" for n in (4, 16)]
        rows.append([f"`{name}`", f"{ms:.0f}", f"{fetches:.1f}", f"{bound:.0f}", f"{ms / bound:.1f}", f"{one / two:.2f}", *more])
        print(rows[-1], flush=True)
    bandwidths = [max(copy_gb_per_s(n) for _ in range(3)) for n in (1, cores)]
    words = [f"Copying memory: {bandwidths[0]:.1f} GB/s with one thread, {bandwidths[1]:.1f} with {cores} (bytes read and bytes written). Copying a picture "
             f"of four floats by a pass: {copy_ms:.1f} ms, {2 * 16 * PIXELS / copy_ms / 1e6:.1f} GB/s. A fetch more in a loop: "
             f"{ns_per_fetch:.2f} ns of both cores, {1 / ns_per_fetch:.2f} fetches a ns.", "",
             table(["effect", "ms", "fetches a pixel", "least, ms", "times the least", f"{cores} cores against 1", "4 cores, by Amdahl", "16"], rows)]
    print("\n".join(words))
    page.fill({"roofline": "\n".join(words)})


if __name__ == "__main__":
    main()
