"""Read what stands behind `--ros-args` (names, remaps, parameters and files), and in front of a program: `sudo`, `env`."""

from __future__ import annotations

from collections.abc import Callable

from archgen.plugins.ros.launch.command_words import split_words
from archgen.plugins.ros.launch.launch_parameter_values import read_value_text
from archgen.plugins.ros.launch.launch_values import OPEN
from archgen.plugins.ros.launch.launched_nodes import LaunchedNode, join_names

_WITH_VALUE = frozenset(
    {"-r", "--remap", "-p", "--param", "--params-file", "--log-level", "--log-file-name", "-e", "--enclave"}
)


def read_ros_arguments(node: LaunchedNode, add_file: Callable[[str], None]) -> None:
    """Take the arguments of ROS out of a node's arguments, and set what they say."""
    kept: list[str] = []
    rules: dict[str, str] = {}
    words = iter(node.arguments)
    is_for_ros = False
    for word in words:
        if word == "--ros-args":
            is_for_ros = True
        elif word == "--" and is_for_ros:
            is_for_ros = False
        elif is_for_ros and word in _WITH_VALUE:
            _read_rule(node, word, next(words, ""), rules, add_file)
        elif not is_for_ros:
            kept.append(word)
    node.arguments = kept
    # On the command line they stand before those of groups and of the node itself, and the first rule for a name counts.
    if "__ns" in rules:
        node.namespace = join_names("", rules.pop("__ns"))
    names = [rules.pop(key) for key in ("__node", "__name") if key in rules]
    node.name = names[0] if names else node.name
    node.remaps = rules | {name: value for name, value in node.remaps.items() if name not in rules}


def _read_rule(
    node: LaunchedNode, word: str, rule: str, rules: dict[str, str], add_file: Callable[[str], None]
) -> None:
    name, joint, value = rule.partition(":=")
    if word == "--params-file":
        add_file(rule)
    elif not joint:
        return
    elif word in {"-p", "--param"}:
        node.parameters[name] = read_value_text(value)
    elif word in {"-r", "--remap"}:
        rules.setdefault(name, value)


def read_nodelet(node: LaunchedNode) -> None:
    """Read what `nodelet` of ROS 1 is told: to load a plug-in, or to be a manager."""
    if node.package != "nodelet" or node.executable != "nodelet" or not node.arguments:
        return
    verb, *rest = node.arguments
    if verb == "manager":
        node.form, node.package, node.executable, node.arguments = "container", "", "", rest
        return
    if verb not in {"load", "standalone"} or not rest:
        return
    node.is_nodelet, node.form, node.plugin = True, "loaded", rest[0]
    node.package, node.executable = rest[0].partition("/")[0] if "/" in rest[0] else "", ""
    is_loaded = verb == "load" and len(rest) > 1
    if is_loaded:
        node.container_name = join_names(node.namespace, rest[1])
    node.arguments = rest[2:] if is_loaded else rest[1:]


def read_prefix(node: LaunchedNode, prefix: str) -> str:
    """Set the user and the folder that a prefix such as `sudo -u robot -- env -C /opt` says; return what is left of it."""
    words = split_words(prefix)
    if words[:1] == ["sudo"] and "-u" in words[1:-1] and OPEN not in prefix:
        place = words.index("-u")
        node.user = words[place + 1]
        words = words[place + 2 :]
        words = words[1:] if words[:1] == ["--"] else words
    if words[:2] == ["env", "-C"] and len(words) == 3:  # noqa: PLR2004 - `env -C FOLDER`
        node.directory, words = words[2], []
    return " ".join(words)
