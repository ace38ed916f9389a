"""Conceptual types as data types and enumerations, and the types that ports, fields and parameters name.

Signatures of templates: names that stand for types in a generic type or component type.

The elements of a UML model as plain data, and ids that no two of them share.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from archgen.plugin.generating import make_id

UmlTree = dict[str, Any]
"""An element: `tag`, `attributes` as pairs, `text`, `children`."""
OWN_PREFIX = "archgen."
TYPE_PREFIX = "type_."
"""What paths in component types begin with. No id ends so: a group may be called `type`."""
_USABLE_ID = re.compile(r"[^\s#<>&\"']{1,200}\Z")


def make_tree(
    tag: str,
    kind: str = "",
    element_id: str = "",
    name: str = "",
    children: Iterable[UmlTree] = (),
    /,
    **attributes: str | None,
) -> UmlTree:
    """Return an element. Attributes that are None are left out."""
    written = {"xmi:type": f"uml:{kind}" if kind else None, "xmi:id": element_id or None, "name": name or None}
    pairs = [[key, value] for key, value in {**written, **attributes}.items() if value is not None]
    return {"tag": tag, "attributes": pairs, "text": "", "children": list(children)}


def make_text(tag: str, text: str) -> UmlTree:
    """Return an element that holds text alone."""
    return make_tree(tag) | {"text": text}


class IdRegistry:
    """Gives out ids. What came from a UML tool keeps the id that it has there."""

    def __init__(self) -> None:
        self._taken: set[str] = set()

    def claim(self, wanted_id: str, hints: object = None) -> str:
        """Return a free id: that of the hints, else the wanted one behind archgen's own prefix."""
        kept = read_hints(hints).get("id")
        element_id = kept if isinstance(kept, str) and _USABLE_ID.match(kept) else f"{OWN_PREFIX}{wanted_id}"
        if element_id in self._taken and element_id == kept:
            element_id = f"{OWN_PREFIX}{wanted_id}"
        number = 2
        free_id = element_id
        while free_id in self._taken:
            free_id = f"{element_id}.{number}"
            number += 1
        self._taken.add(free_id)
        return free_id


def read_hints(hints: object) -> Mapping[str, Any]:
    """Return what the hints of an element say for UML."""
    own = hints.get("uml") if isinstance(hints, Mapping) else None
    return own if isinstance(own, Mapping) else {}


def list_names(hints: Mapping[str, Any], key: str) -> list[str]:
    """Return the names that an import kept below a key: a single one, or a list."""
    kept = hints.get(key)
    return [kept] if isinstance(kept, str) else [str(each) for each in kept] if isinstance(kept, list) else []


def read_mapping(value: object) -> Mapping[str, Any]:
    """Return a mapping of the packed project; an empty one for what is none."""
    return value if isinstance(value, Mapping) else {}


def make_id_word(name: str) -> str:
    """Return a word for an id made of any text."""
    return make_id(name, "x")


def make_comments(element_id: str, body: Mapping[str, Any]) -> list[UmlTree]:
    """Return the texts of an element as comments; the id says which is which."""
    return [
        make_tree("ownedComment", "Comment", f"{element_id}.{key}", "", [text], annotatedElement=element_id)
        for key in ("functionality", "description", "comment")
        if (text := make_text("body", str(body.get(key) or "")))["text"]
    ]


_ARRAY = re.compile(r"\[(<=)?([0-9]*)\]\Z")
_PRIMITIVE = re.compile(r"(?:bool|byte|char|u?int(?:8|16|32|64)|float(?:32|64)|w?string(?:<=[0-9]+)?|time|duration)\Z")
_PARAMETER_TYPES = {"boolean": "Boolean", "integer": "Integer", "float": "Real", "string": "String"}
_LITERALS = {
    "boolean": "LiteralBoolean",
    "integer": "LiteralInteger",
    "float": "LiteralReal",
    "string": "LiteralString",
}


