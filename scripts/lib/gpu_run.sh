#!/bin/bash
# Says how this machine's card draws: doctor, goldens, tests, then times, in under five minutes on a card. Writes them to JSON.
#
#   BACKEND=egl          another backend: egl-software, osmesa
#   SIZES="1920x1080 3840x2160"   of the times; on software 240x135 480x270
#   TESTS=60             seconds for each program of tests; 0: none
#   FRAMES=100           of the sequence from and to files; on software 8
#   PARTS="goldens tests times"
#   OUT=FILE             the JSON (default: gpu.json beside this program)
set -euo pipefail
case ${1:-} in
    "") ;;
    -h | --help) sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//p}' "$0" && exit ;;
    *) echo "run: no option '$1': see --help" >&2 && exit 64 ;;
esac
here=$(cd "$(dirname "$(readlink -f "$0")")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
out=${OUT:-$here/gpu.json}
backend=${BACKEND:-egl}
software=0
case $backend in *software | osmesa) software=1 ;; esac
if [ $software = 1 ]; then sizes=${SIZES:-240x135 480x270} frames=${FRAMES:-8}; else sizes=${SIZES:-1920x1080 3840x2160} frames=${FRAMES:-100}; fi
parts=${PARTS:-goldens tests times}

# ---- libraries: the machine's where it has them, else those of the bundle ----
has_library() { ldconfig -p 2>/dev/null | grep -q "^[[:space:]]*$1 "; }
export LD_LIBRARY_PATH=$here/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
starts() { "$here/bin/aftershade" --version >"$work/starts" 2>&1; }
if ! starts; then
    export LD_LIBRARY_PATH=$LD_LIBRARY_PATH:$here/lib/cxx
    if ! starts; then
        echo "run: aftershade does not start; it needs glibc $(cat "$here/libc-version") or newer:" >&2
        cat "$work/starts" >&2
        exit 1
    fi
fi
if ! has_library libEGL.so.1; then export LD_LIBRARY_PATH=$LD_LIBRARY_PATH:$here/lib/gl; fi
# A container's toolkit may put the driver where no loader looks.
vendor=/usr/local/nvidia/share/glvnd/egl_vendor.d/10_nvidia.json
if [ -z "${__EGL_VENDOR_LIBRARY_FILENAMES:-}" ] && [ -f $vendor ] && ! ls /usr/share/glvnd/egl_vendor.d/*nvidia* >/dev/null 2>&1; then
    export __EGL_VENDOR_LIBRARY_FILENAMES=$vendor
fi
export AFTERSHADE_DATA=$here/tree AFTERSHADE_CACHE=$work/cache AFTERSHADE_BACKEND=$backend
aftershade() { "$here/bin/aftershade" "$@"; }

# 1 where a golden or a test failed, or a time is missing.
status=0
members=()
member() { members+=("\"$1\": $2"); }
seconds() { awk "BEGIN { printf \"%.2f\", $(date +%s.%N) - $1 }"; }
began=$(date +%s.%N)
member commit "\"$(cat "$here/commit")\""

echo "== doctor =="
code=0
aftershade doctor --json >"$work/doctor.json" 2>"$work/doctor.err" || code=$?
aftershade doctor || true
if ! grep -q '{' "$work/doctor.json"; then
    cat "$work/doctor.err" >&2
    exit 1
fi
member doctor "$(cat "$work/doctor.json")"

if [[ " $parts " == *" goldens "* ]]; then
    echo "== goldens =="
    code=0
    cp -r "$here/tree" "$work/tree"
    aftershade golden run "$work/tree/tests/golden" --backend "$backend" >/dev/null 2>"$work/golden.txt" || code=$?
    [ $code = 0 ] || status=1
    grep -v '^ *[0-9]*/.* Passed ' "$work/golden.txt" || true
    member goldens "{\"exit\": $code, \"summary\": \"$(grep ' passed, ' "$work/golden.txt" | tail -n 1 | tr -d '"')\"}"
fi

# Tests look for the tree where they were built.
built=$(cat "$here/built-in")
if [[ " $parts " == *" tests "* ]] && [ ! -e "$built" ]; then
    mkdir -p "$(dirname "$built")" 2>/dev/null && ln -s "$here/tree" "$built" 2>/dev/null || true
