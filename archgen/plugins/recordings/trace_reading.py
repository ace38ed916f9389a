"""Read the text that `babeltrace2` prints of a ros2_tracing session: execution times of callbacks, and periods.

The tracepoints are those of ros2_tracing's design (https://github.com/ros2/ros2_tracing, doc/design_ros_2.md). The duration
of a callback is the time on the clock from its start to its end: what preempts it meanwhile is in it.

The times in which a tracer lost events: what went on meanwhile cannot be counted.
"""

from __future__ import annotations

import heapq
from collections import defaultdict
from dataclasses import dataclass, field
from fractions import Fraction

from archgen.plugin.findings import Diagnostic, Label, Severity
from archgen.plugin.ros import is_common_callback
from archgen.plugin.timing import SampleCounter, format_duration
from archgen.plugins.recordings.recorded_figures import (
    Oddities,
    OddityText,
    RecordedFigures,
    RecordingSource,
    SampleKind,
)
from archgen.plugins.recordings.recorded_names import CallbackPlace, RecordedNames, UnmappedError
from archgen.plugins.recordings.trace_events import (
    Address,
    CallbackOwner,
    Process,
    TraceEvent,
    TraceLoss,
    TraceRegistry,
    read_trace_events,
)

_PUBLISH_EVENTS = frozenset({"rclcpp_intra_publish", "rclcpp_publish", "rcl_publish"})
_NO_ADDRESS: Address = (("", ""), "")
MAX_CALLBACKS = 50_000
"""A trace of more callbacks than this is not that of a robot; it bounds memory."""
_TWIN_REASON = "several processes have a node of this name"
_ODDITIES = {
    "backwards": OddityText(
        "time goes backwards {count} time{s}, here first: what lasted across is not counted",
        "a clock was set, or two recordings follow one another: give them as two files",
    ),
    "lost": OddityText(
        "the tracer discarded {count} event{s}, here first: what was going on meanwhile is not counted",
        "record fewer events, or with larger buffers (`subbuffer_size_ust` of the launch action `Trace`)",
    ),
    "undated loss": OddityText(
        "the tracer discarded {count} event{s}, and nothing says when: some figures may be too large",
        "print the trace again with babeltrace2",
    ),
    "unreadable": OddityText(
        "{count} line{s} of ros2 events cannot be read, this one first",
        "print the trace again with `babeltrace2 FOLDER`",
        rule="syntax-error",
    ),
    "begun again": OddityText(
        "{count} callback{s} began again before an end, in one thread, here first: events are missing; not counted"
    ),
    "without start": OddityText(
        "of {count} callback{s} only the end was recorded, here first; not counted", severity=Severity.NOTE
    ),
    "without end": OddityText(
        "the recording is cut off: {count} callback{s} began and did not end, this one first; not counted",
        severity=Severity.NOTE,
    ),
    "no nodes": OddityText(
        "the trace has callbacks and no `ros2:rcl_node_init`: nothing says whose they are",
        "start the tracing session before the nodes",
        rule="missing-key",
    ),
}


@dataclass(slots=True)
class _Samples:
    """What one callback, activity or topic did."""

    line: int
    executions: SampleCounter = field(default_factory=SampleCounter)
    gaps: SampleCounter = field(default_factory=SampleCounter)
    count: int = 0
    _latest: int = 0
    _epoch: int = -1

    def add_event(self, time: int, epoch: int) -> None:
        """Count an activation or a message, and the time since the one before it in the same epoch."""
        self.count += 1
        if self._epoch == epoch:
            self.gaps.add_sample(time - self._latest)
        self._latest, self._epoch = time, epoch


def read_trace(source: RecordingSource, names: RecordedNames, figures: RecordedFigures) -> None:
    """Read a trace. Raise RecordingError where it cannot be used at all."""
    reader = _TraceReader(source, names)
    for event in read_trace_events(source, reader.oddities):
        if isinstance(event, TraceLoss):
            reader.read_loss(event)
        else:
            reader.read_event(event)
    reader.finish(figures)


