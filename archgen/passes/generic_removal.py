"""The pass that takes generic types away: a type of its own for each combination of types that they stand for."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from itertools import chain, count

from archgen.compose.expanded_project import TypeExpression, parse_type_expression
from archgen.compose.type_table import OPERATION_PARTS, bind_type_body, list_generic_names
from archgen.diagnostics.element_origins import TreePath
from archgen.link import mapping_values
from archgen.link.data_types.field_types import bind_name, is_bound_name
from archgen.model.element_ids import make_unique_id, spell_in_ascii
from archgen.model.generic_names import read_generic_name
from archgen.model.message_types import PART_KEYS
from archgen.model.path_resolver import title_from_id
from archgen.passes.pass_shape import Pass, PassWork
from archgen.passes.project_tree import list_paths
from archgen.passes.selector_rewriting import rename_by_key, rename_in_selectors
from archgen.passes.written_places import find_type_path, is_written, list_holders, list_type_sections
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, YamlNode, list_entries

_ARRAY = re.compile(r"(?:\[(?:<=)?[0-9]*\])?\Z")
_PORT_SECTIONS = frozenset({"inputs", "outputs"})
_SECTIONS = ("groups", "component_types", "libraries", "types")
_CONTENT_KEYS = ("fields", "constants", "values", "comment", "size", "frame", *PART_KEYS)


def _specialise_data_types(work: PassWork) -> list[tuple[str, str]]:
    """Replace the names of bound generic types by those of types that are made for them; no generic type is left.

    Return what they were called, each with its name now.
    """
    specialiser = _DataTypeSpecialiser(work)
    specialiser.specialise_all()
    return list(specialiser.names.items())


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
            for section in list_type_sections(self._tree, "types")
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
        names = chain([wanted_name], (f"{wanted_name} {number}" for number in count(2)))
        return next(name for name in names if name not in used_names)

    def _write_type(self, name: str, plain_name: str, base: str, arguments: tuple[str, ...]) -> None:
        made_path: TreePath = ("types", plain_name)
        generic_path = self._written.get(base)
        if generic_path is None:
            return
        bound_type = self._types.get(name)
        body = self._tree.get(generic_path)
        stands_for = dict(zip(self._types[base].generic, arguments, strict=False))
        contents = {
            each.key: each for each in list_entries(body) if each.key in _CONTENT_KEYS and is_written(each.value)
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
        entries = {e.key: e.with_value(_bind_field(e.value, stands_for)) for e in node}
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


def _remove_generics(work: PassWork) -> None:
    component_names = _specialise_components(work)
    data_names = _specialise_data_types(work)
    for key, new_names, sections in (
        ("is", component_names, list_type_sections(work.tree)),
        ("type", data_names, list_type_sections(work.tree, "types")),
    ):
        known_names = [
            f"{section[1]}.{name}" if key == "is" and len(section) > 1 else name
            for section in sections
            for name in work.tree.get_mapping(section)
        ]
        if new_names:
            rename_in_selectors(work.tree, rename_by_key(key, new_names, known_names))


REMOVE_GENERICS = Pass(
    "remove_generics",
    "Writes `filter<Pose>` as `filter_of_pose` and `Envelope<Pose>` as `Envelope of Pose`; no generic type is left.",
    _remove_generics,
    leaves=("no_generics",),
)


_WORD = re.compile(r"[a-z0-9]+")
_WORD_BREAK = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")
_TYPE_KEYS = ("is", "same_as")


def _specialise_components(work: PassWork) -> list[tuple[str, str]]:
    """Replace instances of generic component types by instances of types that are made for what they stand for.

    Return what generic types were called, with and without what they stand for, with the name of each type made for one.
    """
    tree = work.tree
    names: dict[tuple[TreePath, tuple[str, ...]], str] = {}
    pending = [path for path, _ in _list_concrete(work)]
    while pending:
        path = pending.pop(0)
        made = _specialise_reference(work, path, names)
        if made is not None:
            holder = tree.get(made)
            pending += [made, *_list_inside(made, holder)]
    for section_path in list_type_sections(tree):
        for entry in tuple(tree.get_mapping(section_path).values()):
            if list_generic_names(entry):
                tree.drop((*section_path, entry.key))
    return list(_list_new_names(names))


def _list_new_names(names: Mapping[tuple[TreePath, tuple[str, ...]], str]) -> Iterator[tuple[str, str]]:
    for (path, arguments), name in names.items():
        prefix = f"{path[1]}." if path[0] == "libraries" else ""
        for old_name in (f"{path[-1]}", f"{path[-1]}<{', '.join(arguments)}>"):
            yield f"{prefix}{old_name}", f"{prefix}{name}"


def _list_concrete(work: PassWork) -> Iterator[tuple[TreePath, MappingNode]]:
    """Yield what names types and does not stand in a generic type."""
    generic_paths = {
        (*section, entry.key)
        for section in list_type_sections(work.tree)
        for entry in work.tree.get_mapping(section).values()
        if list_generic_names(entry)
    }
    for holder in list_holders(work.tree):
        is_generic = any(holder.path[: len(path)] == path for path in generic_paths)
        if not is_generic and isinstance(holder.entry.value, MappingNode):
            yield holder.path, holder.entry.value


def _list_inside(path: TreePath, node: YamlNode | None) -> Iterator[TreePath]:
    for part in list_entries(node, "components"):
        yield (*path, "components", part.key)
        yield from _list_inside((*path, "components", part.key), part.value)


def _specialise_reference(
    work: PassWork, path: TreePath, names: dict[tuple[TreePath, tuple[str, ...]], str]
) -> TreePath | None:
    """Name the specialised type in the place of a generic one; return its path if it was made just now."""
    tree = work.tree
    for key in _TYPE_KEYS:
        text = tree.get_text((*path, key))
        expression = parse_type_expression(text) if text and "<" in text else None
        if expression is None or not expression.arguments:
            continue
        # Types of a library see only one another.
        prefix = f"{path[1]}." if path[0] == "libraries" else ""
        generic_path = find_type_path(tree, prefix + expression.name)
        if generic_path is None:
            continue
        known_name = names.get((generic_path, expression.arguments))
        name = known_name or _name_specialised(work, generic_path, expression)
        names[generic_path, expression.arguments] = name
        made_path = (*generic_path[:-1], name)
        if known_name is None:
            _write_specialised(work, generic_path, made_path, expression)
        library, dot, _ = expression.name.rpartition(".")
        tree.set((*path, key), f"{library}{dot}{name}", (*path, key))
        return None if known_name else made_path
    return None


def _name_specialised(work: PassWork, generic_path: TreePath, expression: TypeExpression) -> str:
    """Return an id that no other component type beside the generic one has."""
    arguments = "_and_".join(_make_id_words(argument) for argument in expression.arguments)
    return make_unique_id(f"{generic_path[-1]}_of_{arguments}", work.tree.get_mapping(generic_path[:-1]).keys())


def _make_id_words(type_name: str) -> str:
    """Return the words of a type's name as they stand in an id: `envelope_of_laser_pose` for `Envelope<Laser pose>`."""
    spelled = re.sub(r"(?<!\S)\S*/(?=[^/\s]*+$)", "", type_name).replace("<", " of ").replace(",", " and ")
    words = _WORD.findall(_WORD_BREAK.sub(" ", spell_in_ascii(spelled)).lower())
    return "_".join(words) or "type"


def _write_specialised(work: PassWork, generic_path: TreePath, made_path: TreePath, expression: TypeExpression) -> None:
    body = work.tree.get(generic_path)
    entry = work.tree.get_mapping(generic_path[:-1])[str(generic_path[-1])]
    bindings = dict(zip(list_generic_names(entry), expression.arguments, strict=False))
    bound = bind_type_body(body, bindings) if isinstance(body, MappingNode) else MappingNode({}, entry.key_span)
    bound.entries.pop("generic", None)
    work.tree.set(made_path, bound, generic_path)
    title = mapping_values.get_text(bound, "title") or title_from_id(str(generic_path[-1]))
    arguments = " and ".join(expression.arguments).replace("<", " of ").replace(">", "")
    work.tree.set((*made_path, "title"), f"{title} of {arguments}", generic_path)
