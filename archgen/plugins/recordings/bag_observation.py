"""A bag as what was observed of a robot: of each topic its type, what was offered, how often messages came, how large they were.

The metadata of a bag is read as it is; the messages themselves by rosbags, where that is installed. Nothing of them is decoded
but the `frame_id` of a header in front.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from archgen.plugin import replace
from archgen.plugin.importing import (
    ForeignFileError,
    MappingNode,
    ObservationOptions,
    ObservedRobot,
    RecordedTopic,
    ScalarNode,
    SequenceNode,
    Span,
    node_to_data,
    open_named_file,
    parse_yaml,
)
from archgen.plugin.ros import full_message_name, load_shipped_interfaces
from archgen.plugins.recordings.recorded_figures import RecordedFigures, RecordingError, RecordingSource
from archgen.plugins.recordings.recording_import import (
    BAG_KEY,
    BAG_METADATA,
    list_bag_topics,
    parse_bag,
    read_bag_duration,
)

_EXTRA = "pip install 'archgen[recordings]'"
_ENDINGS = {b"SQLite format 3\0": ".db3", b"\x89MCAP0\r\n": ".mcap", b"#ROSBAG V2.0": ".bag"}
"""How the files of messages begin, and how they end as rosbags asks for it."""
_HEAD_BYTES = 65_536
_MAX_FRAMES = 20
_MAX_FRAME_BYTES = 1_000
_HEADER = re.compile(r"(?:std_msgs/(?:msg/)?)?Header\s+\w+")
_FRAME_AT = 12
"""Bytes in front of a header's `frame_id`: in ROS 2 the encapsulation and the stamp, in ROS 1 the number and the stamp."""
_POLICIES: Mapping[str, Mapping[object, str]] = {
    "reliability": {1: "reliable", 2: "best_effort", "reliable": "reliable", "best_effort": "best_effort"},
    "durability": {1: "transient_local", 2: "volatile", "transient_local": "transient_local", "volatile": "volatile"},
}
"""What metadata writes for each policy: numbers until version 8, words since."""


def observe_recording(path: Path, options: ObservationOptions) -> ObservedRobot | None:
    """Read a bag; None for what is none. Raise ForeignFileError for one that cannot be read."""
    metadata = path / BAG_METADATA if path.is_dir() else path
    if not metadata.is_file():
        return None
    with open_named_file(metadata) as stream:
        head = stream.read(_HEAD_BYTES)
    ending = next((each for magic, each in _ENDINGS.items() if head.startswith(magic)), "")
    if not ending and f"{BAG_KEY}:".encode() not in head:
        return None
    if ending and path.suffix != ending:
        words = f"it holds what files with the ending `{ending}` hold"
        raise ForeignFileError(words, Span.of_file(path.name), f"call it `{path.stem}{ending}`")
    topics = {} if ending else _read_metadata(metadata)
    has_messages = bool(ending) or (path.is_dir() and any(_list_files(path)))
    unread: tuple[str, ...] = ()
    if has_messages and find_spec("rosbags") is None:
        if ending:
            words = "the messages of bags are not read"
            raise ForeignFileError(words, Span.of_file(path.name), f"`{_EXTRA}` installs what reads them")
        unread = (f"the messages: gaps, sizes and frames are not known; `{_EXTRA}` installs what reads them",)
    elif has_messages:
        measured = _read_messages(path, options.distro)
        topics = {
            name: replace(each, at=topics[name].at if name in topics else each.at) for name, each in measured.items()
        }
    return ObservedRobot(str(path), "recording", topics=tuple(topics.values()), unread=unread)


def _list_files(folder: Path) -> Iterator[Path]:
    """Yield the files of messages in the folder of a bag."""
    yield from (each for each in sorted(folder.iterdir()) if {".db3", ".mcap"} & set(each.suffixes))


def _read_metadata(file: Path) -> dict[str, RecordedTopic]:
    """Return what metadata.yaml says of each topic. Raise ForeignFileError."""
    with open_named_file(file) as stream:
        try:
            bag = parse_bag(RecordingSource(file.name, stream), RecordedFigures())
        except RecordingError as error:
            found = error.diagnostic
            raise ForeignFileError(found.message, found.span, found.help or "") from None
    duration = None if bag is None else read_bag_duration(bag)
    if bag is None or not duration:
        words = "it is no metadata of a bag that lasted some time"
        raise ForeignFileError(words, Span.of_file(file.name), "write it again with `ros2 bag reindex FOLDER`")
    _refuse_repeated_files(bag)
    topics = {}
    for name, count, node, topic in list_bag_topics(bag):
        data: Any = node_to_data(topic)
        message = full_message_name(str(data.get("type", ""))) or None
        qos = _read_profiles(data.get("offered_qos_profiles"))
        topics[name] = RecordedTopic(name, message, count, duration, is_own_duration=False, qos=qos, at=node.span)
    return topics


