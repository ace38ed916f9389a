"""Read definition files of components of the Orca Robotics project."""
