"""Launch files read as ROS reads them: which tags and attributes there are, and what is a substitution in a text.

After launch and launch_ros (their frontends' grammar and the `parse` of each action, humble to kilted) and roslaunch (noetic).
"""

from __future__ import annotations

import ast
import re
import shlex
from collections.abc import Mapping
from pathlib import Path
from xml.etree import ElementTree as ET

from archgen.pipeline import check_project
from archgen.products.output_options import OutputOptions
from archgen.products.workspace_product import WorkspaceRequest, write_workspace

_BOOLEAN = re.compile(r"true|false")
_NUMBER = re.compile(r"\d+\.\d+")
_TEXT = re.compile(r".*", re.DOTALL)
_PROCESS = {
    "cwd": _TEXT,
    "launch-prefix": _TEXT,
    "output": re.compile("both"),
    "respawn": _BOOLEAN,
    "respawn_delay": _NUMBER,
}
_NODE = {"pkg": _TEXT, "exec": _TEXT, "name": _TEXT, "namespace": _TEXT, "args": _TEXT, **_PROCESS}
ROS_2_TAGS: Mapping[str, Mapping[str, re.Pattern[str]]] = {
    "launch": {},
    "arg": {
        "name": _TEXT,
        "default": _TEXT,
        "description": _TEXT,
        "value": re.compile(r"\$\(var (prefix|scheduling)\)"),
    },
    "let": {"name": _TEXT, "value": _TEXT, "if": _TEXT, "unless": _TEXT},
    "group": {},
    "include": {"file": _TEXT, "if": _TEXT},
    "node": _NODE,
    "node_container": _NODE,
    "load_composable_node": {"target": _TEXT},
    "composable_node": {"pkg": _TEXT, "plugin": _TEXT, "name": _TEXT, "namespace": _TEXT},
    "extra_arg": {"name": _TEXT, "value": _TEXT},
    "set_env": {"name": _TEXT, "value": _TEXT},
    "executable": {"cmd": _TEXT, "name": _TEXT, **_PROCESS},
    "env": {"name": _TEXT, "value": _TEXT},
    "remap": {"from": _TEXT, "to": _TEXT},
    "param": {"from": _TEXT, "name": _TEXT, "value": _TEXT, "type": re.compile("str")},
}
ROS_2_REQUIRED: Mapping[str, frozenset[str]] = {
    "arg": frozenset({"name"}),
    "let": frozenset({"name", "value"}),
    "include": frozenset({"file"}),
    "node": frozenset({"pkg", "exec"}),
    # Its namespace has no default in Python.
    "node_container": frozenset({"pkg", "exec", "name", "namespace"}),
    "load_composable_node": frozenset({"target"}),
    "composable_node": frozenset({"pkg", "plugin", "name"}),
    "extra_arg": frozenset({"name", "value"}),
    "set_env": frozenset({"name", "value"}),
    "executable": frozenset({"cmd"}),
    "env": frozenset({"name", "value"}),
    "remap": frozenset({"from", "to"}),
}
ROS_2_CHILDREN: Mapping[str, frozenset[str]] = {
    "launch": frozenset(
        {"arg", "set_env", "let", "group", "node", "node_container", "load_composable_node", "executable"}
    ),
    "group": frozenset({"include"}),
    "include": frozenset({"arg"}),
    "node": frozenset({"env", "remap", "param"}),
    "node_container": frozenset({"env", "remap", "param", "composable_node"}),
    "load_composable_node": frozenset({"composable_node"}),
    "composable_node": frozenset({"remap", "param", "extra_arg"}),
    "executable": frozenset({"env"}),
}
_NODE_1 = {
    **dict.fromkeys(("pkg", "type", "name", "ns", "args", "launch-prefix"), _TEXT),
    "respawn": _BOOLEAN,
    "respawn_delay": _NUMBER,
    "output": re.compile("screen"),
}
ROS_1_TAGS: Mapping[str, Mapping[str, re.Pattern[str]]] = {
    "launch": {},
    "arg": {
        "name": _TEXT,
        "default": _TEXT,
        "doc": _TEXT,
        "if": _TEXT,
        "unless": _TEXT,
        "value": re.compile(
            r"\$\(arg (prefix|scheduling)\)|(\$\(find \w+\)/scripts/run_scheduled (chrt|taskset) .* --)?"
        ),
    },
    "include": {"file": _TEXT, "if": _TEXT},
    "node": _NODE_1,
    "env": {"name": _TEXT, "value": _TEXT},
    "remap": {"from": _TEXT, "to": _TEXT},
    "rosparam": {"command": re.compile("load"), "file": _TEXT},
    "param": {"name": _TEXT, "value": _TEXT, "command": _TEXT, "type": re.compile("str")},
}
ROS_1_REQUIRED: Mapping[str, frozenset[str]] = {
    "arg": frozenset({"name"}),
    "include": frozenset({"file"}),
    "node": frozenset({"pkg", "type", "name"}),
    "env": frozenset({"name", "value"}),
    "remap": frozenset({"from", "to"}),
    "rosparam": frozenset({"command", "file"}),
    "param": frozenset({"name"}),
}
ROS_1_CHILDREN: Mapping[str, frozenset[str]] = {
    "launch": frozenset({"arg", "include", "node", "param"}),
    "include": frozenset({"arg"}),
    "node": frozenset({"env", "remap", "rosparam", "param"}),
}
_SUBSTITUTIONS_2 = {"find-pkg-share", "find-pkg-prefix", "env", "var", "command"}
_SUBSTITUTIONS_1 = {"find", "env", "arg"}


