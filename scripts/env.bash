# Puts a bash into the built environment: ROS 2 Jazzy, rrr_traj_planner, and its scripts on PATH.
#
#     source scripts/env.bash
#
# Prints nothing, unless `make setup` has not been run.

_rrr_env() {
    local root scripts nounset=${-//[^u]/}
    root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." > /dev/null && pwd) || return
    scripts=$root/install/rrr_traj_planner/lib/rrr_traj_planner
    if [ ! -d "$scripts" ]; then
        echo "rrr_traj_planner is not built: run 'make setup' in $root" >&2
        return 1
    fi
    set +u  # ROS's own files read variables that are not set
    source "$root/scripts/ros.bash"
    source "$root/install/local_setup.bash"
    PATH=$scripts:${PATH//"$scripts:"/}
    [ -z "$nounset" ] || set -u
}

_rrr_env && unset -f _rrr_env