def _refuse_repeated_files(bag: MappingNode) -> None:
    """Raise ForeignFileError where metadata name a file twice: it would be unpacked and read so often."""
    paths = bag.get("relative_file_paths")
    known = set()
    for node in paths.items if isinstance(paths, SequenceNode) else ():
        name = Path(node.text).name if isinstance(node, ScalarNode) else ""
        if name in known:
            words = f"it names the file `{name}` twice"
            raise ForeignFileError(words, node.span, "write it again with `ros2 bag reindex FOLDER`")
        known.add(name)


def _read_profiles(written: object) -> dict[str, Any]:
    """Return the policies that all publishers of a topic offered, from a list or the text of one, as older versions write it."""
    if isinstance(written, str):
        document, _ = parse_yaml(BAG_METADATA, f"profiles:\n{written}\n")
        data = node_to_data(document.root) if document is not None else {}
        written = data.get("profiles") if isinstance(data, dict) else None
    profiles = [each for each in written if isinstance(each, dict)] if isinstance(written, list) else []
    return _keep_common({policy: _POLICIES[policy].get(each.get(policy)) for policy in _POLICIES} for each in profiles)


def _keep_common(profiles: Iterable[Mapping[str, str | None]]) -> dict[str, Any]:
    """Return the policies that are known and the same in all profiles."""
    first, *others = [dict(each) for each in profiles] or [{}]
    return {key: value for key, value in first.items() if value and all(each.get(key) == value for each in others)}


@dataclass(slots=True)
class _TopicCounter:
    message: str
    qos: dict[str, Any]
    has_header: bool
    is_ros_1: bool
    count: int = 0
    first: int = 0
    last: int = 0
    longest_gap: int = 0
    largest_size: int = 0
    frames: dict[str, None] = field(default_factory=dict)

    def add(self, time: int, data: bytes) -> None:
        """Count a message that was recorded at a time in ns."""
        if self.count:
            # Clocks of recorders may go backwards: that is no gap.
            self.longest_gap = max(self.longest_gap, time - self.last)
            self.last = max(self.last, time)
        else:
            self.first = self.last = time
        self.count += 1
        self.largest_size = max(self.largest_size, len(data))
        if self.has_header and len(self.frames) < _MAX_FRAMES:
            frame = _read_frame(data, is_big_endian=not self.is_ros_1 and data[1:2] == b"\0")
            if frame is not None:
                self.frames[frame] = None


def _read_frame(data: bytes, *, is_big_endian: bool) -> str | None:
    """Return the `frame_id` of a header in front: its length in 4 bytes, then its bytes, in ROS 2 with a 0 at the end."""
    length = int.from_bytes(data[_FRAME_AT : _FRAME_AT + 4], "big" if is_big_endian else "little")
    end = _FRAME_AT + 4 + length
    if length > _MAX_FRAME_BYTES or end > len(data):
        return None
    return data[_FRAME_AT + 4 : end].rstrip(b"\0").decode("utf-8", "replace")


MAX_UNPACKED_BYTES = 2_000_000_000
"""So much more memory may reading a bag take: a chunk says itself how large it is unpacked, and may lie."""
_MOST_TIMES = 20
"""So many times its size may a bag be unpacked, and `MAX_UNPACKED_BYTES` more."""
_ZSTD_BEGINNINGS = (b"\x28\xb5\x2f\xfd", *(bytes([first]) + b"\x2a\x4d\x18" for first in range(0x50, 0x60)))
"""How frames begin, and what may stand before them."""
_MEMORY_FILE = Path("/proc/self/statm")


@contextmanager
def _limit_memory() -> Iterator[None]:
    """Bound the memory of what is done meanwhile, where the system can: behind it stands a MemoryError."""
    if not _MEMORY_FILE.exists():
        yield
        return
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    used = int(_MEMORY_FILE.read_text(encoding="ascii").split()[0]) * resource.getpagesize()
    bounds = [each for each in (soft, hard) if each != resource.RLIM_INFINITY]
    resource.setrlimit(resource.RLIMIT_AS, (min([used + MAX_UNPACKED_BYTES, *bounds]), hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))


class _UnpackedTooLargeError(Exception):
    """A bag holds more, unpacked, than is read."""


@dataclass(slots=True)
class _UnpackedBytes:
    """How much more may be unpacked."""

    left: int

    def take_bytes(self, count: int) -> None:
        """Count what is unpacked. Raise _UnpackedTooLargeError."""
        self.left -= count
        if self.left < 0:
            raise _UnpackedTooLargeError


