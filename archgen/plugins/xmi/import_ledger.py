"""The account of an import: how many of each construct were taken, and each that was not.

Ids, titles and names of the language for elements of UML.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Mapping
from types import MappingProxyType

from archgen.plugin.importing import ImportNote, XmlElement, is_id, make_id, make_unique_id, title_from_id
from archgen.plugin.model import is_parameter_name
from archgen.plugins.xmi.uml_index import UmlIndex, get_id, get_kind, get_name

OWN_PREFIX = "archgen."
"""What the ids of elements begin with that `archgen export xmi` wrote."""
TAKEN, NOTED, NOT_TAKEN = "taken", "noted", "not taken"


class ImportLedger:
    """Counts and notes, in the order in which they come up."""

    def __init__(self, index: UmlIndex) -> None:
        self.index = index
        self.taken: Counter[str] = Counter()
        self._taken_elements: set[XmlElement] = set()
        self._noted_fates: dict[XmlElement, str] = {}
        self._notes: dict[tuple[XmlElement, str], ImportNote] = {}

    def take(self, element: XmlElement, kind: str = "") -> None:
        """Count an element that was taken, once."""
        if element not in self._taken_elements:
            self._taken_elements.add(element)
            self.taken[f"uml:{kind or get_kind(element)}"] += 1

    def leave(
        self,
        element: XmlElement,
        message: str,
        help_line: str = "",
        kind: str = "",
        others: Iterable[XmlElement] = (),
    ) -> None:
        """Note an element that is not taken, and `others` of which the message speaks, too."""
        self._add(element, message, help_line, NOT_TAKEN, kind, tuple(others))

    def refuse(self, element: XmlElement, why: str, help_line: str = "") -> None:
        """Note that an element is not taken, and why."""
        self.leave(element, f"{name_element(element)} is not taken: {why}", help_line)

    def note(self, element: XmlElement, message: str, help_line: str = "", kind: str = "") -> None:
        """Note an element that is taken in another form than it is written in."""
        self._add(element, message, help_line, NOTED, kind, ())

    def _add(  # noqa: PLR0913, PLR0917 - a note and what it is about
        self,
        element: XmlElement,
        message: str,
        help_line: str,
        fate: str,
        kind: str,
        others: tuple[XmlElement, ...],
    ) -> None:
        word = kind or f"uml:{get_kind(element) or element.tag}"
        note = ImportNote(word, message, self.index.get_span(element), help_line, fate, 1 + len(others))
        self._notes.setdefault((element, message), note)
        for each in (element, *others):
            self._noted_fates.setdefault(each, fate)

    def get_fate(self, element: XmlElement) -> str | None:
        """Return what became of an element: `noted` where it was taken, but not all of it; None where nobody said."""
        fate = self._noted_fates.get(element)
        if element in self._taken_elements:
            return TAKEN if fate is None else NOTED
        return fate

    def list_notes(self) -> tuple[ImportNote, ...]:
        """Return the notes in the order of the files."""
        return tuple(sorted(self._notes.values(), key=lambda each: (each.span.file, each.span.line, each.span.column)))


def name_element(element: XmlElement) -> str:
    """Return what messages call an element: its kind and its name or id."""
    name = get_name(element) or get_id(element)
    return f"the {get_kind(element) or element.tag} `{name[:80]}`" if name else f"a {get_kind(element) or element.tag}"


def make_hints(element: XmlElement, **others: object) -> dict[str, object]:
    """Return `hints` with the way back to an element: its id, unless archgen made it, and what else is to be kept."""
    element_id = get_id(element)
    kept: dict[str, object] = {} if not element_id or element_id.startswith(OWN_PREFIX) else {"id": element_id}
    kept |= {key: value for key, value in others.items() if value}
    return {"hints": {"uml": kept}} if kept else {}


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
    return name if is_parameter_name(name) else make_id(name, "parameter")


def name_conceptual_type(name: str) -> str:
    """Return the name of a conceptual type: brackets of templates would be generics."""
    return name.replace("<", "(").replace(">", ")")[:MAX_TYPE_LENGTH].strip()
