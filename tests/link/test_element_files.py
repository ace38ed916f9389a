"""The files of an element: each that says something of it, in order of appearance."""

from __future__ import annotations

from archgen.checking.code_ownership import find_element_files
from archgen.link.slice_merging import merge_documents
from archgen.schema import normalise_document
from archgen.syntax import yaml_parser


def files_of(*texts: str) -> dict[str, str]:
    """Return the files (a, b, ...) of each element, as `kind id`."""
    documents = []
    for name, text in zip("abcdef", texts, strict=False):
        document, _ = yaml_parser.parse_yaml(name, text)
        assert document is not None
        normalise_document(document)
        documents.append(document)
    root, _ = merge_documents(documents)
    return {f"{kind} {element}": " ".join(files) for (kind, element), files in find_element_files(root).items()}


def test_every_slice_of_an_element_counts_once() -> None:
    assert files_of(
        "groups: {g: {title: G, components: {c: {title: C, inputs: {i: x}}}}}",
        "groups: {g: {components: {c: {timing: {rate: 1 Hz, wcet: 2 ms}}}}}",
        "groups: {g: {tags: [a, b], components: {d: D}}}\nnodes: {n: {implements: c}}",
        "nodes: {n: {parameters: {p: 1}}}",
    ) == {"component g.c": "a b", "component g.d": "c", "group g": "a c", "node n": "c d"}


def test_a_file_that_only_adds_components_says_nothing_of_the_group() -> None:
    assert files_of("groups: {g: {title: G}}", "groups: {g: {components: {c: C}}}") == {
        "component g.c": "b",
        "group g": "a",
    }
    assert files_of("groups: {g: {components: {c: C}}}") == {"component g.c": "a", "group g": ""}


def test_a_group_without_components_has_the_file_that_declares_it() -> None:
    assert files_of("groups: {g: }") == {"group g": "a"}
    assert files_of("groups: {g: {title: G, components: {}}}") == {"group g": "a"}


def test_a_list_counts_with_its_items() -> None:
    assert files_of("nodes: {n: }", "nodes: {n: {tags: [a]}}", "nodes: {n: {urls: {u: v}}}") == {"node n": "a b c"}
