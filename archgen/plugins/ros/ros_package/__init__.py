"""Read a package of ROS: its parameters, declared or set, and its messages, as component types and types."""
