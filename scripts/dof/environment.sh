# Sourced by scripts/quality-*, scripts/bench-* and tests/bench/*-against-blender: Python with numpy, OpenEXR, Pillow and
# matplotlib in build/dof-venv. Needs Debian's python3-venv, and PyPI the first time.
dof_python=build/dof-venv/bin/python
if [ ! -e build/dof-venv/complete ]; then
    install_packages python3-venv
    /usr/bin/python3 -m venv build/dof-venv
    build/dof-venv/bin/pip install --quiet 'numpy>=2,<3' 'OpenEXR>=3.3,<4' 'pillow>=10' 'matplotlib>=3.8,<4'
    touch build/dof-venv/complete
fi
