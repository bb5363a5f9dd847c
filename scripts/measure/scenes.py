"""The scenes of docs/quality-dof.md: shipped ones through another lens, so that something lies in front of the focus, in it
and behind it. Each has its truth from `aftershade render --truth lens`, and a twin in which only what is in focus glows."""
import copy
import hashlib
import json
from collections.abc import Sequence
from pathlib import Path

from measure.tree import AFTERSHADE, ROOT, Document, command, link_meshes, read_json

SIZE = (480, 270)
SAMPLES = 256
GLOW = [0.5, 1.0, 0.25]  # emission added to what is in focus; light of it falls on nothing else


def load(name: str) -> Document:
    """A shipped scene's document."""
    return read_json(ROOT / f"scenes/{name}/scene.json")


def lens(scene: Document, focus_m: float, f_number: float, blades: int = 6) -> Document:
    scene["camera"] |= {"focus_distance": focus_m, "f_number": f_number, "blades": blades, "rotation": 0}
    return scene


def split_repeat(scene: Document, name: str, axis: int, at: int) -> None:
    """One of a repeat's rows along an axis becomes an object of its own, `NAME_focused`."""
    objects = scene["objects"]
    whole = next(o for o in objects if o["name"] == name)
    objects.remove(whole)
    count, step = whole["repeat"]["count"][axis], whole["repeat"]["step"][axis]
    for label, first, many in ("before", 0, at), ("focused", at, 1), ("after", at + 1, count - at - 1):
        if many == 0:
            continue
        part = copy.deepcopy(whole) | {"name": f"{name}_{label}"}
        part["position"][axis] += step * first
        part["repeat"]["count"][axis] = many
        objects.append(part)


def glowing(scene: Document, names: Sequence[str]) -> Document:
    """The same scene with more emission of the objects in focus, and of nothing else."""
    scene = copy.deepcopy(scene)
    for item in scene["objects"]:
        if item["name"] not in names:
            continue
        material = copy.deepcopy(scene["materials"][item["material"]])
        before = material.get("emission", [0, 0, 0])
        material["emission"] = [b + g for b, g in zip(before, GLOW)]
        scene["materials"][item["name"] + "_glowing"] = material
        item["material"] = item["name"] + "_glowing"
    return scene


def all_scenes() -> list[tuple[str, Document, int, list[str], str]]:
    """(name, scene, frame, names of the objects in focus or [], what it is for)"""
    shipped = {n: load(n) for n in ("point_grid", "receding_wall", "head", "camera_checker", "moving_box", "bats")}
    stage = read_json(ROOT / "scripts/measure/stage.json")
    split_repeat(shipped["receding_wall"], "posts", 2, 1)
    split_repeat(shipped["camera_checker"], "pillars", 2, 0)
    return [
        ("stage", lens(stage, 4, 0.3), 1, ["balls"], "near bars, balls in focus, lamps behind"),
        ("point_grid", lens(shipped["point_grid"], 4, 0.25), 1, ["focused"], "points on black"),
        ("receding_wall", lens(shipped["receding_wall"], 3.6, 0.2), 1, ["posts_focused"], "a wall through all depths; posts"),
        ("head", lens(shipped["head"], 0.72, 1), 7, ["ear"], "a near head, an ear in focus, a plain wall"),
        ("camera_checker", lens(shipped["camera_checker"], 5, 0.06), 6, ["pillars_focused"], "checks; near pillars, far wall"),
        ("moving_box", lens(shipped["moving_box"], 5, 0.08), 8, ["wall"], "a near box over a wall in focus"),
        ("bats", lens(shipped["bats"], 20, 0.05), 4, [], "triangles of 2 px, all depths"),
    ]


def rendered(name: str, scene: Document, frame: int, work: Path, samples: int = SAMPLES, truth: bool = True) -> tuple[Path, Path]:
    """(capture file, truth file); from the last time where nothing changed."""
    text = json.dumps(scene, indent=1)
    key = hashlib.sha256(f"{text} {frame} {samples} {truth} {SIZE}".encode()).hexdigest()[:12]
    folder = work / f"{name}-{key}"
    capture, lens_file = folder / f"gbuffer_{frame:04d}.exr", folder / f"truth_lens_{frame:04d}.exr"
    if not capture.exists() or truth and not lens_file.exists():
        source = work / "scenes" / name
        source.mkdir(parents=True, exist_ok=True)
        link_meshes(work / "scenes")
        (source / "scene.json").write_text(text)
        words = ["--truth", "lens", "--samples", samples] if truth else []
        command([AFTERSHADE, "render", source, "-o", folder, "--size", "%dx%d" % SIZE, "--frames", frame, "--quiet", *words])
    return capture, lens_file


def lens_of(scene: Document) -> tuple[float, float, float, float]:
    """focus_m, focal_mm, f_number, sensor_mm"""
    camera = scene["camera"]
    metres = lambda v: float(v) if not isinstance(v, str) else float(v.split()[0]) * {"m": 1, "mm": 1e-3}[v.split()[1]]
    focal = camera.get("focal_length", "50 mm")
    focal_mm = metres(focal) * 1000 if isinstance(focal, str) else float(focal)
    return metres(camera["focus_distance"]), focal_mm, float(camera["f_number"]), float(camera.get("sensor_width", 36))
