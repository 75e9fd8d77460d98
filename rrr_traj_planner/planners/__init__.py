"""Planners: a request in, a checked trajectory out; one file for each method; no ROS."""
