# Sourced with $root set, by env.bash and setup.bash: puts ROS 2 Jazzy on this bash, and before it
# the Python environment $root/.venv. ROS is what is sourced already, else what is installed in
# /opt/ros/jazzy, else the wheels in .venv, which then is a ROS prefix itself.

if [ -z "${ROS_DISTRO-}" ] || [ -z "${AMENT_PREFIX_PATH-}" ]; then
    if [ -f /opt/ros/jazzy/setup.bash ]; then
        source /opt/ros/jazzy/setup.bash
    else
        export AMENT_PREFIX_PATH=$root/.venv CMAKE_PREFIX_PATH=$root/.venv
        unset _ROS_WHEELS_BOOTSTRAP_COMPLETE  # set by another environment of wheels, if any
    fi
fi
PATH=$root/.venv/bin:${PATH//"$root/.venv/bin:"/}
