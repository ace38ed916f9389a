"""What recordings give: samples by element and figure, and what of them has no place in the design. Their lines are read
one at a time.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import BinaryIO, Literal, NamedTuple

from archgen.plugin import dataclass
from archgen.plugin.findings import Diagnostic, Severity
from archgen.plugin.importing import Span
from archgen.plugin.model import Quantity
from archgen.plugin.timing import Observation, SampleCounter, SampleStatistics, UnmappedSamples, format_duration

SampleKind = Literal["execution", "storing", "period", "latency"]
"""Execution times of an activity; those of the callback that stores an input; times between two activations, or two
messages of a topic; latencies of a chain.
"""


class RecordedFigures:
    """Collects what readers find in one or several recordings."""

    def __init__(self) -> None:
        self.diagnostics: list[Diagnostic] = []
        self.observations: list[Observation] = []
        """Figures that a recording gives as such, and not as samples."""
        self.partial_activities: set[str] = set()
        """Activities of which some callbacks do not do the whole work: the quickest is not their best case."""
        self._samples: dict[tuple[str, SampleKind], tuple[SampleCounter, Span]] = {}
        self._unmapped: dict[tuple[str, str], UnmappedSamples] = {}

    def add_samples(self, element: str, kind: SampleKind, samples: SampleCounter, at: Span) -> None:
        """Add samples of an element's figure; those of several recordings count together."""
        if not samples.count:
            return
        known_samples = self._samples.get((element, kind))
        if known_samples is None:
            known_samples = self._samples[element, kind] = (SampleCounter(), at)
        known_samples[0].add_samples(samples)

    def add_unmapped(self, name: str, count: int, why: str, at: Span) -> None:
        """Add what could not be mapped to the design."""
        earlier = self._unmapped.get((name, why))
        self._unmapped[name, why] = UnmappedSamples(
            name, count + (earlier.count if earlier else 0), why, earlier.at if earlier else at
        )

    @property
    def unmapped(self) -> tuple[UnmappedSamples, ...]:
        """Everything that could not be mapped, sorted."""
        return tuple(sorted(self._unmapped.values(), key=lambda samples: (samples.name, samples.why)))

    def list_observations(self) -> tuple[Observation, ...]:
        """Return an observation for each element, by its id; then those that recordings gave as such."""
        statistics: dict[str, dict[str, SampleStatistics]] = defaultdict(dict)
        places: dict[str, Span] = {}
        for (element, kind), (counter, at) in sorted(self._samples.items(), key=lambda item: item[0]):
            statistics[element][kind] = counter.summarise()
            places.setdefault(element, at)
        return (
            *(
                Observation(element, self._choose_figures(element, samples), places[element], samples)
                for element, samples in statistics.items()
            ),
            *self.observations,
        )

    def _choose_figures(self, element: str, samples: dict[str, SampleStatistics]) -> dict[str, Quantity]:
        """Return the figures that the design has a counterpart of."""
        values: dict[str, Fraction] = {}
        if period := samples.get("period"):
            values["period"] = Fraction(period.total, period.count)
            # Of an activity the trace knows when callbacks begin, which is later than their activation by as much as they
            # wait: only the mean says something about the gaps that the bounds rest on.
            if element.startswith("/"):
                values |= {"min_period": Fraction(period.least), "max_period": Fraction(period.largest)}
        if execution := samples.get("execution"):
            if element not in self.partial_activities:
                values["bcet"] = Fraction(execution.least)
            values["wcet"] = Fraction(execution.largest)
        values |= {kind: Fraction(samples[kind].largest) for kind in ("storing", "latency") if kind in samples}
        return {key: make_duration(value) for key, value in values.items() if value or key != "period"}


def make_duration(ns: Fraction) -> Quantity:
    """Return a duration with its text."""
    return Quantity(ns, format_duration(ns))


MAX_LINE_BYTES = 65_536
"""A line that is longer is no event and no row; its end is skipped without being kept."""

_COLOUR_PATTERN = re.compile(r"\x1b\[[0-9;]*[mK]")
"""How terminals are told colours, which `script` records too."""


class RecordingError(Exception):
    """A recording cannot be used: nothing of its file counts."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


@dataclass(frozen=True, slots=True)
class RecordingSource:
    """The file of a recording, as people named it, opened."""

    name: str
    stream: BinaryIO

    def span_of(self, line: int) -> Span:
        """Return the place of a line."""
        return Span(self.name, line, 1, line, 1)

    def refuse(self, line: int, message: str, help_line: str, rule: str = "wrong-value") -> RecordingError:
        """Return the error that ends the reading of this file."""
        return RecordingError(Diagnostic(rule, message, self.span_of(line), Severity.ERROR, help=help_line))

    def read_lines(self) -> Iterator[tuple[int, str]]:
        """Yield each line with its number, without its end and colours. Bytes that are no UTF-8 become `\ufffd`."""
        self.stream.seek(0)
        number = 0
        while line := self.stream.readline(MAX_LINE_BYTES):
            number += 1
            is_whole = line.endswith(b"\n")
            while not is_whole and (more := self.stream.readline(MAX_LINE_BYTES)):
                is_whole, line = more.endswith(b"\n"), b""
            text = line.decode("utf-8", "replace").rstrip("\r\n")
            if "\x1b" in text:
                text = _COLOUR_PATTERN.sub("", text)
            yield number, text.removeprefix("\ufeff") if number == 1 else text


class OddityText(NamedTuple):
    """How a kind of oddity is reported; the message may hold `{count}`, and `{s}` for the plural."""

    message: str
    help: str | None = None
    severity: Severity = Severity.WARNING
    rule: str = "wrong-value"


class Oddities:
    """What is odd about a recording: one finding for each kind, however often it occurs."""

    def __init__(self, source: RecordingSource) -> None:
        self._source = source
        self._first_lines: dict[str, int] = {}
        self._counts: dict[str, int] = {}

    def note(self, kind: str, line: int, count: int = 1) -> None:
        """Count an oddity of a kind; the first line of each kind is kept."""
        self._first_lines.setdefault(kind, line)
        self._counts[kind] = self._counts.get(kind, 0) + count

    def diagnose(self, texts: Mapping[str, OddityText]) -> Iterator[Diagnostic]:
        """Yield the findings, in the order of the texts by kind."""
        for kind, text in texts.items():
            if kind in self._counts:
                count = self._counts[kind]
                message = text.message.format(count=f"{count:,}", s="" if count == 1 else "s")
                yield Diagnostic(
                    text.rule, message, self._source.span_of(self._first_lines[kind]), text.severity, help=text.help
                )
