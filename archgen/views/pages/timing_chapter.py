"""The timing chapters of report and site: the architecture as a whole, hosts, network, and chains one by one."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from archgen.timing.analysis import ChainResult
from archgen.views import inline_text
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import UPRIGHT, Drawing
from archgen.views.shapes import Block, Figure, Paragraph, Section
from archgen.views.tables import functional_tables
from archgen.views.timing import element_timing, timing_tables, timing_verdicts, use_tables
from archgen.views.timing.timing_lookup import TimingLookup


def make_figures(drawings: Mapping[str, Drawing], *names: str) -> tuple[Figure, ...]:
    """Return figures for those of the named drawings that exist, in the order of the names."""
    return tuple(
        Figure(
            f"figure:{name}",
            drawings[name].id,  # on paper another one than by its name
            drawings[name].title,
            drawings[name].alt,
            narrow=f"{name}{UPRIGHT}" if f"{name}{UPRIGHT}" in drawings else None,
        )
        for name in names
        if name in drawings
    )


def make_timing_sections(
    lookup: Lookup, timing_lookup: TimingLookup, drawings: Mapping[str, Drawing]
) -> tuple[Section, ...]:
    """Return the sections below the summary: groups, rates, edges, services, hosts, network; no empty ones."""
    group_figures = make_figures(drawings, *(f"timing/{group}" for group in lookup.shown_groups()))
    load_figures = make_figures(drawings, "load", *(f"load/{host}" for host in timing_lookup.analysis.hosts))
    all_sections = (
        Section("timing:groups", "Group by group", group_figures),
        Section(
            "timing:rates",
            "Rates and responses",
            _drop_missing(
                timing_tables.make_activity_table(lookup, timing_lookup),
                use_tables.make_measured_table(lookup, timing_lookup),
            ),
        ),
        Section(
            "timing:fused", "What is used together", _drop_missing(use_tables.make_fused_table(lookup, timing_lookup))
        ),
        Section(
            "timing:edges",
            "Where a reader keeps another pace",
            tuple(use_tables.make_edge_blocks(lookup, timing_lookup)),
        ),
        Section("timing:services", "Services", tuple(use_tables.make_service_blocks(lookup, timing_lookup))),
        Section(
            "timing:hosts",
            "Load of the hosts",
            (
                *load_figures,
                *_drop_missing(
                    timing_tables.make_load_table(lookup, timing_lookup),
                    use_tables.make_resource_table(lookup, timing_lookup),
                ),
            ),
        ),
        Section(
            "timing:network",
            "Network",
            _drop_missing(
                timing_tables.make_traffic_table(lookup, timing_lookup),
                timing_tables.make_bandwidth_table(lookup, timing_lookup),
            ),
        ),
    )
    return tuple(section for section in all_sections if section.blocks)


def make_timing_blocks(
    lookup: Lookup, timing_lookup: TimingLookup, drawings: Mapping[str, Drawing]
) -> tuple[Block, ...]:
    """Return the summary: verdicts, what is late, trigger rings, activities by period, and the picture of the whole."""
    table = _drop_missing(timing_tables.make_period_table(lookup, timing_lookup))
    return (
        timing_verdicts.summarize_verdicts(timing_lookup),
        *timing_verdicts.list_late_elements(lookup, timing_lookup),
        *timing_verdicts.explain_verdict_words(timing_lookup),
        *timing_verdicts.list_trigger_troubles(timing_lookup),
        *timing_verdicts.list_unfound_bounds(lookup, timing_lookup),
        *table,
        *make_figures(drawings, "timing"),
    )


def make_chain_overview(lookup: Lookup) -> tuple[Block, ...]:
    """Return the table of all chains, with their bounds where the timing analysis found some."""
    table = functional_tables.make_chain_table(lookup, lookup.architecture.chains.values())
    if lookup.timing is not None and lookup.timing.chains:
        table = timing_verdicts.make_bound_table(lookup, lookup.timing)
    lead = Paragraph(
        inline_text.to_inlines("From what the robot senses to what it does, with the time that it may take.")
    )
    return (lead, table) if table else ()


def make_chain_sections(lookup: Lookup, drawings: Mapping[str, Drawing]) -> Iterator[Section]:
    """Yield a section for each chain that the timing analysis judged."""
    for result in lookup.timing.chains if lookup.timing else ():
        if lookup.timing is not None and result.id in lookup.architecture.chains:
            yield make_chain_section(lookup, lookup.timing, result, drawings)


def make_chain_section(
    lookup: Lookup,
    timing_lookup: TimingLookup,
    result: ChainResult,
    drawings: Mapping[str, Drawing],
    without: Collection[str] = (),
) -> Section:
    """Make the section of a chain, with those pictures that are drawn and without the facts of some keys."""
    blocks = element_timing.make_chain_blocks(lookup, timing_lookup, result, without)
    drawn_blocks = (block for block in blocks if not isinstance(block, Figure) or block.graph in drawings)
    return Section(f"chain:{result.id}", lookup.architecture.chains[result.id].title, tuple(drawn_blocks))


def _drop_missing(*optional_blocks: Block | None) -> tuple[Block, ...]:
    """Drop the blocks that could not be made."""
    return tuple(block for block in optional_blocks if block is not None)
