"""What each technique of subsurface scattering costs on OSMesa: wall time around glFinish of its passes alone, from a warm program
cache, in turns, the median; texel fetches a pixel as counted by its own shaders with a counter in every fetch. All of the picture
scatters, red's d is 16 px. Prints the figures and fills the section Cost of docs/quality-sss.md.

    SIZE=1920x1080 REPETITIONS=5 VERBOSE=1
"""
import os

from measure.effect_bench import run_bench
from measure.pages import Page, table
from measure.sss_techniques import Technique, present
from measure.tree import ROOT, Document

WORK = ROOT / "build/bench-sss"
SIZE = [int(n) for n in os.environ.get("SIZE", "1920x1080").split("x")]
REPETITIONS = int(os.environ.get("REPETITIONS", "5"))
DEPTH_M = 1
D_PX = [16, 8, 4]


def case(technique: Technique) -> Document:
    label, effect, params = technique
    mm_per_px = 1000 * DEPTH_M * 36 / 50 / SIZE[0]
    profile = {"type": "burley", "d_mm": [d * mm_per_px for d in D_PX]}
    return {"name": label, "effect": effect, "params": {"scattering_profile": profile} | params, "depth_m": DEPTH_M}


def main() -> None:
    page = Page("quality-sss.md", "scripts/bench sss", ["cost"])
    WORK.mkdir(parents=True, exist_ok=True)
    os.environ.setdefault("AFTERSHADE_CACHE", str(WORK / "programs"))
    # The exact sum takes half an hour of such a picture: its cost is the head's, in quality-sss.
    cases = [case(t) for t in present() if t[1] != "sss_exact"]
    names = sorted({c["effect"] for c in cases})
    measured = lambda repetitions, counting: run_bench(
        {"size": SIZE, "repetitions": repetitions, "cases": cases, "role": "irradiance"}, names, [ROOT / "effects"], WORK, counting)
    times, counts = measured(REPETITIONS, False), measured(1, True)
    rows = []
    for name, result in times.items():
        fetches = counts[name]["fetches_per_pixel"]
        rows.append([f"`{name}`", f"{result['ms']:.0f}", f"{fetches:.1f}"])
        print(f"{name:40} {result['ms']:7.1f} ms, {fetches:6.1f} fetches a pixel")
        print("    " + ", ".join(f"{p['pass']} {p['ms']:.1f}" for p in result["passes"]))
    page.fill({"cost": table(["", "ms", "fetches a pixel"], rows)})


if __name__ == "__main__":
    main()
