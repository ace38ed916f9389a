"""References that were resolved in another version of a project: which of them still mean the same."""

from __future__ import annotations

import random

import pytest

from archgen.diagnostics.source_span import NO_SPAN
from archgen.link.link_memory import LinkMemory
from archgen.link.reference_resolution import Answer, NameList, ReferenceResolver, list_endings

KINDS = ("component", "output")


def make_resolver(memory: LinkMemory, ids: dict[str, list[str]]) -> ReferenceResolver:
    spans = {
        kind: dict.fromkeys(ids.get(kind, ()), NO_SPAN) for kind in ("group", "component", "output", "input", "node")
    }
    plain_spans = {"host": dict.fromkeys(ids.get("host", ()), NO_SPAN)}
    return ReferenceResolver(spans, plain_spans, [], all_names=memory.recall_names(spans, plain_spans))


def names_of(resolver: ReferenceResolver) -> NameList:
    assert resolver.all_names is not None
    return resolver.all_names


def draw_ids(chance: random.Random) -> dict[str, list[str]]:
    components = [f"{group}.{name}" for group in "ab" for name in "abc" if chance.random() < 0.7]
    return {
        "group": ["a", "b"],
        "component": components,
        "output": [f"{component}.{name}" for component in components for name in "abo" if chance.random() < 0.5],
    }


@pytest.mark.parametrize("seed", range(40))
def test_answers_hold_exactly_where_each_reference_means_the_same(seed: int) -> None:
    chance = random.Random(seed)  # noqa: S311 - the same names each time
    memory, old_ids = LinkMemory(), draw_ids(chance)
    old = make_resolver(memory, old_ids)
    new_ids = {kind: [each for each in ids if chance.random() < 0.9] for kind, ids in old_ids.items()}
    new = make_resolver(memory, {**new_ids, "output": [*new_ids["output"], "b.c.a"]})
    paths = sorted({path for ids in old_ids.values() for each in ids for path in list_endings(each)})
    judged: set[bool] = set()
    for path in paths:
        for writer in (None, "a.a", "b.c"):
            match = old.names.resolve_path(path, KINDS, component_id=writer)
            if match.unique_element is None or match.hidden_elements:
                continue  # that is found fault with, and never remembered
            now = new.names.resolve_path(path, KINDS, component_id=writer)
            is_same = now.unique_element == match.unique_element and not now.hidden_elements
            answer = Answer(path, KINDS, writer, match.unique_element)
            assert new.gives_answers([answer], names_of(old)) == is_same, (path, writer)
            judged.add(is_same)
    assert True in judged


def test_what_is_named_by_its_id_alone_must_be_there() -> None:
    memory = LinkMemory()
    old, new = make_resolver(memory, {"host": ["pc", "arm"]}), make_resolver(memory, {"host": ["pc"]})
    assert new.gives_answers([Answer("pc", ("host",))], names_of(old))
    assert not new.gives_answers([Answer("arm", ("host",))], names_of(old))
