"""Write a component type of its own for each combination of types that a generic one stands for: `filter_of_pose`."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from archgen.compose.type_expressions import TypeExpression, parse_type_expression
from archgen.compose.type_table import bind_type_body, list_generic_names
from archgen.diagnostics.element_origins import TreePath
from archgen.link import mapping_values
from archgen.model.element_ids import make_unique_id, spell_in_ascii
from archgen.model.path_resolver import title_from_id
from archgen.passes.pass_shape import PassWork
from archgen.passes.written_places import find_type_path, list_holders, list_type_sections
from archgen.syntax.yaml_tree import MappingNode

_WORD = re.compile(r"[a-z0-9]+")
_WORD_BREAK = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")
_TYPE_KEYS = ("is", "same_as")


def specialise_components(work: PassWork) -> list[tuple[str, str]]:
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


def _list_inside(path: TreePath, node: object) -> Iterator[TreePath]:
    components = node.get("components") if isinstance(node, MappingNode) else None
    for part in components if isinstance(components, MappingNode) else ():
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
