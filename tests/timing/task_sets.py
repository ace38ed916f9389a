"""Independent elements on one computer, written as a project, and what comes out of it."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.timing.analysis import Analysis

MS = 10**6


def tasks(rows: Mapping[str, str], *, host: str = "cores: 1") -> str:
    """Write independent elements on one computer, in the order of falling priority where `{p}` stands in a row."""
    components = "\n".join(f"      {name}: {{outputs: {{out: std_msgs/msg/Empty}}}}" for name in rows)
    nodes = "\n".join(
        f"  {name}: {{implements: {name}, host: pc, timing: {{{row.format(p=len(rows) - place)}}}}}"
        for place, (name, row) in enumerate(rows.items())
    )
    return f"groups:\n  g:\n    components:\n{components}\nnodes:\n{nodes}\nhosts: {{pc: {{{host}}}}}\n"


def periodic(period: str, cost: str, more: str = "priority: {p}") -> str:
    return f"behaviour: periodic, period: {period} ms, wcet: {cost} ms, {more}"


def worst(found: Analysis) -> dict[str, object]:
    """Give the worst responses in ms, or what is said instead."""
    return {
        name: response.worst.value / MS if response.worst.value is not None else response.worst.assumptions
        for name, response in found.responses.items()
    }
