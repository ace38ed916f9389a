"""What other files of a project say is not written again; what they say otherwise is told."""

from __future__ import annotations

import pytest

from archgen.edit.earlier_import import leave_out_said, list_said_values, read_slice_content
from archgen.project.slice_parsing import parse_slice
from archgen.syntax.yaml_writer import write_yaml

OTHERS = "nodes: {a: {namespace: /front, arguments: [-v], parameters: {rate: 5}, publishes: {o: /scan}}}\n"


@pytest.mark.parametrize(
    ("data", "kept", "differences"),
    [
        ({"nodes": {"a": {"namespace": "/front", "host": "pc"}}}, {"nodes": {"a": {"host": "pc"}}}, []),
        ({"nodes": {"a": {"namespace": "/front"}}}, {}, []),
        (
            {"nodes": {"a": {"namespace": "/rear"}}},
            {},
            ["nodes.a.namespace: `/front` in other.yaml, `/rear` here"],
        ),
        ({"nodes": {"a": {"parameters": {"rate": 5, "gain": 1}}}}, {"nodes": {"a": {"parameters": {"gain": 1}}}}, []),
        # A short form is what it stands for.
        ({"nodes": {"a": {"publishes": {"o": "/scan"}}}}, {}, []),
        ({"nodes": {"a": {"arguments": ["-v"]}}}, {}, []),
        ({"nodes": {"b": {"namespace": "/front"}}}, {"nodes": {"b": {"namespace": "/front"}}}, []),
    ],
)
def test_only_what_nobody_says_is_left(data: dict[str, object], kept: object, differences: list[str]) -> None:
    parsed_slice = parse_slice("other.yaml", OTHERS)
    assert parsed_slice.document is not None
    parsed_slice.validate_once()
    said = list_said_values([parsed_slice.document], frozenset())
    left_out = leave_out_said(data, read_slice_content("new.yaml", write_yaml(data)).data, said)
    assert (left_out.data, list(left_out.differences.values())) == (kept, differences)
    assert list_said_values([parsed_slice.document], frozenset({"other.yaml"})) == {}
