"""Verdicts of `inspect --check-velocity` on renders of known motion; started by scripts/check-velocity-verdicts."""
import copy
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT, WORK = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
PROGRAM = os.environ["AFTERSHADE"]
SIZE = "240x136"
ENOUGH = 0.95

CHECKER = {"checker": [[0.7, 0.55, 0.4], [0.12, 0.2, 0.35]], "cells": [9, 7]}
SCENE = {
    "aftershade": 1, "summary": "A room of textured things.", "frames": "0-3", "size": [240, 136],
    "camera": {"position": [0, 0.3, 4], "target": [0, 0, 0], "focal_length": "36 mm", "focus_distance": "4 m", "f_number": 4},
    "materials": {"wall": {"albedo": {"checker": [[0.55, 0.5, 0.42], [0.2, 0.25, 0.32]], "cells": [31, 17]}, "specular": 0},
                  "floor": {"albedo": CHECKER, "specular": 0}, "thing": {"albedo": CHECKER, "specular": 0.02}},
    "objects": [
        {"name": "wall", "shape": "plane", "size": [24, 12], "position": [0, 0, -3], "material": "wall"},
        {"name": "left", "shape": "box", "size": [0.8, 1.4, 0.8], "position": [-1.2, -0.2, 0.3], "rotation": [0, 30, 0], "material": "thing"},
        {"name": "ball", "shape": "sphere", "radius": 0.55, "position": [0.9, 0, 0.6], "material": "thing"}],
    "lights": [{"type": "directional", "position": [1, 2, 3], "intensity": 3}],
}


def keys(at):
    """A position for each frame."""
    return {"keys": {str(frame): at(frame) for frame in range(-1, 6)}}


def camera(**changes):
    return lambda scene: scene["camera"].update(changes)


def thing(index, **changes):
    return lambda scene: scene["objects"][index].update(changes)


# name: (change of the scene, whether its speed changes so that frames tell the two directions in time apart)
MOTIONS = {
    "uniform pan": (camera(position=keys(lambda f: [0.12 * f, 0.3, 4]), target=keys(lambda f: [0.12 * f, 0, 0])), False),
    "uniform truck past a target": (camera(position=keys(lambda f: [-0.4 + 0.15 * f, 0.3, 4])), False),
    "dolly": (camera(position=keys(lambda f: [0, 0.3, 4 - 0.18 * f])), False),
    "turn": (camera(target=keys(lambda f: [0.2 * f - 0.3, 0.05 * f, 0])), False),
    "faster and faster": (camera(position=keys(lambda f: [0.05 * f * f, 0.3, 4]), target=keys(lambda f: [0.05 * f * f, 0.02 * f * f, 0])), True),
    "a ball at one speed": (thing(2, position=keys(lambda f: [0.9 - 0.2 * f, 0.05 * f, 0.6])), False),
    "a ball that bounces": (thing(2, position=keys(lambda f: [0.9 - 0.12 * f, 0.35 * abs(f - 1.5) - 0.2, 0.6])), True),
    "a box that turns": (thing(1, rotation=keys(lambda f: [0, 30 + 9 * f, 0])), False),
}
PROFILES = ["native", "blender", "unreal", "nuke", "arnold", "vray", "moonray"]
OPPOSITE = {"cur-prev": "prev-cur", "prev-cur": "cur-prev", "next-cur": "cur-next", "cur-next": "next-cur"}


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)


def checks(folder, profile, *more):
    frames = sorted(folder.glob("gbuffer_*.exr"))
    result = run("inspect", "--check-velocity", frames[1], frames[2], "--profile", profile, "--json", *more)
    if result.returncode not in (0, 1):
        return {"": {"verdict": "failed", "sentence": result.stderr.strip()}}
    return {check["role"]: check for check in json.loads(result.stdout)["checks"]}


def read_profile(name):
    text = (ROOT / "profiles" / f"{name}.json").read_text()
    return json.loads("\n".join(line for line in text.splitlines() if not line.strip().startswith("//")))


def misreadings(profile, role):
    """(name, profile) for each way in which the role's decoding can be wrong."""
    def changed(name, change):
        wrong = copy.deepcopy(profile)
        change(wrong["roles"])
        return name, wrong

    is_next = role == "velocity_next"
    yield changed("sign", lambda r: r[role].update(delta=OPPOSITE[r[role].get("delta", "next-cur" if is_next else "cur-prev")]))
    yield changed("y axis", lambda r: r[role].update(y_axis="up" if r[role].get("y_axis", "down") == "down" else "down"))
    yield changed("scale", lambda r: r[role].update(scale=[2 * s for s in scales(r[role])]))
    yield changed("order", lambda r: r[role].update(channels=r[role]["channels"][::-1]))

    def exchange_time(roles):
        other = "velocity" if is_next else "velocity_next"
        moved = roles.pop(role)
        roles.pop(other, None)
        words = moved.get("delta", "next-cur" if is_next else "cur-prev")
        moved["delta"] = {"next-cur": "cur-prev", "cur-next": "prev-cur", "cur-prev": "next-cur", "prev-cur": "cur-next"}[words]
        roles[other] = moved
    yield changed("time", exchange_time)


def scales(decoding):
    scale = decoding.get("scale", 1)
    return scale if isinstance(scale, list) else [scale, scale]


def main():
    accused, named, tellable, silent, true_checks = [], 0, 0, [], 0
    for motion, (change, tells_time) in MOTIONS.items():
        scene = copy.deepcopy(SCENE)
        change(scene)
        for profile in PROFILES:
            slug = re.sub(r"\W+", "_", f"{motion} {profile}")
            folder = WORK / slug
            folder.mkdir(parents=True, exist_ok=True)
            (folder / "scene.json").write_text(json.dumps(scene))
            made = run("render", folder / "scene.json", "-o", folder / "out", "--frames", "0-3", "--size", SIZE,
                       "--profile", profile, "--quiet")
            if made.returncode:
                sys.exit(f"{slug}: {made.stderr}")
            truth = checks(folder / "out", profile)
            for role, check in truth.items():
                true_checks += 1
                if check["verdict"] not in ("confirmed", "undecided", "untestable"):
                    accused.append(f"{motion}, {profile}, {role}: {check['sentence']}")
                print(f"{motion:28} {profile:8} {role:14} {check['verdict']}", flush=True)
            declared = read_profile(profile)
            for role in truth:
                for name, wrong in misreadings(declared, role):
                    if name == "time" and not tells_time:
                        continue
                    (folder / name).mkdir(exist_ok=True)
                    (folder / name / f"{profile}.json").write_text(json.dumps(wrong))
                    found = checks(folder / "out", profile, "--profile-path", folder / name)
                    read_as = role if name != "time" else ("velocity" if role == "velocity_next" else "velocity_next")
                    verdict = found.get(read_as, {"verdict": "failed", "sentence": str(found)})
                    tellable += 1
                    if verdict["verdict"] in ("wrong", "no_fit"):
                        named += 1
                    else:
                        silent.append(f"{motion}, {profile}, {role}, {name}: {verdict['verdict']}: {verdict['sentence']}")
    print(f"\ntrue captures accused: {len(accused)} of {true_checks}", *accused, sep="\n  ")
    print(f"wrong readings named: {named} of {tellable} ({100 * named / tellable:.1f} %); the others:", *silent, sep="\n  ")
    sys.exit(bool(accused) or named < ENOUGH * tellable)


main()
