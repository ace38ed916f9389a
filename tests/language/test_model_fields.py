"""Each key of an element is held by a field of the type that it is read as, and each field holds a key; or a reason stands here."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import MISSING, Field, fields
from functools import partial
from pathlib import Path
from types import NoneType
from typing import Any, Literal, get_args, get_origin, get_type_hints

import pytest

from archgen import pipeline
from archgen.language.language_tables import KEYS, PLACED_KEYS, WORDS
from archgen.link.declare.element_declaration import DECLARERS, find_declarer
from archgen.link.value_readers import VALUE_READERS, find_type, find_value_reader, list_held_keys
from archgen.model.architecture import Architecture
from archgen.model.component import PerformanceIndicator
from archgen.model.declared_timing import Timing
from archgen.model.element_annotations import PropertyDeclaration
from archgen.model.node import Qos, ReadyConditions, StartUp
from archgen.model.parameter import Operation, Parameter
from archgen.model.project_settings import ConformSettings, ReviewSettings
from archgen.model.report_settings import ReportSettings
from archgen.model.use_case_steps import Actor
from tests.compare.test_element_kinds import MODEL_CLASSES, ROBOT, SECTIONS

CLASSES: Mapping[str, type] = {
    **MODEL_CLASSES,
    "property_declaration": PropertyDeclaration,
    "actor": Actor,
    "indicator": PerformanceIndicator,
    "operation": Operation,
    "parameter_declaration": Parameter,
    "timing": Timing,
    "start": StartUp,
    "start_ready": ReadyConditions,
    "qos": Qos,
    "report": ReportSettings,
    "review": ReviewSettings,
    "conform": ConformSettings,
}
KEYS_WITHOUT_FIELD = {
    **dict.fromkeys(("group.autoconnect", "component.autoconnect", "component.from"), "the connections that it makes"),
    **dict.fromkeys(("output.from", "output.to"), "the connections that it makes"),
    **dict.fromkeys(("component.components", "component.containers", "component.frames"), "elements of their own"),
    "component.node": "the node that it makes",
    **{
        f"component_type.{key}": "what its instances have"
        for key in (
            "role",
            "requirements",
            "performance",
            "autoconnect",
            "node",
            "containers",
            "timing",
            "tags",
            "urls",
        )
    },
    "component_type.layout": "what its instances have",
    **{f"node.{key}": "the field `uses`" for key in ("publishes", "subscribes", "serves", "calls", "internal")},
    **{f"report.{key}": "the chapters, read by themselves" for key in ("chapters", "texts", "pictures")},
}
FIELDS_WITHOUT_KEY = {
    **dict.fromkeys(("type.name", "parameter_declaration.name"), "the key of the element"),
    **dict.fromkeys(("component.name", "input.name", "output.name"), "the last part of the id"),
    **dict.fromkeys(
        ("component.group", "component.parent", "input.component", "output.component"), "the first parts of it"
    ),
    **dict.fromkeys(("group.co_owners", "component.co_owners", "node.co_owners"), "the rest of the key `owner`"),
    "component.children": "the key `components`",
    **{f"component.{key}_known": f"whether `{key}` is written" for key in ("requirements", "inputs", "outputs")},
    **dict.fromkeys(("component_type.library", "type.library", "type.origin"), "where it is declared"),
    "component_type.inner_types": "the key `components`",
    "output.is_made": "what it gives on",
    "type.part_fields": "the keys `request`, `response` and `feedback`",
    "frame.component": "where it is written",
    "node.wholes": "the key `implements`",
    "node.uses": "the keys `publishes`, `subscribes`, `serves`, `calls` and `internal`",
    **dict.fromkeys(("node.written", "node.implements_written"), "whether and how it is written"),
    **dict.fromkeys(("node.own_values", "node.executor_places", "node.remap_places", "node.argument_places"), "places"),
    **dict.fromkeys(
        ("node.file_values", "node.unread_files", "node.file_remarks"), "the key `parameter_files`, read later"
    ),
    **dict.fromkeys(("timing.places", "start.places", "start_ready.places"), "places"),
    "qos.written": "whether it is written",
    "review.guards_margins": "the key `breaking`",
}
PAIR = """\
archgen: 1
project: {id: pair, title: Pair}
groups: {g: {components: {a: {layout: {direction: top-bottom}, outputs: {o: T}}, b: {inputs: {i: a.o}}}}}
"""
"""What no element of `ROBOT` has: a component with a layout, an input with a source."""
MADE_FIELDS = ("id", "title", "at")
"""What every element has."""


@pytest.mark.parametrize("kind", CLASSES)
def test_each_key_has_a_field_and_each_field_a_key_or_there_is_a_reason(kind: str) -> None:
    held_keys = list_held_keys(kind, CLASSES[kind])
    excepted_keys = [key for key in KEYS[kind] if f"{kind}.{key}" in KEYS_WITHOUT_FIELD]
    assert sorted(KEYS[kind].keys() - held_keys.keys()) == sorted(excepted_keys)
    placed_fields = {f"{key}_at" for key in PLACED_KEYS.get(kind, ()) if key in held_keys}
    held_fields = {*MADE_FIELDS, *placed_fields, *(name for names in held_keys.values() for name in names)}
    names = {field.name for field in fields(CLASSES[kind])}
    excepted_fields = [name for name in names if f"{kind}.{name}" in FIELDS_WITHOUT_KEY]
    assert sorted(names - held_fields) == sorted(excepted_fields)
    assert placed_fields <= names


@pytest.mark.parametrize("kind", CLASSES)
def test_each_field_is_of_the_type_that_its_key_is_read_as(kind: str) -> None:
    hints = get_type_hints(CLASSES[kind])
    made_fields = {field.name: field for field in fields(CLASSES[kind])}
    for key, names in list_held_keys(kind, CLASSES[kind]).items():
        reader = find_value_reader(kind, key) or find_declarer(kind, key)
        if reader is None:
            continue  # the declaration of the kind reads it
        read_type = get_type_hints(reader.func if isinstance(reader, partial) else reader)["return"]
        read_types = get_args(read_type) if len(names) > 1 else (read_type,)
        for name, each in zip(names, read_types, strict=True):
            assert spell_type(hints[name]) == spell_type(each), (kind, key, name)
            may_be_left_out = NoneType in get_args(each)
            assert not may_be_left_out or name in MADE_FIELDS or has_default(made_fields[name]), (kind, key, name)


@pytest.mark.parametrize("kind", CLASSES)
def test_each_field_for_a_word_names_the_words_of_the_language(kind: str) -> None:
    hints = get_type_hints(CLASSES[kind])
    for key, names in list_held_keys(kind, CLASSES[kind]).items():
        words = WORDS.get(find_type(kind, key))
        literal = next(
            (each for each in (hints[names[0]], *get_args(hints[names[0]])) if get_origin(each) is Literal), None
        )
        if words is not None and literal is not None:
            assert set(get_args(literal)) == set(words), (kind, key)


def test_what_is_written_at_a_key_is_read(tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text(ROBOT, encoding="utf-8")
    (tmp_path / "pair.yaml").write_text(PAIR, encoding="utf-8")
    architectures = [pipeline.check_project(tmp_path / name).architecture for name in ("robot.yaml", "pair.yaml")]
    unread = {
        f"{kind}.{key}"
        for kind in MODEL_CLASSES
        for key, names in list_held_keys(kind, MODEL_CLASSES[kind]).items()
        if not any(is_given(each, names[0]) for project in architectures for each in list_elements(project, kind))
    }
    assert unread == set()


def test_the_tables_name_types_and_keys_of_the_language() -> None:
    keys = {f"{kind}.{key}" for kind, keys in KEYS.items() for key in keys}
    types = {find_type(kind, key) for kind, keys in KEYS.items() for key in keys}
    assert VALUE_READERS.keys() | DECLARERS.keys() <= keys | types
    assert KEYS_WITHOUT_FIELD.keys() <= keys


def list_elements(architecture: Architecture, kind: str) -> Iterable[Any]:
    """Return the elements of a kind, and the project as the only one of its kind."""
    return [architecture.project] if kind == "project" else list(getattr(architecture, SECTIONS[kind]).values())


def is_given(element: object, name: str) -> bool:
    """Whether an element has another value in a field than its default."""
    field = next(each for each in fields(element) if each.name == name)  # type: ignore[arg-type]
    default = field.default_factory() if field.default_factory is not MISSING else field.default
    return bool(getattr(element, name) != default)


def has_default(field: Field[Any]) -> bool:
    """Whether an object can be made without a value for a field."""
    return field.default is not MISSING or field.default_factory is not MISSING


def spell_type(hint: Any) -> str:  # noqa: ANN401 - an annotation
    """Return a type without what does not matter here: whether it may be None, and which words a text may be."""
    if get_origin(hint) is Literal:
        return "str"
    inner = [spell_type(each) for each in get_args(hint) if each is not NoneType]
    if NoneType in get_args(hint):
        return " | ".join(sorted(inner))
    name = {dict: "Mapping"}.get(get_origin(hint), getattr(get_origin(hint) or hint, "__name__", str(hint)))
    return f"{name}[{', '.join(inner)}]" if inner else name
