"""What an output promises to the readers of an interface, beside what follows from the figures of timing; and the version
of an interface: a short hash of what passes over the wire, and of what is promised of it.

Titles, ids, order, hosts, nodes and what is only expected are no part of it. The comments of fields are: units stand there.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import TypeVar

from archgen.analyses.kept_promises import judge_promises, rank_bound
from archgen.derivation.ros_names import default_port_name
from archgen.diagnostics import Span
from archgen.frozen import dataclass, replace
from archgen.model.agreed_terms import RULES, hash_text
from archgen.model.component import Output
from archgen.model.component_nesting import find_relied_output
from archgen.model.declared_timing import OutputTiming
from archgen.model.known_interfaces import Interface, InterfaceField, Interfaces
from archgen.model.node import Endpoint, Evidence, Qos
from archgen.model.partner_interfaces import PartnerInterface, list_givers
from archgen.model.promise import Promise, describe_deprecation, format_range
from archgen.model.quantity import Quantity
from archgen.model.ros_distro import is_ros_1
from archgen.timing.chains.chain_verdicts import find_read_ages, find_sent_ages
from archgen.timing.figures.figure_wording import format_duration
from archgen.timing.figures.tick_unit import written_period
from archgen.timing.figures.timing_values import TimingValue, is_boundless
from archgen.timing.system import activity_builder
from archgen.views import inline_text
from archgen.views.agreement.promise_rows import (
    MAX_AGE,
    MAX_GAP,
    RATE,
    SOURCE_PHRASE,
    JudgedWords,
    PromiseRow,
    PromiseStrength,
    TermName,
    find_giver_timing,
    identify_qos,
    judge_sent_gaps,
)
from archgen.views.inline_text import format_qos
from archgen.views.lookup import Lookup
from archgen.views.shapes import Fact, Inlines, Text
from archgen.views.timing import value_format

_WORDS = {"rate": "at least {}", "max_gap": "at most {}", "max_age": "no older than {}"}
_Value = TypeVar("_Value")


@dataclass(frozen=True, slots=True)
class CountedPort:
    """An output as readers name it, which says what they may count on, and those of an interface that name it."""

    port: Output
    readers: tuple[str, ...]

    @property
    def promise(self) -> Promise:
        """What it promises; nothing where it says nothing."""
        return self.port.promise or Promise()


def list_counted_ports(lookup: Lookup, interface: PartnerInterface) -> tuple[CountedPort, ...]:
    """Return the ports whose word counts for the readers of an interface; readers of equal words are taken together."""
    if interface.output is None:
        return ()
    ports: dict[tuple[object, ...], CountedPort] = {}
    for reader in interface.inputs:
        connection = next((each for each in reader.connections if interface.output.id in each.outputs), None)
        port = find_relied_output(lookup.architecture, connection, interface.output) if connection else interface.output
        words = tuple((port.promise or Promise()).list_kept()), port.version, _deprecation_text(port)
        known = ports.get(words, CountedPort(port, ()))
        ports[words] = CountedPort(known.port, (*known.readers, reader.id))
    return tuple(ports.values()) or (CountedPort(interface.output, ()),)


def list_word_facts(ports: Sequence[CountedPort]) -> Iterator[Fact]:
    """Yield the version that the owner counts, and until when it may be used."""
    yield from _list_fact("Version by its owner", ports, lambda each: each.port.version)
    yield from _list_fact("Deprecated", ports, lambda each: _deprecation_text(each.port))


def _deprecation_text(port: Output) -> str | None:
    return describe_deprecation(port.deprecated) if port.deprecated else None


def _list_fact(
    name: str, ports: Sequence[CountedPort], read_text: Callable[[CountedPort], str | None]
) -> Iterator[Fact]:
    texts = _group_values(ports, read_text)
    if texts:
        yield Fact("", name, _write_values(texts, str, is_several=len(ports) > 1))


def add_promises(
    lookup: Lookup,
    activity_names: activity_builder.ActivityNames,
    interface: PartnerInterface,
    ports: Sequence[CountedPort],
    rows: Iterable[PromiseRow],
) -> Iterator[PromiseRow]:
    """Yield rows with what outputs promise in the place of what is written of their timing, which is expected then."""
    if not any(each.port.promise for each in ports):
        yield from rows
        return
    rows_by_name = {row.name: row for row in rows}
    for name in (RATE, MAX_GAP, MAX_AGE):
        key = name.key
        row = rows_by_name.pop(name, PromiseRow(name))
        if key == "max_age":
            row = replace(row, expected=_write_age(lookup, activity_names, interface))
        values = _group_values(ports, lambda each, key=key: getattr(each.promise, key))  # type: ignore[misc]
        if values:
            row = _promise_figure(
                row,
                key,
                values,
                is_several=len(ports) > 1,
                is_complete=all(getattr(each.promise, key) is not None for each in ports),
            )
        if values or row.promised or (row.expected and key != "max_age"):
            yield row
    yield from rows_by_name.values()
    yield from _list_value_rows(ports)


def _group_values(
    ports: Sequence[CountedPort], read_value: Callable[[CountedPort], _Value | None]
) -> list[tuple[_Value, tuple[str, ...]]]:
    """Return the different values with those who read them."""
    values: list[tuple[_Value, tuple[str, ...]]] = []
    for each in ports:
        value = read_value(each)
        if value is not None:
            index = next((i for i, (known, _) in enumerate(values) if known == value), None)
            if index is None:
                values.append((value, each.readers))
            else:
                values[index] = (value, (*values[index][1], *each.readers))
    return values


def _write_values(
    values: Sequence[tuple[_Value, tuple[str, ...]]], write: Callable[[_Value], str], *, is_several: bool
) -> Inlines:
    """Write values, one a line; where not all readers see the same, each with its readers."""
    lines = []
    for value, readers in values:
        names = f" for {', '.join(_shorten_id(reader) for reader in readers)}" if is_several and readers else ""
        number = str(value.value) if isinstance(value, Quantity) else None
        lines.append((Text(f"{write(value)}{names}", sort_number=number),))
    return inline_text.join_lines(lines)


def _shorten_id(port_id: str) -> str:
    return ".".join(port_id.split(".")[-2:])


def _promise_figure(
    row: PromiseRow, key: str, values: list[tuple[Quantity, tuple[str, ...]]], *, is_several: bool, is_complete: bool
) -> PromiseRow:
    """Return a row with the promised figure; what is written as timing is expected beside it."""
    written = "".join(run.text for run in row.promised)
    expected = (
        inline_text.to_inlines(f"{written}{SOURCE_PHRASE}the timing that is written") if written else row.expected
    )
    figures = [quantity.value for quantity, _ in values]
    # Of several the one that promises least counts.
    aspect, figure = ("rate", min(figures)) if key == "rate" else (key, -max(figures))
    strength: PromiseStrength = {**row.strength, **({aspect: figure} if is_complete else {})}
    promised = _write_values(values, _WORDS[key].format, is_several=is_several)
    identity = "; ".join(f"{quantity.value} {', '.join(readers) if is_several else ''}" for quantity, readers in values)
    return PromiseRow(row.name, promised, expected, strength, identity)


def _list_value_rows(ports: Sequence[CountedPort]) -> Iterator[PromiseRow]:
    """Yield the promised unit, frame and range of the values."""
    is_several = len(ports) > 1
    for name, read_text in (
        (
            TermName("range", "Range of values"),
            lambda each: format_range(each.promise.range, each.promise.unit) if each.promise.range else None,
        ),
        (TermName("unit", "Unit"), lambda each: each.promise.unit if each.promise.range is None else None),
        (TermName("frame", "Frame"), lambda each: each.promise.frame),
    ):
        texts = _group_values(ports, read_text)
        if texts:
            yield PromiseRow(
                name,
                _write_values(texts, str, is_several=is_several),
                strength=_measure_range(ports) if name.key == "range" else {},
            )


def _measure_range(ports: Sequence[CountedPort]) -> Mapping[str, Fraction]:
    limits = [each.promise.range for each in ports]
    finite = [limit for limit in limits if limit is not None and not {float("inf"), float("-inf")} & set(limit)]
    if len(finite) != len(ports):
        return {}
    least, greatest = min(limit[0] for limit in finite), max(limit[1] for limit in finite)
    return {"least": Fraction(least), "greatest": -Fraction(greatest)}


def _write_age(lookup: Lookup, activity_names: activity_builder.ActivityNames, interface: PartnerInterface) -> Inlines:
    """Return how old what is read may be at the takers of an interface, as it follows from the timing."""
    if lookup.timing is None or interface.output is None:
        return ()
    takers = {activity_builder.activity_of_endpoint(activity_names, endpoint) for endpoint in interface.taker_endpoints}
    analysis = lookup.timing.analysis
    ages = [age for arc, age in find_sent_ages(analysis, {interface.output.id}) if arc.target in takers]
    boundless = next((age for age in ages if is_boundless(age)), None)
    if boundless is not None:
        return inline_text.to_inlines("without a bound")
    known = [age.value for age in ages if age.value is not None]
    if not known:
        return ()
    complete = all(age.value is not None and age.complete for age in ages)
    words = value_format.display_duration(TimingValue(max(known), complete=complete)).replace(">= ", "at least ")
    return (Text(f"{words}{SOURCE_PHRASE}how often it is sent and read", sort_number=str(max(known))),)


def find_broken_words(lookup: Lookup, interface: PartnerInterface, ports: Sequence[CountedPort]) -> Iterator[str]:
    """Yield a sentence for each promise that figures do not keep, and for each reader that needs more than is promised."""
    broken: dict[str, JudgedWords] = {}
    for judged in _judge_words(lookup, interface, ports):
        known = broken.get(judged.promise)
        # Of the readers of an age the one who reads the oldest.
        if judged.state == "broken" and (known is None or rank_bound(judged.bound) > rank_bound(known.bound)):
            broken[judged.promise] = judged
    yield from (judged.sentence for judged in broken.values())
    freshness = {port.id: port.freshness for port in interface.inputs if port.freshness}
    for each in ports:
        for reader in each.readers:
            needed, promised = freshness.get(reader), each.promise.max_age
            if needed and promised and promised.value > needed.value:
                yield f"`{_shorten_id(reader)}` needs what is no older than {needed}, and {promised} is promised."


def find_unproven_words(
    lookup: Lookup, interface: PartnerInterface, ports: Sequence[CountedPort], known: Collection[str]
) -> Iterator[str]:
    """Yield a sentence for each promise of which nobody knows whether it is kept, since figures are missing of elements
    (activities) that are `known`: those that are new may have none yet.
    """
    names = activity_builder.name_activities(lookup.architecture)
    givers = list_givers(lookup.architecture, interface)
    for judged in (
        *(each for endpoint in givers for each in judge_sent_gaps(lookup, names, endpoint)),
        *_judge_words(lookup, interface, ports),
    ):
        missing = judged.bound.missing
        if judged.state == "unknown" and not (missing and set(known).isdisjoint(missing)):
            yield f"{judged.promise}: nobody knows it without figures of {', '.join(missing)}."


def _judge_words(lookup: Lookup, interface: PartnerInterface, ports: Sequence[CountedPort]) -> Iterator[JudgedWords]:
    """Yield what outputs promise these readers and what they ask for, with what follows from figures."""
    if lookup.timing is None or interface.output is None:
        return
    analysis, port_ids = lookup.timing.analysis, {each.port.id for each in ports if each.port.promise}
    inputs = {port.id for port in interface.inputs}
    for each in judge_promises(lookup.architecture, analysis) if port_ids else ():
        is_read_here = each.read_over is None or each.read_over.input in inputs
        if each.leaf == interface.output.id and each.port in port_ids and is_read_here:
            promise = f"`{_shorten_id(each.port)}` promises {each.promised}"
            yield JudgedWords(promise, each.words, each.state, each.bound)
    freshness = {port.id: port.freshness for port in interface.inputs if port.freshness}
    for read in find_read_ages(analysis) if freshness else ():
        if read.arc.input in freshness and read.arc.output == interface.output.id:
            need = f"`{_shorten_id(read.arc.input)}` needs what is no older than {freshness[read.arc.input]}"
            value = read.age.value
            words = "there is no bound" if value is None else f"it may be {format_duration(value)} old when it is read"
            yield JudgedWords(need, words, read.state, read.age)


def _identify_words(ports: Sequence[CountedPort]) -> list[list[str]]:
    """Return what readers may count on, for the version of an interface: the same for equal words, nothing for none."""
    words = [
        [
            *(
                f"{key} {value.value if isinstance(value, Quantity) else value}"
                for key, value in each.promise.list_kept()
            ),
            *([f"version {each.port.version}"] if each.port.version else []),
            *([f"until {each.port.deprecated.until}"] if each.port.deprecated else []),
        ]
        for each in ports
    ]
    return sorted(each for each in words if each)


_NO_EVIDENCE = Evidence("unknown")


def hash_interface(lookup: Lookup, interface: PartnerInterface, rules: int = RULES) -> str:
    """Return the version of an interface, six hexadecimal digits. By the first rules the launch has no say in it."""
    architecture = lookup.architecture
    with_qos = interface.flow == "topic" and not is_ros_1(architecture.distro)
    givers = list_givers(lookup.architecture, interface)
    message_type = architecture.types.get(interface.type or "")
    content: dict[str, object] = {
        "flow": interface.flow,
        "names": sorted({_find_first_name(endpoint) for endpoint in interface.giver_endpoints}),
        # The type is a name of the project's own; without a message it is all that says what flows.
        "carried": interface.message or f"type {interface.type}",
        "definitions": list(_list_definitions(architecture.interfaces, interface.message)),
        "meaning": _collapse_blanks((interface.output.description if interface.output else None) or ""),
        # To write down what counted before promises it.
        "promises qos": any(_find_first_qos(lookup, each).written for each in interface.giver_endpoints) and with_qos,
        "offered": _list_qos(lookup, interface.giver_endpoints) if with_qos else [],
        "asked": _list_qos(lookup, interface.taker_endpoints) if with_qos else [],
        "promised": sorted(_list_promises(lookup, endpoint) for endpoint in givers),
        "size": _write_quantity(message_type.size if message_type else None),
    }
    freshness = {_write_quantity(port.freshness) for port in interface.inputs if port.freshness}
    # Nothing where nobody asks for it: versions that were signed stay what they are.
    content |= {"freshness": sorted(freshness)} if freshness else {}
    frame_name = architecture.frame_of(interface.output) if interface.output else None
    content |= {"frame": frame_name} if frame_name else {}
    words = _identify_words(list_counted_ports(lookup, interface))
    content |= {"words": words} if words else {}
    content |= _describe_launch(interface) if rules > 1 else {}
    return hash_text(content)


def _describe_launch(interface: PartnerInterface) -> dict[str, object]:
    """Return what the launch makes of both sides, where that is not what the programs say: nothing for most interfaces."""
    parts: dict[str, set[str]] = {}
    for side, endpoints in (("gives", interface.giver_endpoints), ("takes", interface.taker_endpoints)):
        for endpoint in endpoints:
            for name, value, _ in _list_launch_parts(endpoint):
                parts.setdefault(name, set()).add(f"{side} {value}")
    return {name: sorted(values) for name, values in parts.items()}


def list_launch_words(interface: PartnerInterface) -> Iterator[tuple[str, Span]]:
    """Yield sentences on what the launch makes of an interface, each with where that is written."""
    for endpoint in (*interface.giver_endpoints, *interface.taker_endpoints):
        for name, _, sentence in _list_launch_parts(endpoint):
            reasons = (each for key, each in endpoint.evidence.items() if key.partition(".")[0] == name)
            yield sentence, next(reasons, _NO_EVIDENCE).at


def _list_launch_parts(endpoint: Endpoint) -> Iterator[tuple[str, str, str]]:
    """Yield the fields of an end that the launch has a say in, with the value and a sentence on it."""
    node, said = f"`{endpoint.node}`", endpoint.program_name or endpoint.label
    if endpoint.is_moved:
        yield "name", str(endpoint.name), f"`{said}` of {node} runs on `{endpoint.label}`"
    elif endpoint.name is None and endpoint.evidence.get("name", _NO_EVIDENCE).rule:
        yield "name", "unknown", f"nobody knows on what `{said}` of {node} runs"
    if endpoint.qos_override in {"obeyed", "unknown"}:
        doubt = ", if its program allows that" if endpoint.qos_override == "unknown" else ""
        words = f"the QoS of {node} is overridden{doubt}: {format_qos(endpoint.qos)}"
        yield "qos", f"{endpoint.qos_override} {identify_qos(endpoint.qos)}", words
    if endpoint.domain is not None:
        yield "domain", str(endpoint.domain), f"{node} runs in the domain {endpoint.domain}"
    # One that is not known is no other one: a parameter file that is not at hand is no word of the launch.
    if endpoint.clock == "simulated":
        yield "clock", "simulated", f"{node} follows simulated time"
    if endpoint.runs in {"inactive", "off"}:
        yield "runs", str(endpoint.runs), f"{node} is {endpoint.runs}"


def _find_first_qos(lookup: Lookup, endpoint: Endpoint) -> Qos:
    """Return the quality of service of an end by the first rules: what is written at it, whatever parameters make of that."""
    if endpoint.qos_override != "obeyed":
        return endpoint.qos_if_ignored or endpoint.qos
    uses = lookup.architecture.nodes[endpoint.node].uses
    named = (each for each in uses if (each.use, each.port) == (endpoint.use, endpoint.port) and each.qos)
    return next((each.qos for each in named if each.qos), Qos())


def _find_first_name(endpoint: Endpoint) -> str:
    """Return the name of an end by the first rules: a launch moved nothing, and one that nobody says was made of the port."""
    if endpoint.is_moved and endpoint.program_name:
        return endpoint.program_name
    return endpoint.name or default_port_name(endpoint.port or endpoint.label)


def _list_definitions(interfaces: Interfaces, message: str | None) -> Iterator[object]:
    """Yield the definition of a message and of all that it holds: each once, in the order of their fields."""
    waiting, seen = [message] if message else [], set[str]()
    while waiting:
        name = waiting.pop(0)
        definition = interfaces.definitions.get(name)
        if name in seen or definition is None:
            continue
        seen.add(name)
        yield [name, *_write_definition(definition)]
        waiting += [field.type for part in definition.parts for field in part if "/" in field.type]


def _write_definition(definition: Interface) -> Iterator[object]:
    for part in definition.parts:
        yield [
            [field.name, field.type + field.array, field.default, _read_comment(definition, field)] for field in part
        ]
    # Constants have no place on the wire: their order says nothing.
    for constants in definition.constants:
        yield sorted([item.name, item.type, item.value, _collapse_blanks(item.comment)] for item in constants)


def _read_comment(definition: Interface, field: InterfaceField) -> str:
    """Return what is said of a field. An introduction counted as said of the header: signed versions stay what they are."""
    introduction = definition.introduction if field.name == "header" else ""
    return _collapse_blanks(f"{introduction} {field.comment}")


def _list_qos(lookup: Lookup, endpoints: Iterable[Endpoint]) -> list[str]:
    """Return the distinct qualities of service of written nodes, sorted."""
    nodes = lookup.architecture.nodes
    return sorted({identify_qos(_find_first_qos(lookup, each)) for each in endpoints if nodes[each.node].written})


def _list_promises(lookup: Lookup, endpoint: Endpoint) -> list[str]:
    timing = find_giver_timing(lookup, endpoint)
    output_timing = timing.outputs.get(endpoint.port or "", OutputTiming())
    behaviour = timing.behaviour if timing.behaviour in {"once", "on_demand"} else ""
    return [
        str(behaviour),
        str(written_period(timing)),
        str(output_timing.conditional),
        # Of what is sent at each activation `max_gap` says nothing.
        *map(
            _write_quantity,
            (output_timing.max_gap if output_timing.conditional else None, timing.jitter, timing.response),
        ),
    ]


def _write_quantity(quantity: Quantity | None) -> str:
    return str(quantity.value) if quantity else ""


def _collapse_blanks(text: str) -> str:
    """Return a text with single spaces: line breaks say nothing."""
    return " ".join(text.split())