fi
limit=${TESTS:-60}
if [[ " $parts " == *" tests "* ]] && [ "$limit" != 0 ]; then
    echo "== tests =="
    if [ ! -e "$built/effects" ]; then
        echo "not run: they need the tree at $built, which could not be linked there"
    else
        results=()
        for test in gpu_test graph_test render_test effects_test; do
            code=0
            AFTERSHADE_TEST_BACKENDS=$backend timeout "$limit" "$here/bin/$test" >"$work/$test.txt" 2>&1 || code=$?
            passed=$(grep -c '^\[       OK' "$work/$test.txt" || true)
            failed=$(grep '^\[  FAILED  \].*ms)$' "$work/$test.txt" | sed 's/^\[  FAILED  \] //; s/ (.*//; s/,.*//; s/["\\]//g; s/.*/"&"/' | paste -sd , || true)
            whole=true
            if [ $code = 124 ]; then whole=false; elif [ $code != 0 ]; then status=1; fi
            [ -z "$failed" ] || status=1
            echo "$test: $passed passed, failed: ${failed:-none}$([ $whole = true ] || echo ", stopped after $limit s")"
            results+=("\"$test\": {\"passed\": $passed, \"failed\": [$failed], \"whole\": $whole}")
        done
        member tests "{$(IFS=,; echo "${results[*]}")}"
    fi
fi

# ---- times ----

