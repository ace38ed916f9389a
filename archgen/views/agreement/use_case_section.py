"""The section on use cases: the steps in which one partner sends, asks or answers something to the other one."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.model.step_connections import ConnectedStep
from archgen.views import inline_text
from archgen.views.agreement.agreement_content import AgreementContent
from archgen.views.sequences.sequence_blocks import make_step_table
from archgen.views.shapes import Paragraph, Section

_LEAD = (
    "What the interfaces are there for: these steps run along them, under their numbers in the whole use case. They say what happens "
    "and change no interface."
)


def write_use_case_section(content: AgreementContent) -> Iterator[Section]:
    """Yield the section, where steps of use cases run from one of the two to the other."""
    lookup = content.lookup
    tables = []
    for use_case_id, steps in list_crossing_steps(content).items():
        table = make_step_table(lookup, lookup.architecture.use_cases[use_case_id], steps)
        tables.append(table)
    if tables:
        yield Section("page:use_cases", "Use cases", (Paragraph(inline_text.to_inlines(_LEAD)), *tables))


def list_crossing_steps(content: AgreementContent) -> dict[str, tuple[ConnectedStep, ...]]:
    """Return the steps that run along an interface of the two, by use case."""
    interfaces = [record.terms.interface for record in content.records]
    crossings = {(each.output.id, port.id) for each in interfaces if each.output is not None for port in each.inputs}
    crossing_steps = {
        use_case_id: tuple(
            each for each in steps if any((way.output, way.input) in crossings for way in each.connections)
        )
        for use_case_id, steps in content.lookup.steps.by_use_case.items()
    }
    return {use_case_id: steps for use_case_id, steps in crossing_steps.items() if steps}
