"""How AADL writes names, texts, durations and what an import left in `hints: {aadl: ...}`; names differ where case does not
count.
"""

from __future__ import annotations

import hashlib
import math
import re
from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Any

from archgen.plugin.generating import AADL_KEYWORDS, spell_in_ascii, title_from_id
from archgen.plugin.model import Component, ConceptualType, Group, Node, Quantity

MAX_NAME_LENGTH = 80
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9]*(?:_[A-Za-z0-9]+)*\Z", re.ASCII)
# Readers differ in whether a backslash escapes, and in which alphabet they read.
_ESCAPED = re.compile(r"[^\x20-\x7e]|[\"\\%]")
_UNITS = (("sec", 10**9), ("ms", 10**6), ("us", 10**3), ("ns", 1))
_LONGEST = Fraction(1000 * 3600 * 10**9)
"""The longest duration that the standard's own project file lets readers take, in ns."""

AadlProperty = dict[str, str]
"""A `name`, a `value` as AADL writes it, and what it `applies_to` where that is not the element itself."""


def make_aadl_name(name: str) -> str:
    """Return a name as an identifier of AADL, letters of either case; a keyword gets `_x` behind it."""
    if not _NAME.match(name):
        name = "_".join(re.findall(r"[A-Za-z0-9]+", spell_in_ascii(name))) or f"x_{_digest(name)}"
    if name[0].isdigit():
        name = f"x{name}"
    if len(name) > MAX_NAME_LENGTH:
        name = f"{name[: MAX_NAME_LENGTH - 7].rstrip('_')}_{_digest(name)}"
    return f"{name}_x" if name.lower() in AADL_KEYWORDS else name


def _digest(name: str) -> str:
    return hashlib.sha256(name.encode("utf-8", "replace")).hexdigest()[:6]


class NameSpace:
    """The names of one namespace. Two that differ in case alone are one name for AADL."""

    def __init__(self, taken_names: Iterable[str] = ()) -> None:
        """Begin with names that are taken already."""
        self._taken = {name.lower() for name in taken_names}

    def take_name(self, name: str) -> str:
        """Return a name that nothing else has, like the wanted one; it is taken from now on."""
        wanted = make_aadl_name(name)
        found, number = wanted, 2
        while found.lower() in self._taken:
            found, number = f"{wanted}_{number}", number + 1
        self._taken.add(found.lower())
        return found


class FlowBook:
    """What flows of a process are called, by their texts and properties."""

    def __init__(self) -> None:
        self.names: dict[tuple[str, str], str] = {}
        self.space = NameSpace()


def write_aadl_string(text: str) -> str:
    """Return a text as a string of AADL; quotes, backslashes and all that is not ASCII as `%` and two digits for each byte."""
    return f'"{_ESCAPED.sub(_escape_character, text)}"'


def _escape_character(match: re.Match[str]) -> str:
    return "".join(f"%{byte:02X}" for byte in match[0].encode("utf-8", "replace"))


def write_texts(texts: Iterable[str]) -> str:
    """Return texts as a list of strings."""
    return f"({', '.join(map(write_aadl_string, texts))})"


def write_aadl_duration(duration: Fraction, *, round_up: bool = False) -> str:
    """Return a duration (ns) in the largest unit in which it is whole; what is no whole ps is rounded."""
    if not duration:
        return "0 ns"
    for unit, factor in _UNITS:
        if duration % factor == 0:
            return f"{duration / factor} {unit}"
    return f"{(math.ceil if round_up else math.floor)(duration * 1000)} ps"


def write_range(lowest: Fraction, highest: Fraction) -> str:
    """Return a range of durations (ns), rounded outwards."""
    return f"{write_aadl_duration(lowest)} .. {write_aadl_duration(highest, round_up=True)}"


def can_be_written(duration: Fraction) -> bool:
    """Whether AADL can hold a duration (ns)."""
    return 0 <= duration <= _LONGEST


def make_property(name: str, value: str, applies_to: str = "") -> AadlProperty:
    """Return a property association."""
    return {"name": name, "value": value, "applies_to": applies_to}


def make_duration_property(name: str, quantity: Quantity | None) -> list[AadlProperty]:
    """Return the property for a duration; nothing where it is not known, or longer than AADL's longest."""
    if quantity is None or not can_be_written(quantity.value):
        return []
    return [make_property(name, write_aadl_duration(quantity.value, round_up=True))]


def make_text_properties(**texts: str | None) -> list[AadlProperty]:
    """Return archgen's own properties for those texts that there are: `title` is `archgen::Title`."""
    return [
        make_property(f"archgen::{'_'.join(map(str.capitalize, key.split('_')))}", write_aadl_string(text))
        for key, text in texts.items()
        if text
    ]


