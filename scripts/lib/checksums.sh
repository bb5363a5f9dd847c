# Sourced by scripts that make what others install.
#
#   system_name               debian-12_amd64: the release and the architecture of this machine, as names of packages have them
#   write_checksums FOLDER NAME   adds FOLDER/NAME.sha256 of all files there, lists them, and prints its SHA-256, which a recipe
#                             of CI can pin
system_name() { (. /etc/os-release && echo "$ID-${VERSION_ID:-${VERSION_CODENAME:-}}_$(dpkg --print-architecture)"); }

write_checksums() {
    (
        cd "$1" || exit
        rm -f "$2.sha256"
        sha256sum -- * >"$2.sha256"
        ls -- *
        echo "SHA-256 of $2.sha256: $(sha256sum "$2.sha256" | cut -d ' ' -f 1)"
    )
}
