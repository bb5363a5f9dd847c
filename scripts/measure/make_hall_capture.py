"""Writes scenes/hall: two frames of scenes/camera_checker, and four sub-frames of the second one's exposure, small and with the
channels alone that the cases of effects on motion read."""
import pathlib
import tempfile

from measure.exr import write_trimmed
from measure.tree import AFTERSHADE, ROOT, command

FOLDER = ROOT / "scenes/hall"
FULL = {"R": "e", "G": "e", "B": "e", "A": "e", "Z": "f", "object_id.I": "I", "velocity.X": "e", "velocity.Y": "e"}
COLOR = {"R": "e", "G": "e", "B": "e"}


def main() -> None:
    FOLDER.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        work, words = pathlib.Path(name), [AFTERSHADE, "render", ROOT / "scenes/camera_checker", "--size", "160x90", "--quiet"]
        command([*words, "-o", work / "frames", "--frames", "5-6"])
        command([*words, "-o", work / "exposure", "--frames", "6", "--subframes", "4"])
        for number in 5, 6:
            write_trimmed(work / f"frames/gbuffer_{number:04}.exr", FOLDER / f"gbuffer_{number:04}.exr", FULL)
        for number in range(24, 28):
            write_trimmed(work / f"exposure/gbuffer_{number:04}.exr", FOLDER / f"exposure_{number:04}.exr", COLOR)


if __name__ == "__main__":
    main()
