"""Read what the command-line tools of ROS print about a running robot: its nodes, topics, services, actions, parameters."""