class _TraceReader:
    def __init__(self, source: RecordingSource, names: RecordedNames) -> None:
        self.oddities = Oddities(source)
        self._source = source
        self._names = names
        self._registry = TraceRegistry()
        self._silence = LossTimes()
        self._time = 0
        self._epoch = 0
        """Counts the interruptions: what lasted across one was not seen whole."""
        self._running: dict[tuple[Process, str, str], TraceEvent] = {}
        self._owned: dict[tuple[CallbackOwner, Address], _Samples] = {}
        """By owner and, of timers, the address of the callback: a node may have two timers of one period."""
        self._unowned: dict[str, _Samples] = {}
        self._activations: dict[str, _Samples] = {}
        """By activity: several subscriptions may fire one."""
        self._messages: dict[str, _Samples] = {}
        """By topic: several nodes may publish on it."""
        self._publish_events: dict[Address, str] = {}
        self._places: dict[CallbackOwner, CallbackPlace | str] = {}
        """What each owner is in the design, or why it is nothing."""

    def read_loss(self, loss: TraceLoss) -> None:
        """Take in that events were lost."""
        if loss.start is None or loss.end is None:
            self.oddities.note("undated loss", loss.line, loss.count)
            self._interrupt()
        else:
            self.oddities.note("lost", loss.line, loss.count)
            self._silence.add_times(loss.start, loss.end)

    def read_event(self, event: TraceEvent) -> None:
        """Take in an event."""
        if event.time < self._time:
            self.oddities.note("backwards", event.line)
            self._interrupt()
        self._time = event.time
        if self._registry.read_event(event):
            self._check_size(event)
            return
        if self._silence.has_begun(event.time):
            self._interrupt()
            if self._silence.covers(event.time):
                return
        if event.name == "callback_start":
            self._start_callback(event)
        elif event.name == "callback_end":
            self._end_callback(event)
        elif event.name in _PUBLISH_EVENTS:
            self._publish(event)

    def _interrupt(self) -> None:
        self._running.clear()
        self._epoch += 1

    def _check_size(self, event: TraceEvent) -> None:
        if (
            self._registry.is_too_large()
            or max(len(self._owned) + len(self._unowned), len(self._running)) > MAX_CALLBACKS
        ):
            message = "the trace tells of more things than any robot has"
            raise self._source.refuse(event.line, message, "record one robot at a time", "too-large")

    def _start_callback(self, event: TraceEvent) -> None:
        callback = event.fields.get("callback", "")
        key = (event.process, event.thread, callback)
        if key in self._running:
            self.oddities.note("begun again", event.line)
        self._running[key] = event
        self._check_size(event)
        owner = self._registry.find_owner(event.process, callback)
        self._samples_of(owner, event).add_event(event.time, self._epoch)
        place = self._find_place(owner) if owner and owner.kind != "timer" else None
        if isinstance(place, CallbackPlace) and place.stored_input is None:
            activations = self._activations.setdefault(place.activity, _Samples(event.line))
            activations.add_event(event.time, self._epoch)

    def _end_callback(self, event: TraceEvent) -> None:
        callback = event.fields.get("callback", "")
        start = self._running.pop((event.process, event.thread, callback), None)
        if start is None:
            self.oddities.note("without start", event.line)
        else:
            owner = self._registry.find_owner(event.process, callback)
            self._samples_of(owner, event).executions.add_sample(event.time - start.time)

    def _samples_of(self, owner: CallbackOwner | None, event: TraceEvent) -> _Samples:
        if owner is None:
            process = event.fields.get("procname") or event.process[1]
            return self._unowned.setdefault(process, _Samples(event.line))
        address = (event.process, event.fields.get("callback", "")) if owner.kind == "timer" else _NO_ADDRESS
        return self._owned.setdefault((owner, address), _Samples(event.line))

    def _find_place(self, owner: CallbackOwner) -> CallbackPlace | str:
        place = self._places.get(owner)
        if place is None:
            find = self._names.find_service if owner.kind == "service" else self._names.find_subscription
            try:
                place = find(owner.node, owner.name)
            except UnmappedError as error:
                place = str(error)
            self._places[owner] = place
        return place

    def _publish(self, event: TraceEvent) -> None:
        publisher = (event.process, event.fields.get("publisher_handle", ""))
        topic = self._registry.find_topic(*publisher)
        # One message passes several layers, and rclpy and older versions lack the upper ones: the first event that a
        # publisher shows counts its messages.
        if topic and self._publish_events.setdefault(publisher, event.name) == event.name:
            self._messages.setdefault(topic, _Samples(event.line)).add_event(event.time, self._epoch)

    def finish(self, figures: RecordedFigures) -> None:
        """Hand over everything."""
        for start in self._running.values():
            self.oddities.note("without end", start.line)
        if (self._owned or self._unowned) and not self._registry.node_lines:
            self.oddities.note("no nodes", min(samples.line for samples in self._unowned.values()))
        figures.diagnostics += self.oddities.diagnose(_ODDITIES)
        self._report_twins(figures)
        self._hand_over_callbacks(figures)
        self._hand_over_timers(figures)
        for activity, samples in self._activations.items():
            # A callback that waits for others, or drops its message, is no activation.
            is_partial = activity in figures.partial_activities
            if not is_partial and not self._is_twin(self._names.name_node(activity)):
                self._add_samples(figures, activity, "period", samples)
        for topic, samples in self._messages.items():
            if self._names.has_topic(topic):
                self._add_samples(figures, topic, "period", samples)
            elif not is_common_callback("subscription", topic):
                self._add_unmapped(figures, f"messages of {topic}", samples, "the design has no topic of this name")
        for process, samples in self._unowned.items():
            why = "the recording does not say whose they are"
            self._add_unmapped(figures, f"callbacks of the process {process}", samples, why)

    def _report_twins(self, figures: RecordedFigures) -> None:
        """Report nodes of one name in several processes."""
        for name, lines in self._registry.node_lines.items():
            if len(lines) > 1:
                first_line, *other_lines = lines.values()
                figures.diagnostics.append(
                    Diagnostic(
                        "ambiguous-reference",
                        f"{len(lines)} processes have a node {name}: none of its callbacks is counted",
                        self._source.span_of(other_lines[0]),
                        Severity.WARNING,
                        labels=(Label(self._source.span_of(first_line), "the first of them"),),
                        help="start one of them under another name, or record one run only",
                    )
                )

    def _is_twin(self, node: str) -> bool:
        return len(self._registry.node_lines.get(node, ())) > 1

    def _hand_over_callbacks(self, figures: RecordedFigures) -> None:
        for (owner, _), samples in self._owned.items():
            if owner.kind == "timer" or is_common_callback(owner.kind, owner.name):
                continue
            place = _TWIN_REASON if self._is_twin(owner.node) else self._find_place(owner)
            if isinstance(place, str):
                self._add_unmapped(figures, f"{owner.node}: {owner.kind} {owner.name}", samples, place)
            elif place.stored_input:
                self._add_samples(figures, place.stored_input, "storing", samples)
            else:
                self._add_samples(figures, place.activity, "execution", samples)
                if place.is_partial:
                    figures.partial_activities.add(place.activity)

    def _hand_over_timers(self, figures: RecordedFigures) -> None:
        timers: dict[str, list[tuple[int, _Samples]]] = defaultdict(list)
        for (owner, _), samples in self._owned.items():
            if owner.kind == "timer":
                timers[owner.node].append((int(owner.name), samples))
        for node, node_timers in timers.items():
            for (period, samples), match in zip(node_timers, self._match_timers(node, node_timers), strict=True):
                if isinstance(match, UnmappedError):
                    name = f"{node}: timer of {format_duration(Fraction(period))}"
                    self._add_unmapped(figures, name, samples, str(match))
                else:
                    self._add_samples(figures, match, "execution", samples)
                    self._add_samples(figures, match, "period", samples)

    def _match_timers(self, node: str, timers: list[tuple[int, _Samples]]) -> list[str | UnmappedError]:
        """Return the activity of each timer, or why it has none."""
        try:
            if self._is_twin(node):
                raise UnmappedError(_TWIN_REASON)  # noqa: TRY301 - one way for all reasons
            matches = self._names.match_timers(node, [period for period, _ in timers])
        except UnmappedError as error:
            return [error] * len(timers)
        why = UnmappedError("no activity of this node has this period, or several have")
        return [match or why for match in matches]

    def _add_samples(self, figures: RecordedFigures, element: str, kind: SampleKind, samples: _Samples) -> None:
        counter = samples.gaps if kind == "period" else samples.executions
        figures.add_samples(element, kind, counter, self._source.span_of(samples.line))

    def _add_unmapped(self, figures: RecordedFigures, name: str, samples: _Samples, why: str) -> None:
        figures.add_unmapped(name, samples.count, why, self._source.span_of(samples.line))


_MAX_LOSSES = 10_000
"""More of them are taken for one, so that a file of warnings takes no more room."""


class LossTimes:
    """The times between which the tracer lost events."""

    def __init__(self) -> None:
        self._times: list[tuple[int, int]] = []
        self._end = -1
        """The end of those that have begun."""

    def add_times(self, start: int, end: int) -> None:
        """Add a time in which events were lost."""
        heapq.heappush(self._times, (start, end))
        if len(self._times) > _MAX_LOSSES:
            self._times = [(self._times[0][0], max(end for _, end in self._times))]

    def has_begun(self, time: int) -> bool:
        """Whether such a time has begun since the last call, or still lasts."""
        has_begun = self.covers(time)
        while self._times and self._times[0][0] <= time:
            self._end = max(self._end, heapq.heappop(self._times)[1])
            has_begun = True
        return has_begun

    def covers(self, time: int) -> bool:
        """Whether events of this time may be lost."""
        return time <= self._end
