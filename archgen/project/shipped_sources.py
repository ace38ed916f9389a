"""Where the facts about the component types that ship with archgen were read: repository, version, date, file and line.

`ros_library/sources/` has a file for each distribution. It is read only when somebody asks: no check of a project does.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from typing import Any

from archgen import resources
from archgen.frozen import NamedTuple
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, YamlNode, find_value, list_entries

SOURCE_KINDS = ("documentation", "source text", "recording")
"""Words for what was read: what people wrote about the package, the package's own files, or a running node."""


_PROGRAM_KEYS = ("executable", "plugin", "own_name", "inner_nodes")
_USE_KINDS = ("publishes", "subscribes", "serves", "calls")
_NAMING_KEYS = ("named_by", "when")
"""What says which parameters name a port of the node, and whether it has the port. Its name itself is at the port's line."""


class ShippedSource(NamedTuple):
    """A state of a repository from which facts about a type were read."""

    address: str
    """The repository's, without the commit."""
    version: str
    released: str
    """The version that the distribution has; the one that was read, unless that one was not at hand."""
    commit: str
    date: str
    """The commit's, as YYYY-MM-DD."""
    kind: str
    files: Mapping[str, Mapping[str, int]]
    """The line of each fact, by the file's path in the repository and the fact's path in the type."""

    def format_link(self, file: str = "", line: int | None = None) -> str:
        """Return the address of a line, a file, or the whole commit."""
        if not file:
            return f"{self.address}/tree/{self.commit}"
        return f"{self.address}/blob/{self.commit}/{file}" + (f"#L{line}" if line else "")


@cache
def read_shipped_sources(distro: str) -> Mapping[str, tuple[ShippedSource, ...]]:
    """Return the sources of each type that ships for a distribution, by its name; read once."""
    import yaml

    # Not archgen's own parser: the file ships with archgen, and no position in it is ever reported.
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    path = resources.resource_path("ros_library", "sources", f"{distro}.yaml")
    data = yaml.load(path.read_text("utf-8"), loader)  # noqa: S506 - safe ones
    return {name: tuple(_read_source(source) for source in sources) for name, sources in data.items()}


def _read_source(source: dict[str, Any]) -> ShippedSource:
    return ShippedSource(
        source["address"],
        source["version"],
        source.get("released", source["version"]),
        source["commit"],
        str(source["date"]),
        source["kind"],
        source["files"],
    )


def list_type_facts(body: MappingNode) -> Iterator[str]:
    """Yield the paths of all that a type states about its package: its program, ports, operations, parameters.

    What is said of the world outside, such as who presses keys, is nothing that a package could say.
    """
    for entry in list_entries(body, "node"):
        if entry.key in _PROGRAM_KEYS:
            yield entry.key
        elif entry.key in _USE_KINDS and isinstance(entry.value, MappingNode):
            for use in entry.value:
                yield from (f"{key}.{use.key}" for key in _NAMING_KEYS if _has_key(use.value, key))
    for section in ("inputs", "outputs", "operations"):
        for entry in list_entries(body, section):
            medium = find_value(entry.value, "medium")
            if not (isinstance(medium, ScalarNode) and medium.text == "physical"):
                yield f"{section}.{entry.key}"
    yield from _list_parameters(list_entries(body, "parameters"), "parameters")


def _has_key(node: YamlNode, key: str) -> bool:
    return isinstance(node, MappingNode) and key in node.entries


def _list_parameters(parameters: Iterable[MappingEntry], path: str) -> Iterator[str]:
    for entry in parameters:
        name, value = f"{path}.{entry.key}", entry.value
        if isinstance(value, MappingNode) and not {"type", "value"} & value.entries.keys():
            yield from _list_parameters(value, name)
        else:
            yield name
