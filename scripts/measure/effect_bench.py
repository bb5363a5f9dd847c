"""Times effects, or counts their texel fetches, by tests/bench/effect_bench.cpp."""
import json
import os
import re
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path

from measure.tree import ROOT, Document

BENCH = ROOT / "build/release/tests/bench/effect_bench"


def run_bench(job: Document, names: Sequence[str], folders: Sequence[Path], work: Path, counting: bool = False) -> Document:
    """Results by name: the median of ms, the passes of that run, fetches a pixel. `job` has size, repetitions, cases; `names` are
    the effects in `folders`."""
    data = counting_copy(names, folders, work) if counting else ROOT
    folders = [data / f"effects-{i}" if counting else f for i, f in enumerate(folders)]
    job = job | {"data": str(data), "effects": [str(f) for f in folders]}
    done = subprocess.run([BENCH], input=json.dumps(job), stdout=subprocess.PIPE, text=True,
                          stderr=None if os.environ.get("VERBOSE") else subprocess.PIPE)
    if done.returncode:
        raise SystemExit(f"effect_bench ended with {done.returncode}: {(done.stderr or '')[-2000:]}")
    results: dict[str, list[Document]] = {}
    for result in json.loads(done.stdout)["results"]:
        results.setdefault(result["name"], []).append(result)
    return {name: sorted(runs, key=lambda r: r["ms"])[(len(runs) - 1) // 2] for name, runs in results.items()}


# Counting: the same shaders with every fetch through a macro that adds one, and the sum of each invocation at its end. On software GL the
# host puts loads from images in the place of fetches.
PRELUDE = """
layout(std430, binding = 15) buffer FetchCounts { uint fetch_counts[4096]; };
uint fetches_made = 0u;
#define texelFetch(s, p, l) (fetches_made++, texelFetch(s, p, l))
#define imageLoad(s, p) (fetches_made++, imageLoad(s, p))
#define textureLod(s, p, l) (fetches_made++, textureLod(s, p, l))
#define texture(s, p) (fetches_made++, texture(s, p))
#define textureGather(s, p) (fetches_made += 4u, textureGather(s, p))
"""
EPILOGUE = """
void main() {
    main_that_is_counted();
    atomicAdd(fetch_counts[%s & 4095u], fetches_made);
}
"""
PLACE = {".frag": "(uint(gl_FragCoord.x) * 37u + uint(gl_FragCoord.y))", ".vert": "uint(gl_InstanceID)",
         ".comp": "gl_GlobalInvocationID.x"}


def counting_copy(names: Sequence[str], folders: Sequence[Path], work: Path) -> Path:
    """A data folder of counting shaders. Reads of buffers are not counted."""
    folder = work / "counting"
    shutil.rmtree(folder, ignore_errors=True)
    for part in "glsl", "profiles":
        shutil.copytree(ROOT / part, folder / part, ignore=shutil.ignore_patterns("isf"))  # has names of its own for fetches
    (folder / "effects").mkdir()
    for i, source in enumerate(folders):
        for name in names:
            if (source / name / "effect.json").exists():
                shutil.copytree(source / name, folder / f"effects-{i}" / name, ignore=shutil.ignore_patterns("cases", "*.cpp"))
        (folder / f"effects-{i}").mkdir(exist_ok=True)
    for file in folder.rglob("*"):
        if not file.is_file() or file.suffix not in (".glsl", *PLACE):
            continue
        text = file.read_text()
        code = re.sub(r"//.*", "", text)
        known = {"texture", "textureLod", "textureGather", "texelFetch", "textureSize", "textureQueryLevels"}
        other = set(re.findall(r"\b(texture\w*|texelFetch\w+)\s*\(", code)) - known
        if other:
            raise SystemExit(f"{file}: {', '.join(sorted(other))} is not counted yet; extend PRELUDE")
        if file.suffix in PLACE and "#include <pass>" in text and re.search(r"\bvoid\s+main\s*\(", code):
            text = text.replace("#include <pass>", "#include <pass>" + PRELUDE, 1)
            text = re.sub(r"\bvoid\s+main\s*\(\s*\)", "void main_that_is_counted()", text)
            file.write_text(text + EPILOGUE % PLACE[file.suffix])
    return folder