def make_launch_workspace(project: Path, folder: Path, backend: str, **request: str | None) -> tuple[Path, list[str]]:
    """Generate a project's launch files, and return the folder of their package, and what was left out."""
    checked_project = check_project(project)
    assert not checked_project.has_errors, checked_project.findings
    result = write_workspace(checked_project, OutputOptions(), backend, folder, WorkspaceRequest(**request))  # type: ignore[arg-type]
    packages = list((folder / "src").iterdir()) if (folder / "src").is_dir() else [folder]
    return packages[0], [finding.message for finding in result.findings]


def read_launch_file(file: Path, ros: int) -> ET.Element:
    """Parse a launch file, and demand that ROS knows all that stands in it."""
    tags, required, children = (
        (ROS_2_TAGS, ROS_2_REQUIRED, ROS_2_CHILDREN) if ros == 2 else (ROS_1_TAGS, ROS_1_REQUIRED, ROS_1_CHILDREN)
    )
    root = ET.parse(file).getroot()  # noqa: S314 - of archgen itself
    assert root.tag == "launch"
    for element in root.iter():
        assert not (element.text or "").strip()
        assert not (element.tail or "").strip()
        assert required.get(element.tag, frozenset()) <= set(element.attrib), element.tag
        for name, value in element.attrib.items():
            assert tags[element.tag][name].fullmatch(value), (element.tag, name, value)
            # Each text can be read.
            read_text_2(value) if ros == 2 else read_text_1(value)
        for child in element:
            assert child.tag in children[element.tag], (element.tag, child.tag)
    _take_prefix(root, "$(var prefix)" if ros == 2 else "$(arg prefix)")
    return root


def _take_prefix(root: ET.Element, prefix: str) -> None:
    """Read a launch file of the first robot: nothing stands in front of its names, all of which begin with `/`."""
    (argument,) = (each for each in root if each.get("name") == "prefix")
    assert argument.get("default") == ""
    root.remove(argument)
    for element in root.iter():
        for child in element.findall("arg"):
            if child.get("value") == prefix:
                element.remove(child)
        for name, value in element.attrib.items():
            assert all(rest.startswith(("/", "'/")) for rest in value.split(prefix)[1:]), (name, value)
            element.set(name, value.replace(prefix, ""))


def read_text_2(value: str) -> list[tuple[str, str]]:
    """Return the pieces of a text in ROS 2: `("text", ...)`, or the name of a substitution with its argument."""
    pieces: list[tuple[str, str]] = []
    text, place = "", 0
    while place < len(value):
        if value[place] == "\\" and place + 1 < len(value):
            # As Python's `.`, it leaves the ends of lines alone.
            text += value[place + 1] if value[place + 1] != "\n" else "\\\n"
            place += 2
        elif value.startswith("$(", place):
            found = re.compile(r"\$\(([a-z-]+) (?:'((?:[^'\\]|\\.)*)'|([^\s'\"\\$()]+))\)", re.DOTALL).match(
                value, place
            )
            assert found, value[place:]
            assert found[1] in _SUBSTITUTIONS_2, value[place:]
            quoted = re.sub(r"\\(.)", r"\1", found[2]) if found[2] is not None else found[3]
            assert found[2] is None or not re.search(r"(?<!\\)\$\(", found[2])
            pieces += [("text", text)] if text else []
            pieces.append((found[1], quoted))
            text, place = "", found.end()
        else:
            text += value[place]
            place += 1
    return [*pieces, ("text", text)] if text or not pieces else pieces


def read_literal_2(value: str) -> str:
    """Return a text in which nothing is a substitution."""
    ((kind, text),) = read_text_2(value)
    assert kind == "text"
    return text


def read_text_1(value: str) -> str:
    """Return a text of ROS 1 with `$(eval ...)` evaluated; only what a launch file may say is a substitution."""
    if value.startswith("$(eval ") and value.endswith(")"):
        assert "__" not in value
        return str(ast.literal_eval(value[7:-1]))
    for found in collect_arguments_1(value):
        assert found.split()[0] in _SUBSTITUTIONS_1, value
    return value


def collect_arguments_1(value: str) -> list[str]:
    """Return what roslaunch takes for substitutions: its own machine with four states."""
    found: list[str] = []
    state, inside = "out", ""
    for character in value:
        if character == "$":
            assert state in {"out", "dollar"}, value
            state = "dollar"
        elif character == "(":
            assert state in {"out", "dollar"}, value
            state = "opened" if state == "dollar" else "out"
        elif character == ")":
            found += [inside] if state == "in" else []
            state, inside = "out", ""
        elif state == "dollar":
            state = "out"
        elif state == "opened":
            state = "in"
        inside += character if state == "in" else ""
    return found


def read_words_1(value: str) -> list[str]:
    """Return the words of arguments as the program gets them: nothing of them is a substitution, however often one looks."""
    assert collect_arguments_1(value) == []
    return shlex.split(value)
