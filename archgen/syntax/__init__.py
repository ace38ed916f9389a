"""Syntax: files become trees with positions. YAML, and the interface definitions of ROS."""