def _refuse_large_files(folder: Path, most_bytes: int) -> None:
    """Raise _UnpackedTooLargeError where packed files of a folder hold more together: rosbags writes them out wholly."""
    zstd: Any = import_module("rosbags.rosbag2.reader").zstd
    budget = _UnpackedBytes(most_bytes)
    for file in _list_regular_files(folder):
        # One that is broken is told where it is read as a part of the bag.
        with open_named_file(file) as stream, suppress(zstd.ZstdError, EOFError):
            if not stream.read(4).startswith(_ZSTD_BEGINNINGS):
                continue
            stream.seek(0)
            with zstd.open(stream) as unpacking:
                while block := unpacking.read(1_000_000):
                    budget.take_bytes(len(block))


def _list_regular_files(path: Path) -> list[Path]:
    return [each for each in sorted(path.iterdir() if path.is_dir() else (path,)) if each.is_file()]


def _read_messages(path: Path, distro: str) -> dict[str, RecordedTopic]:
    """Return what the messages say of each topic. Raise ForeignFileError for a bag that cannot be read."""
    from rosbags.rosbag1 import Reader as Reader1
    from rosbags.rosbag2 import Reader as Reader2

    is_ros_1 = path.suffix == ".bag"
    counters: dict[str, _TopicCounter] = {}
    start = None
    most_bytes = MAX_UNPACKED_BYTES + _MOST_TIMES * sum(each.stat().st_size for each in _list_regular_files(path))
    budget = _UnpackedBytes(most_bytes)
    try:
        if path.is_dir():
            _refuse_large_files(path, most_bytes)
        with _limit_memory(), (Reader1 if is_ros_1 else Reader2)(path) as reader:
            for connection in reader.connections:
                message = full_message_name(connection.msgtype) or connection.msgtype
                has_header = _begins_with_header(message, connection.msgdef.data, distro)
                qos = _read_offered(connection.ext)
                known = counters.get(connection.topic)
                counters[connection.topic] = _TopicCounter(
                    message, _keep_common([known.qos, qos]) if known else qos, has_header, is_ros_1
                )
            for connection, time, data in reader.messages():
                start = time if start is None else min(start, time)
                counters[connection.topic].add(time, data)
                budget.take_bytes(len(data))
    except _UnpackedTooLargeError as error:
        words = f"it unpacks to more than {most_bytes // 1_000_000:,} MB"
        help_line = "unpack its files first, or give its metadata.yaml alone"
        raise ForeignFileError(words, Span.of_file(path.name), help_line) from error
    except MemoryError as error:
        words = f"a part of it unpacks to more than {MAX_UNPACKED_BYTES // 1_000_000:,} MB"
        help_line = "record with smaller chunks, or give its metadata.yaml alone"
        raise ForeignFileError(words, Span.of_file(path.name), help_line) from error
    except Exception as error:  # whatever rosbags makes of a broken file is said in a sentence
        words = f"it cannot be read as a bag: {error}"
        raise ForeignFileError(
            words, Span.of_file(path.name), "give a bag that is whole: `ros2 bag reindex FOLDER`"
        ) from error
    return {
        name: _summarise(name, each, start or 0, Span.of_file("." if path.is_dir() else path.name))
        for name, each in counters.items()
    }


def _summarise(name: str, counter: _TopicCounter, start: int, at: Span) -> RecordedTopic:
    has_messages = counter.count > 0
    return RecordedTopic(
        name,
        counter.message,
        counter.count,
        counter.last - counter.first,
        is_own_duration=True,
        delay=counter.first - start if has_messages else None,
        longest_gap=counter.longest_gap if counter.count > 1 else None,
        largest_size=counter.largest_size if has_messages else None,
        frames=tuple(counter.frames) if counter.has_header and has_messages else None,
        qos=counter.qos,
        at=at,
    )


def _begins_with_header(message: str, definition: str, distro: str) -> bool:
    """Whether a message begins with a header: by its definition in the bag, else by what ships of ROS."""
    lines = (line.partition("#")[0].strip() for line in definition.splitlines())
    first = next((line for line in lines if line and "=" not in line.partition('"')[0]), "")
    if first:
        return _HEADER.fullmatch(first) is not None
    known = load_shipped_interfaces(distro or None).definitions.get(message)
    return known is not None and bool(known.parts[0]) and known.parts[0][0].type == "std_msgs/msg/Header"


def _read_offered(extension: Any) -> dict[str, Any]:  # noqa: ANN401 - that of rosbags for ROS 1 or ROS 2
    """Return the policies that all publishers of a connection offered; in ROS 1 a latched topic is one that is kept."""
    latching = getattr(extension, "latching", None)
    if latching is not None:
        return {"durability": "transient_local" if latching else "volatile"}
    profiles = getattr(extension, "offered_qos_profiles", ())
    return _keep_common(
        {policy: _POLICIES[policy].get(getattr(each, policy).name.lower()) for policy in _POLICIES} for each in profiles
    )
