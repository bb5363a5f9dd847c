# Sourced by scripts/bench, check, make and quality, each of which runs by name what is of its kind: programs of scripts/checks
# and scripts/makes, modules of the Python package scripts/measure, and scripts/page for Node.
scripts=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
kind=$(basename "$(realpath "$0")")

files_named() {
    local file
    for file in "$scripts/${kind}s"/* "$scripts/measure/${kind}"_*.py "$scripts/page/$kind"-*.mjs; do
        [ ! -f "$file" ] || echo "$(basename "$file" | sed "s/^${kind}[-_]//; s/\.[a-z]*$//; s/_/-/g") $file"
    done | sort
}

list_named() {
    local name file
    echo
    files_named | while read -r name file; do printf '%-20s %s\n' "$name" "$(usage_of "$file" | head -n 1)"; done
}
source "$scripts/lib/help.sh"

# needs_of MODULE: what runs it, an environment of lib/python.sh or the machine's python3, and what is built for it.
needs_of() {
    case $1 in
        bench_all) echo measure aftershade effect_bench exr_bench ;;
        bench_bandwidth) echo measure aftershade fetch_bench ;;
        bench_compare) echo compare flip_bench ;;
        bench_dof | bench_isf | bench_sss) echo measure aftershade effect_bench ;;
        bench_exr) echo measure exr_bench ;;
        bench_graph) echo python3 graph_bench ;;
        bench_ocio) echo ocio aftershade effect_bench ;;
        bench_python | bench_render) echo python3 aftershade ;;
        bench_roofline) echo measure effect_bench ;;
        check_compare_8k) echo compare aftershade ;;
        make_starter_capture) echo measure ;;
        quality_bokeh) echo python3 aftershade effects_test ;;
        *) echo measure aftershade ;;
    esac
}

run_module() {
    local module=$1 needs target options=()
    shift
    source "$scripts/setup.sh"
    source "$scripts/lib/python.sh"
    read -ra needs < <(needs_of "$module")
    if [ "$module" = bench_all ]; then python_with bpy; fi
    python=${PYTHON:-python3}
    if [ "${needs[0]}" != python3 ]; then python_with "${needs[0]}"; fi
    for target in "${needs[@]:1}"; do
        case $target in
            *_bench) options=(-DAFTERSHADE_BENCHMARKS=ON) ;;
            *_test) options=(-DAFTERSHADE_TESTS=ON) ;;
        esac
        if [ "$target" != aftershade ] || [ -z "${AFTERSHADE:-}" ]; then build_target "$target" "${options[@]}"; fi
    done
    PYTHONPATH=$scripts exec "$python" -m "measure.$module" "$@"
}

# run_named NAME [ARGUMENTS]
run_named() {
    local name=$1 file
    shift
    file=$(files_named | sed -n "s/^$name //p")
    case $file in
        "")
            echo "scripts/$kind: no '$name' (known: $(files_named | cut -d ' ' -f 1 | paste -sd ' '))" >&2
            exit 64
            ;;
        *.py | *.mjs)
            if [[ ${1:-} == --help || ${1:-} == -h ]]; then
                usage_of "$file"
                exit 0
            fi
            ;;
    esac
    case $file in
        *.py) run_module "$(basename "$file" .py)" "$@" ;;
        *.mjs)
            export AFTERSHADE_EXECUTABLE=${AFTERSHADE_EXECUTABLE:-$scripts/../build/release/aftershade} AFTERSHADE_CACHE=off
            exec node "$file" "$@"
            ;;
        *) exec "$file" "$@" ;;
    esac
}