# passes_ms LOOK CAPTURE [ARGUMENTS]: least of the frames, of all passes, upload and readback; ms.
passes_ms() {
    local look=$1 capture=$2
    shift 2
    aftershade run "$look" "$capture" -o "$work/out_####.exr" --overwrite --no-journal --progress plain -v "$@" 2>&1 >/dev/null | awk '
        /^pass  .* mean / { within = 1; next }
        /^stage/ { within = 0 }
        within && $1 == "upload" { upload = $(NF - 1); next }
        within && $1 == "readback" { readback = $(NF - 1); next }
        within && NF > 3 { sum += $(NF - 1); passes++ }
        END { if (passes) printf "{\"passes\": %.3f, \"upload\": %.2f, \"readback\": %.2f}", sum, upload, readback; else printf "null" }'
}
step_look() { printf '{"aftershade": 1, "steps": [%s]}' "$1" >"$work/$2.json"; }
# still CAPTURE_FOLDER FRAMES: its first frame, so many times, in FOLDER_still.
still() {
    local file i
    mkdir -p "$1_still"
    file=$(printf '%s\n' "$1"/*.exr | head -n 1)
    for ((i = 1; i <= $2; i++)); do ln -sf "$file" "$1_still/$(printf 'gbuffer_%04d.exr' "$i")"; done
    sed 's/"range": "[^"]*"/"range": "1-'"$2"'"/' "$1/capture.json" >"$1_still/capture.json"
}
psnr() {
    # Pictures that differ end compare with 1.
    { aftershade compare "$1" "$2" --json 2>/dev/null || true; } | sed -n 's/.*"psnr_db": *\([0-9.]*\).*/\1/p' | sed -n 1p
}

if [[ " $parts " == *" times "* ]]; then
    echo "== times, ms: passes, upload, readback =="
    lens='"params": {"f_number": 0.25, "focus_distance": "6 m"}'
    step_look "{\"effect\": \"dof\", $lens}" dof
    step_look "{\"effect\": \"bokeh\", $lens}" bokeh
    step_look '{"effect": "motion_blur"}' motion_blur
    step_look '{"effect": "taa"}' taa
    step_look '{"effect": "bloom"}' bloom
    step_look '{"effect": "view_transform"}' view_transform
    cp "$here/tree/scenes/looks/film.json" "$work/film.json"
    sized=()
    for size in $sizes; do
        aftershade render "$here/tree/scenes/toys" -o "$work/toys_$size" --size "$size" --frames 1-2 --quiet >/dev/null
        times=()
        for look in film dof bokeh motion_blur taa bloom view_transform; do
            aftershade run "$work/$look.json" "$work/toys_$size/capture.json" -o "$work/warm_####.exr" --overwrite --no-journal --progress none >/dev/null 2>&1 || true
            roles=(--output-roles color)
            [ $look != view_transform ] || roles=(--output-roles display)
            ms=$(passes_ms "$work/$look.json" "$work/toys_$size/capture.json" "${roles[@]}")
            echo "$size $look $ms"
            [ "$ms" != null ] || status=1
            times+=("\"$look\": $ms")
        done
        sized+=("\"$size\": {$(IFS=,; echo "${times[*]}")}")
    done
    member times "{$(IFS=,; echo "${sized[*]}")}"

    echo "== scattering: ms, and dB against 4096 samples =="
    size=${sizes%% *} scattered=()
    for scene in skin_patch skin_ear; do
        aftershade render "$here/tree/scenes/$scene" -o "$work/$scene" --size "$size" --frames 1-1 --quiet >/dev/null
        still "$work/$scene" 16
        profile=$(tr -d '\n' <"$here/tree/scenes/$scene/scene.json" | grep -o '"scattering_profile": *{[^}]*}' | head -n 1)
        skin() { step_look "{\"effect\": \"$1\", \"params\": {$profile, \"object_ids\": [1]$2}}" "$3"; }
        skin sss_burley ', "samples": 4096' reference
        skin sss_burley ', "samples": 64' fixed
        skin sss_adaptive "" adaptive
        skin sss_adaptive ', "min_samples": 2, "target_variance": 0.012' few
        picture=(--output-roles irradiance --pixel-type float)
        aftershade run "$work/reference.json" "$work/$scene/capture.json" -o "$work/reference.exr" --overwrite --no-journal --progress none "${picture[@]}" >/dev/null 2>&1
        looks=()
        for look in fixed adaptive few; do
            ms=$(passes_ms "$work/$look.json" "$work/${scene}_still/capture.json" "${picture[@]}")
            db=$(psnr "$work/out_0016.exr" "$work/reference.exr")
            echo "$scene $look $ms $db dB"
            [ "$ms" != null ] && [ -n "$db" ] || status=1
            looks+=("\"$look\": {\"ms\": $ms, \"db\": ${db:-null}}")
        done
        scattered+=("\"$scene\": {$(IFS=,; echo "${looks[*]}")}")
    done
    member scattering "{$(IFS=,; echo "${scattered[*]}")}"

    still "$work/toys_$size" "$frames"
    start=$(date +%s.%N)
    aftershade run "$work/view_transform.json" "$work/toys_${size}_still/capture.json" -o "$work/sequence_####.exr" --output-roles display --overwrite --no-journal --progress none >/dev/null 2>&1
    took=$(seconds "$start")
    echo "== $frames frames from and to files: $took s =="
    waits=()
    for way in direct mapped; do
        start=$(date +%s.%N)
        AFTERSHADE_TRANSFERS=$way aftershade run "$work/view_transform.json" "$work/toys_${size}_still/capture.json" -o "$work/sequence_####.exr" --output-roles display --overwrite --no-journal --progress plain -v >/dev/null 2>"$work/waits" || true
        # "transfers: mapped, 96.0 MiB of buffers; a frame waited 0.52 ms for uploads, 0.41 ms for readbacks"
        wait=$(sed -n 's/^transfers: .* waited \([0-9.]*\) ms for uploads, \([0-9.]*\) ms for readbacks$/"upload_wait_ms": \1, "read_wait_ms": \2/p' "$work/waits")
        [ -n "$wait" ] || status=1
        echo "transfers $way: $(seconds "$start") s; a frame: ${wait:-no times}"
        waits+=("\"$way\": {\"seconds\": $(seconds "$start")${wait:+, $wait}}")
    done
    member sequence "{\"frames\": $frames, \"size\": \"$size\", \"seconds\": $took, $(IFS=,; echo "${waits[*]}")}"

    echo "== transfers of a picture in rgba32f, ms =="
    read -ra list <<<"$sizes"
    moved=$("$here/bin/transfer_bench" "$backend" "${list[@]}") || status=1
    echo "${moved:-none}"
    member transfers "${moved:-null}"
fi
member seconds "$(seconds "$began")"
(IFS=,; echo "{${members[*]}}") >"$out"
echo "$out: $(seconds "$began") s in all"
exit $status
