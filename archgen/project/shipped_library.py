"""The library of component types that ships with archgen: what `libraries: {ros: builtin}` stands for.

Its files are slices like any others, in `ros_library/`; `distributions.yaml` beside them says which file is for which
distributions of ROS, and in which of them a package is released.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache, lru_cache
from types import MappingProxyType
from typing import NamedTuple

from archgen import resources
from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.source_span import Span
from archgen.model.known_interfaces import KNOWN_DISTROS, guess_distro
from archgen.project.slice_parsing import parse_slice
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlDocument, YamlNode

SHIPPED_PATH = "builtin"
"""What stands in the place of a library's path. A folder of this name is `./builtin`."""
SHIPPED_ID = "ros"
"""What the documentation calls the library; a project may call it otherwise."""
_FOLDER = "ros_library"
_TABLE_FILE = "distributions.yaml"


class DistributionTable(NamedTuple):
    """For which distributions the shipped types are."""

    files: Mapping[str, tuple[str, ...]]
    """The distributions that each file is for."""
    packages: Mapping[str, tuple[str, ...]]
    """The distributions in which each package is released."""


def choose_distro(distro: str | None) -> str | None:
    """Return the distribution whose types a project gets; the first one that is known for a project without any."""
    return KNOWN_DISTROS[0] if distro is None else guess_distro(distro)


@cache
def load_shipped_component_types(distro: str | None) -> Mapping[str, MappingEntry]:
    """Return the component types that ship for a distribution, in normal form, by name; none for one that is not known.

    They are shared: nobody may change their trees.
    """
    table = read_distribution_table()
    entries: dict[str, MappingEntry] = {}
    for file, distros in table.files.items():
        if distro in distros:
            for entry in parse_shipped_file(file):
                if distro in table.packages[_get_node_text(entry.value, "package")]:
                    entries[entry.key] = entry
    return MappingProxyType(dict(sorted(entries.items())))


# The trees of documents are never changed, and the history of a project reads hundreds of commits with the same line.
@lru_cache(8)
def read_shipped_document(distro: str | None, span: Span) -> YamlDocument:
    """Return the types that ship for a project's distribution as if all of them were written at a span.

    So no finding names a file that its reader does not have.
    """
    types = {
        name: MappingEntry(name, span, _move_node(entry.value, span))
        for name, entry in load_shipped_component_types(choose_distro(distro)).items()
    }
    section = MappingEntry("component_types", span, MappingNode(types, span))
    return YamlDocument(span.file, MappingNode({section.key: section}, span))


def is_shipped_type(name: str, distro: str | None) -> bool:
    """Whether a type ships for a project's distribution."""
    return name in load_shipped_component_types(choose_distro(distro))


def describe_missing_type(name: str, distro: str | None) -> str | None:
    """Return for which distributions a type ships that does not for a project's; None where it ships for none."""
    distros = [each for each in KNOWN_DISTROS if name in load_shipped_component_types(each)]
    if not distros:
        return None
    meant_distro = f"the project's distribution, {choose_distro(distro)}"
    if distro is None:
        meant_distro = f"{choose_distro(distro)}, which counts where `ros.distro` is not written"
    return f"it ships for {join_words(distros)}, not for {meant_distro}"


def list_shipping_distros() -> tuple[str, ...]:
    """Return the distributions for which types ship."""
    distros = {distro for file_distros in read_distribution_table().files.values() for distro in file_distros}
    return tuple(distro for distro in KNOWN_DISTROS if distro in distros)


@cache
def read_distribution_table() -> DistributionTable:
    """Return for which distributions files and packages are; read once."""
    import yaml

    # Not archgen's own parser: the file ships with archgen, and no position in it is ever reported.
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    data = yaml.load(resources.resource_path(_FOLDER, _TABLE_FILE).read_text("utf-8"), loader)  # noqa: S506 - safe ones
    return DistributionTable(
        {name: tuple(distros) for name, distros in data["files"].items()},
        {name: tuple(distros) for name, distros in data["packages"].items()},
    )


@cache
def parse_shipped_file(file: str) -> MappingNode:
    """Return the component types of a shipped file. Raises `ValueError` where it is wrong, which a test rules out."""
    parsed_slice = parse_slice(file, resources.resource_path(_FOLDER, file).read_text("utf-8"))
    diagnostics = parsed_slice.validate_once().diagnostics
    types = parsed_slice.document.root.get("component_types") if parsed_slice.document else None
    if diagnostics or not isinstance(types, MappingNode):
        msg = f"{file}: {'; '.join(f'{each.span.line}: {each.message}' for each in diagnostics)}"
        raise ValueError(msg)
    return types


def find_program_name(package: str, program: str) -> str | None:
    """Return what a program of ROS 2 calls its node where nobody names it, by its executable or plug-in.

    None where no type that ships knows it, or distributions differ.
    """
    names = _index_program_names().get((package, program), set())
    return next(iter(names)) if len(names) == 1 else None


@cache
def _index_program_names() -> Mapping[tuple[str, str], set[str]]:
    index: dict[tuple[str, str], set[str]] = {}
    for file, distros in read_distribution_table().files.items():
        for entry in () if "noetic" in distros else parse_shipped_file(file):
            package, own_name = (_get_node_text(entry.value, key) for key in ("package", "own_name"))
            for program in filter(None, (_get_node_text(entry.value, key) for key in ("executable", "plugin"))):
                index.setdefault((package, program), set()).add(own_name)
    return index


def _get_node_text(body: YamlNode, key: str) -> str:
    node = body.get("node") if isinstance(body, MappingNode) else None
    value = node.get(key) if isinstance(node, MappingNode) else None
    return value.text if isinstance(value, ScalarNode) else ""


def _move_node(node: YamlNode, span: Span) -> YamlNode:
    if isinstance(node, ScalarNode):
        return ScalarNode(node.value, node.text, span, node.is_plain)
    if isinstance(node, SequenceNode):
        return SequenceNode([_move_node(item, span) for item in node.items], span)
    entries = {e.key: MappingEntry(e.key, span, _move_node(e.value, span)) for e in node}
    return MappingNode(entries, span, node.declares)
