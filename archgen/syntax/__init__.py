"""Syntax: parse YAML files and ROS interface definitions into trees that know where each value was written."""
