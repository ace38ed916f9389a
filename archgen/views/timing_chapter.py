"""The timing chapters of report and site: the architecture as a whole, hosts, network, and chains one by one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.views import tables, timing, timing_between, timing_of, timing_verdicts, words
from archgen.views.bars import Drawing
from archgen.views.index import Index
from archgen.views.shapes import Block, Figure, Paragraph, Section
from archgen.views.timed import Timed


def figures(drawn: Mapping[str, Drawing], *names: str) -> tuple[Figure, ...]:
    """Return figures for those of the named drawings that exist, in the order of the names."""
    return tuple(Figure(f"figure:{name}", name, drawn[name].title, drawn[name].alt) for name in names if name in drawn)


def sections(view: Index, timed: Timed, drawn: Mapping[str, Drawing]) -> tuple[Section, ...]:
    """Return the sections below the summary: groups, rates, edges, services, hosts, network; no empty ones."""
    groups = figures(drawn, *(f"timing/{group}" for group in view.groups()))
    loads = figures(drawn, "load", *(f"load/{host}" for host in timed.analysis.hosts))
    found = (
        Section("timing:groups", "Group by group", groups),
        Section("timing:rates", "Rates and responses", _present(timing.elements(view, timed))),
        Section("timing:edges", "Where rates differ", tuple(timing_between.edges(view, timed))),
        Section("timing:services", "Services", tuple(timing_between.services(view, timed))),
        Section("timing:hosts", "Load of the hosts", (*loads, *_present(timing.hosts(view, timed)))),
        Section(
            "timing:network",
            "Network",
            _present(timing.links(view, timed), timing.topics(view, timed)),
        ),
    )
    return tuple(section for section in found if section.blocks)


def blocks(view: Index, timed: Timed, drawn: Mapping[str, Drawing]) -> tuple[Block, ...]:
    """Return the summary: verdicts, what is late, trigger rings, activities by period, and the picture of the whole."""
    table = _present(timing.steps(view, timed))
    return (
        timing_verdicts.summary(timed),
        *timing_verdicts.late(view, timed),
        *timing_verdicts.troubles(timed),
        *table,
        *figures(drawn, "timing"),
    )


def chain_blocks(view: Index) -> tuple[Block, ...]:
    """Return the table of all chains, with their bounds where the timing analysis found some."""
    table = tables.chains(view, view.architecture.chains.values())
    if view.timed is not None and view.timed.chains:
        table = timing_verdicts.chains(view, view.timed)
    lead = Paragraph(words.text("From what the robot senses to what it does, with the time that it may take."))
    return (lead, table) if table else ()


def chains(view: Index, drawn: Mapping[str, Drawing]) -> Iterator[Section]:
    """Yield a section for each chain that the timing analysis judged."""
    for result in view.timed.chains if view.timed else ():
        chain = view.architecture.chains.get(result.id)
        if chain is not None and view.timed is not None:
            found = timing_of.chain_blocks(view, view.timed, result)
            kept = tuple(block for block in found if not isinstance(block, Figure) or block.graph in drawn)
            yield Section(f"chain:{result.id}", chain.title, kept)


def _present(*found: Block | None) -> tuple[Block, ...]:
    """Drop the blocks that could not be made."""
    return tuple(block for block in found if block is not None)
