"""The names of a project that an editor offers while somebody types: each with what it means, by where it fits."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain
from typing import Protocol

from archgen.diagnostics import make_visible
from archgen.frozen import NamedTuple
from archgen.language.language_tables import SECTION_KINDS
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.document_chapters import GENERATED_CHAPTERS
from archgen.model.known_interfaces import KNOWN_DISTROS
from archgen.model.port_media import DIGITAL, MEDIUM_NAMES, ROS, name_medium

_MAX_MEANING_LENGTH = 100
_PLAIN_NAME = re.compile(r"[A-Za-z0-9_/~][A-Za-z0-9_./~:+-]*\Z")
"""Names that mean the same in YAML with and without quotes; others cannot be put into a list as they stand."""


_BOOLEANS = ("true", "false")


class OfferedName(NamedTuple):
    """A name, and what it means in a few words: the element's title, an output's type, a type's message."""

    name: str
    meaning: str


class HasTitle(Protocol):
    """An element with a title."""

    @property
    def title(self) -> str:
        """Its name as people read it."""


OfferedNames = Mapping[str, tuple[OfferedName, ...]]
"""Names by the kind of place where they fit: sections by their own name, references by what they may lead to."""


_OTHERWISE_TITLED = frozenset({"component_types", "groups", "nodes", "types", "libraries", "properties"})
"""Sections of which less or more than every element with its title is offered."""


def list_offered_names(architecture: Architecture, library_types: Mapping[str, str] = {}) -> OfferedNames:
    """Return all names of a project by where they fit, in the order of the files.

    `library_types` are the titles of the component types of libraries, used or not, by name.
    """
    groups = tuple(_list_titles(architecture.groups))
    components = tuple(OfferedName(each.id, _shorten_text(each.title)) for each in architecture.components.values())
    composed = tuple(OfferedName(each.id, _shorten_text(each.title)) for each in architecture.shells.values())
    outputs = tuple(_list_outputs(architecture))
    composed_outputs = tuple(
        OfferedName(port.id, port.type or "no type yet")
        for shell in architecture.shells.values()
        for port in shell.outputs.values()
    )
    nodes = tuple(_list_titles({id_: node for id_, node in architecture.nodes.items() if node.written}))
    messages = sorted(architecture.interfaces.names)
    sections = {
        name: tuple(_list_titles(getattr(architecture, name)))
        for name in SECTION_KINDS
        if name not in _OTHERWISE_TITLED
    }
    own_types = {id_: each for id_, each in architecture.component_types.items() if each.library is None}
    return sections | {
        "component_types": tuple(_list_titles(own_types)),
        "component_type_names": (
            *_list_titles(own_types),
            *(OfferedName(name, _shorten_text(title)) for name, title in library_types.items()),
        ),
        "groups": groups,
        "nodes": nodes,
        "types": tuple(
            OfferedName(each.name, each.message or "no message yet") for each in architecture.types.values()
        ),
        "sources": _add_short_forms((*outputs, *composed_outputs, *components, *groups)),
        "implemented": _add_short_forms((*components, *composed)),
        "startable": _add_short_forms((*nodes, *components, *composed)),
        "step_ends": (
            *_list_actors(architecture),
            *_add_short_forms((*components, *composed)),
            *outputs,
        ),
        "waypoints": _add_short_forms((*nodes, *components, *composed, *outputs)),
        "inputs": tuple(_list_inputs(architecture.components.values())),
        "tags": tuple(OfferedName(tag, "") for tag in sorted(_list_tags(architecture))),
        "topics": tuple(
            OfferedName(each.name, ", ".join(each.messages))
            for each in architecture.topics.values()
            if each.flow == "topic" and each.is_known
        ),
        "topic_messages": tuple(OfferedName(name, "") for name in messages if "/msg/" in name),
        "call_messages": tuple(OfferedName(name, "") for name in messages if "/msg/" not in name),
        "selectors": (
            *groups,
            *(OfferedName(f"tag:{tag}", "what bears this tag") for tag in sorted(_list_tags(architecture))),
            *(OfferedName(f"owner:{each.id}", _shorten_text(each.title)) for each in architecture.partners.values()),
        ),
        **_list_declared_properties(architecture),
        "media": tuple(_list_media(architecture)),
        "distros": tuple(OfferedName(name, "") for name in KNOWN_DISTROS),
        "chapters": tuple(OfferedName(name, "a chapter that archgen writes") for name in GENERATED_CHAPTERS),
    }


