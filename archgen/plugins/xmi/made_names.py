"""Ids, titles and names of the language for elements of UML."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from types import MappingProxyType

from archgen.plugin.importing import XmlElement, is_id, make_id, make_unique_id, title_from_id
from archgen.plugins.xmi.import_ledger import OWN_PREFIX
from archgen.plugins.xmi.uml_index import get_id, get_kind, get_name

_PARAMETER_NAME = re.compile(r"[^\s.]+(?:\.[^\s.]+)*\Z")
MAX_TYPE_LENGTH = 200
_NO_IDS: Mapping[str, str] = MappingProxyType({})


def choose_id(
    element: XmlElement, kind: str, taken_ids: Collection[str], name: str = "", known_ids: Mapping[str, str] = _NO_IDS
) -> str:
    """Return a free id for an element: the known one, or that which archgen exported it from, else one of its name."""
    own_id = get_id(element)
    known_id = known_ids.get(own_id, "")
    if is_id(known_id) and known_id not in taken_ids:
        return known_id
    if own_id.startswith(OWN_PREFIX) and is_id(last_word := own_id.rpartition(".")[2]) and last_word not in taken_ids:
        return last_word
    wanted = make_id(name or get_name(element) or get_kind(element), kind)
    return make_unique_id(wanted, taken_ids)


def say_title(name: str, element_id: str) -> dict[str, object]:
    """Return `title` where the id alone would give another one."""
    return {"title": name} if name and name != title_from_id(element_id) else {}


def name_parameter(name: str) -> str:
    """Return a name that a parameter may have."""
    return name if _PARAMETER_NAME.match(name) and len(name) <= MAX_TYPE_LENGTH else make_id(name, "parameter")


def name_conceptual_type(name: str) -> str:
    """Return the name of a conceptual type: brackets of templates would be generics."""
    return name.replace("<", "(").replace(">", ")")[:MAX_TYPE_LENGTH].strip()
