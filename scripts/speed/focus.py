"""What a frame costs `dof` of which 5 % is out of focus, and one all out of focus: processor time from the capture in memory to the
result in memory (upload, passes, readback) at 1920x1080, with the lens of scripts/bench-dof at a CoC radius of 16 px."""
import sys

from family import ROOT, effect_folders
from effect_bench import run_bench

SIZE = [1920, 1080]
FOCUS_M, FOCAL_MM, SENSOR_MM, COC_RADIUS_PX = 2, 200, 36, 16


def case(name, blurred):
    aperture_mm = 2 * COC_RADIUS_PX * SENSOR_MM / SIZE[0] * FOCUS_M * 1000 / FOCAL_MM
    params = {"focus_distance": FOCUS_M, "focal_length": FOCAL_MM, "sensor_width": SENSOR_MM, "lens_model": "pinhole",
              "f_number": FOCAL_MM / aperture_mm, "max_coc_radius": 64, "blades": 6}
    return {"name": name, "effect": "dof", "params": params, "blurred": blurred, "depth_m": None}


def frames(repetitions):
    """Of a twentieth and of all: processor ms a frame, and its passes."""
    job = {"size": SIZE, "repetitions": repetitions, "cases": [case("5 %", 0.05), case("all", 1)]}
    return run_bench(job, ["dof"], effect_folders(), ROOT / "build/bench", by="frame_processor_ms")


def figures(repetitions=7):
    found = frames(repetitions)
    part, whole = (found[name]["frame_processor_ms"] for name in ("5 %", "all"))
    print(f"dof, processor time a frame: 5 % out of focus {part:.1f} ms, all {whole:.1f} ms", flush=True)
    return {"`dof`: a frame with 5 % out of focus, of one all out of focus, processor time": round(part / whole, 3)}


if __name__ == "__main__":
    for name, result in frames(int(sys.argv[1]) if len(sys.argv) > 1 else 7).items():
        print(f"{name}: {result['frame_processor_ms']:.1f} ms of processor, {result['frame_ms']:.1f} ms; "
              + ", ".join(f"{p['pass']} {p['ms']:.1f}" for p in result["passes"] if p["ms"] >= 0.5))
