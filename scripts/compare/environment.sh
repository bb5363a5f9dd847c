# Sourced by scripts/test, scripts/bench-compare and scripts/make-compare-figures: Python with NVIDIA's flip-evaluator and
# scikit-image in build/compare-venv, which tests compare with. Needs Debian's python3-venv, and PyPI the first time.
compare_python=build/compare-venv/bin/python
if [ ! -e build/compare-venv/complete ]; then
    install_packages python3-venv
    # Chained, for where `set -e` is off: "complete" says that all of it is there.
    /usr/bin/python3 -m venv --clear build/compare-venv &&
        build/compare-venv/bin/pip install --quiet 'flip-evaluator==1.6.0.1' 'scikit-image>=0.22,<1' 'numpy>=2,<3' 'pillow>=10' &&
        touch build/compare-venv/complete
fi
