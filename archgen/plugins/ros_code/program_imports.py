"""What the module of a node imports of messages, and what it calls their classes."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence

from archgen.plugin.generating import PORT_SECTIONS, make_camel_name

_IMPORTED_OF_ROS_2 = frozenset(
    [
        *("ActionClient", "ActionServer", "Clock", "ClockType", "Duration", "DurabilityPolicy"),
        *("ExternalShutdownException", "FloatingPointRange", "Future", "GoalResponse", "HistoryPolicy", "IntegerRange"),
        *("LifecycleNode", "LivelinessPolicy", "MultiThreadedExecutor", "MutuallyExclusiveCallbackGroup", "Node"),
        *("NotActive", "Parameter", "ParameterDescriptor", "QoSProfile", "ReentrantCallbackGroup", "ReliabilityPolicy"),
        *("SetParametersResult", "TransitionCallbackReturn"),
    ]
)
"""What the modules of nodes import of rclpy: a message of this name is imported under another one."""
_IMPORTED_OF_ROS_1 = frozenset(["RLock", "SimpleActionClient", "SimpleActionServer"])
"""The same of rospy, actionlib and Python."""
IMPORTED_CLASSES = _IMPORTED_OF_ROS_2 | _IMPORTED_OF_ROS_1
"""What no class of a program is called: it would hide what its module imports."""
_ROS_1_CLASSES: Mapping[str, Sequence[str]] = {
    "services": ("", "Response"),
    "action_servers": ("Action",),
    "action_clients": ("Action",),
}
"""How the classes end that are imported for a port in ROS 1; of a topic it is the message alone."""
_Sections = Mapping[str, Sequence[dict[str, object]]]


def import_in_ros_2(sections: _Sections, class_name: str) -> list[dict[str, object]]:
    """Return what is imported of which module, and tell each port the class of its message (`python_class`).

    Messages of one name in several packages are told apart by their packages.
    """

    def list_classes(_section: str, port: Mapping[str, object]) -> tuple[str, list[str]]:
        return f"{port['package']}.{port['kind']}", [str(port["name"])]

    return _import_classes(
        sections, list_classes, {class_name, f"{class_name}Node", f"{class_name}StandIn", *_IMPORTED_OF_ROS_2}
    )


def import_in_ros_1(sections: _Sections, class_name: str) -> list[dict[str, object]]:
    """Return the same for ROS 1.

    There the response of a service is a class of its own (`part_class`), and an action is a message.
    """

    def list_classes(section: str, port: Mapping[str, object]) -> tuple[str, list[str]]:
        module = "srv" if port["kind"] == "srv" else "msg"
        return f"{port['package']}.{module}", [f"{port['name']}{end}" for end in _ROS_1_CLASSES.get(section, ("",))]

    return _import_classes(sections, list_classes, {class_name, f"{class_name}Node", *_IMPORTED_OF_ROS_1})


def _import_classes(
    sections: _Sections,
    list_classes: Callable[[str, Mapping[str, object]], tuple[str, list[str]]],
    taken_names: Collection[str],
) -> list[dict[str, object]]:
    listed = [(port, *list_classes(section, port)) for section in PORT_SECTIONS.values() for port in sections[section]]
    modules_by_name: dict[str, set[str]] = {}
    for _, module, names in listed:
        for name in names:
            modules_by_name.setdefault(name, set()).add(module)
    imports: dict[str, set[str]] = {}
    for port, module, names in listed:
        classes = []
        for name in names:
            is_taken = len(modules_by_name[name]) > 1 or name in taken_names
            classes.append(f"{make_camel_name(module)}{name}" if is_taken else name)
            imports.setdefault(module, set()).add(f"{name} as {classes[-1]}" if is_taken else name)
        port["python_class"], port["part_class"] = classes[0], classes[-1]
    return [{"module": module, "names": sorted(each)} for module, each in sorted(imports.items())]
