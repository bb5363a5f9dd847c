"""Where things lie, and commands that must succeed."""
import json
import os
import pathlib
import re
import subprocess
from collections.abc import Sequence
from typing import Any

Document = dict[str, Any]
ROOT = pathlib.Path(__file__).resolve().parents[2]
AFTERSHADE = pathlib.Path(os.environ.get("AFTERSHADE", ROOT / "build/release/aftershade"))
CAPTURES = pathlib.Path(os.environ.get("AFTERSHADE_CAPTURES", ROOT / "../shared/captures"))
# Of every run whose picture is measured: no program that was not asked for, no file but the picture.
EXACT = ["--pixel-type", "float", "--compression", "none", "--progress", "none", "--backend", "software", "--no-journal", "--overwrite"]


def command(words: Sequence[object], **more: Any) -> str:
    """What it prints; ends this program where it fails."""
    result = subprocess.run([str(w) for w in words], capture_output=True, text=True, cwd=ROOT, **more)
    if result.returncode:
        raise SystemExit(f"{' '.join(map(str, words))}\nended with {result.returncode}:\n{result.stderr}")
    return result.stdout


def read_json(path: pathlib.Path) -> Any:
    """A document with lines of comments, as scenes and captures are."""
    return json.loads(re.sub(r"^\s*//.*$", "", path.read_text(), flags=re.M))


def write_json(path: pathlib.Path, value: object) -> pathlib.Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(value))
    return path


def write_look(path: pathlib.Path, *steps: dict[str, Any]) -> pathlib.Path:
    return write_json(path, {"aftershade": 1, "steps": list(steps)})


def link_meshes(folder: pathlib.Path) -> None:
    """For scenes in folders of `folder`, whose files say "../meshes"."""
    folder.mkdir(parents=True, exist_ok=True)
    if not (folder / "meshes").exists():
        (folder / "meshes").symlink_to(ROOT / "scenes/meshes")
