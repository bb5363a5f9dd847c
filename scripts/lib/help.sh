# Sourced first by the scripts of scripts/: `--help` prints the comment at a script's top, and no script runs without the
# arguments that its usage line, "scripts/NAME ARGUMENT" or "scripts/KIND NAME ARGUMENT", asks for.
if [ "$(type -t usage_of)" = function ]; then return; fi

# usage_of FILE: the comment at its top, or a Python file's first string.
usage_of() {
    if head -n 1 "$1" | grep -q '^"""\|python3$'; then
        awk '/^"""/ && !inside { inside = 1; sub(/^"""/, "") }
             inside { last = sub(/""".*/, ""); print; if (last) exit }' "$1"
    else
        sed -n '/^#!/d; /^\/\/\|^#/!q; s/^\(#\|\/\/\) \{0,1\}//p' "$1"
    fi
}

case ${1:-} in
    --help | -h)
        usage_of "$0"
        if [ "$(type -t list_named)" = function ]; then list_named; fi
        exit 0
        ;;
esac
if [ $# -eq 0 ] && [ "$(type -t list_named)" != function ] &&
    usage_of "$0" | grep -Eq "^ *scripts/((check|make) )?$(basename "$0") [A-Z]"; then
    usage_of "$0" >&2
    exit 2
fi
