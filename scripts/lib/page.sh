# Sourced by scripts/test: Debian's Chromium, Node, and what tests/page/package-lock.json pins, in build/page-modules; the
# tests of the report's page run in them. Needs npm's registry the first time.
page_lock=tests/page/package-lock.json
install_packages chromium
command -v node >/dev/null || install_packages nodejs
if ! cmp -s "$page_lock" build/page-modules/package-lock.json || [ ! -e build/page-modules/complete ]; then
    command -v npm >/dev/null || install_packages npm
    # Chained, for where `set -e` is off: "complete" says that all of it is there.
    rm -rf build/page-modules && mkdir -p build/page-modules &&
        cp "$page_lock" tests/page/package.json build/page-modules/ &&
        npm ci --silent --no-audit --no-fund --prefix build/page-modules &&
        touch build/page-modules/complete
fi
