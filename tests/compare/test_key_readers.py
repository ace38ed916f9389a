"""A key has a reader of its own where the normal form of its type does not do, and nowhere else."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from archgen import pipeline
from archgen.compare.kinds import ELEMENT_KINDS
from archgen.compare.kinds.key_readers import READERS
from archgen.compare.kinds.key_spec import ReadContext
from archgen.compare.kinds.kind_spec import make_form_reader
from archgen.compare.matched_ids import MatchedIds
from archgen.language.language_tables import KEY_FACTS, KeyFacts
from archgen.products.compared_versions import make_comparison_input
from tests.compare.test_element_kinds import ROBOT

OTHERWISE = """\
ros: {parameter_texts: {n.yaml: "n: {ros__parameters: {x: 1}}"}}
groups:
  g:
    components:
      a: {outputs: {do: std_srvs/srv/Trigger}, timing: {period: 10 ms, cores: [1]}}
      b: {inputs: {do: a.do}}
      c: {outputs: {o: std_msgs/msg/Bool}, timing: {outputs: {o: {conditional: true}}}}
nodes:
  n: {implements: b, parameter_files: [n.yaml], timing: {calls: {do: 2}}}
  odometry: {kind: program}
frames: {map: , odom: {parent: map, by: odometry}}
"""
"""What nobody can write beside what `ROBOT` says."""
ReadKey = tuple[str, str]
_MISSING = object()


def test_every_reader_reads_a_key_that_is_described() -> None:
    described = {(kind, name) for kind, keys in KEY_FACTS.items() for name in keys}
    assert [key for key in READERS if key not in described] == []


def test_what_holds_elements_has_a_reader() -> None:
    # What a component type has from components is read off its pattern.
    kinds = KEY_FACTS.keys() - {"component_type"}
    held = [(kind, name) for kind in kinds for name, facts in KEY_FACTS[kind].items() if facts.get("form") == "entries"]
    assert [key for key in held if key not in READERS] == []


def test_no_reader_reads_what_the_type_does(tmp_path: Path) -> None:
    needed: set[ReadKey] = set()
    for name, text in (("robot.yaml", ROBOT), ("otherwise.yaml", OTHERWISE)):
        (tmp_path / name).write_text(text, encoding="utf-8")
        version = make_comparison_input(pipeline.check_project(tmp_path / name))
        elements = [
            (kind.name, element_id, element)
            for kind in ELEMENT_KINDS.values()
            for element_id, element in (kind.elements(version) if kind.elements else {}).items()
        ]
        renamed_ids = MatchedIds()
        for kind, element_id, _ in elements:
            renamed_ids.add_pair(kind, element_id, f"{element_id}_2")
        context = ReadContext(version, renamed_ids)
        needed.update(
            key for kind, _, element in elements if kind in KEY_FACTS for key in _list_needed(kind, element, context)
        )
    assert sorted(READERS.keys() - needed) == []


def _list_needed(kind: str, element: object, context: ReadContext) -> Iterator[ReadKey]:
    """Yield the keys of an element that their type alone would read otherwise, those below them as well."""
    for name, facts in KEY_FACTS[kind].items():
        own_reader = READERS.get((kind, name))
        typed = _read_by_type(name, facts, element, context)
        value = own_reader(element, context) if own_reader else typed
        if own_reader and value != typed:
            yield kind, name
        if "inner" in facts and value is not None and value is not _MISSING:
            for holder in value.values() if isinstance(value, dict) else [value]:
                yield from _list_needed(facts["inner"], holder, context)


def _read_by_type(name: str, facts: KeyFacts, element: object, context: ReadContext) -> Any:  # noqa: ANN401 - any value
    attribute = facts.get("attribute", name.removesuffix("."))
    if "inner" in facts:
        return getattr(element, attribute, _MISSING)
    try:
        return make_form_reader(attribute, facts)(element, context)
    except (LookupError, AttributeError, TypeError):
        return _MISSING
