# Sourced by scripts that need a Debian that has nothing, made by debootstrap and reaching the package mirror as this machine
# does. Needs root, debootstrap and about 3 GB.
#
#   fresh_root FOLDER [SUITE]   makes FOLDER/root from a fresh copy of FOLDER/pristine-SUITE, which is kept; sets $root.
#                               SUITE: bookworm unless given
#                               HIDE='libOSMesa*' or 'libEGL*': no package may install libraries of such names there; in
#                               place of EGL there is Debian's libosmesa6
#   leave_root                  unmounts what fresh_root mounted; for the trap EXIT
#   in_root COMMAND...          runs it there
fresh_root() {
    local pristine=$1/pristine-${2:-bookworm} file
    root=$1/root
    mkdir -p "$1"
    [ -e "$pristine/complete" ] || { debootstrap --variant=minbase "${2:-bookworm}" "$pristine" >"$pristine.log" && touch "$pristine/complete"; }
    leave_root
    rm -rf --one-file-system "$root"
    cp -a "$pristine" "$root"
    cp /etc/resolv.conf "$root/etc/"
    # The package mirror, PyPI and npm as this machine reaches them; certificates under a name that no package writes.
    cp -a /etc/apt/apt.conf.d/. "$root/etc/apt/apt.conf.d/"
    mkdir -p "$root/etc/ssl/certs"
    for file in /etc/ssl/certs/ca-certificates.crt /etc/ssl/mirror.crt; do
        cp /etc/ssl/certs/ca-certificates.crt "$root$file"
    done
    [ -z "${HIDE:-}" ] || echo "path-exclude=/usr/lib/*/$HIDE" >"$root/etc/dpkg/dpkg.cfg.d/hide"
    mount -t proc proc "$root/proc"
    mkdir -p "$root/dev/shm"
    mount -t tmpfs tmpfs "$root/dev/shm"
    [ "${HIDE:-}" != 'libEGL*' ] || in_root sh -c 'apt-get update -qq && apt-get install -y -qq --no-install-recommends libosmesa6'
}

leave_root() {
    local folder
    for folder in proc dev/shm; do ! mountpoint -q "$root/$folder" || umount "$root/$folder"; done
}

in_root() { chroot "$root" env -i HOME=/root TERM=dumb PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
                http_proxy="${http_proxy:-}" https_proxy="${https_proxy:-}" PIP_CERT=/etc/ssl/mirror.crt \
                NPM_CONFIG_CAFILE=/etc/ssl/mirror.crt "$@"; }
