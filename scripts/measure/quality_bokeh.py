"""Makes the pictures of docs/quality-bokeh.md and README.md and prints its figures. Needs the large captures and oiiotool.

    AFTERSHADE=FILE            another executable, and no build
    AFTERSHADE_CAPTURES=DIR    where suzanne lies (docs/measures.md)
"""
from measure.tree import AFTERSHADE, CAPTURES, EXACT, ROOT, command, write_look

WORK = ROOT / "build/quality-bokeh"
FRAME = CAPTURES / "suzanne/large/gbuffer_0004.exr"
PARAMS = {"focus_distance": "6.4 m", "focal_length": "50 mm", "sensor_width": "36 mm", "f_number": 0.25, "lens_model": "pinhole"}
VARIANTS: dict[str, dict[str, object]] = {"hexagon": {}, "octagon": {"shape": "octagon"}, "max": {"combine": "max"}, "dof": {}}


def main() -> None:
    pictures = {"sharp": FRAME, "truth": CAPTURES / "suzanne/truth/dof_0004.exr"}
    for name, params in VARIANTS.items():
        look, pictures[name] = write_look(WORK / "look.json", {"effect": "dof" if name == "dof" else "bokeh", "params": PARAMS | params}), WORK / f"{name}.exr"
        command([AFTERSHADE, "run", look, FRAME, "-o", pictures[name], *EXACT])
    for name, picture in pictures.items():
        layer = "ViewLayer.Combined." if picture == FRAME else ""
        command(["oiiotool", picture, "--ch", ",".join(f"{c}={layer}{c}" for c in "RGB"), "--mulc", 1.6, "--clamp:min=0:max=1", "--colorconvert",
                 "linear", "sRGB", "--cut", "480x270+480+10", "--resize:filter=box", "320x180", "-d", "uint8", "-o",
                 ROOT / f"docs/images/bokeh_{name}.png"])
    told = command([ROOT / "build/release/tests/effects_test", "--gtest_filter=BokehOnSuzanne.*"])
    print("\n".join(line for line in told.splitlines() if "PSNR" in line))


if __name__ == "__main__":
    main()
