"""What the techniques of subsurface scattering cost; started by scripts/bench-sss, which says what it needs."""
import os

from effect_bench import run_bench
from family import ROOT
from techniques import present

WORK = ROOT / "build/bench-sss"
SIZE = [int(n) for n in os.environ.get("SIZE", "1920x1080").split("x")]
REPETITIONS = int(os.environ.get("REPETITIONS", "5"))
DEPTH_M = 1
D_PX = [16, 8, 4]


def case(technique):
    label, effect, params = technique
    mm_per_px = 1000 * DEPTH_M * 36 / 50 / SIZE[0]
    profile = {"type": "burley", "d_mm": [d * mm_per_px for d in D_PX]}
    return {"name": label, "effect": effect, "params": {"scattering_profile": profile} | params, "depth_m": DEPTH_M}


def main():
    WORK.mkdir(parents=True, exist_ok=True)
    os.environ.setdefault("AFTERSHADE_CACHE", str(WORK / "programs"))
    # The exact sum takes half an hour of such a picture: its cost is the head's, in quality-sss.
    cases = [case(t) for t in present() if t[1] != "sss_exact"]
    names = sorted({c["effect"] for c in cases})
    measured = lambda repetitions, counting: run_bench(
        {"size": SIZE, "repetitions": repetitions, "cases": cases, "role": "irradiance"}, names, [ROOT / "effects"], WORK, counting)
    times, counts = measured(REPETITIONS, False), measured(1, True)
    rows = ["| | ms | fetches a pixel |", "|---|---|---|"]
    for name, result in times.items():
        fetches = counts[name]["fetches_per_pixel"]
        rows.append(f"| `{name}` | {result['ms']:.0f} | {fetches:.1f} |")
        print(f"{name:40} {result['ms']:7.1f} ms, {fetches:6.1f} fetches a pixel")
        print("    " + ", ".join(f"{p['pass']} {p['ms']:.1f}" for p in result["passes"]))
    (ROOT / "scripts/sss/cost-table.md").write_text("\n".join(rows) + "\n")


main()
