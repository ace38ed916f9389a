"""The site's page on the robot that exists: how much of the design was seen there, end by end, and what differs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import get_args

from archgen.conformance.seen_record import (
    EndState,
    SeenRobot,
    join_states,
    keep_known,
    list_ends,
    list_seen_components,
    name_end,
)
from archgen.diagnostics import floor_percent
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint
from archgen.views import inline_text
from archgen.views.lookup import Lookup
from archgen.views.shapes import Block, Column, Facts, Inlines, Paragraph, Status, Table, Text

_LEAD = (
    "What workspaces, running robots and recordings said when they were held against this design (`archgen conform --keep`). "
    "An end that has another name by now is one at which nobody looked."
)
_STATE_CHIPS: dict[str, tuple[str, Status | None]] = {
    "seen": ("as designed", "met"),
    "differs": ("differs", "missed"),
    "missing": ("not there", "missed"),
    "untold": ("cannot be told", None),
}
_KIND_WORDS = {
    "workspace": "In the sources of",
    "graph": "Seen running on",
    "recording": "Recorded on",
    "trace": "Traced on",
}


def make_as_built_blocks(lookup: Lookup, robots: Sequence[SeenRobot], obstacle: str) -> Iterator[Block]:
    """Yield the blocks of the page; none where nobody looked at a robot. `obstacle` says why a record could not be read."""
    if obstacle:
        yield Paragraph(inline_text.message_to_inlines(obstacle), "warning")
    if not robots:
        return
    architecture = lookup.architecture
    robots = keep_known(architecture, robots)
    ends = [each for each in list_ends(architecture) if each.node in {node.id for node in lookup.shown_nodes()}]
    yield Paragraph(inline_text.read_marks(_LEAD))
    yield Facts(tuple((f"{_KIND_WORDS[each.kind]} {each.name}", _describe_robot(each)) for each in robots))
    yield _make_group_table(architecture, robots, ends)
    if differences := _make_difference_table(architecture, robots):
        yield differences
    names = [each.name for each in robots]
    titles = [each.name if names.count(each.name) == 1 else f"{each.name}, {each.origin}" for each in robots]
    columns = (Column("Node", 1), Column("Use", 0.6), Column("Name", 1.5), *(Column(title, 0.8) for title in titles))
    rows = tuple(
        (
            inline_text.to_inlines(inline_text.node_link(architecture.nodes[each.node])),
            inline_text.to_inlines(each.use),
            inline_text.to_inlines(inline_text.topic_link(each.name or "")),
            *(_state_cell(robot.ends.get(name_end(each))) for robot in robots),
        )
        for each in ends
    )
    if rows:
        yield Table("table:as_built", "Each end of the design, and what was seen of it", columns, rows)


def _describe_robot(robot: SeenRobot) -> Inlines:
    counts = Counter(robot.ends.values())
    told = counts.total() - counts["untold"]
    words = [
        f"{counts['seen']} of {told} ends as designed ({floor_percent(counts['seen'], told)} %)"
        if told
        else "no end of this design"
    ]
    words += [f"{_STATE_CHIPS[state][0]}: {counts[state]}" for state in get_args(EndState)[1:] if counts[state]]
    return inline_text.to_inlines(f"{', '.join(words)}; {robot.origin}")


def _make_group_table(architecture: Architecture, robots: Sequence[SeenRobot], ends: Sequence[Endpoint]) -> Table:
    """Count ends by group: in sources, seen on something that runs, different, not there, and where nobody looked."""
    sources = [each for each in robots if each.kind == "workspace"]
    running = [each for each in robots if each.kind != "workspace"]
    seen_components = list_seen_components(architecture, robots)
    rows = []
    for group in architecture.groups.values():
        names = [name_end(each) for each in ends if (each.component or "").partition(".")[0] == group.id]
        states = [join_states(robots, name) for name in names]
        counts = (
            len(names),
            sum(join_states(sources, name) == "seen" for name in names),
            sum(join_states(running, name) == "seen" for name in names),
            states.count("differs"),
            states.count("missing"),
            states.count(None) + states.count("untold"),
            sum(each.partition(".")[0] == group.id for each in sorted(seen_components)),
        )
        if names:
            link = inline_text.to_inlines(inline_text.group_link(architecture, group.id))
            rows.append((link, *((Text(str(each), sort_number=str(each)),) for each in counts)))
    titles = ("Ends", "In the sources", "Seen", "Differ", "Not there", "Not known", "Components seen whole")
    columns = (Column("Group", 1.5), *(Column(title, 0.8, "right") for title in titles))
    return Table("table:as_built_groups", "How much of each group was seen", columns, tuple(rows))


def _make_difference_table(architecture: Architecture, robots: Sequence[SeenRobot]) -> Table | None:
    columns = (Column("On", 0.8), Column("Difference", 3), Column("Of", 1), Column("Rule", 0.8))
    rows = tuple(
        (
            inline_text.to_inlines(robot.name),
            inline_text.message_to_inlines(each.message),
            _link_element(architecture, each.element),
            inline_text.to_inlines(each.rule),
        )
        for robot in robots
        for each in robot.differences
    )
    return Table("table:as_built_differences", "What differs", columns, rows) if rows else None


def _link_element(architecture: Architecture, element: str) -> Inlines:
    if element in architecture.nodes:
        return inline_text.to_inlines(inline_text.node_link(architecture.nodes[element]))
    if element in architecture.outputs or element in architecture.inputs:
        return inline_text.port_id_link(architecture, element)
    return inline_text.to_inlines(element)


def _state_cell(state: str | None) -> Inlines:
    if state is None:
        return inline_text.to_inlines(Text("nobody looked", muted=True))
    word, status = _STATE_CHIPS[state]
    return (Text(word, status=status),) if status else inline_text.to_inlines(Text(word, muted=True))
