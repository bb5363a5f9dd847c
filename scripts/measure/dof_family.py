"""The effects of the depth-of-field family that this tree has, and runs of them."""
import os
import pathlib
from typing import Any

from measure.exr import read_exr
from measure.measures import Array
from measure.tree import AFTERSHADE, EXACT, ROOT, command, read_json, write_look

# In the order of the documents; what this tree does not have is left out.
FAMILY = ["dof_simple", "bokeh", "bokeh_gather", "dof_scatter", "bokeh_hexagon", "bokeh_disk", "dof_layered", "dof"]


class Effect:
    def __init__(self, folder: pathlib.Path) -> None:
        self.id = folder.name
        self.params: dict[str, Any] = read_json(folder / "effect.json")["params"]

    def with_blades(self, blades: int) -> dict[str, Any] | None:
        """Parameters of an aperture with so many blades; None where the effect cannot have it."""
        if "blades" in self.params:
            highest = self.params["blades"].get("max", 12)
            return {"blades": blades} if blades <= highest else None
        if "shape" in self.params:
            shape = {4: "square", 6: "hexagon", 8: "octagon"}.get(blades)
            return {"shape": shape} if shape in self.params["shape"]["values"] else None
        return {} if blades == 6 and "hexagon" in self.id else None

    def closest_to_hexagon(self) -> dict[str, Any]:
        return self.with_blades(6) or {}


def effect_folders() -> list[pathlib.Path]:
    extra = os.environ.get("AFTERSHADE_EFFECTS", "")
    return [pathlib.Path(p) for p in extra.split(":") if p] + [ROOT / "effects"]


def effects() -> list[Effect]:
    found: dict[str, Effect] = {}
    for folder in [*effect_folders(), ROOT / "effects/reference"]:
        for name in FAMILY:
            if name not in found and (folder / name / "effect.json").exists():
                found[name] = Effect(folder / name)
    return [found[name] for name in FAMILY if name in found]


def run_effect(effect: str, capture: pathlib.Path, out: pathlib.Path, params: dict[str, Any], work: pathlib.Path,
               frame: int | None = None) -> Array:
    """The effect's picture of one capture file, or of one frame of a sequence, RGB float32."""
    look = write_look(work / f"{effect}.json", {"effect": effect, "params": params})
    paths = [word for folder in effect_folders()[:-1] for word in ("--effect-path", str(folder))]
    command([AFTERSHADE, "run", look, capture, "-o", out, *EXACT, *(["--frames", frame] if frame else []), *paths])
    return read_exr(out)
