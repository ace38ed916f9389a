"""A bag as what was observed of a robot: of each topic its type, what was offered, how often messages came, how large they were.

The metadata of a bag is read as it is; the messages themselves by rosbags, where that is installed.
"""

from __future__ import annotations

from collections.abc import Iterator
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
from archgen.plugin.ros import full_message_name
from archgen.plugins.recordings.bag_messages import POLICIES, keep_common, measure_topics
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
        measured = measure_topics(path, options.distro)
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
    return keep_common({policy: POLICIES[policy].get(each.get(policy)) for policy in POLICIES} for each in profiles)
