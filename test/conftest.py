"""What every test needs before ROS is imported."""

import os

# Stay on this machine, and refuse values that rclpy would otherwise garble without a word.
os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
os.environ['ROS_PYTHON_CHECK_FIELDS'] = '1'

# A domain for each test process, among those that leave its ports free: 1 to 101.
os.environ['ROS_DOMAIN_ID'] = str(1 + os.getpid() % 101)