class UmlTypes:
    """The data types of the model. What is only named, and stands nowhere below `types`, gets an element, too."""

    def __init__(self, registry: IdRegistry, types: Mapping[str, Any]) -> None:
        self._registry = registry
        self._types = types
        self._ids: dict[str, str] = {}
        self._named: dict[str, UmlTree] = {}
        self._enumerations: list[UmlTree] = []
        self._written: set[str] = set()
        self.generic_ids: dict[str, str] = {}
        """The ids of the names that stand for types in the component type that is being written."""
        for name, body in types.items():
            self._ids[name] = registry.claim(f"type.{make_id_word(name)}", read_mapping(body).get("hints"))

    def refer(self, name: str) -> str:
        """Return the id of a type that something names."""
        if name in self.generic_ids:
            return self.generic_ids[name]
        self._written.add(name)
        if name not in self._ids:
            is_primitive = _PRIMITIVE.match(name) is not None
            self._ids[name] = self._registry.claim(f"name.{make_id_word(name)}")
            kind = "PrimitiveType" if is_primitive else "DataType"
            self._named[name] = make_tree("packagedElement", kind, self._ids[name], name)
        return self._ids[name]

    def refer_parameter(self, kind: str) -> str:
        """Return the id of UML's type for a type of a parameter."""
        return self.refer(_PARAMETER_TYPES[kind])

    def add_choices(self, path: str, choices: list[str]) -> str:
        """Add an enumeration for the choices of a parameter, and return its id."""
        element_id = self._registry.claim(f"choices.{path}")
        literals = self._write_literals(path, choices)
        self._enumerations.append(
            make_tree("packagedElement", "Enumeration", element_id, path.rpartition(".")[2], literals)
        )
        return element_id

    def _write_literals(self, path: str, values: Iterable[object]) -> list[UmlTree]:
        return [
            make_tree("ownedLiteral", "EnumerationLiteral", self._registry.claim(f"literal.{path}.{word}"), str(value))
            for value in values
            for word in (make_id_word(str(value)),)
        ]

    def write_types(self, *, only_used: bool) -> list[UmlTree]:
        """Return the elements of all types; with a selection those that are named."""
        trees: dict[str, UmlTree] = {}
        wanted = self._written if only_used else self._types.keys()
        # A type may name others that nothing named before.
        while names := [name for name in self._types if name in wanted and name not in trees]:
            for name in names:
                trees[name] = self._write_type(name, read_mapping(self._types[name]))
        ordered = [trees[name] for name in self._types if name in trees]
        return [*ordered, *self._named.values(), *self._enumerations]

    def _write_type(self, name: str, body: Mapping[str, Any]) -> UmlTree:
        element_id = self._ids[name]
        kind = "Enumeration" if body.get("values") else "DataType"
        tree = make_tree("packagedElement", kind, element_id, name)
        tree["children"] += make_comments(element_id, body)
        if names := [str(each) for each in body.get("generic") or ()]:
            formal_ids = [self._registry.claim(f"formal.type.{make_id_word(name)}.{each}") for each in names]
            signature_id = self._registry.claim(f"signature.type.{make_id_word(name)}")
            signature, self.generic_ids = make_signature(signature_id, names, formal_ids)
            tree["children"].append(signature)
        tree["children"] += self._write_literals(element_id, body.get("values") or ())
        for field_name, field in read_mapping(body.get("fields")).items():
            written = str(read_mapping(field).get("type") or "")
            field_id = self._registry.claim(f"field.{element_id}.{field_name}")
            element_type = self.refer(_ARRAY.sub("", written)) if written else None
            inner = make_comments(field_id, read_mapping(field)) + self.write_bounds(field_id, written)
            attribute = make_tree("ownedAttribute", "Property", field_id, field_name, inner, type=element_type)
            tree["children"].append(attribute)
        self.generic_ids = {}
        return tree

    def write_bounds(self, element_id: str, written: str) -> list[UmlTree]:
        """Return the bounds of an array: `T[]`, `T[3]`, `T[<=5]`; none for a single value."""
        array = _ARRAY.search(written)
        if array is None:
            return []
        lower, upper = ("0" if array[1] or not array[2] else array[2]), array[2] or "*"
        bounds = (("lowerValue", "LiteralInteger", lower), ("upperValue", "LiteralUnlimitedNatural", upper))
        return [
            make_tree(tag, kind, self._registry.claim(f"bound.{element_id}.{tag}"), value=value)
            for tag, kind, value in bounds
        ]

    def write_default(self, element_id: str, kind: str, value: object, name: str = "") -> UmlTree:
        """Return the default of a property as a literal; `name` keeps the words that it was written in."""
        text = ("true" if value else "false") if isinstance(value, bool) else str(value)
        literal_id = self._registry.claim(f"default.{element_id}")
        return make_tree("defaultValue", _LITERALS[kind], literal_id, name, value=text)


def make_signature(
    signature_id: str, names: Sequence[str], formal_ids: Sequence[str]
) -> tuple[UmlTree, dict[str, str]]:
    """Return the signature, and the ids of what its names are inside of the template."""
    signature = make_tree(
        "ownedTemplateSignature", "RedefinableTemplateSignature", signature_id, parameter=" ".join(formal_ids)
    )
    element_ids = {name: f"{formal_id}.element" for name, formal_id in zip(names, formal_ids, strict=True)}
    for formal_id, (name, element_id) in zip(formal_ids, element_ids.items(), strict=True):
        inner = [make_tree("ownedParameteredElement", "Class", element_id, name, templateParameter=formal_id)]
        words = {"parameteredElement": element_id}
        formal = make_tree("ownedParameter", "ClassifierTemplateParameter", formal_id, "", inner, **words)
        signature["children"].append(formal)
    return signature, element_ids
