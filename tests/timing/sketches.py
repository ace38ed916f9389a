"""Systems in two lines: who runs where and how, and who feeds whom; and all that follows from them, line by line."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis, ChainResult, EventPace, Reason
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.chains.figure_explanations import explain_word
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.printed import show, show_ms
from tests.timing.random_systems import architecture


def sketch(nodes: Mapping[str, str], wires: str = "", rest: str = "") -> str:
    """Return a project of nodes (`name @host` or `name +container`: timing), each with one component and the output `out`.

    `a>b` reads it (the input is called `a`), `a~>b` as an optional input, `x>b` from outside where no node is called `x`,
    `c?s` calls the service of `s`. A message takes 1 kB, a request 500 B.
    """
    names = {head.split(" ")[0]: head for head in nodes}
    servers = [wire.split("?")[1] for wire in wires.split() if "?" in wire]
    components = "".join(f"      {name}: {_component(name, names, servers, wires)}\n" for name in names)
    lines = "".join(f"  {name}: {_node(name, head, nodes[head])}\n" for name, head in names.items())
    types = (
        "types: {Data: {message: std_msgs/msg/String, size: 1 kB}, Ask: {message: std_srvs/srv/Trigger, size: 500 B}}"
    )
    return f"groups:\n  g:\n    components:\n{components}nodes:\n{lines}{types}\n{rest}\n"


def _component(name: str, names: Mapping[str, str], servers: list[str], wires: str) -> str:
    inputs: list[str] = []
    for wire in wires.split():
        source, mark, target = (part for part in _split_wire(wire))
        if mark == "?" and source == name:
            inputs.append(f"{target}: {target}.serve")
        elif mark != "?" and target == name and source not in names:
            inputs.append(f"{source}: {{external: Something happens, medium: physical}}")
        elif mark == ">" and target == name:
            inputs.append(f"{source}: {source}.out")
        elif mark == "~>" and target == name:
            inputs.append(f"{source}: {{from: {source}.out, optional: true}}")
    is_writer = name not in servers or f"{name}>" in wires
    outputs = [*(["out: Data"] if is_writer else []), *(["serve: Ask"] if name in servers else [])]
    return f"{{inputs: {{{', '.join(inputs)}}}, outputs: {{{', '.join(outputs)}}}}}"


def _split_wire(wire: str) -> tuple[str, str, str]:
    mark = next(mark for mark in ("~>", ">", "?") if mark in wire)
    source, _, target = wire.partition(mark)
    return source, mark, target


def _node(name: str, head: str, timing: str) -> str:
    place, _, container = head.partition("+")
    host = place.partition("@")[2]
    parts = [f"implements: {name}", *([f"host: {host}"] if host else [])]
    parts += [f"container: {container}"] if container else []
    return f"{{{', '.join([*parts, *([f'timing: {{{timing}}}'] if timing else [])])}}}"


def read_sketch(nodes: Mapping[str, str], wires: str = "", rest: str = "") -> Architecture:
    """Return the architecture of a sketch."""
    return architecture(sketch(nodes, wires, rest))


def analyse_sketch(nodes: Mapping[str, str], wires: str = "", rest: str = "") -> Analysis:
    """Return what follows from a sketch."""
    return analyse_architecture(read_sketch(nodes, wires, rest))


def _reasons(reasons: tuple[Reason, ...]) -> str:
    return " | ".join(f"{reason.text} @{reason.at.line}:{reason.at.column}" for reason in reasons)


def _pace(pace: EventPace) -> str:
    how = "inferred" if pace.inferred else "written"
    return (
        f"{pace.behaviour} {how}: {show(pace.rate)} Hz, gap {show_ms(pace.gap)}, jitter {show_ms(pace.jitter)},"
        f" apart {show_ms(pace.distance)}"
    )


def list_paces(analysis: Analysis) -> list[str]:
    """Return how often everything works: `name behaviour: rate, gap, jitter, smallest gap`."""
    return [f"{name} {_pace(pace)}" for name, pace in analysis.paces.items()]


def list_reasons(analysis: Analysis) -> list[str]:
    """Return the reasons of rates and responses with their places."""
    return [
        *(f"{name}: {_reasons(pace.reasons)}" for name, pace in analysis.paces.items()),
        *(f"{name} takes: {_reasons(time.reasons)}" for name, time in analysis.responses.items()),
    ]


def list_outputs(analysis: Analysis) -> list[str]:
    """Return how often everything is published, with the reasons of its own that an output has."""
    return [
        f"{name} {key} {_pace(pace)}{' # ' if pace.reasons else ''}{_reasons(pace.reasons)}"
        for (name, key), pace in analysis.outputs.items()
    ]


def list_responses(analysis: Analysis) -> list[str]:
    """Return all responses: `name best..worst tier`."""
    return [
        f"{name} {show_ms(time.best)}..{show_ms(time.worst)} {time.tier}" for name, time in analysis.responses.items()
    ]


def list_hosts(analysis: Analysis) -> list[str]:
    """Return the loads of hosts: in all, core by core, activity by activity, and the bounds."""
    return [line for name in analysis.hosts for line in _host(analysis, name)]


def _host(analysis: Analysis, name: str) -> Iterator[str]:
    load = analysis.hosts[name]
    bounds = f"rm {show(load.rate_monotonic_bound)}, edf {show(load.earliest_deadline_bound)}"
    yield f"{name}: {show(load.utilisation)} of {load.cores}: {load.verdict}; {bounds}"
    yield "  " + ", ".join(f"{core} ({count}) {show(part)}" for core, count, part in load.core_loads)
    yield "  " + ", ".join(f"{activity} {show(part)}" for activity, part in load.activity_shares)


def list_links(analysis: Analysis) -> list[str]:
    """Return the loads of links: traffic, share, burst, queueing, and what each topic adds."""
    return [
        f"{name}: {show(load.traffic)} B/s, share {show(load.share)}, burst {show(load.burst)} B,"
        f" queueing {show_ms(load.queueing)}; "
        + ", ".join(f"{topic} {show(part)}" for topic, part in load.topic_traffic)
        for name, load in analysis.links.items()
    ]


def list_topics(analysis: Analysis) -> list[str]:
    """Return the loads of topics."""
    return [
        f"{name}: {show(load.size)} B, {show(load.published)} B/s published, {show(load.delivered)} delivered"
        for name, load in analysis.topics.items()
    ]


def list_edges(analysis: Analysis) -> list[str]:
    """Return how the ends of each arc fit together."""
    return [
        f"{fit.arc.source}>{fit.arc.target}: loss {show(fit.loss)}, rereads {show(fit.rereads)},"
        f" beat {show_ms(fit.beat)}, queue {show(fit.queue)}"
        for fit in analysis.edges
    ]


def list_services(analysis: Analysis) -> list[str]:
    """Return how long answers take, and what becomes of those who wait for them."""
    return [
        f"{name} asked by {','.join(load.callers)}: {show_ms(load.worst)}; "
        + ", ".join(
            f"{caller} waits {show_ms(wait)} takes {show_ms(load.synchronous_responses[caller])}"
            for caller, wait in load.waits.items()
        )
        for name, load in analysis.services.items()
    ]


def list_chains(analysis: Analysis, model: Architecture) -> list[str]:
    """Return all chains: figures, verdict, and each term (waits, takes, link) with its reason."""
    return [line for chain in bound_all_chains(analysis, model).values() for line in _chain(chain)]


def _chain(chain: ChainResult) -> Iterator[str]:
    figures = (chain.bound, chain.best, chain.reduced_reaction, chain.reduced_age)
    bound, best, reaction, age = map(show_ms, figures)
    yield f"{chain.id} {' > '.join(chain.through)}: {bound}, best {best}, from a sample {reaction}, age {age}: {chain.verdict}"
    for term in chain.terms:
        figures_of_term = " + ".join(map(show_ms, (term.link, term.sampling, term.response)))
        yield f"  {term.activity} {figures_of_term}: {term.why} @{term.at.line}:{term.at.column}"


def explain(analysis: Analysis, model: Architecture, word: str) -> list[str]:
    """Return the reasoning behind what an id names, indented, each line with its place."""
    return [
        f"{'  ' * line.depth}{line.text} @{line.at.line}:{line.at.column}"
        for line in explain_word(analysis, bound_all_chains(analysis, model), word)
    ]
