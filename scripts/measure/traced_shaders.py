"""A copy of the shaders in which one records each texel that it fetches, for tests/bench/fetch_bench.cpp."""
import re
import shutil
from pathlib import Path

from measure.tree import ROOT

# Words of records: fetch_bench.cpp says what they are. A function of int, since GLSL's comma takes no void.
RECORDING = """
layout(std430, binding = 15) buffer Records { uint records[]; };
uint records_made = 0u;
int record(uint texture, ivec2 p, int level, bool filtered) {
    uint row = uint(gl_FragCoord.y) - records[1];
    if (row >= records[2]) return 0;
    uint at = 4u + (row * records[0] + uint(gl_FragCoord.x)) * (records[3] + 1u);
    p = max(p, ivec2(0));
    if (records_made < records[3])
        records[at + 1u + records_made] = uint(p.x) | uint(p.y) << 11 | uint(level) << 22 | texture << 25 | (filtered ? 1u << 31 : 0u);
    records[at] = ++records_made;
    return 0;
}
// Trilinear: four texels of each of two levels.
int record_lod(uint texture, vec2 place, float level) {
    int low = int(floor(level));
    record(texture, ivec2(floor(place * vec2(frame.size >> low) - 0.5)), low, true);
    if (level > float(low)) record(texture, ivec2(floor(place * vec2(frame.size >> (low + 1)) - 0.5)), low + 1, true);
    return 0;
}
#define TRACED(texture, p, level) record(texture, p, level, false),
#define TRACED_LOD(texture, place, level) record_lod(texture, place, level),
"""
SILENT = """
#define TRACED(texture, p, level)
#define TRACED_LOD(texture, place, level)
"""
FETCH = re.compile(r"\b(texelFetch|textureLod)\s*\(")


def arguments(text: str, begin: int) -> tuple[list[str], int]:
    """Of the call whose "(" ends before `begin`, and where it ends."""
    depth, last = 1, begin
    parts: list[str] = []
    for i in range(begin, len(text)):
        depth += {"(": 1, ")": -1}.get(text[i], 0)
        if depth == 0:
            return parts + [text[last:i].strip()], i + 1
        if text[i] == "," and depth == 1:
            parts.append(text[last:i].strip())
            last = i + 1
    raise SystemExit("a call without an end")


def traced(text: str, numbers: dict[str, int]) -> str:
    """The text with each fetch marked; `numbers` learns the names of textures."""
    result, at = "", 0
    while found := FETCH.search(text, at):
        (name, *rest), end = arguments(text, found.end())
        number = numbers.setdefault(name, len(numbers))
        mark = "TRACED_LOD" if found[1] == "textureLod" else "TRACED"
        inner = [traced(word, numbers) for word in rest]
        result += text[at:found.start()] + f"({mark}({number}u, {', '.join(rest)}) {found[1]}({name}, {', '.join(inner)}))"
        at = end
    return result + text[at:]


def traced_copy(effect: str, shader: str, folder: Path, where: str = "1") -> list[str]:
    """Copies data and the effect to `folder`; the shader records where the preprocessor finds `where`. Returns names of textures by number."""
    shutil.rmtree(folder, ignore_errors=True)
    for part in "glsl", "profiles":
        shutil.copytree(ROOT / part, folder / part)
    shutil.copytree(ROOT / "effects" / effect, folder / "effects" / effect, ignore=shutil.ignore_patterns("cases", "*.cpp"))
    numbers: dict[str, int] = {}
    for file in sorted(folder.rglob("*")):
        if file.suffix not in (".glsl", ".frag", ".comp", ".vert"):
            continue
        text = "\n".join(re.sub(r"//.*", "", line) for line in file.read_text().splitlines()) + "\n"
        text = traced(text, numbers)
        if "#include <pass>" in text:
            prelude = f"\n#if {where}\n{RECORDING}\n#else\n{SILENT}\n#endif\n" if file == folder / "effects" / effect / shader else SILENT
            text = text.replace("#include <pass>", "#include <pass>" + prelude, 1)
        elif "TRACED" in text:
            text = "#ifndef TRACED\n" + SILENT.strip() + "\n#endif\n" + text  # a predicate of a tile list
        file.write_text(text)
    return sorted(numbers, key=numbers.__getitem__)
