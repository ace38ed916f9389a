"""What no stage of an import spoke of: each such element is noted, so that nothing of a model is lost in silence."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence

from archgen.plugin.importing import XmlElement
from archgen.plugins.xmi.import_ledger import NOT_TAKEN, OWN_PREFIX, ImportLedger, name_element
from archgen.plugins.xmi.uml_catalogue import TOOL_TAGS
from archgen.plugins.xmi.uml_index import get_id, get_kind, get_name, is_written_here
from archgen.plugins.xmi.xmi_files import XmiDocument

_WHOLE_KINDS = frozenset({"Connector", "Operation", "Association", "CommunicationPath", "EnumerationLiteral"})
"""What is taken with all that stands in it: ends, parameters."""
_PARTS = {
    "Property": "nothing here has values or parts for it",
    "Operation": "an interface only says here who is connected with whom",
    "Generalization": "only classes and components are made from one another",
    "Comment": "what it stands in has no description",
    "Port": "only components and classes have ports",
    "Constraint": "archgen cannot check it",
    "EnumerationLiteral": "what it stands in has no values",
    "Parameter": "what it stands in has no parameters",
}
"""Why parts of elements are not taken that nobody asked for."""
_NAMES_SHOWN = 5


def note_leftovers(ledger: ImportLedger, documents: Sequence[XmiDocument]) -> None:
    """Note what nobody spoke of: parts of one kind in one element together."""
    for document in documents:
        for model in document.models:
            for owner, kind, parts in _list_leftovers(ledger, model):
                verb = "is" if len(parts) == 1 else "are"
                words = f"{_name_parts(kind, parts)} of {name_element(owner)} {verb} not taken: {_PARTS[kind]}"
                ledger.leave(parts[0], words, others=parts[1:])


def _name_parts(kind: str, parts: Sequence[XmlElement]) -> str:
    names = [f"`{name[:60]}`" for each in parts if (name := get_name(each))]
    shown = ", ".join(names[:_NAMES_SHOWN]) + (" and others" if 0 < len(names[:_NAMES_SHOWN]) < len(parts) else "")
    plural = "Properties" if kind == "Property" else f"{kind}s"
    if len(parts) == 1:
        return f"the {kind} {shown}" if shown else f"a {kind}"
    return f"the {plural} {shown}" if shown else f"{len(parts)} {plural}"


def _list_leftovers(ledger: ImportLedger, model: XmlElement) -> Iterator[tuple[XmlElement, str, list[XmlElement]]]:
    """Yield owner, kind and parts. What stands in an element that is not taken is left out with it."""
    stack = [model]
    while stack:
        owner = stack.pop()
        parts: dict[str, list[XmlElement]] = defaultdict(list)
        for child in owner.children:
            fate, kind = ledger.get_fate(child), get_kind(child)
            if child.tag in TOOL_TAGS or fate == NOT_TAKEN or not is_written_here(child):
                continue
            if fate is None and kind in _PARTS and not get_id(child).startswith(OWN_PREFIX):
                is_read = get_kind(owner) in _WHOLE_KINDS and kind not in {"Comment", "Constraint"}
                if not is_read and (kind != "EnumerationLiteral" or get_kind(owner) != "Enumeration"):
                    parts[kind].append(child)
                    continue
            stack.append(child)
        for kind, members in parts.items():
            yield owner, kind, members
