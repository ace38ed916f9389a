"""ROS: what exists of a robot, from its launch files, packages and descriptions of nodes, and from the running robot."""

PLUGIN = {
    "api": 1,
    "page": "docs/existing_robot.md",
    "importers": {
        "nodl": {
            "rank": 4,
            "summary": "interfaces of nodes in the Node Definition Language, version 1 (XML) and 2 (YAML, JSON)",
            "endings": (".nodl.yaml", ".nodl.yml", ".nodl.json", ".nodl.xml"),
            "reader": "archgen.plugins.ros.nodl.nodl_import:read_nodl",
        },
        "launch": {
            "rank": 5,
            "summary": "nodes that exist, from launch files of ROS in XML, YAML and Python (which is never run)",
            "endings": (
                ".launch",
                *(f"{mark}launch.{ending}" for mark in "._" for ending in ("xml", "py", "yaml", "yml")),
            ),
            "reader": "archgen.plugins.ros.launch.launch_import:read_launch",
            "takes_arguments": True,
            "takes_environment": True,
        },
        "workspace": {
            "rank": 4.5,
            "summary": "a robot from its workspace: launch files, packages, sources in Python and C++",
            "endings": (),
            "reader": "archgen.plugins.ros.workspace.workspace_import:read_workspace",
            "takes_arguments": True,
            "takes_environment": True,
            "takes_launch_files": True,
        },
        "package": {
            "rank": 6,
            "summary": "packages of ROS: their programs, parameters and messages (package.xml, or a folder)",
            "endings": ("package.xml",),
            "reader": "archgen.plugins.ros.ros_package.package_import:read_packages",
        },
        "ros2": {
            "rank": 7,
            "summary": "a running robot, from what `ros2 node info` and its like print",
            "endings": (),
            "reader": "archgen.plugins.ros.running_graph.graph_import:read_ros_2_graph",
            "has_dated_files": True,
        },
        "ros1": {
            "rank": 8,
            "summary": "a running robot, from what `rosnode info` and its like print",
            "endings": (),
            "reader": "archgen.plugins.ros.running_graph.graph_import:read_ros_1_graph",
            "has_dated_files": True,
        },
    },
    "readers": {"the recorder of graphs": "archgen.plugins.ros.running_graph.graph_observation:read_recorder"},
    "observers": {
        "workspace": {
            "rank": 1,
            "summary": "a folder with packages of ROS",
            "reader": "archgen.plugins.ros.workspace.workspace_observation:observe_workspace",
        },
        "graph": {
            "rank": 3,
            "summary": "what `archgen conform --recorder`, `ros2 node info` or `rosnode info` say of a running robot",
            "reader": "archgen.plugins.ros.running_graph.graph_observation:observe_graph",
        },
    },
}
