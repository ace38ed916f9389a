"""What is promised of an interface, and what is only expected: two things that an agreement never mixes.

Promised is what an owner wrote. Expected is what follows from other figures, and nobody answers for it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

from archgen.frozen import dataclass, field, replace
from archgen.model.node import Qos
from archgen.model.partner_interfaces import PartnerInterface, list_givers
from archgen.model.quantity import Quantity
from archgen.timing.chains.measured_comparison import Observation
from archgen.timing.figures.figure_wording import format_duration, format_rate
from archgen.timing.system import activity_builder
from archgen.views import inline_text
from archgen.views.lookup import Lookup
from archgen.views.shapes import Column, Inlines, Table, Text, make_columns

PromiseStrength = Mapping[str, Fraction | int]
"""How much is promised, by aspects (`rate`, `reliability`): less of one, or one that is gone, is a weaker promise."""
SOURCE_PHRASE = ", follows from "
"""What stands between an expected figure and what it follows from."""
_UNLIMITED = 10**30


@dataclass(frozen=True, slots=True)
class TermName:
    """What a term is called. `key` is what code calls it; `node` is whose term it is, where several nodes give."""

    key: str
    title: str
    node: str = ""

    @property
    def text(self) -> str:
        """The name as it stands alone: `Rate of lidar_driver`."""
        return f"{self.title} of {self.node}" if self.node else self.title

    @property
    def words(self) -> str:
        """The name as it stands inside of a sentence."""
        return self.text if self.key == "qos" else self.text.lower()


RATE, MAX_GAP, MAX_AGE = (
    TermName("rate", "Rate"),
    TermName("max_gap", "Largest gap"),
    TermName("max_age", "Greatest age"),
)
QOS_OFFERED = TermName("qos", "QoS offered")


@dataclass(frozen=True, slots=True)
class PromiseRow:
    """A term with what is promised, expected and was measured of it, each empty where there is nothing.

    `promise_identity` is the same for whatever promises the same, in other units or words; left out, it is the text.
    """

    name: TermName
    promised: Inlines = ()
    expected: Inlines = ()
    strength: PromiseStrength = field(default_factory=dict)
    promise_identity: str = ""
    measured: Inlines = ()


def promise_limit(name: TermName, limit: Quantity, aspect: str, words: str = "{}") -> PromiseRow:
    """Return the promise to stay below a limit; `words` has a place for it."""
    strength = {aspect: -limit.value}
    promised = (Text(words.format(limit), sort_number=str(limit.value)),)
    return PromiseRow(name, promised, (), strength, str(limit.value))


def is_weaker(old_strength: PromiseStrength, new_strength: PromiseStrength) -> bool:
    """Whether something that was promised is not, or not as much, any more."""
    return any(aspect not in new_strength or new_strength[aspect] < figure for aspect, figure in old_strength.items())


def join_figures(runs: Inlines) -> str:
    """Return the figures alone, without what each follows from; readers of different ports may see several."""
    lines = (run.text for index, run in enumerate(runs) if run.line_break or not index)
    return ", ".join(line.partition(SOURCE_PHRASE)[0].removesuffix(", computed") for line in lines)


def measure_qos(qos: Qos) -> PromiseStrength:
    """Return how much a quality of service promises. Deadline and lease promise more the shorter they are."""
    limits = {"deadline": qos.deadline, "lease": qos.lease_duration}
    return {
        "reliability": int(qos.reliability == "reliable"),
        "durability": int(qos.durability == "transient_local"),
        "depth": _UNLIMITED if qos.history == "keep_all" else qos.depth or 0,
        "lifespan": qos.lifespan.value if qos.lifespan else _UNLIMITED,
        "liveliness": int(qos.liveliness == "manual_by_topic"),
        **{aspect: -limit.value for aspect, limit in limits.items() if limit},
    }


def identify_qos(qos: Qos) -> str:
    """Return a text that two qualities of service share if their values are the same, whatever their profiles are called."""
    return ", ".join(f"{aspect} {figure}" for aspect, figure in measure_qos(qos).items())


def write_promise_table(anchor: str, caption: str, giver_title: str, rows: tuple[PromiseRow, ...]) -> Table:
    """Write what is promised beside what is expected and was measured; where there is nothing, the table says so."""
    columns: tuple[Column, ...] = make_columns(
        ("Term", 0.8), (f"Promised by {giver_title}", 1.3), ("Expected, not promised", 1.7)
    )
    cells: tuple[tuple[Inlines, ...], ...] = tuple(
        (
            inline_text.to_inlines(row.name.text),
            row.promised or inline_text.to_inlines(Text("nothing", muted=True)),
            row.expected or (() if row.promised else inline_text.to_inlines(Text("not known", muted=True))),
        )
        for row in rows
    )
    if any(row.measured for row in rows):
        columns = (*columns, Column("Measured", 0.8))
        cells = tuple((*cell, row.measured) for cell, row in zip(cells, rows, strict=True))
    return Table(anchor, caption, columns, cells, numbered=False)


_NS_PER_SECOND = 10**9
_ROW_ASPECTS = {RATE.key: "rate", MAX_GAP.key: "gap", MAX_AGE.key: "max_age"}
_PROMISED_ASPECTS = {MAX_GAP.key: ("gap", "max_gap"), RATE.key: ("rate",), MAX_AGE.key: ("max_age",)}


def add_measured(
    lookup: Lookup,
    activity_names: activity_builder.ActivityNames,
    interface: PartnerInterface,
    rows: Sequence[PromiseRow],
    observations: Sequence[Observation],
) -> tuple[PromiseRow, ...]:
    """Return rows with what was measured of the interface's topics, else of who sends it.

    A row of one of several nodes (`Rate of NODE`) has what was measured of that node alone.
    """
    if interface.flow != "topic":
        return tuple(rows)
    givers = {
        endpoint.node: activity_builder.activity_of_endpoint(activity_names, endpoint)
        for endpoint in list_givers(lookup.architecture, interface)
    }
    topic_figures = _collect_figures(observations, set(interface.topic_names))
    all_figures = topic_figures or _collect_figures(observations, set(givers.values()) if len(givers) == 1 else set())
    figures_by_row = {
        row.name: _collect_figures(observations, {givers.get(row.name.node, "")})
        if row.name.node and row.name.key in _ROW_ASPECTS
        else all_figures
        for row in rows
    }
    measured_rows = [_measure_row(row, figures_by_row[row.name]) for row in rows]
    if "max_age" in all_figures and not any(row.name == MAX_AGE for row in rows):
        measured_rows.append(_measure_row(PromiseRow(MAX_AGE), all_figures))
    return tuple(measured_rows)


def _collect_figures(observations: Sequence[Observation], ids: set[str]) -> dict[str, Fraction]:
    """Return the worst that was seen of some topics or activities: rate in Hz, gap and age in ns."""
    figures: dict[str, list[Fraction]] = {}
    for observation in observations:
        if observation.id in ids:
            for aspect, value in _list_figures(observation):
                figures.setdefault(aspect, []).append(value)
    return {aspect: min(values) if aspect == "rate" else max(values) for aspect, values in figures.items()}


def _list_figures(observation: Observation) -> Iterator[tuple[str, Fraction]]:
    figures = observation.figures
    if "rate" in figures:
        yield "rate", figures["rate"].value
    elif "period" in figures and figures["period"].value:
        yield "rate", _NS_PER_SECOND / figures["period"].value
    if "max_period" in figures:
        yield "gap", figures["max_period"].value
    if "delay" in figures:
        yield "max_age", figures["delay"].value


def _measure_row(row: PromiseRow, figures: dict[str, Fraction]) -> PromiseRow:
    value = figures.get(_ROW_ASPECTS.get(row.name.key, ""))
    return row if value is None else replace(row, measured=_write_figure(row, value))


def _write_figure(row: PromiseRow, value: Fraction) -> Inlines:
    """Return a measured figure, marked where it is worse than what is promised."""
    key = row.name.key
    promised = next((row.strength[each] for each in _PROMISED_ASPECTS[key] if each in row.strength), None)
    if key == RATE.key:
        text, is_worse = format_rate(value), promised is not None and value < promised
    else:
        text, is_worse = format_duration(value), promised is not None and value > -promised
    words = f"{text} on arrival" if key == MAX_AGE.key else text
    if is_worse:
        return (Text(f"{words}, worse than promised", status="missed", sort_number=str(value)),)
    return (Text(words, sort_number=str(value)),)