def keep_plain_names(names: Iterable[OfferedName]) -> tuple[OfferedName, ...]:
    """Return the names that need no quotes in YAML."""
    return tuple(each for each in names if _PLAIN_NAME.match(each.name))


def _list_titles(elements: Mapping[str, HasTitle]) -> Iterator[OfferedName]:
    for id_, element in elements.items():
        yield OfferedName(id_, _shorten_text(element.title))


def _list_actors(architecture: Architecture) -> Iterator[OfferedName]:
    """Return the actors of all use cases, each id once."""
    seen_ids = set[str]()
    for use_case in architecture.use_cases.values():
        for actor in use_case.actors.values():
            if actor.id not in seen_ids:
                seen_ids.add(actor.id)
                yield OfferedName(actor.id, _shorten_text(actor.title))


def _list_outputs(architecture: Architecture) -> Iterator[OfferedName]:
    for output in architecture.outputs.values():
        title = architecture.components[output.component].title
        yield OfferedName(output.id, _shorten_text(f"{title}: {output.type}" if output.type else title))


def _list_inputs(components: Iterable[Component]) -> Iterator[OfferedName]:
    """Return the ids of inputs, each once, as `trigger` names them, with the first component that has such an input."""
    seen_names = set[str]()
    for component in components:
        for name in component.inputs:
            if name not in seen_names:
                seen_names.add(name)
                yield OfferedName(name, _shorten_text(f"input of {component.title}"))


def _list_declared_properties(architecture: Architecture) -> dict[str, tuple[OfferedName, ...]]:
    """Return the declared properties, and for each that has choices these, below `choices:` and its id."""
    declared = architecture.properties.values()
    choices = {
        f"choices:{each.id}": tuple(OfferedName(choice, "") for choice in each.choices or _BOOLEANS)
        for each in declared
        if each.choices or each.type == "boolean"
    }
    return {"properties": tuple(OfferedName(each.id, _shorten_text(each.title)) for each in declared), **choices}


def _list_media(architecture: Architecture) -> Iterator[OfferedName]:
    """Yield the words for media: those that the project uses, then those that archgen knows."""
    own_words = {port.medium for port in architecture.list_ports()} | {
        link.protocol for link in architecture.links.values() if link.protocol
    }
    own_words.add(architecture.project.middleware)
    for word in dict.fromkeys((*sorted(own_words - {ROS}), DIGITAL, *MEDIUM_NAMES)):
        meaning = name_medium(word) if name_medium(word) != word else ""
        yield OfferedName(word, "used in this project" if word in own_words and not meaning else meaning)


def _list_tags(architecture: Architecture) -> set[str]:
    tags_by_element: tuple[Iterable[tuple[str, ...]], ...] = (
        (group.tags for group in architecture.groups.values()),
        (component.tags for component in architecture.components.values()),
        (node.tags for node in architecture.nodes.values()),
        (requirement.tags for requirement in architecture.requirements.values()),
        (host.tags for host in architecture.hosts.values()),
    )
    return set(chain.from_iterable(chain.from_iterable(tags_by_element)))


def _add_short_forms(names: tuple[OfferedName, ...]) -> tuple[OfferedName, ...]:
    """Return the names, each followed by itself without its group where that still means only one element.

    A single word for an output is left out: `scan` alone says less to a reader than it saves.
    """
    short_forms = [each.name.partition(".")[2] for each in names]
    counts = Counter(chain((each.name for each in names), short_forms))
    return tuple(
        chain.from_iterable(
            (each, OfferedName(short_form, each.meaning)) if short_form and counts[short_form] == 1 else (each,)
            for each, short_form in zip(names, short_forms, strict=True)
        )
    )


def _shorten_text(text: str) -> str:
    """Return a text on one line, without control characters, and not so long that it fills the editor."""
    line = make_visible(" ".join(text.split()))
    return line if len(line) <= _MAX_MEANING_LENGTH else f"{line[: _MAX_MEANING_LENGTH - 3]}..."
