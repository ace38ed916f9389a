"""A recording held against the design: types, what was offered, and what outputs promise, topic by topic.

That a topic is not recorded says nothing: nobody knows whether it was sent.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction

from archgen.conformance.conformance_rules import RULES
from archgen.conformance.endpoint_comparison import EndpointComparer, EndpointPair, compare_types
from archgen.conformance.observed_robot import ObservedEndpoint, ObservedRobot, RecordedTopic
from archgen.conformance.seen_record import EndState, name_end
from archgen.derivation.ros_names import shared_topic_names
from archgen.diagnostics import Diagnostic, Label, Severity, first_written_span, join_words
from archgen.diagnostics.rule_options import OptionValues, read_option_values
from archgen.model.architecture import Architecture
from archgen.model.common_callbacks import is_common_callback
from archgen.model.component import Output
from archgen.model.node import Topic
from archgen.model.promise import Promise
from archgen.timing.figures.figure_wording import format_duration, format_rate, format_size

_FEWEST_MESSAGES = 10
"""Rates of fewer messages say nothing."""
_NS_PER_SECOND = 10**9


class RecordingComparer:
    """Compares the topics of a recording. `options` are those that the project sets, by rule."""

    def __init__(self, architecture: Architecture, robot: ObservedRobot, options: Mapping[str, OptionValues]) -> None:
        """Index the topics of the design; `ends` are those of which the recording tells something."""
        self.ends: dict[str, EndState] = {}
        self._architecture = architecture
        self._robot = robot
        self._margins = {
            rule.name: read_option_values(rule.options, options.get(rule.name, {}))["margin"]
            for rule in RULES
            if rule.options
        }
        self._shared = shared_topic_names(architecture.shared_topics)
        self._topics = {name: each for name, each in architecture.topics.items() if each.is_known}

    def count_expected(self) -> int:
        """Return how many topics of the design somebody publishes."""
        return sum(each.flow == "topic" and bool(each.writers) for each in self._topics.values())

    def count_recorded(self) -> int:
        """Return how many of them have messages in the recording."""
        return sum(each.count > 0 and self._find_topic(each) is not None for each in self._robot.topics)

    def compare_topics(self) -> Iterator[Diagnostic]:
        """Yield what differs, topic by topic."""
        pairs: list[EndpointPair] = []
        for recorded in self._robot.topics:
            topic = self._find_topic(recorded)
            if topic is None:
                yield from self._report_strange(recorded)
                continue
            own_pairs = [
                EndpointPair(
                    writer,
                    ObservedEndpoint(
                        "", "publishes", "topic", recorded.name, recorded.message, recorded.qos, at=recorded.at
                    ),
                )
                for writer in topic.writers
            ]
            for pair in own_pairs:
                node = self._architecture.nodes[pair.designed.node]
                findings = list(compare_types(node, pair, self._robot.where))
                self.ends[name_end(pair.designed)] = "differs" if findings else "seen" if recorded.count else "untold"
                yield from findings
            # What several publishers offer may differ: which of them offered what is not in a recording.
            pairs += own_pairs if len(own_pairs) == 1 else []
            yield from self._compare_figures(topic, recorded)
        comparer = EndpointComparer(self._architecture, self._robot)
        yield from comparer.compare_qos(pairs)
        self.ends |= dict.fromkeys(comparer.differing, "differs")

    def _find_topic(self, recorded: RecordedTopic) -> Topic | None:
        topic = self._topics.get(recorded.name)
        return topic if topic is not None and topic.flow == "topic" and topic.writers else None

    def _report_strange(self, recorded: RecordedTopic) -> Iterator[Diagnostic]:
        name = recorded.name
        if not recorded.count or name in self._shared or "/_" in name or is_common_callback("subscription", name):
            return
        count = "1 message" if recorded.count == 1 else f"{recorded.count:,} messages"
        message = f"`{name}` was recorded ({count}), and the design has nobody who publishes it"
        help_line = "give the component that publishes it an output, or leave it out of recordings"
        yield Diagnostic("not-in-model", message, recorded.at, help=help_line, element=name)

    def _compare_figures(self, topic: Topic, recorded: RecordedTopic) -> Iterator[Diagnostic]:
        outputs = {
            writer.port: output
            for writer in topic.writers
            if writer.port is not None and (output := self._architecture.outputs.get(writer.port)) is not None
        }
        for port, output in outputs.items():
            if output.promise is not None and recorded.count > 0:
                yield from self._compare_promise(port, output.promise, recorded)
        yield from self._compare_size(topic, recorded)
        yield from self._compare_frames(outputs, recorded)

    def _compare_promise(self, port: str, promise: Promise, recorded: RecordedTopic) -> Iterator[Diagnostic]:
        """Yield what of a promise was not kept. Of several publishers of a topic none sent more than all together."""
        is_enough = recorded.count >= _FEWEST_MESSAGES and recorded.duration > 0
        if promise.rate is not None and is_enough:
            intervals = recorded.count - 1 if recorded.is_own_duration else recorded.count
            rate = Fraction(intervals * _NS_PER_SECOND, recorded.duration)
            if rate < promise.rate.value * (1 - self._margins["rate-below-promise"]):
                whole = "" if recorded.is_own_duration else " over the whole recording, whenever it began"
                words = f"{recorded.count:,} messages of `{recorded.name}` came at {format_rate(rate)}{whole}"
                # Of a topic that began late the whole recording says too little.
                severity = None if recorded.is_own_duration else Severity.WARNING
                yield self._report_broken("rate-below-promise", port, promise, "rate", recorded, words, severity)
        if promise.max_gap is None:
            return
        if recorded.longest_gap is not None:
            limit = promise.max_gap.value * (1 + self._margins["gap-above-promise"])
            if recorded.longest_gap > limit:
                gap = format_duration(Fraction(recorded.longest_gap))
                words = f"between two of {recorded.count:,} messages of `{recorded.name}` lay {gap}"
                yield self._report_broken("gap-above-promise", port, promise, "max_gap", recorded, words)
        if recorded.delay is not None:
            limit = promise.max_gap.value * (1 + self._margins["late-first-message"])
            if recorded.delay > limit:
                delay = format_duration(Fraction(recorded.delay))
                words = f"the first message of `{recorded.name}` came {delay} after the recording began"
                yield self._report_broken("late-first-message", port, promise, "max_gap", recorded, words)

    def _report_broken(  # noqa: PLR0913, PLR0917 - what a finding about a promise says
        self,
        rule: str,
        port: str,
        promise: Promise,
        key: str,
        recorded: RecordedTopic,
        words: str,
        severity: Severity | None = None,
    ) -> Diagnostic:
        promised = getattr(promise, key)
        phrase = f"{promised} are promised" if key == "rate" else f"gaps of at most {promised} are promised"
        place = first_written_span(promise.places.get(key, promise.at), promise.at)
        help_line = "find out what holds it up, or promise less"
        labels = (Label(recorded.at, "measured here"),)
        return Diagnostic(rule, f"{words}, and {phrase}", place, severity, labels, help_line, port)

    def _compare_size(self, topic: Topic, recorded: RecordedTopic) -> Iterator[Diagnostic]:
        if topic.size is None or recorded.largest_size is None:
            return
        if recorded.largest_size > topic.size.value * (1 + self._margins["larger-than-modelled"]):
            message = (
                f"a message of `{recorded.name}` had {format_size(Fraction(recorded.largest_size))}, and {topic.size} are "
                "in the model"
            )
            writer = topic.writers[0]
            carrier = self._architecture.types.get(topic.types[0]) if topic.types else None
            place = first_written_span(carrier.at if carrier is not None else writer.at, writer.at)
            help_line = "write a larger `size` at the type: loads of links and latencies rest on it"
            labels = (Label(recorded.at, "measured here"),)
            yield Diagnostic(
                "larger-than-modelled", message, place, None, labels, help_line, writer.port or writer.node
            )

    def _compare_frames(self, outputs: Mapping[str, Output], recorded: RecordedTopic) -> Iterator[Diagnostic]:
        frames = {port: _find_frame(each) for port, each in outputs.items()}
        if recorded.frames is None or not outputs or not all(frames.values()):
            return
        if any("$(" in frame for frame in frames.values() if frame):
            return
        wanted = {frame.lstrip("/") for frame in frames.values() if frame}
        strange = [frame for frame in recorded.frames if frame.lstrip("/") not in wanted]
        if strange:
            port, output = next(iter(outputs.items()))
            shown = join_words([f"`{frame}`" for frame in strange])
            designed = join_words([f"`{frame}`" for frame in sorted(wanted)])
            message = f"messages of `{recorded.name}` are given in {shown}, and in {designed} in the design"
            place = first_written_span(output.frame_at, output.promise.at if output.promise else output.at, output.at)
            help_line = f"write `frame: {strange[0]}`, or have the program write the other one"
            labels = (Label(recorded.at, "recorded here"),)
            yield Diagnostic("other-frame", message, place, None, labels, help_line, port)


def _find_frame(output: Output) -> str | None:
    """Return the frame in which an output's data is given, as it is written or promised."""
    return output.frame or (output.promise.frame if output.promise is not None else None)
