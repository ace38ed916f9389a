"""The messages of a bag, counted by rosbags in a process of its own, which is bound in time, memory and what it writes.

A bag says itself how large a chunk is unpacked, how many rows a page has and what a table is: it may lie in each of these, and
rosbags and SQLite look for hours at some kB then. Nothing of a message is decoded but the `frame_id` of a header in front.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import Any

from archgen.plugin.importing import ForeignFileError, RecordedTopic, Span, open_named_file, worker_environment
from archgen.plugin.ros import full_message_name, load_shipped_interfaces

_START = "import sys; sys.path.insert(0, {root!r}); from archgen.plugins.recordings.bag_messages import main; sys.exit(main())"
_MAX_FRAMES = 20
_MAX_FRAME_BYTES = 1_000
_HEADER = re.compile(r"(?:std_msgs/(?:msg/)?)?Header\s+\w+")
_FRAME_AT = 12
"""Bytes in front of a header's `frame_id`: in ROS 2 the encapsulation and the stamp, in ROS 1 the number and the stamp."""
POLICIES: Mapping[str, Mapping[object, str]] = {
    "reliability": {1: "reliable", 2: "best_effort", "reliable": "reliable", "best_effort": "best_effort"},
    "durability": {1: "transient_local", 2: "volatile", "transient_local": "transient_local", "volatile": "volatile"},
}
"""What metadata writes for each policy: numbers until version 8, words since."""
_ZSTD_BEGINNINGS = (b"\x28\xb5\x2f\xfd", *(bytes([first]) + b"\x2a\x4d\x18" for first in range(0x50, 0x60)))
"""How frames begin, and what may stand before them."""


