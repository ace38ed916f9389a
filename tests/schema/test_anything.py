"""Whatever stands in a document, reading it raises nothing, and what is left of it the schema allows."""

from __future__ import annotations

from typing import Any

import yaml as pyyaml
from hypothesis import given, settings
from hypothesis import strategies as st

from archgen.link.slice_merging import merge_documents
from archgen.schema import normalise_document, validate_document
from archgen.schema.language_schema import load_schema
from archgen.syntax import yaml_parser
from tests.property_sizes import count_examples


def _names(part: Any) -> set[str]:  # noqa: ANN401
    """Collect every key of the language."""
    found = set(part.get("properties", ())) if isinstance(part, dict) else set()
    for below in part.values() if isinstance(part, dict) else ():
        if isinstance(below, dict):
            found |= _names(below)
    return found


KEYS = st.sampled_from(
    [
        *sorted(_names(load_schema())),
        "a",
        "b_c",
        "R-1",
        "Bad-Id",
        "../x",
        "all",
        "x.y",
        "Point  cloud",
        "0",
        "01",
        "+1",
        "\0",
    ]
)
LEAVES = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=5),
    st.sampled_from(["10 Hz", "3 ms", "5 KB", "a.b", "a", "filter", "any", "sensor_data", "pkg/msg/Name", "off", "1/3"]),
)  # fmt: skip
TREES = st.recursive(
    LEAVES,
    lambda below: st.one_of(st.lists(below, max_size=3), st.dictionaries(KEYS, below, max_size=4)),
    max_leaves=25,
)


def _nested(*keys: str) -> st.SearchStrategy[Any]:
    """Put a tree where an element of the language stands."""

    def put(tree: object) -> object:
        for key in reversed(keys):
            tree = {key: tree}
        return tree

    return TREES.map(put)


DOCUMENTS = st.one_of(
    st.dictionaries(KEYS, TREES, max_size=3),
    _nested("groups", "g"),
    _nested("groups", "g", "components", "c"),
    _nested("groups", "g", "components", "c", "timing"),
    _nested("groups", "g", "components", "c", "performance"),
    _nested("nodes", "n"),
    _nested("nodes", "n", "publishes", "p"),
    _nested("types"),
    _nested("rules"),
)


@settings(max_examples=count_examples(400), deadline=None)
@given(st.lists(DOCUMENTS, min_size=1, max_size=3))
def test_any_data(trees: list[object]) -> None:
    documents = []
    for name, tree in zip("abc", trees, strict=False):
        document, _ = yaml_parser.parse_yaml(name, pyyaml.safe_dump(tree, allow_unicode=True))
        if document is None:
            continue
        validate_document(document)
        left = validate_document(
            document
        )  # only ids that are not well formed, and kept so that references to them hold
        assert [
            d.message for d in left if " cannot be an id" not in d.message and " cannot be a port" not in d.message
        ] == []
        normalise_document(document)
        documents.append(document)
    merge_documents(documents)


@settings(max_examples=count_examples(300), deadline=None)
@given(st.binary(max_size=200))
def test_any_bytes(data: bytes) -> None:
    document, found = yaml_parser.parse_yaml("f", data.decode("latin-1"))
    if document is None:
        assert found != ()
    else:
        validate_document(document)
        normalise_document(document)
        merge_documents([document])
