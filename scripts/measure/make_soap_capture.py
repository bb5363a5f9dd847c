"""Writes scenes/soap: a frame of scenes/shadow_edge, small and with the channels alone that the cases of effects on subsurface
scattering read."""
import pathlib
import tempfile

from measure.exr import write_trimmed
from measure.tree import AFTERSHADE, ROOT, command

LIGHT = [f"{role}.{c}" for role in ("irradiance", "albedo") for c in "RGB"] + ["R", "G", "B", "A"]
KINDS = {name: "e" for name in LIGHT + ["normal.X", "normal.Y", "normal.Z"]} | {"Z": "f", "object_id.I": "I"}


def main() -> None:
    folder = ROOT / "scenes/soap"
    folder.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as work:
        command([AFTERSHADE, "render", ROOT / "scenes/shadow_edge", "-o", work, "--size", "160x90", "--quiet"])
        write_trimmed(pathlib.Path(work) / "gbuffer_0001.exr", folder / "gbuffer_0001.exr", KINDS)


if __name__ == "__main__":
    main()
