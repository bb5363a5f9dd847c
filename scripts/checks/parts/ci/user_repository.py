"""Makes what a user of golden suites has: a git repository with a capture, a look, a suite in golden/ whose approved images
are those of the shipped effects' own cases, and Aftershade as a submodule. Three commits, by the tags of what a run tells:
same, warning (one approved image is another, within a large tolerance), failure (it is another, and the tolerance is small).

    user_repository.py CHECKOUT FOLDER AFTERSHADE_URL SUBMODULE_URL

AFTERSHADE_URL is cloned; .gitmodules gets SUBMODULE_URL.
"""

import json
import shutil
import subprocess
import sys
from pathlib import Path

CAPTURE = "../shots/starter/capture.json"
CHANGED = "bloom_lamps"
OTHER = "bloom_threshold"


def git(folder, *words):
    author = ["-c", "user.name=A User", "-c", "user.email=user@example.org"]
    subprocess.run(["git", "-C", folder, *author, *words], check=True, stdout=subprocess.DEVNULL)


def case_of(checkout, effect, case):
    document = json.loads((checkout / "effects" / effect / "cases" / f"{case}.json").read_text())
    del document["aftershade"]
    return {"name": f"{effect}_{case}", **document, "capture": CAPTURE}


def write_json(path, document):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(document, indent=2) + "\n")


def copy_golden(checkout, folder, effect, case):
    """The approved image and its sidecar."""
    for suffix in ("exr", "json"):
        source = checkout / "effects" / effect / "cases" / f"{case}.color.0001.{suffix}"
        shutil.copy(source, folder / "golden/goldens" / f"{effect}_{case}.color.0001.{suffix}")


def main():
    checkout, folder = Path(sys.argv[1]), Path(sys.argv[2])
    aftershade_url, submodule_url = sys.argv[3:]
    goldens = folder / "golden/goldens"
    goldens.mkdir(parents=True)
    shutil.copytree(checkout / "scenes/starter", folder / "shots/starter")

    names = [("vignette", "artistic"), ("bloom", "lamps"), ("bloom", "threshold")]
    cases = [case_of(checkout, *name) for name in names]
    for name in names:
        copy_golden(checkout, folder, *name)
    write_json(folder / "looks/vignette.json", {"aftershade": 1, "steps": cases[0].pop("steps")})
    cases[0]["look"] = "../looks/vignette.json"
    suite = {"aftershade": 1, "cases": cases}
    write_json(folder / "golden/golden.json", suite)

    git(folder, "init", "--quiet", "--initial-branch=main")
    git(folder, "-c", "protocol.file.allow=always", "submodule", "--quiet", "add", aftershade_url, "aftershade")
    git(folder, "config", "--file", ".gitmodules", "submodule.aftershade.url", submodule_url)
    git(folder, "add", "--all")
    git(folder, "commit", "--quiet", "--message", "A suite of goldens")
    git(folder, "tag", "same")

    # Without a sidecar the bits of the look's own image are not known: only the tolerance speaks.
    shutil.copy(goldens / f"{OTHER}.color.0001.exr", goldens / f"{CHANGED}.color.0001.exr")
    (goldens / f"{CHANGED}.color.0001.json").unlink()
    git(folder, "commit", "--quiet", "--all", "--message", "A golden that the look does not give")
    git(folder, "tag", "failure")

    changed = next(case for case in cases if case["name"] == CHANGED)
    changed["tolerance"] = {"fail": 10000, "warn": 0.001}
    write_json(folder / "golden/golden.json", suite)
    git(folder, "commit", "--quiet", "--all", "--message", "A tolerance that warns of it")
    git(folder, "tag", "warning")


main()
