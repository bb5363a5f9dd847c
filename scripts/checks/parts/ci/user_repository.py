"""Makes what a user of golden suites has: a git repository with a capture in LFS, a look, and a suite of ten cases in golden/ whose
approved images are those of the shipped effects' own cases. Its commits, by tags:

    same       every image is approved
    warning    one approved image is another, within a large tolerance
    failure    it is another, and the tolerance is small
    hostile    the suite's folder and a look are named as shell commands
    absent     a file of LFS, named as one, that the server does not have

    user_repository.py CHECKOUT FOLDER OBJECTS LFS_URL     OBJECTS: gets the files of LFS by SHA-256

Prints the hostile folder's name as JSON, which YAML reads too.
"""

import hashlib
import json
import shutil
import subprocess
import sys
from pathlib import Path

CAPTURE = "../shots/starter/capture.json"
CASES = [("vignette", "artistic"), ("bloom", "lamps"), ("bloom", "threshold"), ("bokeh", "near_and_far"), ("chromatic_aberration", "smooth"),
         ("color_grade", "cdl"), ("dof", "near_and_far"), ("film_grain", "color"), ("motion_blur", "in_motion"), ("sharpen", "cas")]
CHANGED = "bloom_lamps"
OTHER = "bloom_threshold"
# A job's shell that takes a name for text of its own makes the file PWNED.
HOSTILE = "go \"$(touch PWNED)\" 'x`touch PWNED`;touch PWNED\n::error::y"


def git(folder, *words):
    author = ["-c", "user.name=A User", "-c", "user.email=user@example.org"]
    subprocess.run(["git", "-C", folder, *author, *words], check=True, stdout=subprocess.DEVNULL)


def commit(folder, tag, message):
    git(folder, "add", "--all")
    git(folder, "commit", "--quiet", "--message", message)
    git(folder, "tag", tag)


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


def pointer(digest, size):
    return f"version https://git-lfs.github.com/spec/v1\noid sha256:{digest}\nsize {size}\n"


def move_to_lfs(file, objects):
    content = file.read_bytes()
    digest = hashlib.sha256(content).hexdigest()
    (objects / digest).write_bytes(content)
    file.write_text(pointer(digest, len(content)))


def write_hostile(folder, suite):
    git(folder, "-c", "advice.detachedHead=false", "checkout", "--quiet", "same")
    (folder / "golden").rename(folder / HOSTILE)
    look = "looks/$(touch PWNED).json"
    (folder / "looks/vignette.json").rename(folder / look)
    write_json(folder / HOSTILE / "golden.json", {**suite, "cases": [{**suite["cases"][0], "look": f"../{look}"}, *suite["cases"][1:]]})
    commit(folder, "hostile", "$(touch PWNED)")
    git(folder, "-c", "advice.detachedHead=false", "checkout", "--quiet", "same")
    (folder / "shots/$(touch PWNED)\n::error::y.exr").write_text(pointer("0" * 64, 10))
    commit(folder, "absent", "A file of LFS that is not there")


def main():
    checkout, folder, objects, lfs_url = Path(sys.argv[1]), Path(sys.argv[2]), Path(sys.argv[3]), sys.argv[4]
    goldens = folder / "golden/goldens"
    goldens.mkdir(parents=True)
    objects.mkdir(parents=True, exist_ok=True)
    shutil.copytree(checkout / "scenes/starter", folder / "shots/starter")
    (folder / "ci").mkdir()
    shutil.copy(checkout / "ci/golden", folder / "ci/golden")
    for file in (folder / "shots/starter").glob("*.exr"):
        move_to_lfs(file, objects)
    (folder / ".gitattributes").write_text("shots/**/*.exr filter=lfs diff=lfs merge=lfs -text\n")
    (folder / ".lfsconfig").write_text(f"[lfs]\n\turl = {lfs_url}\n")

    cases = [case_of(checkout, *name) for name in CASES]
    for name in CASES:
        copy_golden(checkout, folder, *name)
    write_json(folder / "looks/vignette.json", {"aftershade": 1, "steps": cases[0].pop("steps")})
    cases[0]["look"] = "../looks/vignette.json"
    suite = {"aftershade": 1, "cases": cases}
    write_json(folder / "golden/golden.json", suite)
    git(folder, "init", "--quiet", "--initial-branch=main")
    commit(folder, "same", "A suite of goldens")

    # Without a sidecar the bits of the look's own image are not known: only the tolerance speaks.
    shutil.copy(goldens / f"{OTHER}.color.0001.exr", goldens / f"{CHANGED}.color.0001.exr")
    (goldens / f"{CHANGED}.color.0001.json").unlink()
    commit(folder, "failure", "A golden that the look does not give")

    changed = next(case for case in cases if case["name"] == CHANGED)
    tolerance = changed["tolerance"]
    changed["tolerance"] = {"fail": 10000, "warn": 0.001}
    write_json(folder / "golden/golden.json", suite)
    commit(folder, "warning", "A tolerance that warns of it")
    changed["tolerance"] = tolerance
    write_hostile(folder, suite)
    print(json.dumps(HOSTILE))


main()
