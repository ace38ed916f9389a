"""Read launch files of ROS 1 and ROS 2, in XML, YAML and Python: the nodes that they start. Nothing in them is run."""
