"""What an import from AADL left in `hints: {aadl: ...}`, as the properties that it was read from."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from archgen.plugin.model import Component, ConceptualType, Node
from archgen.plugins.aadl.views.aadl_words import AadlProperty, make_property, write_aadl_string, write_texts


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
