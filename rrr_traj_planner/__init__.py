"""Trajectory planning for a three-joint (RRR) robot arm, on ROS 2."""
