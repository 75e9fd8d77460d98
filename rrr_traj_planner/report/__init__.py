"""Pages with figures and tables of plans; what they show, without ROS and without a network."""