def make_named_properties(name: str, element_id: str, title: str | None = None) -> list[AadlProperty]:
    """Return the id of an element that is called otherwise here, and its title where that is not made from the id."""
    own_title = title if title and title != title_from_id(element_id.rpartition(".")[2]) else None
    return make_text_properties(id=element_id if name != element_id else None, title=own_title)


def list_tags(element: Component | Group) -> list[AadlProperty]:
    """Return the tags of an element."""
    return [make_property("archgen::Tags", write_texts(element.tags))] if element.tags else []


def list_component_words(element: Component | Node, role: str | None, owner: str | None) -> list[AadlProperty]:
    """Return what a component says of itself beside its ports and timing."""
    texts = make_text_properties(
        description=element.description,
        functionality=element.functionality if isinstance(element, Component) else None,
        role=role,
        owner=owner,
    )
    return [*texts, *(list_tags(element) if isinstance(element, Component) else [])]


def make_item(name: str, text: str, properties: Iterable[AadlProperty] = ()) -> dict[str, Any]:
    """Return a line of a section: a feature, subcomponent, connection or flow."""
    return {"name": name, "text": text, "properties": list(properties)}


def make_classifier(category: str, name: str, **sections: Any) -> dict[str, Any]:  # noqa: ANN401 - sections differ
    """Return a type or an implementation with its sections, empty where they are not given."""
    empty: dict[str, Any] = {
        "extends": "",
        "comment": "",
        "place": "",
        **{key: [] for key in ("features", "subcomponents", "connections", "flows", "properties")},
    }
    return {"category": category, "name": name, **empty, **sections}


def read_aadl_hints(*elements: Node | Component | ConceptualType) -> dict[str, Any]:
    """Return the hints of elements that are one in AADL; what the last one says counts."""
    found: dict[str, Any] = {}
    for element in elements:
        hints = element.annotations.hints.get("aadl")
        if isinstance(hints, Mapping):
            found.update(hints)
    return found


def list_source_properties(hints: Mapping[str, Any]) -> list[AadlProperty]:
    """Return the schema of a node's internal state, and its own sources."""
    found = []
    schema = _find_text(hints.get("internal_state"), "schema")
    if schema:
        found.append(make_property("Source_Text", write_texts((schema,)), "internal_state"))
    return found + list_own_sources(hints)


def list_own_sources(hints: Mapping[str, Any]) -> list[AadlProperty]:
    """Return the sources of an element itself."""
    sources = _list_texts(hints.get("source_text"))
    return [make_property("Source_Text", write_texts(sources))] if sources else []


def has_tf_access(hints: Mapping[str, Any]) -> bool:
    """Return whether a process had access to the transformations, whatever it called it."""
    accesses = hints.get("access")
    kept = accesses.values() if isinstance(accesses, Mapping) else ()
    return any((_find_text(each, "type") or "").lower() == "ros::tf" for each in kept)


def find_thread_name(hints: Mapping[str, Any]) -> str | None:
    """Return what the only thread of a process was called."""
    threads = hints.get("threads")
    if not isinstance(threads, Mapping) or len(threads) != 1:
        return None
    name = next(iter(threads))
    return name if isinstance(name, str) else None


def list_function_properties(hints: Mapping[str, Any], component_name: str) -> list[AadlProperty]:
    """Return headers and entry of the function that a component's thread calls, in terms of that thread."""
    threads = hints.get("threads")
    # A component that is a thread itself says it without naming one.
    thread: object = hints
    if isinstance(threads, Mapping) and threads:
        thread = threads.get(component_name) or next(iter(threads.values()))
    functions = thread.get("functions") if isinstance(thread, Mapping) else None
    if not isinstance(functions, Mapping) or not functions:
        return []
    function = functions.get("function") or next(iter(functions.values()))
    found = []
    sources = _list_texts(function.get("source_text") if isinstance(function, Mapping) else None)
    if sources:
        found.append(make_property("Source_Text", write_texts(sources), "function"))
    entry = _find_text(function, "source_name")
    if entry:
        found.append(make_property("Source_Name", write_aadl_string(entry), "function"))
    return found


def _find_text(hints: object, key: str) -> str | None:
    value = hints.get(key) if isinstance(hints, Mapping) else None
    return value if isinstance(value, str) else None


def _list_texts(value: object) -> tuple[str, ...]:
    return tuple(each for each in value if isinstance(each, str)) if isinstance(value, list | tuple) else ()
