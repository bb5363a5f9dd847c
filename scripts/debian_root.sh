# Sourced by scripts/check-bare-debian and scripts/check-ci-recipes: a Debian 12 that has nothing, made by debootstrap and
# reaching the package mirror as this machine does. Needs root, debootstrap and about 3 GB.
#
#   fresh_root FOLDER       makes FOLDER/root from a fresh copy of FOLDER/pristine, which is kept; sets $root
#   leave_root              unmounts what fresh_root mounted; for the trap EXIT
#   in_root COMMAND...      runs it there
fresh_root() {
    local pristine=$1/pristine file
    root=$1/root
    [ -e "$pristine/etc/debian_version" ] || debootstrap --variant=minbase bookworm "$pristine" >/dev/null
    leave_root
    rm -rf --one-file-system "$root"
    cp -a "$pristine" "$root"
    cp /etc/resolv.conf "$root/etc/"
    # The package mirror and its certificates as this machine reaches them.
    rm -f "$root/etc/apt/sources.list"
    for file in /etc/apt/apt.conf.d /etc/apt/sources.list.d/debian.sources /etc/ssl/certs/ca-certificates.crt; do
        [ -e "$file" ] && mkdir -p "$root/$(dirname "$file")" && cp -a "$file" "$root/$(dirname "$file")/"
    done
    mount -t proc proc "$root/proc"
}

leave_root() { ! mountpoint -q "$root/proc" || umount "$root/proc"; }

in_root() { chroot "$root" env -i HOME=/root TERM=dumb PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
                http_proxy="${http_proxy:-}" https_proxy="${https_proxy:-}" "$@"; }
