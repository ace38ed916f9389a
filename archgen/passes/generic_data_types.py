"""Write a data type of its own for each combination of types that a generic one stands for: `Envelope of Pose`."""

from __future__ import annotations

import re
from collections.abc import Iterator

from archgen.compose.type_table import OPERATION_PARTS
from archgen.diagnostics.element_origins import TreePath
from archgen.link import mapping_values
from archgen.link.data_types.field_types import bind_name, is_bound_name
from archgen.model.generic_names import read_generic_name
from archgen.model.message_types import PART_KEYS
from archgen.passes.pass_shape import PassWork
from archgen.passes.project_tree import ProjectTree, list_paths
from archgen.passes.written_places import is_written
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, YamlNode

_ARRAY = re.compile(r"(?:\[(?:<=)?[0-9]*\])?\Z")
_PORT_SECTIONS = frozenset({"inputs", "outputs"})
_SECTIONS = ("groups", "component_types", "libraries", "types")
_CONTENT_KEYS = ("fields", "constants", "values", "comment", "size", "frame", *PART_KEYS)


def specialise_data_types(work: PassWork) -> list[tuple[str, str]]:
    """Replace the names of bound generic types by those of types that are made for them; no generic type is left.

    Return what they were called, each with its name now.
    """
    specialiser = _DataTypeSpecialiser(work)
    specialiser.specialise_all()
    return list(specialiser.names.items())


def list_data_type_sections(tree: ProjectTree) -> list[TreePath]:
    """Return the paths of the mappings that hold data types: the project's own, then those of its libraries."""
    return [("types",), *(("libraries", name, "types") for name in tree.get_mapping(("libraries",)))]


class _DataTypeSpecialiser:
    """Names and makes the types; each name is made once."""

    def __init__(self, work: PassWork) -> None:
        self._work = work
        self._tree = work.tree
        self._types = work.link().declared_types.types
        self.names: dict[str, str] = {}
        """The names that bound types get."""
        self._written = {
            mapping_values.normalise_type_name(key): path
            for section in list_data_type_sections(self._tree)
            for key in self._tree.get_mapping(section)
            for path in ((*section, key),)
        }

    def specialise_all(self) -> None:
        if not any(each.generic for each in self._types.values()):
            return
        generic_paths = [
            self._written[name] for name, each in self._types.items() if each.generic and name in self._written
        ]
        for path in list(self._list_mentions(generic_paths)):
            self._rename_at(path)
        for name, path in list(self._written.items()):
            if is_bound_name(name, self._types):
                self._name_plainly(name, path)
                self._tree.drop(path)
        for path in generic_paths:
            self._tree.drop(path)

    def _list_mentions(self, generic_paths: list[TreePath]) -> Iterator[TreePath]:
        """Yield the paths of all scalars that name a type and do not stand in a generic one."""
        for section in _SECTIONS:
            node = self._tree.get((section,))
            for path, value in list_paths(node, (section,)) if node is not None else ():
                names_type = isinstance(value, ScalarNode) and value.value is not None and _names_type(path)
                if names_type and not any(path[: len(each)] == each for each in generic_paths):
                    yield path

    def _rename_at(self, path: TreePath) -> None:
        text = self._tree.get_text(path)
        if text is not None and "<" in text and (renamed := self._rename(text, path)) != text:
            self._tree.set(path, renamed, path)

    def _rename(self, text: str, source: TreePath) -> str:
        """Return the name of a type, or of an array of it, without generic types."""
        array = _ARRAY.search(text)
        brackets = array[0] if array else ""
        name = mapping_values.normalise_type_name(text.removesuffix(brackets).strip())
        if not is_bound_name(name, self._types):
            return text
        return self._name_plainly(name, source) + brackets

    def _name_plainly(self, name: str, source: TreePath) -> str:
        """Return the name of the type that is made for a bound one, which is written with it."""
        if name not in self.names:
            base, arguments = read_generic_name(name)
            plain_arguments = [self._rename(argument, source) for argument in arguments]
            words = " and ".join(argument.rpartition("/")[2] for argument in plain_arguments)
            self.names[name] = plain_name = self._find_free_name(f"{base.rpartition('/')[2]} of {words}")
            self._write_type(name, plain_name, base, arguments)
        return self.names[name]

    def _find_free_name(self, wanted_name: str) -> str:
        used_names = {*self._types, *self.names.values()}
        number, name = 1, wanted_name
        while name in used_names:
            number += 1
            name = f"{wanted_name} {number}"
        return name

    def _write_type(self, name: str, plain_name: str, base: str, arguments: tuple[str, ...]) -> None:
        made_path: TreePath = ("types", plain_name)
        generic_path = self._written.get(base)
        if generic_path is None:
            return
        bound_type = self._types.get(name)
        body = self._tree.get(generic_path)
        stands_for = dict(zip(self._types[base].generic, arguments, strict=False))
        contents = {
            each.key: each
            for each in (body if isinstance(body, MappingNode) else ())
            if each.key in _CONTENT_KEYS and is_written(each.value)
        }
        bound_entries = {
            key: MappingEntry(key, each.key_span, _bind_content(each.value, stands_for))
            for key, each in contents.items()
        }
        self._tree.set(made_path, MappingNode(bound_entries, self._tree.find_place(generic_path)), generic_path)
        if bound_type is not None and bound_type.message:
            self._tree.set((*made_path, "message"), bound_type.message, generic_path)
        own_path = self._written.get(name)
        if own_path is not None:
            self._tree.merge(made_path, self._tree.get(own_path) or {}, own_path)
        for path, value in list(
            list_paths(self._tree.get(made_path) or MappingNode({}, self._tree.root.span), made_path)
        ):
            if isinstance(value, ScalarNode) and _names_type(path):
                self._rename_at(path)


