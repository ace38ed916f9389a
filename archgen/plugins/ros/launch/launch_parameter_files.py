"""Read the parameter files that launch files name, where they lie beside: what they say to a node."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from archgen.plugin.importing import (
    ForeignFileError,
    MappingNode,
    ScalarNode,
    Span,
    YamlNode,
    node_to_data,
    read_bounded,
)
from archgen.plugin.ros import ParameterText, matches_node_name, read_parameter_text
from archgen.plugins.ros.launch.launch_parameter_values import read_value_text

_YAML_1_1_WORDS = {"yes": True, "on": True, "no": False, "off": False}
"""What ROS 1 reads as booleans besides `true` and `false`."""
_MAX_BYTES = 4_000_000
MAX_OPENED_BYTES = 32_000_000
"""How much YAML launch files in Python may open altogether."""
FILE_KIND = "parameter file"
"""The substitution for a file among parameters: its path, the namespace of its values, and its FileRewrites."""


class ParameterFileReader:
    """Reads each file once. `show` gives its name in messages."""

    def __init__(self) -> None:
        self._texts: dict[Path, ParameterText | None] = {}
        self._sizes: dict[Path, int] = {}
        self._opened = 0

    def read_for_node(self, path: Path, full_name: str) -> dict[str, Any] | None:
        """Return the values that a file of ROS 2 gives to a node, by their dotted names; None where it cannot be read."""
        text = self._read(path)
        if text is None or (not text.sections and text.root is None):
            return None
        parts = tuple(part for part in full_name.split("/") if part)
        candidates = text.list_candidates(parts[-1] if parts else "")
        return {
            value.name: value.value
            for section in candidates
            if matches_node_name(section.pattern, parts)
            for value in section.values
        }

    def read_whole(self, path: Path) -> dict[str, Any] | None:
        """Return all values of a file of ROS 1, nested as it has them; None where it cannot be read."""
        text = self._read(path)
        return _read_tree(text.root) if text is not None and text.root is not None else None

    def read_mapping(self, path: Path) -> dict[str, Any] | None:
        """Return what a file in YAML says, with its keys as they are; None where it cannot be read."""
        text = self._read(path)
        # A launch file may open the same file in a loop.
        self._opened += self._sizes.get(path, 0)
        if text is None or text.root is None or self._opened > MAX_OPENED_BYTES:
            return None
        return _read_tree(text.root, "")

    def _read(self, path: Path) -> ParameterText | None:
        if path not in self._texts:
            try:
                data = read_bounded(path, _MAX_BYTES).decode("utf-8", "replace").removeprefix("\ufeff")
            except ForeignFileError:
                self._texts[path] = None
            else:
                self._sizes[path] = len(data)
                text = read_parameter_text(path.name, data)
                self._texts[path] = None if text.problem else text
        return self._texts[path]


def _read_tree(node: MappingNode, ends: str = "/") -> dict[str, Any]:
    """Return a mapping as data, its keys without some characters at their ends."""
    return {entry.key.strip(ends): _read_value(entry.value, ends) for entry in node}


def _read_value(node: YamlNode, ends: str) -> Any:  # noqa: ANN401
    if isinstance(node, MappingNode):
        return _read_tree(node, ends)
    if isinstance(node, ScalarNode) and node.is_plain and node.text.lower() in _YAML_1_1_WORDS:
        return _YAML_1_1_WORDS[node.text.lower()]
    return node.text if isinstance(node, ScalarNode) and not node.is_plain else node_to_data(node)


def read_inline_values(text: str, span: Span) -> dict[str, Any] | None:
    """Return the values of YAML that stands in a launch file; None where it is no mapping."""
    source = read_parameter_text(span.file, text)
    return None if source.problem or source.root is None else _read_tree(source.root)


def read_inline_value(text: str) -> Any:  # noqa: ANN401
    """Return one value of YAML that stands in a launch file."""
    return read_value_text(text)


def overlay_parameters(values: dict[str, Any], more: Mapping[str, Any]) -> None:
    """Put values over others, leaf by leaf."""
    for name, value in more.items():
        old = values.get(name)
        if isinstance(old, dict) and isinstance(value, dict):
            overlay_parameters(old, value)
        else:
            values[name] = value
