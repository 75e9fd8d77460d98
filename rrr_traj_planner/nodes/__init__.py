"""ROS 2 nodes and entry scripts around the planners and the core."""