def _names_type(path: TreePath) -> bool:
    """Whether a scalar at a path is the name of a type."""
    key, holders = path[-1], [step for step in path[:-1] if isinstance(step, str)]
    in_types = path[0] == "types" or (path[0] == "libraries" and len(path) > 3 and path[2] == "types")  # noqa: PLR2004
    if in_types:
        inner = path[2 if path[0] == "types" else 4 :]
        return _names_field_type(inner)
    if key == "type":
        return len(holders) > 1 and holders[-2] in _PORT_SECTIONS
    if "operations" in holders:
        return _names_operation_type(path[path.index("operations") + 2 :])
    return False


def _names_operation_type(inner: TreePath) -> bool:
    """Whether what stands at a path inside of an operation is the name of a type: of all that goes over, or of a field."""
    return inner[0] in OPERATION_PARTS and len(inner) <= 2 if inner else False  # noqa: PLR2004 - the part and a field


def _names_field_type(inner: TreePath) -> bool:
    """Whether what stands at a path inside of a type is the name of a type."""
    match inner:
        case ("request" | "response" | "feedback",):
            return True
        case ("deprecated", "use"):
            return True
        case ("fields" | "request" | "response" | "feedback", _, "type"):
            return True
        case _:
            return False


def _bind_content(node: YamlNode, stands_for: dict[str, str]) -> YamlNode:
    """Return the content of a generic type with the types in it that its names stand for."""
    if isinstance(node, MappingNode):
        entries = {e.key: MappingEntry(e.key, e.key_span, _bind_field(e.value, stands_for)) for e in node}
        return MappingNode(entries, node.span)
    return _bind_scalar(node, stands_for)


def _bind_field(node: YamlNode, stands_for: dict[str, str]) -> YamlNode:
    if isinstance(node, MappingNode) and (written := node.entries.get("type")) is not None:
        bound = MappingEntry("type", written.key_span, _bind_scalar(written.value, stands_for))
        return MappingNode({**node.entries, "type": bound}, node.span)
    return node


def _bind_scalar(node: YamlNode, stands_for: dict[str, str]) -> YamlNode:
    if not isinstance(node, ScalarNode) or node.value is None:
        return node
    array = _ARRAY.search(node.text)
    brackets = array[0] if array else ""
    bound = bind_name(node.text.removesuffix(brackets), stands_for) or ""
    text = bound + brackets
    return node if text == node.text else ScalarNode(text, text, node.span)
