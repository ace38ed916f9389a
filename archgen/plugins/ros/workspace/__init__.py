"""Read a whole workspace of ROS: launch files, packages, sources and the library that ships, joined to one architecture."""
