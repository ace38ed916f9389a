"""The explorer's page as it is without scripts: the picture of the whole, and a list of what flows between the groups."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import chain

from archgen.diagnostics import join_first
from archgen.views import inline_text
from archgen.views.graphs.drawn_level import list_flows
from archgen.views.lookup import Lookup
from archgen.views.shapes import Block, Column, Figure, Paragraph, Table, Text

EXPLORER_LEAD = "With scripts this page is a map of all groups, components, nodes and hosts. Without them it is a picture and a list."


def make_explorer_blocks(lookup: Lookup, figures: Iterable[Figure]) -> tuple[Block, ...]:
    """Make the blocks: pictures, where all connections are, and what flows from one group to another."""
    link = Text("the table of all connections", ref="page:connections")
    hint = Paragraph((Text(f"{EXPLORER_LEAD} Single ports stand in "), link, Text(".")))
    table = _make_flow_table(lookup)
    return (hint, *figures, *((table,) if table else ()))


def _make_flow_table(lookup: Lookup) -> Table | None:
    """Make the table of what flows between groups; None where nothing does."""
    groups = lookup.architecture.groups
    flow_types: dict[tuple[str, str], list[tuple[str, ...]]] = {}
    for flow in list_flows(lookup.architecture):
        tail, head = flow.tail.partition(".")[0], flow.head.partition(".")[0]
        if lookup.scope.shows_component(flow.tail) and lookup.scope.shows_component(flow.head):
            flow_types.setdefault((tail, head), []).append(flow.types)
    rows = tuple(
        (
            (Text(groups[tail].title, ref=f"group:{tail}"),),
            (Text(groups[head].title, ref=f"group:{head}"),) if head != tail else (Text("itself", muted=True),),
            (Text(str(len(types)), sort_number=str(len(types))),),
            inline_text.to_inlines(join_first(list(dict.fromkeys(chain.from_iterable(types))))),
        )
        for (tail, head), types in flow_types.items()
    )
    columns = (Column("From"), Column("To"), Column("Flows", align="right"), Column("What"))
    return Table("table:explorer", "What flows between the groups", columns, rows) if rows else None