@dataclass(frozen=True, slots=True)
class ReadingLimits:
    """What reading a bag may take: seconds of computing, bytes of memory, and bytes that come out of it in all."""

    computing: int
    memory: int
    unpacked: int

    @classmethod
    def for_size(cls, size: int) -> ReadingLimits:
        """Return the limits for a bag of so many bytes: 400,000 messages of 52 bytes take 1 % of the time, packed by Zstandard 6 %."""
        # Of ROS 1 all messages are indexed before the first one is read.
        return cls(7 + size // 500_000, 900_000_000 + size, 900_000_000 + 20 * size)


def measure_topics(path: Path, distro: str, limits: ReadingLimits | None = None) -> dict[str, RecordedTopic]:
    """Return what the messages of a bag say of each topic. Raise ForeignFileError for a bag that cannot be read."""
    at = Span.of_file("." if path.is_dir() else path.name)
    limits = limits or ReadingLimits.for_size(sum(each.stat().st_size for each in list_regular_files(path)))
    # The folder that holds the package `archgen`: three levels above this file's own.
    command = (sys.executable, "-P", "-c", _START.format(root=str(Path(__file__).resolve().parents[3])))
    request = {"path": str(path), "distro": distro, "limits": [limits.computing, limits.memory, limits.unpacked]}
    try:
        process = subprocess.run(  # noqa: S603 - ourselves
            command,
            input=json.dumps(request).encode(),
            env=worker_environment("HOME", "USERPROFILE", "TMPDIR", "TEMP", "TMP"),
            capture_output=True,
            # Where computing is bound, one that waits is one of a busy machine, and comes to its end.
            timeout=limits.computing * (3 if sys.platform == "win32" else 60),
            check=False,
        )
        answer = json.loads(process.stdout)
    except (subprocess.TimeoutExpired, ValueError):
        words = f"reading it takes more than {limits.computing} s of computing"
        raise ForeignFileError(words, Span.of_file(path.name), "give its metadata.yaml alone") from None
    if "refused" in answer:
        words, help_line = answer["refused"]
        raise ForeignFileError(words, Span.of_file(path.name), help_line)
    return {
        each["name"]: RecordedTopic(
            **{**each, "frames": None if each["frames"] is None else tuple(each["frames"])}, at=at
        )
        for each in answer["topics"]
    }


def list_regular_files(path: Path) -> list[Path]:
    """Return a file, or the files in a folder."""
    return [each for each in sorted(path.iterdir() if path.is_dir() else (path,)) if each.is_file()]


def main() -> int:
    """Read one bag in this process, and write what is found: one object of JSON each from and to the standard streams."""
    request = json.load(sys.stdin)
    limits = ReadingLimits(*request["limits"])
    _confine_process(limits)
    try:
        answer: dict[str, Any] = {"topics": list(read_messages(Path(request["path"]), request["distro"], limits))}
    except ForeignFileError as error:
        answer = {"refused": [error.message, error.help_line]}
    json.dump(answer, sys.stdout)
    return 0


def _confine_process(limits: ReadingLimits) -> None:
    """Bind this process; systems without such limits (Windows) still have the time in all, which the parent process watches."""
    with suppress(ImportError):
        import resource

        for kind, bound in (
            (resource.RLIMIT_CPU, limits.computing),
            (resource.RLIMIT_AS, limits.memory),
            (resource.RLIMIT_FSIZE, limits.unpacked),
            (resource.RLIMIT_CORE, 0),
        ):
            with suppress(ValueError, OSError):  # a tighter limit than ours is in force already
                resource.setrlimit(kind, (bound, bound))


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
    for file in list_regular_files(folder):
        # One that is broken is told where it is read as a part of the bag.
        with open_named_file(file) as stream, suppress(zstd.ZstdError, EOFError):
            if not stream.read(4).startswith(_ZSTD_BEGINNINGS):
                continue
            stream.seek(0)
            with zstd.open(stream) as unpacking:
                while block := unpacking.read(1_000_000):
                    budget.take_bytes(len(block))


def read_messages(path: Path, distro: str, limits: ReadingLimits) -> Iterator[dict[str, Any]]:
    """Yield what the messages say of each topic, as RecordedTopic has it. Raise ForeignFileError for a bag that cannot be read."""
    from rosbags.rosbag1 import Reader as Reader1
    from rosbags.rosbag2 import Reader as Reader2

    is_ros_1 = path.suffix == ".bag"
    counters: dict[str, _TopicCounter] = {}
    start = None
    budget = _UnpackedBytes(limits.unpacked)
    try:
        if path.is_dir():
            _refuse_large_files(path, limits.unpacked)
        with (Reader1 if is_ros_1 else Reader2)(path) as reader:
            for connection in reader.connections:
                message = full_message_name(connection.msgtype) or connection.msgtype
                has_header = _begins_with_header(message, connection.msgdef.data, distro)
                qos = _read_offered(connection.ext)
                known = counters.get(connection.topic)
                counters[connection.topic] = _TopicCounter(
                    message, keep_common([known.qos, qos]) if known else qos, has_header, is_ros_1
                )
            for connection, time, data in reader.messages():
                start = time if start is None else min(start, time)
                counters[connection.topic].add(time, data)
                budget.take_bytes(len(data))
    except _UnpackedTooLargeError as error:
        words = f"it unpacks to more than {limits.unpacked // 1_000_000:,} MB"
        help_line = "unpack its files first, or give its metadata.yaml alone"
        raise ForeignFileError(words, Span.of_file(path.name), help_line) from error
    except MemoryError as error:
        words = f"a part of it unpacks to more than {limits.memory // 1_000_000:,} MB"
        help_line = "record with smaller chunks, or give its metadata.yaml alone"
        raise ForeignFileError(words, Span.of_file(path.name), help_line) from error
    except Exception as error:  # whatever rosbags makes of a broken file is said in a sentence
        words = f"it cannot be read as a bag: {error}"
        raise ForeignFileError(
            words, Span.of_file(path.name), "give a bag that is whole: `ros2 bag reindex FOLDER`"
        ) from error
    for name, counter in counters.items():
        yield _summarise(name, counter, start or 0)


def _summarise(name: str, counter: _TopicCounter, start: int) -> dict[str, Any]:
    has_messages = counter.count > 0
    return {
        "name": name,
        "message": counter.message,
        "count": counter.count,
        "duration": counter.last - counter.first,
        "is_own_duration": True,
        "delay": counter.first - start if has_messages else None,
        "longest_gap": counter.longest_gap if counter.count > 1 else None,
        "largest_size": counter.largest_size if has_messages else None,
        "frames": list(counter.frames) if counter.has_header and has_messages else None,
        "qos": counter.qos,
    }


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
    return keep_common(
        {policy: POLICIES[policy].get(getattr(each, policy).name.lower()) for policy in POLICIES} for each in profiles
    )


def keep_common(profiles: Iterable[Mapping[str, str | None]]) -> dict[str, Any]:
    """Return the policies that are known and the same in all profiles."""
    first, *others = [dict(each) for each in profiles] or [{}]
    return {key: value for key, value in first.items() if value and all(each.get(key) == value for each in others)}
