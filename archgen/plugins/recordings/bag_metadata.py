"""Read the metadata.yaml of rosbag2: how many messages of each topic came in how much time.

The keys are the same in versions 1 to 9 of the file; later ones only added others. A topic's rate is its count by the whole
duration, so that one that began later or paused comes out slower.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from archgen.plugin.findings import Diagnostic, Severity
from archgen.plugin.importing import MappingNode, ScalarNode, SequenceNode, YamlNode, parse_yaml
from archgen.plugin.model import Quantity
from archgen.plugin.ros import is_common_callback
from archgen.plugin.timing import Observation, format_rate
from archgen.plugins.recordings.recorded_figures import RecordedFigures
from archgen.plugins.recordings.recorded_names import RecordedNames
from archgen.plugins.recordings.recording_lines import RecordingSource

BAG_KEY = "rosbag2_bagfile_information"
_LATEST_VERSION = 9
_MAX_BYTES = 16_000_000
_MAX_DIGITS = 20


def read_bag_metadata(source: RecordingSource, names: RecordedNames, figures: RecordedFigures) -> None:
    """Read the metadata of a bag. Raise RecordingError where the duration is missing."""
    bag = parse_bag(source, figures)
    if bag is None:
        return
    version = _read_count(bag.get("version"))
    if version is None or version > _LATEST_VERSION:
        shown_version = "no number" if version is None else str(version)
        message = f"the version of this file is {shown_version}; archgen knows those from 1 to {_LATEST_VERSION}"
        figures.diagnostics.append(Diagnostic("wrong-value", message, bag.span, Severity.WARNING))
    duration = read_bag_duration(bag)
    if not duration:
        message = "`duration: {nanoseconds: ...}` is missing or 0: without it there are no rates"
        raise source.refuse(
            bag.span.line, message, "write the file again with `ros2 bag reindex FOLDER`", "missing-key"
        )
    for name, count, node, _ in list_bag_topics(bag):
        if not names.has_topic(name):
            if count and not is_common_callback("subscription", name):
                figures.add_unmapped(f"messages of {name}", count, "the design has no topic of this name", node.span)
        elif count > 1:
            rate = Fraction(count * 10**9, duration)
            # One message more or less, before the first or behind the last, makes no difference to the design.
            observation = Observation(
                name, {"rate": Quantity(rate, format_rate(rate))}, node.span, {}, {"rate": Fraction(10**9, duration)}
            )
            figures.observations.append(observation)


def read_bag_duration(bag: MappingNode) -> int | None:
    """Return the duration of a whole bag in ns, None where it is not written."""
    duration_node = bag.get("duration")
    return _read_count(duration_node.get("nanoseconds")) if isinstance(duration_node, MappingNode) else None


def parse_bag(source: RecordingSource, figures: RecordedFigures) -> MappingNode | None:
    """Return what stands below the key of a bag, None for what is no YAML. Raise RecordingError."""
    source.stream.seek(0)
    data = source.stream.read(_MAX_BYTES + 1)
    if len(data) > _MAX_BYTES:
        message = f"metadata.yaml has more than {_MAX_BYTES:,} bytes"
        raise source.refuse(1, message, "give the file that rosbag2 wrote", "too-large")
    document, diagnostics = parse_yaml(source.name, data.decode("utf-8", "replace").removeprefix("\ufeff"))
    figures.diagnostics += diagnostics
    if document is None:
        return None
    bag = document.root.get(BAG_KEY)
    if not isinstance(bag, MappingNode):
        message = f"`{BAG_KEY}` is no mapping: this is not what rosbag2 wrote"
        raise source.refuse(1, message, "write the file again with `ros2 bag reindex FOLDER`", "missing-key")
    return bag


def list_bag_topics(bag: MappingNode) -> Iterator[tuple[str, int, YamlNode, MappingNode]]:
    """Yield the name, the count of messages, where the name stands, and the whole metadata of each topic."""
    topics = bag.get("topics_with_message_count")
    for item in topics.items if isinstance(topics, SequenceNode) else ():
        if not isinstance(item, MappingNode):
            continue
        topic, count = item.get("topic_metadata"), _read_count(item.get("message_count"))
        name = topic.get("name") if isinstance(topic, MappingNode) else None
        if isinstance(topic, MappingNode) and isinstance(name, ScalarNode) and count is not None:
            yield name.text, count, name, topic


def _read_count(node: YamlNode | None) -> int | None:
    """Return a whole number that is not negative."""
    text = node.text if isinstance(node, ScalarNode) else ""
    return int(text) if text.isascii() and text.isdecimal() and len(text) <= _MAX_DIGITS else None
