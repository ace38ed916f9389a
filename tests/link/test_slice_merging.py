"""Slices become one table; what is written twice or declared nowhere is found."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import NO_SPAN
from archgen.link.slice_merging import merge_documents
from archgen.pipeline import check_project
from archgen.schema import normalise_document, validate_document
from archgen.syntax import yaml_parser
from archgen.syntax.yaml_tree import YamlDocument, node_to_data
from tests.judged_projects import check_text


def slices(*texts: str) -> list[YamlDocument]:
    """Read several files (a, b, ...) into normal form."""
    documents = []
    for name, text in zip("abcdef", texts, strict=False):
        document, _ = yaml_parser.parse_yaml(name, text)
        assert document is not None
        assert (validate_document(document), normalise_document(document)) == ((), ())
        documents.append(document)
    return documents


def merged(*texts: str) -> tuple[object, list[str]]:
    """Merge, and give the findings as `place rule: message | help`."""
    root, found = merge_documents(slices(*texts))
    return node_to_data(root), [_line(diagnostic) for diagnostic in found]


def _line(diagnostic: Diagnostic) -> str:
    first = f" ({diagnostic.labels[0].span})" if diagnostic.labels else ""
    return f"{diagnostic.span} {diagnostic.rule}: {diagnostic.message}{first} | {diagnostic.help}"


ONCE = "a value is written once in the whole project, even where both are equal: keep one of them"


def test_mappings_merge_in_order_of_first_appearance() -> None:
    assert merged(
        "groups: {g: {title: G, components: {c: C}}}",
        "groups: {h: H, g: {components: {d: D, c: {timing: {rate: 3 Hz}}}}}\nhosts: {p: }",
    ) == (
        {
            "groups": {
                "g": {
                    "title": "G",
                    "components": {"c": {"title": "C", "timing": {"rate": "3 Hz"}}, "d": {"title": "D"}},
                },
                "h": {"title": "H"},
            },
            "hosts": {"p": {}},
        },
        [],
    )


def test_a_leaf_is_written_once_even_if_equal() -> None:
    result, found = merged(
        "groups: {g: {title: G, tags: [a]}}", "groups: {g: {title: G}}", "groups: {g: {title: H, tags: [b]}}"
    )
    assert result == {"groups": {"g": {"title": "G", "tags": ["a"]}}}
    assert found == [
        f"b:1:21 conflicting-values: `title` of `g` is written in two places (a:1:21) | {ONCE}",
        f"c:1:21 conflicting-values: `title` of `g` is written in two places (a:1:21) | {ONCE}",
        f"c:1:30 conflicting-values: `tags` of `g` is written in two places (a:1:30) | {ONCE}",
    ]


def test_one_parameter_is_a_leaf() -> None:
    result, found = merged("nodes: {n: {parameters: {a: {x: 1}, b: 1}}}", "nodes: {n: {parameters: {a: {y: 2}, c: 3}}}")
    assert result == {"nodes": {"n": {"parameters": {"a": {"x": 1}, "b": 1, "c": 3}}}}
    assert found == [f"b:1:29 conflicting-values: `a` of `n` is written in two places (a:1:29) | {ONCE}"]


def test_a_leaf_never_merges_with_a_mapping() -> None:
    result, found = merged("nodes: {n: {timing: {trigger: any}}}", "nodes: {n: {timing: {trigger: {all: [a]}}}}")
    assert result == {"nodes": {"n": {"timing": {"trigger": "any"}}}}
    assert [line.split(":")[0] for line in found] == ["b"]
    assert merged("nodes: {n: {timing: {trigger: {all: [a]}}}}", "nodes: {n: {timing: {trigger: any}}}")[1]


def test_empty_is_not_written_and_known_to_be_none_survives() -> None:
    text = "groups: {g: {title: G, components: {c: {title: C, inputs: {}, requirements: []}}}}"
    result, found = merged("groups: {g: {title: , components: {c: {outputs: }}}}", text)
    assert result == {
        "groups": {"g": {"components": {"c": {"title": "C", "inputs": {}, "requirements": []}}, "title": "G"}}
    }
    assert found == []


def test_elements_that_nobody_declares() -> None:
    result, found = merged(
        "groups: {sensing: {title: S, components: {camera: C, lidar: }}}",
        "groups: {sensing: {components: {camra: {timing: {rate: 1 Hz}, tags: [x]}}}, sensng: {owner: p}}",
        "groups: {sensing: {components: {lidar: {timing: {rate: 1 Hz}}}}, sensnig: {components: {camera: {tags: [a]}}}}",
    )
    assert result == {
        "groups": {
            "sensing": {"title": "S", "components": {"camera": {"title": "C"}, "lidar": {"timing": {"rate": "1 Hz"}}}}
        }
    }
    assert found == [
        "b:1:33 undeclared-element: no file declares the component `sensing.camra` | did you mean `sensing.camera`?",
        "b:1:77 undeclared-element: no file declares the group `sensng` | did you mean `sensing`?",
        "c:1:89 undeclared-element: no file declares the component `sensnig.camera` | did you mean `sensing.camera`?",
    ]


def test_what_a_broken_file_may_declare_is_not_called_undeclared() -> None:
    documents = slices("groups: {g: {components: {c: {tags: [a]}}}}")
    assert [d.rule for d in merge_documents(documents)[1]] == ["undeclared-element"]
    assert merge_documents(documents, frozenset({"c"}))[1] == ()


def test_what_means_nothing_without_a_key() -> None:
    _, found = merged(
        "views: {v: {title: V}}\npolicies: {p: {forbid: {from: a}}}", "policies: {q: {forbid: {from: a, to: b}}}"
    )
    assert [line.split(" |")[0] for line in found] == [
        "a:1:9 missing-key: `v` lacks `show`",
        "a:2:12 missing-key: `p` lacks `forbid.to`",
    ]


def test_documents_stay_as_they_are() -> None:
    documents = slices("groups: {g: {title: G}}", "groups: {g: {tags: [a], components: {c: {tags: [b]}}}}")
    before = [node_to_data(document.root) for document in documents]
    merge_documents(documents)
    assert [node_to_data(document.root) for document in documents] == before


def test_nothing() -> None:
    assert merged() == ({}, [])


def test_what_is_accepted_has_a_reason() -> None:
    _, found = merged("review: {accepted: {a.b: agreed, a.c: , a.d: {key: qos}}}")
    assert [line.split(" |")[0] for line in found] == [
        "a:1:34 missing-key: `a.c` lacks `reason`",
        "a:1:41 missing-key: `a.d` lacks `reason`",
    ]


def test_what_is_declared_stays_where_something_else_is_not() -> None:
    result, found = merged(
        "groups: {bare: , titled: {title: T, components: {x: {tags: [a]}}}, kept: {components: {c: C, y: {tags: [a]}}}}",
        "groups: {gone: {components: {z: {tags: [a]}}}, whole: {components: {d: D}}}",
    )
    assert result == {
        "groups": {
            "bare": {},
            "titled": {"title": "T", "components": {}},
            "kept": {"components": {"c": {"title": "C"}}},
            "whole": {"components": {"d": {"title": "D"}}},
        }
    }
    assert [line.split("component ")[1].split(" |")[0] for line in found] == ["`titled.x`", "`kept.y`", "`gone.z`"]


def test_a_merged_mapping_stands_where_its_first_slice_does() -> None:
    root, _ = merge_documents(slices("groups: {g: {title: G}}", "groups: {h: {title: H}}"))
    assert (root.span.file, root.entries["groups"].value.span.file) == ("a", "a")
    assert merge_documents([])[0].span == NO_SPAN


@pytest.mark.parametrize("order", [1, -1])
def test_a_value_that_cannot_be_read_conflicts_with_none(tmp_path: Path, order: int) -> None:
    for name, text in zip(
        ("archgen.yaml", "b.yaml"),
        ("nodes: {n: {implements: {x: y}}}", "nodes: {n: {implements: g.a}}")[::order],
        strict=True,
    ):
        (tmp_path / name).write_text(text)
    with (tmp_path / "archgen.yaml").open("a") as file:
        file.write("\narchgen: 1\ngroups: {g: {title: G, components: {a: {outputs: {}}}}}\n")
    assert [d.message for d in check_project(tmp_path).findings if d.severity == "error"] == [
        "`implements` is a mapping, but must be text or a list"
    ]


def test_an_element_whose_declaration_cannot_be_read_is_declared() -> None:
    text = "groups:\n  g: {title: [G]}\n  h: {components: {a: {inputs: 3}, b: {functionality: {}, timing: {rate: 1 Hz}}}}\n"
    assert not [d.message for d in check_text(text) if d.rule == "undeclared-element"]
