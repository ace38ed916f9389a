"""Generators of ROS workspaces: packages of interfaces and of nodes in Python and C++, launch files."""

PLUGIN = {
    "api": 1,
    "page": "docs/generation.md",
    "views": {
        "interfaces": "archgen.plugins.ros_code.interface_packages:make_view",
        "programs": "archgen.plugins.ros_code.node_programs:make_view",
        "ros1_programs": "archgen.plugins.ros_code.node_programs:make_ros1_view",
        "ros1_launch": "archgen.plugins.ros_code.launch_view:make_ros1_view",
        "ros2_launch": "archgen.plugins.ros_code.launch_view:make_ros2_view",
    },
}
