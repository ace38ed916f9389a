"""Data types, enumerations and classes that are only data: the types of the language, with fields where all are known."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from archgen.importers.foreign.xml_tree import XmlElement
from archgen.importers.xmi import uml_values
from archgen.importers.xmi.import_ledger import OWN_PREFIX, ImportLedger, call, make_hints
from archgen.importers.xmi.made_names import name_type
from archgen.importers.xmi.uml_catalogue import read_description
from archgen.importers.xmi.uml_index import UmlIndex, get_id, get_kind, get_name, list_children
from archgen.model.element_ids import make_id

_UNDECLARED = (f"{OWN_PREFIX}name.", f"{OWN_PREFIX}choices.")
"""Ids of types that archgen wrote because something names them: nobody declares them."""
_MESSAGE = re.compile(r"[a-zA-Z][a-zA-Z0-9_]*(?:/msg)?/[A-Z][A-Za-z0-9_]*\Z")


class DataTypes:
    """Makes the section `types`. Nothing else than the file says: a type with a field of unknown type has no fields."""

    def __init__(self, index: UmlIndex, ledger: ImportLedger, elements: Iterable[XmlElement]) -> None:
        self._index, self._ledger = index, ledger
        self._elements: dict[str, XmlElement] = {}
        for element in elements:
            name = name_type(get_name(element))
            if uml_values.find_field_type(name) or get_id(element).startswith(_UNDECLARED):
                continue
            if not name or name in self._elements:
                why = "there is another one of this name" if name else "it has no name"
                ledger.leave(element, f"{call(element)} is not taken: {why}")
                continue
            self._elements[name] = element
        self._fields = {name: self._read_fields(each) for name, each in self._elements.items()}
        self._drop_unknown_fields()

    def _read_fields(self, element: XmlElement) -> dict[str, dict[str, object]] | None:
        """Return the fields of a type; None where it has none, or one whose type is not known."""
        fields: dict[str, dict[str, object]] = {}
        for child in list_children(element, "Property"):
            name = make_id(get_name(child), "field") if get_name(child) else ""
            written = uml_values.find_type_name(self._index, child)
            primitive = uml_values.find_field_type(written)
            known = primitive or (name_type(written) if written else "")
            is_known = primitive is not None or known in self._elements or _MESSAGE.match(known) is not None
            problem = "it has no name" if not name else "there is another one" if name in fields else ""
            if problem or not is_known:
                why = problem or "its type is not known"
                words = f"the fields of `{get_name(element)[:80]}` are not taken: of `{get_name(child)[:80]}` {why}"
                self._ledger.leave(child, words)
                return None
            texts = read_description(self._index, child)
            comment = texts.get("comment") or texts.get("description")
            fields[name] = {"type": known + uml_values.write_array(child)} | ({"comment": comment} if comment else {})
        return fields or None

    def _drop_unknown_fields(self) -> None:
        """Leave out fields of types that have none themselves, and those that hold themselves."""
        while True:
            dropped = [name for name, fields in self._fields.items() if fields and not self._is_whole(fields)]
            if not dropped:
                break
            for name in dropped:
                self._fields[name] = None
                words = f"the fields of `{name[:80]}` are not taken: the fields of one of their types are not known"
                self._ledger.leave(self._elements[name], words)
        for name in [each for each in self._elements if self._holds_itself(each)]:
            self._fields[name] = None
            self._ledger.leave(self._elements[name], f"the fields of `{name[:80]}` are not taken: it would hold itself")
        while dropped := [name for name, fields in self._fields.items() if fields and not self._is_whole(fields)]:
            for name in dropped:
                self._fields[name] = None

    def _is_whole(self, fields: dict[str, dict[str, object]]) -> bool:
        for field in fields.values():
            name = _name_inner(field)
            inner = self._elements.get(name)
            if inner is not None and get_kind(inner) != "Enumeration" and not self._fields[name]:
                return False
        return True

    def _holds_itself(self, name: str) -> bool:
        seen: set[str] = set()
        stack = [name]
        while stack:
            for field in (self._fields.get(stack.pop()) or {}).values():
                inner = _name_inner(field)
                if inner == name:
                    return True
                if inner not in seen:
                    seen.add(inner)
                    stack.append(inner)
        return False

    def make_types(self) -> dict[str, object]:
        """Return the section `types`."""
        section: dict[str, object] = {}
        for name, element in self._elements.items():
            body: dict[str, object] = {}
            if get_kind(element) == "Enumeration":
                body |= self._write_values(element)
            elif fields := self._fields[name]:
                body["fields"] = {key: each if len(each) > 1 else each["type"] for key, each in fields.items()}
            texts = read_description(self._index, element)
            comment = texts.get("comment") or texts.get("description")
            body |= {"comment": comment} if comment else {}
            section[name] = body | make_hints(element)
            self._ledger.take(element)
        return section

    def _write_values(self, element: XmlElement) -> dict[str, object]:
        values = [make_id(get_name(each), "value").upper() for each in list_children(element, "EnumerationLiteral")]
        if len(set(values)) != len(values):
            self._ledger.leave(element, f"the values of `{get_name(element)[:80]}` are not taken: two have one name")
            return {}
        return {"values": values} if values else {}


def _name_inner(field: Mapping[str, object]) -> str:
    """Return the type of a field without the brackets of an array."""
    return str(field["type"]).partition("[")[0]
