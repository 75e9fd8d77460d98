"""Model, kinematics, dynamics, motion pieces and control of an RRR arm; no ROS."""
