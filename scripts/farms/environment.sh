# Sourced by scripts/test and scripts/check-farms, after scripts/setup.sh: GNU parallel, and in build/farms-venv what reads
# the jobs of `aftershade submit`: openjd, kubernetes-validate and PyOutline; and
# dockerfile-parse, which reads the container recipe. Puts them on PATH. Needs PyPI the first time.
farms_venv=$PWD/build/farms-venv
install_packages python3-venv parallel
if [ ! -e "$farms_venv/complete-2" ]; then
    # Chained, for where `set -e` is off. PyOutline imports packaging and setuptools without asking for them.
    /usr/bin/python3 -m venv --clear "$farms_venv" &&
        "$farms_venv/bin/pip" install --quiet 'openjd-cli==0.8.0' 'kubernetes-validate==1.37.0' 'opencue-pyoutline==1.37.0' \
            'dockerfile-parse==2.0.1' packaging 'setuptools<80' 'OpenEXR>=3.3' 'numpy>=2' &&
        touch "$farms_venv/complete-2"
fi
export PATH="$PATH:$farms_venv/bin"
