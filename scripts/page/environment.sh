# Sourced by scripts/test: Debian's Chromium, Node, and what tests/page/package-lock.json pins, in build/page-modules; the
# tests of the report's page run in them. Needs npm's registry the first time.
page_lock=tests/page/package-lock.json
if ! cmp -s "$page_lock" build/page-modules/package-lock.json || [ ! -e build/page-modules/complete ]; then
    install_packages chromium
    command -v node >/dev/null || install_packages nodejs
    command -v npm >/dev/null || install_packages npm
    rm -rf build/page-modules && mkdir -p build/page-modules &&
        cp "$page_lock" tests/page/package.json build/page-modules/ &&
        npm ci --silent --no-audit --no-fund --prefix build/page-modules 2>/dev/null &&
        touch build/page-modules/complete
fi
