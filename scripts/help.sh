# Sourced first by the scripts of this folder: `--help` prints the comment at a script's top, and no script runs without the
# arguments that its usage line, "scripts/NAME ARGUMENT", asks for.
usage_of() { sed -n '2,/^[^#]/{/^#/s/^# \{0,1\}//p}' "$0"; }
case ${1:-} in
    --help | -h)
        usage_of
        exit 0
        ;;
esac
if [ $# -eq 0 ] && usage_of | grep -q "^ *scripts/$(basename "$0") [A-Z]"; then
    usage_of >&2
    exit 2
fi
