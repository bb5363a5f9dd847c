"""What scripts/check docs prepares for the commands of a page, in shell; $ROOT is the checkout."""

SCENE = """echo '{ "aftershade": 1, "frames": "1-4", "size": [64, 36], "camera": { "position": [0, 0, 4] }, "ambient": 1, "objects": [
  { "shape": "sphere", "radius": 1, "position": { "keys": { "1": [-0.5, 0, 0], "4": [0.5, 0, 0] } } } ] }' >scene.json
"""
# The scene of a wheel takes minutes at its full size.
SMALL_SCENES = """cp -r "$ROOT/scenes" . && sed -i 's/"size": .480, 270./"size": [96, 54]/' scenes/wheel/scene.json scenes/skin_front/scene.json
"""
VIEW = """echo '{ "aftershade": 1, "steps": [ { "effect": "view_transform" } ] }' >look.json
"""

PREPARE = {
    "README.md": SMALL_SCENES + """mkdir tests && cp -r "$ROOT/effects" . && cp -r "$ROOT/tests/golden" tests/
ln -s scenes/looks/portrait.json LOOK && ln -s scenes/suzanne CAPTURE
""",
    "docs/captures.md": SCENE.replace("1-4", "1-48") + """aftershade render scene.json -o . --quiet && cp gbuffer_0003.exr frame.exr
cp "$ROOT"/scenes/suzanne/gbuffer_0003.exr frame_0003.exr && cp "$ROOT"/scenes/suzanne/gbuffer_0004.exr frame_0004.exr
""",
    "docs/compare.md": SCENE + VIEW + """aftershade render scene.json -o a --frames 1 --quiet && aftershade render scene.json -o b --frames 2 --quiet
for name in a golden reference; do cp a/gbuffer_0001.exr $name.exr; done
for name in b out test; do cp b/gbuffer_0002.exr $name.exr; done
aftershade run look.json a.exr -o golden.png --progress none && aftershade run look.json b.exr -o out.png --progress none
""",
    "docs/farms.md": SCENE + """aftershade render scene.json -o shot --quiet
echo '{ "aftershade": 1, "steps": [ { "effect": "bokeh" } ] }' >look.json
""",
    "docs/golden.md": SCENE + VIEW + """aftershade render scene.json -o shot --frames 1 --quiet && mkdir SUITE
echo '{ "aftershade": 1, "cases": [ { "name": "lens", "look": "../look.json", "capture": "../shot", "outputs": ["display"] } ] }' >SUITE/golden.json
aftershade golden approve SUITE && ln -s look.json LOOK && ln -s shot CAPTURE
""",
    "docs/looks.md": VIEW + """sed -i 's/{ "effect"/{ "effect": "taa" }, { "effect"/' look.json
echo '{ "aftershade": 1, "frames": "1-200", "size": [16, 9], "camera": { "position": [0, 0, 4] }, "ambient": 1, "objects": [
  { "shape": "sphere", "radius": 1 } ] }' >scene.json && aftershade render scene.json -o CAPTURE --quiet
""",
    "docs/scenes.md": SMALL_SCENES + """ln -s scenes/looks/film.json LOOK
""",
    "docs/subsurface.md": SMALL_SCENES + """echo '{ "aftershade": 1, "summary": "Candle wax.", "type": "burley", "d_mm": [4, 3, 2] }' >wax.json
""",
}

# A machine without ffmpeg gets one that keeps the frames as they come.
FFMPEG = """command -v ffmpeg >/dev/null || { printf '#!/bin/sh\\nfor file; do :; done\\ncat >"${file#file:}"\\n' >"$HOME/bin/ffmpeg"
    chmod +x "$HOME/bin/ffmpeg"; }
"""

# (page, beginning of a command): what it needs besides.
BEFORE = {
    ("docs/compare.md", "aftershade compare golden.exr out.exr --json"): "cp golden.exr out.exr\n",
    ("README.md", "aftershade run scenes/looks/portrait.json scenes/suzanne/capture.json -o film.mp4"): FFMPEG,
    ("docs/batch.md", "aftershade run look.json wheel -o film.mp4"): FFMPEG,
    ("docs/golden.md", "export GOLDEN_SUITE=golden"): 'cp -r "$ROOT/ci" . && cp -r SUITE golden\n',
    ("docs/golden.md", "aftershade golden comment report"):
        "export URL=https://ci.example PULL_REQUEST=7\n"
        "printf '#!/bin/sh\\ngrep -q \"aftershade golden\" comment.md\\n' >\"$HOME/bin/gh\" && chmod +x \"$HOME/bin/gh\"\n",
    ("docs/golden.md", "aftershade golden apply-approvals"):
        """echo '{ "aftershade": 1, "approvers": [ { "who": ["ada@example.org"] } ] }' >SUITE/approvers.json
echo '{ "aftershade": 1, "author": "ada@example.org", "decisions": [ { "case": "lens", "decision": "approve" } ] }' >decisions.json
""",
    ("docs/batch.md", "aftershade run look.json wheel -o - "): "rm -f film.mp4\n",
    ("docs/isf.md", "aftershade import isf"):
        "mkdir -p filters\n"
        "printf '/*{\"CREDIT\": \"me\"}*/\\nvoid main() { gl_FragColor = vec4(1.0); }\\n' >'filters/Edge Blur.fs'\n",
    ("docs/batch.md", "aftershade inspect out_####.exr"): "cp film/out_*.exr .\n",
    ("docs/batch.md", "aftershade inspect 'out_####.png'"): "aftershade run look.json wheel -o 'out_####.png' --progress none\n",
    ("docs/batch.md", "aftershade run look.json wheel -o film/out_####.exr --chunk auto "):
        "export SLURM_ARRAY_TASK_ID=1 SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_MAX=4 SLURM_ARRAY_TASK_COUNT=4 SLURM_ARRAY_TASK_STEP=1\n",
    ("docs/batch.md", "aftershade run look.json wheel -o film/out_####.exr --chunk auto/8"):
        "unset ${!SLURM_*}; export JOB_COMPLETION_INDEX=2\n",
    # No scene writes a Cryptomatte; the captures for tests have one.
    ("docs/captures.md", "aftershade inspect frame.exr --cryptomatte"):
        'aftershade() { if [ -n "${AFTERSHADE_CAPTURES:-}" ]; then command aftershade "$@"; else command aftershade "$@" || [ $? -eq 3 ]; fi; }\n'
        '[ -z "${AFTERSHADE_CAPTURES:-}" ] || cp "$AFTERSHADE_CAPTURES"/producers/karma/karma_cpu_solaris_one_crypto.exr frame.exr\n',
    ("docs/captures.md", "aftershade inspect frame.exr --json"): "unset -f aftershade\n",
}

PLACEHOLDERS = {" -o OUT\n": " -o out_####.exr\n"}
# Verbs with a verdict, and the largest exit code that is one.
VERDICTS = {"aftershade compare ": 2, "aftershade inspect --check-velocity ": 1}


def shell_text(block: str) -> str:
    """An indented command as a shell runs it."""
    text = "\n".join(line[4:] for line in block.rstrip("\n").split("\n")) + "\n"
    for word, instead in PLACEHOLDERS.items():
        text = text.replace(word, instead)
    for verb, largest in VERDICTS.items():
        if text.startswith(verb) and "||" not in text:
            text = text.rstrip("\n").split("  #")[0] + f" || [ $? -le {largest} ]\n"
    return text


def before(page: str, block: str) -> str:
    return "".join(setup for (where, beginning), setup in BEFORE.items() if where == page and block.startswith(beginning))
