# Sourced by scripts/demo and scripts/test: brings a bare Debian 12 to where the project builds.
#
#   install_packages PACKAGE...   installs what dpkg does not have; needs root or sudo, else prints the line to run
#   build_target TARGET [-D...]   configures the preset release and builds
export LC_ALL=C.UTF-8
cd "$(dirname "${BASH_SOURCE[0]}")/.."

build_packages=(
    cmake ninja-build g++ ccache
    python3 python3-glad        # the GL loader is generated when configuring
    libopenexr-dev libimath-dev libglm-dev libstb-dev libfmt-dev nlohmann-json3-dev libcli11-dev libmurmurhash-dev
    libtinygltf-dev libxxhash-dev zlib1g-dev libdeflate-dev
)
# Opened at run time, so nothing pulls them in; without libgl1-mesa-dri EGL finds no driver.
gl_packages=(libegl1 libgl1-mesa-dri libosmesa6)

install_packages() {
    local missing=() package
    for package in "$@"; do
        [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
    done
    [ ${#missing[@]} -eq 0 ] && return
    local as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null; then
            echo "These packages are missing and neither root nor sudo is at hand. Run as root:" >&2
            echo "    apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
            exit 1
        fi
        as_root=(sudo)
    fi
    echo "installing: ${missing[*]}"
    "${as_root[@]}" apt-get update -qq
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
        "${missing[@]}" >/dev/null
}

build_target() {
    local target=$1
    shift
    mkdir -p build
    local log=build/build.log
    if ! { cmake --preset release "$@" && cmake --build --preset release --target "$target"; } >"$log" 2>&1; then
        tail -n 60 "$log" >&2
        echo "The build failed; the whole log is $log" >&2
        exit 1
    fi
}
