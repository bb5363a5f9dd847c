# Sourced by scripts that build: brings a fresh machine to where the project builds. Debian 12 and newer, and what follows
# them, have all packages; docs/platforms.md lists what has been tried.
#
#   install_packages PACKAGE...   installs what dpkg does not have, and leaves out a PACKAGE? that this distribution has
#                                 not; needs root or sudo, else prints the line to run
#   build_target TARGET [-D...]   configures the preset release and builds
source "$(dirname "${BASH_SOURCE[0]}")/lib/help.sh"
export LC_ALL=C.UTF-8
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit

# CMake uses a ccache that is installed; on a first build it costs a tenth, so that it is not among these.
build_packages=(
    cmake ninja-build g++
    python3 python3-glad        # the GL loader is generated when configuring
    libopenexr-dev libimath-dev libglm-dev libstb-dev libfmt-dev nlohmann-json3-dev libcli11-dev libmurmurhash-dev
    libtinygltf-dev libxxhash-dev zlib1g-dev libdeflate-dev libopencolorio-dev?
)
# Opened at run time, so nothing pulls them in; without libgl1-mesa-dri EGL finds no driver.
gl_packages=(libegl1 libegl-mesa0 libgl1-mesa-dri)
# The other software backend: Mesa up to 25.0 has it, and so Debian up to 13.
osmesa_packages=(libosmesa6?)

without_apt() {
    cat >&2 <<'TEXT'
This system has no apt, so nothing is installed. Aftershade is built with: CMake 3.23, Ninja, GCC 12 or Clang 16, Python 3 with
glad 2, and the headers of OpenEXR 3.1, Imath, glm, stb, fmt 9, nlohmann-json 3.11, CLI11 2.1, MurmurHash, tinygltf 2.5, xxHash,
zlib and, for speed, libdeflate, and for colour, OpenColorIO 2.1; or newer ones. It runs on OpenGL 4.5 through EGL (a GPU or Mesa's llvmpipe) or through OSMesa.
Tests need GoogleTest.
TEXT
}

is_installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

install_packages() {
    if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
        without_apt
        return
    fi
    local missing=() optional=() package
    for package in "$@"; do
        if is_installed "${package%\?}"; then continue; fi
        case $package in *\?) optional+=("${package%\?}") ;; *) missing+=("$package") ;; esac
    done
    [ $((${#missing[@]} + ${#optional[@]})) -eq 0 ] && return
    local as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        [ ${#missing[@]} -eq 0 ] && return  # nothing that has to be
        if ! command -v sudo >/dev/null; then
            echo "These packages are missing and neither root nor sudo is at hand. Run as root:" >&2
            echo "    apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
            exit 1
        fi
        as_root=(sudo)
    fi
    [ ${#missing[@]} -eq 0 ] || "${as_root[@]}" apt-get update -qq
    for package in "${optional[@]}"; do
        if apt-cache show --no-all-versions "$package" >/dev/null 2>&1; then missing+=("$package"); fi
    done
    [ ${#missing[@]} -eq 0 ] && return
    echo "installing: ${missing[*]}"
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
        "${missing[@]}" >/dev/null
}

build_target() {
    local target=$1 jobs
    shift
    # A compiler takes up to 1.6 GB here; Ninja alone would start two more than there are cores.
    jobs=$(awk -v cores="$(nproc)" '/^MemAvailable/ { fit = int($2 / 1.7e6); print fit < 1 ? 1 : fit < cores ? fit : cores }' /proc/meminfo)
    export CMAKE_BUILD_PARALLEL_LEVEL=${CMAKE_BUILD_PARALLEL_LEVEL:-$jobs}
    mkdir -p build
    local log=build/build.log
    if ! { cmake --preset release "$@" && cmake --build --preset release --target "$target"; } >"$log" 2>&1; then
        tail -n 60 "$log" >&2
        echo "The build failed; the whole log is $log" >&2
        exit 1
    fi
}
