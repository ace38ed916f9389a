"""Graphs as templates hold them, back in the shape that emitters draw."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any, TypeVar

from archgen.views.picture_shapes import Arrow, Box, Cluster, Graph, Lifeline, SequenceChart, SequenceMessage

Shape = TypeVar("Shape", Box, Arrow, Cluster, Graph, Lifeline, SequenceMessage, SequenceChart)


def graph_from_plain(data: object) -> Graph:
    """Return the graph that `shape_to_plain` made plain data of. Raise TypeError for anything else."""
    if not isinstance(data, Mapping) or data.get("shape") != "graph":
        msg = "`mermaid_graph` takes one of `graphs`"
        raise TypeError(msg)
    parts: dict[str, Any] = {
        "boxes": tuple(_from_plain(Box, box) for box in data["boxes"]),
        "arrows": tuple(_from_plain(Arrow, arrow) for arrow in data["arrows"]),
        "clusters": tuple(_from_plain(Cluster, cluster) for cluster in data["clusters"]),
    }
    return _from_plain(Graph, {**data, **parts})


def sequence_from_plain(data: object) -> SequenceChart:
    """Return the sequence that `shape_to_plain` made plain data of. Raise TypeError for anything else."""
    if not isinstance(data, Mapping) or data.get("shape") != "sequencechart":
        msg = "`mermaid_sequence` takes one of `sequences`"
        raise TypeError(msg)
    parts: dict[str, Any] = {
        "lifelines": tuple(_from_plain(Lifeline, lifeline) for lifeline in data["lifelines"]),
        "messages": tuple(_from_plain(SequenceMessage, message) for message in data["messages"]),
    }
    return _from_plain(SequenceChart, {**data, **parts})


def _from_plain(shape: type[Shape], data: Mapping[str, Any]) -> Shape:
    names = {field.name for field in dataclasses.fields(shape)}
    values: dict[str, Any] = {
        name: tuple(value) if isinstance(value, list) else value for name, value in data.items() if name in names
    }
    return shape(**values)
