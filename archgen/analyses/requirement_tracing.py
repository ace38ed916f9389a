"""Is every requirement served by a component and verified, does every component serve one, and do parents go in a circle?"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import lru_cache
from itertools import dropwhile

from archgen.diagnostics import Diagnostic, Label, Severity, Span, did_you_mean, find_closest, join_words, keep_first
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.requirement import Requirement, add_wholes, index_parts


def unknown_requirement(architecture: Architecture) -> Iterator[Diagnostic]:
    """A component or chain names a requirement that nobody declares, or a sentence holds nothing but ids."""
    id_by_title = _index_titles(architecture)
    for component in architecture.list_described_components():
        for use in component.requirements:
            if not use.is_id:
                yield from _check_sentence(architecture, use.text, use.at, component.id, id_by_title)
            elif not _is_declared(architecture, use.text):
                yield _report_unknown_requirement(architecture, use.text, use.at, component.id)
    for chain in architecture.chains.values():
        spans = chain.requirement_places or (chain.at,) * len(chain.requirements)
        for requirement, span in zip(chain.requirements, spans, strict=True):
            if not _is_declared(architecture, requirement):
                yield _report_unknown_requirement(architecture, requirement, span, chain.id)


_ID_SEPARATOR = re.compile(r"[,;&\s]+")
_MAX_SENTENCE = 1000
"""Longer text consists of more than ids."""


def _check_sentence(
    architecture: Architecture, sentence: str, span: Span, element: str, id_by_title: Mapping[str, str]
) -> Iterator[Diagnostic]:
    """Report a sentence that was not meant as one: nothing but ids, or the title of a requirement."""
    ids = _list_meant_requirements(architecture, sentence, id_by_title)
    if not ids:
        return
    is_title = id_by_title.get(sentence.casefold()) in ids
    reason = f"the title of `{ids[0]}`" if is_title else "made of ids only"
    message = f"`{sentence}` is {reason}, and serves nothing: what holds a blank is a sentence of its own here"
    help_line = f"write `{ids[0]}`" if is_title else f"write `[{', '.join(ids)}]`: each is an entry"
    labels = tuple(Label(architecture.requirements[name].at, "declared here") for name in ids)
    yield Diagnostic("unknown-requirement", message, span, labels=labels, help=help_line, element=element)


def _list_meant_requirements(
    architecture: Architecture, sentence: str, id_by_title: Mapping[str, str]
) -> tuple[str, ...]:
    """Return the requirements that a sentence means: it is made of their ids, or is the title of one; else none."""
    ids = _split_words(sentence) if len(sentence) <= _MAX_SENTENCE else ()
    if ids and all(word in architecture.requirements for word in ids):
        return ids
    title_id = id_by_title.get(sentence.casefold())
    return (title_id,) if title_id else ()


@lru_cache(1 << 12)  # variants have the same sentences, and many components serve the same
def _split_words(sentence: str) -> tuple[str, ...]:
    """Return the words that may be ids, each once."""
    return tuple(dict.fromkeys(word for word in _ID_SEPARATOR.split(sentence) if word not in {"", "and"}))


def _index_titles(architecture: Architecture) -> dict[str, str]:
    """Return the ids of requirements by title."""
    return {requirement.title.casefold(): requirement.id for requirement in architecture.requirements.values()}


def _is_declared(architecture: Architecture, requirement: str) -> bool:
    """Whether a requirement is declared, or may be declared in what could not be read."""
    if requirement in architecture.requirements or requirement in architecture.unread_keys:
        return True
    return architecture.partial and "requirements" in architecture.unread_keys


def _report_unknown_requirement(
    architecture: Architecture, requirement_id: str, span: Span, element: str
) -> Diagnostic:
    use_case = architecture.use_cases.get(requirement_id)
    if use_case is not None:
        return Diagnostic(
            "unknown-requirement",
            f"`{requirement_id}` is a use case, not a requirement",
            span,
            labels=(Label(use_case.at, "declared here"),),
            help=f"requirements name their use cases: `requirements: {{ID: {{use_cases: [{requirement_id}]}}}}`",
            element=element,
        )
    guess = did_you_mean(requirement_id, architecture.requirements)
    cure = guess or "declare it in the section `requirements`, or write a sentence in its place"
    return Diagnostic(
        "unknown-requirement", f"no requirement `{requirement_id}` is declared", span, help=cure, element=element
    )


def uncovered_requirement(architecture: Architecture) -> Iterator[Diagnostic]:
    """No component and no chain serves a requirement."""
    if architecture.partial:
        return
    named_ids = {use.text for c in architecture.list_described_components() for use in c.requirements if use.is_id}
    named_ids.update(requirement for chain in architecture.chains.values() for requirement in chain.requirements)
    # A sentence that means requirements is reported by `unknown-requirement`, too.
    id_by_title = _index_titles(architecture)
    sentences = {use.text for c in architecture.list_described_components() for use in c.requirements if not use.is_id}
    for sentence in sorted(sentences):
        named_ids.update(_list_meant_requirements(architecture, sentence, id_by_title))
    # A misspelt id is reported by `unknown-requirement`; the requirement that it means is not reported once more.
    misspelt_ids = {
        find_closest(text, architecture.requirements) for text in named_ids if text not in architecture.requirements
    }
    parts = index_parts(architecture.requirements)
    served_ids = add_wholes(architecture.requirements, named_ids) if parts else named_ids
    for requirement in architecture.requirements.values():
        # Of a whole, those of its parts are reported that nobody serves.
        is_open = requirement.id not in served_ids and requirement.id not in parts
        if is_open and requirement.id not in misspelt_ids:
            yield Diagnostic(
                "uncovered-requirement",
                f"no component and no chain serves the requirement `{requirement.id}`{f' ({requirement.title})' if requirement.title != requirement.id else ''}",
                requirement.at,
                help=f"name `{requirement.id}` in `requirements` of the component or chain whose task it is",
                element=requirement.id,
            )


def unjustified_component(architecture: Architecture) -> Iterator[Diagnostic]:
    """A component serves no requirement, though the project declares some."""
    if not architecture.requirements:
        return
    for component in architecture.components.values():
        around = (*architecture.list_around(component), *filter(None, [architecture.shells.get(component.id)]))
        # What a composed component is there for, its parts are there for.
        if not component.requirements and not any(shell.requirements for shell in around):
            yield Diagnostic(
                "unjustified-component",
                f"`{component.id}` serves no requirement",
                component.at,
                help=_suggest_justification(architecture, component),
                element=component.id,
            )


def _suggest_justification(architecture: Architecture, component: Component) -> str:
    if component.is_reference:
        return (
            f"name in `requirements` of its component type `{component.type_name}` what it is there for: a reference (`same_as`) has "
            "none of its own, an instance (`is`) has"
        )
    component_type = architecture.component_types.get(component.type_name)
    elsewhere = f", or in those of `{component.type_name}`," if component_type and component_type.library else ""
    return f"name in its `requirements`{elsewhere} what it is there for, as an id or in a sentence"


_MAX_LISTED = 5


def circular_requirement(architecture: Architecture) -> Iterator[Diagnostic]:
    """Requirements are part of one another in a circle."""
    requirements = architecture.requirements
    judged_ids: set[str] = set()
    told_ids: set[str] = set()
    for start in requirements:
        if start in judged_ids or not requirements[start].parents:
            continue
        # Down one way at a time, without recursion: the tree may be as deep as there are requirements.
        way: dict[str, Iterator[str]] = {start: iter(requirements[start].parents)}
        judged_ids.add(start)
        while way:
            current = next(reversed(way))
            parent = next(way[current], None)
            if parent is None:
                del way[current]
            elif parent in way and told_ids.isdisjoint((parent, current)):
                circle = list(dropwhile(parent.__ne__, way))
                # Of circles with a part in common one is said: when it is mended, the next is.
                if told_ids.isdisjoint(circle):
                    yield _diagnose_circle(requirements, circle)
                told_ids.update(circle)
            elif parent in requirements and parent not in judged_ids:
                judged_ids.add(parent)
                way[parent] = iter(requirements[parent].parents)


def _diagnose_circle(requirements: Mapping[str, Requirement], circle: list[str]) -> Diagnostic:
    first, *others = (requirements[each] for each in circle)
    if others:
        names = keep_first([f"`{each}`" for each in circle], _MAX_LISTED)
        message = f"the requirements {join_words(names)} are part of one another"
    else:
        message = f"the requirement `{first.id}` is its own parent"
    return Diagnostic(
        "circular-requirement",
        message,
        first.parent_at,
        labels=tuple(Label(each.parent_at, f"the parent of `{each.id}`") for each in others[:_MAX_LISTED]),
        help="take out the `parent` of the one that is the whole",
        element=first.id,
    )


def unverified_requirement(architecture: Architecture) -> Iterator[Diagnostic]:
    """Nothing shows that a requirement is met."""
    if architecture.partial:
        return
    requirements = architecture.requirements
    parts = index_parts(requirements)
    verified_ids = add_wholes(requirements, (each.id for each in requirements.values() if each.verified_by))
    for requirement in requirements.values():
        # Of a whole, its parts are reported.
        if requirement.id not in verified_ids and requirement.id not in parts:
            title = "" if requirement.title == requirement.id else f" ({requirement.title})"
            yield Diagnostic(
                "unverified-requirement",
                f"nothing verifies the requirement `{requirement.id}`{title}",
                requirement.at,
                help="name in `verified_by` the use case, chain or file that shows it, or say it in a sentence",
                element=requirement.id,
            )


RULES = (
    (unknown_requirement, Severity.ERROR),
    (uncovered_requirement, Severity.WARNING),
    (unjustified_component, Severity.WARNING),
    (circular_requirement, Severity.ERROR),
    (unverified_requirement, Severity.OFF),
)
