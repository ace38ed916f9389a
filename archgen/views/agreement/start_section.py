"""The section on the start-up: what of one partner waits for what of the other one, and until when."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.bringup.plan_shapes import StartStep
from archgen.bringup.start_plan import describes_start, make_start_plan
from archgen.model.architecture import Architecture
from archgen.views import inline_text, start_phrases
from archgen.views.agreement.agreement_content import AgreementContent
from archgen.views.graphs.element_boxes import join_owner_titles
from archgen.views.shapes import Column, Inlines, Paragraph, Section, Table, Text, drop_empty_columns
from archgen.views.tables.start_table import link_step

_LEAD = (
    "When the robot starts, one of the two waits for the other one here. Each says how one sees that its own is up. The order "
    "follows from the connections, the phases and what is written; it is no term of an interface."
)


def list_start_steps(architecture: Architecture) -> dict[str, StartStep]:
    """Return the steps by id; none where the project does not describe its start-up."""
    return {step.id: step for step in make_start_plan(architecture).steps} if describes_start(architecture) else {}


def write_start_section(content: AgreementContent) -> Iterator[Section]:
    """Yield the section, where the project describes its start-up and one of the two waits for the other."""
    steps = list_start_steps(content.lookup.architecture)
    rows = tuple(row for step in steps.values() for row in _list_rows(content, step, steps))
    if rows:
        columns = (
            Column("What waits", 1.1),
            Column("Partner", 0.9),
            Column("For what", 1.1),
            Column("Partner", 0.9),
            Column("Until", 1.3),
            Column("Why", 1.8),
        )
        table = drop_empty_columns(Table("table:shared_start", "Who waits for whom", columns, rows))
        yield Section("page:start", "Start-up", (Paragraph(inline_text.to_inlines(_LEAD)), table))


def _list_rows(
    content: AgreementContent, step: StartStep, steps: dict[str, StartStep]
) -> Iterator[tuple[Inlines, ...]]:
    for named in start_phrases.name_waits(step):
        awaited = steps[named.awaited]
        pair = _find_direction(content, step, awaited)
        if pair is not None:
            until = {"ended": "it has ended", "started": "it is started"}.get(named.until)
            sign = until or start_phrases.describe_ready(awaited) or "it is started"
            yield (
                (link_step(step),),
                inline_text.to_inlines(join_owner_titles(content.lookup, pair[:1])),
                (link_step(awaited),),
                inline_text.to_inlines(join_owner_titles(content.lookup, pair[1:])),
                inline_text.to_inlines(sign),
                (Text("; ".join(named.reasons), muted=True),),
            )


def _find_direction(content: AgreementContent, step: StartStep, awaited: StartStep) -> tuple[str, str] | None:
    """Return who of the two waits and who is awaited; None where that is somebody else, or both at both ends."""
    own, other = (_list_owners(content, each) for each in (step, awaited))
    for pair in (content.pair, content.pair[::-1]):
        if pair[0] in own and pair[1] in other and not (pair[1] in own and pair[0] in other):
            return pair[0], pair[1]
    return None


def _list_owners(content: AgreementContent, step: StartStep) -> frozenset[str]:
    """Return the owners of what a step starts; those of a container are the owners of all that it loads."""
    nodes = content.lookup.architecture.nodes
    if step.kind != "container":
        return frozenset(nodes[step.id].owners)
    return frozenset(owner for node in nodes.values() if node.container == step.container for owner in node.owners)
