"""Read sources of nodes, in Python and C++, of ROS 1 and ROS 2: what each program says to ROS. Nothing of them is run or built."""
